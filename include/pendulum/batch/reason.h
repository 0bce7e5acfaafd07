// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// Why a run could not be fitted, or keeps a former result: place and sentence of an error. Empty: there is no reason.
struct Reason {
  std::string place, sentence;

  bool empty() const { return sentence.empty(); }
  std::string text() const { return MessageAt(place, sentence); }
};

/// The reason that an error is.
inline Reason ReasonOf(const Status& error) { return {error.place, error.sentence}; }

}  // namespace pendulum
