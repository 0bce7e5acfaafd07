// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/recording.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

std::string SampleText(Eigen::Index sample) { return "sample " + std::to_string(sample); }

}  // namespace

Result<Recording> MakeRecording(Recording recording) {
  const Eigen::VectorXd& time = recording.time;
  const Eigen::VectorXd& value = recording.value;
  if (time.size() != value.size()) {
    return ErrorAt(StatusCode::kDataLoss, recording.path,
                   std::to_string(time.size()) + " times and " + std::to_string(value.size()) +
                       " values are not a recording; every sample needs one of each");
  }
  if (time.size() < kMinimumSamples) {
    return ErrorAt(StatusCode::kFailedPrecondition, recording.path,
                   std::to_string(time.size()) + " samples are too few for a recording; at least " +
                       std::to_string(kMinimumSamples) + " are needed");
  }
  if (!(recording.resolution >= 0) || !std::isfinite(recording.resolution)) {
    return ErrorAt(
        StatusCode::kDataLoss, recording.path,
        "the resolution is " + NumberText(recording.resolution) + "; it must be 0 (none) or positive and finite");
  }
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    if (!std::isfinite(time[i]) || !std::isfinite(value[i])) {
      return ErrorAt(StatusCode::kDataLoss, recording.path,
                     SampleText(i) + " is (" + NumberText(time[i]) + ", " + NumberText(value[i]) +
                         "); time and value must be finite");
    }
    if (i > 0 && time[i] <= time[i - 1]) {
      return ErrorAt(StatusCode::kDataLoss, recording.path,
                     "time " + NumberText(time[i]) + " s of " + SampleText(i) + " does not follow " +
                         NumberText(time[i - 1]) + " s; times must increase");
    }
  }
  return recording;
}

}  // namespace pendulum
