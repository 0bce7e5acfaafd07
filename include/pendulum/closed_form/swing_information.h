// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/closed_form/free_swing.h"

namespace pendulum {

/// How well a part of a swing determines its period: the inverse of the variance in white noise, but for a factor that
/// all parts of a recording share (MODEL.md eq. (6.20)). Half swings count whose middle is in [from, to], in s.
double InformationOn(const FreeSwing& swing, double from, double to);

/// What the window [from, to] leaves out of a swing; std::nullopt if it leaves out no half swing, or all.
std::optional<LeftOut> LeftOutOf(const FreeSwing& swing, double from, double to);

}  // namespace pendulum
