// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "pendulum/closed_form/sampling.h"
#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// Describes the sampling of a recording; empty if it is unknown.
Sections SamplingSections(const std::optional<Sampling>& known);

/// The closed forms of recording k, the check of the fits against them (kMain: in a comparison, of the main fit alone),
/// and the table of turning points: up to 60 if there is no fit, otherwise the first ten and the last two (kAll: up to
/// 1000). Without closed forms the reason is shown; empty if there is no reason.
Sections ClosedFormSections(const Identification& identification, std::size_t k, FitsInFull which);

}  // namespace pendulum
