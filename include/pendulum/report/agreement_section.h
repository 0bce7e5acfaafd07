// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The agreement of several recordings on the shared parameters: a verdict, and for each parameter the separate
/// estimates, the joint estimate and the random-effects mean. The fit has a homogeneity.
Section AgreementSection(const Identification& identification, std::size_t fit);

}  // namespace pendulum
