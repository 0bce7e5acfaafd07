// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// How well a recording determines a parameter.
struct Identifiability {
  enum class Verdict {
    kIdentifiable,
    kWeakly,           ///< Its interval reaches a bound, or other parameters can compensate for it.
    kNotIdentifiable,  ///< It has no effect, or only its combination with other parameters has an effect.
  };
  std::string parameter;
  Verdict verdict = Verdict::kIdentifiable;
  std::vector<std::string> direction;  ///< The parameters of the combination that the recording does not determine.
  std::string advice;                  ///< Which measurement would determine it; empty if identifiable.
};

/// "identifiable", "weakly identifiable", "not identifiable".
std::string_view VerdictName(Identifiability::Verdict verdict);

/// The measurement that distinguishes a parameter from other parameters that can compensate for it.
std::string MeasurementFor(std::string_view parameter);

}  // namespace pendulum
