// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/window.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

std::string SpanText(double from, double to) {
  std::string text = "[";
  return text.append(NumberText(from)).append(", ").append(NumberText(to)).append("] s");
}

tl::unexpected<Status> TooFew(const Recording& recording, Eigen::Index count, double from, double to) {
  const std::string span =
      recording.size() == 0 ? "is empty" : "spans " + SpanText(recording.time[0], recording.time[recording.size() - 1]);
  return ErrorAt(StatusCode::kFailedPrecondition, recording.path,
                 "the window " + SpanText(from, to) + " leaves " + std::to_string(count) +
                     " samples of a recording that " + span + "; at least " + std::to_string(kMinimumSamples) +
                     " are needed: widen the window");
}

}  // namespace

Result<Recording> SelectWindow(Recording recording, double from, double to) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  if (std::isnan(from)) from = -kOpen;
  if (std::isnan(to)) to = kOpen;
  if (from >= to) {
    return Error(StatusCode::kInvalidArgument,
                 "the window " + SpanText(from, to) + " is empty; its start must be before its end");
  }
  const double* begin = recording.time.data();
  const double* end = begin + recording.size();
  const Eigen::Index first = std::lower_bound(begin, end, from) - begin;
  const Eigen::Index count = std::upper_bound(begin, end, to) - begin - first;
  if (count < kMinimumSamples) return TooFew(recording, count, from, to);

  for (Eigen::VectorXd* const samples : {&recording.time, &recording.value}) {
    std::copy_n(samples->data() + first, count, samples->data());
    samples->conservativeResize(count);
  }
  return recording;
}

namespace {

/// Everything except the samples, which may be many.
Recording WithoutSamples(const Recording& recording) {
  Recording copy;
  copy.path = recording.path;
  copy.sha256 = recording.sha256;
  copy.quantity = recording.quantity;
  copy.unit = recording.unit;
  copy.resolution = recording.resolution;
  copy.edge = recording.edge;
  copy.oversampling = recording.oversampling;
  copy.range = recording.range;
  copy.clock_scale = recording.clock_scale;
  copy.clock_scale_std_dev = recording.clock_scale_std_dev;
  copy.calibration = recording.calibration;
  copy.arc = recording.arc;
  copy.shows_gravity = recording.shows_gravity;
  copy.rig_json = recording.rig_json;
  copy.time_source = recording.time_source;
  copy.stated_sensor = recording.stated_sensor;
  copy.sensor_errors = recording.sensor_errors;
  copy.warnings = recording.warnings;
  return copy;
}

}  // namespace

Recording Thinned(const Recording& recording, Eigen::Index max_samples) {
  const Eigen::Index stride = std::max<Eigen::Index>((recording.size() + max_samples - 1) / max_samples, 1);
  const Eigen::Index count = (recording.size() + stride - 1) / stride;
  Recording thinned = WithoutSamples(recording);
  thinned.time = recording.time(Eigen::seqN(0, count, stride));
  thinned.value = recording.value(Eigen::seqN(0, count, stride));
  return thinned;
}

Recording InTrueSeconds(Recording recording) {
  const double first = recording.time[0];
  recording.time = first + recording.clock_scale * (recording.time.array() - first);
  return recording;
}

Recording Excerpt(const Recording& recording, Eigen::Index max_samples, double per_second, bool at_end) {
  const double longest = static_cast<double>(max_samples) / per_second;
  const double first = recording.time[0];
  const double last = recording.time[recording.size() - 1];
  const double from = at_end ? std::max(first, last - longest) : first;
  const double to = at_end ? last : std::min(last, first + longest);
  const Result<Recording> part = SelectWindow(recording, from, to);
  return Thinned(part ? *part : recording, max_samples);
}

}  // namespace pendulum
