// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/status.h"

#include <utility>

namespace pendulum {

std::string MessageAt(const std::string& place, const std::string& sentence) {
  return place.empty() ? sentence : place + ": " + sentence;
}

tl::unexpected<Status> Within(const std::string& place, Status status) {
  if (!place.empty()) status.place = status.place.empty() ? place : MessageAt(place, status.place);
  return tl::unexpected<Status>(std::move(status));
}

int ExitCode(StatusCode code) {
  switch (code) {
    case StatusCode::kInvalidArgument: return 2;
    case StatusCode::kNotFound: return 3;
    case StatusCode::kDataLoss: return 4;
    case StatusCode::kFailedPrecondition: return 5;
    case StatusCode::kCannotWrite: return 73;
    case StatusCode::kTryAgain: return 75;
    case StatusCode::kInternal: return 70;
  }
  return 70;
}

}  // namespace pendulum
