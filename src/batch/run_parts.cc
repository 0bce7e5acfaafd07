// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/run_parts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/base/format.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/repair_values.h"

namespace pendulum {

Result<ReadSwings> FindSwings(Recording read, const SwingChoice& choice, std::optional<Rig> rig,
                              const FitOptions& fit) {
  if (!rig && !read.rig_json.empty()) {
    auto own = ParseRig(read.rig_json, read.path + ": # rig");
    if (!own) return tl::unexpected(own.error());
    rig = *std::move(own);
  }
  ReadSwings one;
  one.samples = read.size();
  // Readings far apart in time do not resemble their neighbours, which repairs rest on.
  one.recording = IsUndersampled(read, rig) ? std::move(read) : WithEdges(RepairValues(std::move(read)), fit.noise);
  one.samples = std::max(one.samples, one.recording.size());  // silences between events
  auto swings = ChooseSwings(one.recording, choice, rig);
  if (!swings) return tl::unexpected(swings.error());
  one.swings = *std::move(swings);
  one.common.rig = std::move(rig);
  one.common.warnings = std::exchange(one.recording.warnings, {});
  if (one.recording.calibration) one.common.calibration = one.recording.calibration->source;
  return one;
}

Result<ReadSwings> ReadOne(const RunOptions& options, const std::string& path, std::optional<Rig> rig) {
  auto read = ReadRecording(path, options.read);
  if (!read) return tl::unexpected(read.error());
  return FindSwings(*std::move(read), options.swing, std::move(rig), options.fit);
}

tl::unexpected<Status> ErrorAmong(const Status& status, const std::string& path, int release) {
  const std::string name = path == "-" ? "standard input" : path;
  if (release == 0 && status.message.starts_with(name + ":")) return tl::unexpected(status);
  const std::string where = name + ": ";
  const std::size_t skip = status.message.starts_with(where) ? where.size() : 0;
  return Error(status.code, where + (release == 0 ? "" : "free swing " + std::to_string(release) + ": ") +
                                status.message.substr(skip));
}

void AddClosedForms(const MotionModel& model, const Recording& used, RunReport& report) {
  auto forms = EstimateClosedForms(used, model);
  if (!forms) {
    report.no_closed_forms = forms.error().message;
    return;
  }
  report.closed_forms = *std::move(forms);
  report.closed_forms_model = model.name;
}

void AddChecks(const Recording& used, RunReport& report) {
  if (!report.closed_forms) return;
  for (const FitReport& fit : report.fits) {
    report.checks.emplace_back();
    if (fit.termination == Termination::kFailed) continue;
    const bool same = fit.model.name == report.closed_forms_model;
    const auto own = same ? Result<ClosedForms>(*report.closed_forms) : EstimateClosedForms(used, fit.model);
    if (own) report.checks.back() = CheckClosedForms(used, *own, fit, report.rig);
  }
}

namespace {

/// The rig's geometry is rough, but not by so much.
void WarnOfFrequency(const Sampling& sampling, RunReport& report) {
  constexpr double kFar = 2;
  const double seen = sampling.frequency_hz, expected = sampling.expected_frequency_hz.value_or(seen);
  if (!(seen > 0) || (seen < kFar * expected && expected < kFar * seen)) return;
  report.warnings.push_back({"rig_frequency", "it swings at " + NumberText(seen, 3) +
                                                  " Hz, and the rig's inertia lets " + NumberText(expected, 3) +
                                                  " Hz expect; check the unit of time, and the rig's units (SI)"});
}

}  // namespace

void AddSampling(const FreeSwing& swing, const Recording& used, RunReport& report) {
  const double clock_scale = used.clock_scale;
  double half_period = swing.half_period;
  if (!(half_period > 0) && report.closed_forms) half_period = report.closed_forms->table.half_period / clock_scale;
  const bool is_seen = half_period > 0 && !(swing.undersampled && report.rig);
  const std::optional<double> seen = is_seen ? std::optional(half_period) : std::nullopt;
  std::optional<double> expected = ExpectedFrequency(report.rig);
  if (expected) *expected *= clock_scale;
  const bool told =
      swing.undersampled && !report.fits.empty() && ExitCode(report.fits[report.MainFit()].termination) == 0;
  if (expected && told) expected = 0.5 / swing.half_period;
  report.sampling = DescribeSampling(used, seen, expected);
  WarnOfFrequency(*report.sampling, report);
  if (swing.undersampled || used.edge) return;  // events have no sampling rate
  std::ranges::move(SamplingWarnings(*report.sampling), std::back_inserter(report.warnings));
}

}  // namespace pendulum
