// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

/// Why an end of a confidence interval is missing.
enum class OpenInterval {
  kClosed,           ///< None is missing.
  kNotDetermined,    ///< The recording does not determine the parameter.
  kFlatLikelihood,   ///< The likelihood does not fall far enough on that side.
  kNotFollowed,      ///< The profile could not be computed.
  kBetterMinimum,    ///< The profile found a better minimum than the estimate.
  kAtBound,          ///< The estimate is at its bound, and the covariance gives no other end.
  kNothingExcluded,  ///< The interval is the whole range between the bounds.
  kFailedResamples,  ///< Too many fits of the bootstrap failed.
};

/// The reason in words; empty for kClosed.
std::string_view Sentence(OpenInterval open);

}  // namespace pendulum
