// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// Which model is recommended and why, the criteria of each, what each foresees of samples it was not fitted to, and
/// the likelihood-ratio tests. None without a comparison.
Sections ComparisonSections(const Identification& report);

/// Whether the parameters of the fit of that index are constants: a sentence, and tables of what is not. None where
/// that was not looked into.
Sections ConstancySections(const Identification& report, std::size_t fit);

}  // namespace pendulum
