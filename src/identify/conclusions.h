// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/identify/identification.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// Adds what is concluded from the used samples and the fits of one swing: closed forms with the friction of `model`
/// (std::nullopt: none are possible), the check of those fits that are to be checked, each against closed
/// forms with its own friction, and how the
/// swing was sampled. Once a stop is requested it ends soon, with conclusions that mean nothing.
void AddConclusions(const FreeSwing& swing, const std::optional<MotionModel>& model,
                    const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop,
                    Identification& one);

}  // namespace pendulum
