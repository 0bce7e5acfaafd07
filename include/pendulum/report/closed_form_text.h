// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// Describes the sampling of the recording; empty if it is unknown.
Sections SamplingSections(const Identification& identification);

/// The closed forms, the check of each fully shown fit against them, and the table of turning points: up to 60 turning
/// points if there is no fit, otherwise the first ten and the last two. Without closed forms the reason is shown; empty
/// if there is no reason.
Sections ClosedFormSections(const Identification& identification);

}  // namespace pendulum
