// SPDX-License-Identifier: Apache-2.0
// Any bytes give a calibration with a curve, or an error sentence.
#include <cstddef>
#include <cstdint>

#include "pendulum/recording/sensor.h"
#include "tests/fuzz/require.h"

namespace pendulum {
namespace {

void Check(std::string_view text) {
  const Result<Calibration> calibration = ParseCalibration(text, "a.json");
  if (calibration) {
    const auto order = static_cast<Eigen::Index>(calibration->coefficients.size());
    Require(order >= 2 && (calibration->covariance.size() == 0 || calibration->covariance.rows() == order));
    Require(!calibration->input_range || calibration->input_range->low < calibration->input_range->high);
    Require(ParseCalibration(calibration->source.dump(), "a.json").has_value());
  } else {
    Require(calibration.error().code == StatusCode::kDataLoss);
    RequireSentence(calibration.error().message(), "a.json");
  }
}

}  // namespace
}  // namespace pendulum

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::Check(pendulum::TextOf(data, size));
  return 0;
}
