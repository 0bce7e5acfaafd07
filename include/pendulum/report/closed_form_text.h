// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// Describes the sampling of the recording; empty if it is unknown.
Sections SamplingSections(const Identification& identification);

/// The closed forms, the check of each fully shown fit against them, and the table of turning points. Without a fit it
/// has up to 60 turning points, next to a fit the first ten and the last two. Empty without closed forms.
Sections ClosedFormSections(const Identification& identification);

}  // namespace pendulum
