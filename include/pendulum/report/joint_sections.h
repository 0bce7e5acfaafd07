// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The sections specific to a joint fit: the recordings and the comparison; for the main fit the shared parameters, the
/// agreement of the recordings, and the separate parameters of each.
Sections JointSections(const Identification& identification);

/// The agreement of the recordings on the shared parameters: a verdict, and for each parameter the separate estimates,
/// the joint estimate and the random-effects mean.
Section AgreementSection(const Identification& identification, std::size_t fit);

}  // namespace pendulum
