// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/constancy.h"
#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The recommended model and the reason, the criteria of each model, the prediction of samples that were not fitted,
/// and the likelihood-ratio tests. Empty without a comparison.
Sections ComparisonSections(const Identification& identification);

/// Whether the parameters of a fit are constant: a sentence, and tables of the parameters that are not, or why this was
/// not tested. Empty if there is neither a verdict nor a reason, or for nullptr.
Sections ConstancySections(const Constancy* constancy);

}  // namespace pendulum
