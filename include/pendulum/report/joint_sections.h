// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// What a joint fit says instead of what one recording's report does: the recordings, the comparison, and of the main
/// fit what is shared, whether the recordings agree, and what each has of its own.
Sections JointSections(const Identification& report);

/// Whether the recordings agree on what is shared: a verdict, and for each parameter the recordings' own estimates, the
/// joint one and the random-effects mean.
Section AgreementSection(const Identification& report, std::size_t fit);

}  // namespace pendulum
