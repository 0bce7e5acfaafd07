// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/status.h"

namespace pendulum {

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
