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

/// Adds the conclusions from the used samples and the fits of recording k: closed forms with the friction of `model`
/// (std::nullopt: no closed forms), checks of the fits against closed forms with their friction, where is_checked(fit)
/// is true, and a description of the sampling. After a stop request the function ends soon, and the conclusions are
/// meaningless.
void AddConclusions(const FreeSwing& swing, const std::optional<MotionModel>& model,
                    const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop, std::size_t k,
                    Identification& identification);

}  // namespace pendulum
