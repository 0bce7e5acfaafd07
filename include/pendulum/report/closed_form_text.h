// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// How the recording was sampled; none when the report does not say.
Sections SamplingSections(const Identification& report);

/// The closed forms, the check of each fit that is shown in full against them, and the table of turning points: all
/// turning points of closed forms only (60 at most), beside a fit the first ten and the last two. None without these.
Sections ClosedFormSections(const Identification& report);

}  // namespace pendulum
