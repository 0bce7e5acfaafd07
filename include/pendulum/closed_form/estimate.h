// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// A number and its standard error, in the unit given at its declaration.
struct Estimate {
  double value = 0;
  double std_error = 0;
};

}  // namespace pendulum
