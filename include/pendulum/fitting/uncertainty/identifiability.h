// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// What a recording can tell of a parameter.
struct Identifiability {
  enum class Verdict {
    kIdentifiable,
    kWeakly,           ///< Its interval reaches a bound, or it can be traded for others.
    kNotIdentifiable,  ///< It leaves no trace, or only a combination with others does.
  };
  std::string parameter;
  Verdict verdict = Verdict::kIdentifiable;
  std::vector<std::string> direction;  ///< The parameters of the combination that the recording does not tell.
  std::string advice;                  ///< What to measure to settle it; empty when identifiable.
};

/// "identifiable", "weakly identifiable", "not identifiable".
std::string_view VerdictName(Identifiability::Verdict verdict);

/// Which measurement would tell a parameter apart from those it can be traded for.
std::string MeasurementFor(std::string_view parameter);

}  // namespace pendulum
