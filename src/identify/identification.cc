// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/identification.h"

#include <algorithm>
#include <optional>
#include <tuple>

namespace pendulum {
namespace {

bool ContainsWarning(const std::vector<Warning>& warnings, const Warning& warning) {
  return std::ranges::find(warnings, warning) != warnings.end();
}

/// Whether the same was assumed; the messages may name different files.
bool Assumes(const std::vector<Warning>& warnings, const Warning& warning) {
  return std::ranges::find(warnings, warning.assumed, &Warning::assumed) != warnings.end();
}

void AddOnce(const std::vector<Warning>& warnings, std::vector<Warning>& all) {
  for (const Warning& warning : warnings) {
    if (!ContainsWarning(all, warning)) all.push_back(warning);
  }
}

bool IsWarningOfAll(const std::vector<FitReport>& fits, const Warning& warning) {
  return std::ranges::all_of(fits, [&](const FitReport& fit) { return ContainsWarning(fit.warnings, warning); });
}

/// The warnings of a joint fit's recordings, as `of_run` lists them. Each names its recording, or says that it applies
/// to all.
template <typename OfRun>
std::vector<Warning> WarningsOfRuns(const Identification& identification, const OfRun& of_run) {
  std::vector<std::vector<Warning>> runs;
  for (const Identification& run : identification.runs) runs.push_back(of_run(run));
  std::vector<Warning> all;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    for (Warning warning : runs[k]) {
      const bool of_each = std::ranges::all_of(runs, [&](const auto& run) { return ContainsWarning(run, warning); });
      warning.about.recording = of_each ? WarningSubject::kEachRecording : static_cast<int>(k) + 1;
      if (!of_each) warning.about.recording_name = RecordingLabel(identification, k);
      if (!warning.assumed.empty() &&
          !std::ranges::all_of(runs, [&](const auto& run) { return Assumes(run, warning); }))
        warning.assumed = RecordingLabel(identification, k) + ": " + warning.assumed;
      AddOnce({warning}, all);
    }
  }
  return all;
}

}  // namespace

void SummarizeUsed(const Recording& used, const FreeSwing& swing, DataSummary& data) {
  data.path = used.path;
  data.sha256 = used.sha256;
  data.unit = used.value_unit();
  data.used_samples = used.size();
  data.from = used.time[0];
  data.to = used.time[used.size() - 1];
  data.resolution = used.resolution;
  data.resolution_source = used.resolution > 0 ? used.resolution_source : "";
  data.clock_scale = used.clock_scale;
  data.clock_scale_std_dev = used.clock_scale_std_dev;
  data.sensor = used.sensor_errors;
  data.begins = Sentence(swing.begins);
  data.ends = Sentence(swing.ends);
}

const std::optional<Rig>& Identification::si_rig() const {
  static const std::optional<Rig> none;
  return rig && rig->gives_torque ? rig : none;
}

std::vector<const Identification*> Identification::Parts() const {
  if (!is_joint()) return {this};
  std::vector<const Identification*> parts;
  for (const Identification& run : runs) parts.push_back(&run);
  return parts;
}

std::size_t Identification::MainFit() const {
  const std::string recommended = comparison ? comparison->recommended : "";
  const auto order = [&](const FitReport& fit) {
    return std::tuple(fit.model.name != recommended, fit.termination != Termination::kConverged,
                      fit.termination == Termination::kFailed, fit.statistics.rms_residual);
  };
  return static_cast<std::size_t>(std::ranges::min_element(fits, {}, order) - fits.begin());
}

std::vector<Warning> AllWarnings(const Identification& identification) {
  std::vector<Warning> all;
  AddOnce(identification.warnings, all);
  for (const FitReport& fit : identification.fits) {
    std::vector<Warning> named = fit.warnings;
    for (Warning& warning : named) {
      if (!IsWarningOfAll(identification.fits, warning)) warning.about.law = fit.model.name;
    }
    AddOnce(named, all);
  }
  AddOnce(WarningsOfRuns(identification, AllWarnings), all);
  return all;
}

std::vector<Warning> WarningsOfFit(const Identification& identification, std::size_t fit) {
  std::vector<Warning> all;
  AddOnce(identification.warnings, all);
  AddOnce(identification.fits[fit].warnings, all);
  AddOnce(WarningsOfRuns(identification, [&](const Identification& run) { return WarningsOfFit(run, fit); }), all);
  return all;
}

bool IsOneOfSeveral(const Identification& identification, std::size_t run) {
  const DataSummary& data = identification.runs[run].data;
  const auto is_match = [&](const Identification& other) { return other.data.path == data.path; };
  return data.release > 0 && std::ranges::count_if(identification.runs, is_match) > 1;
}

std::string RecordingLabel(const Identification& identification, std::size_t run) {
  const DataSummary& data = identification.runs[run].data;
  std::string label = "recording " + std::to_string(run + 1);
  if (data.path.empty()) return label;
  return label + " (" + data.path +
         (IsOneOfSeveral(identification, run) ? ", free swing " + std::to_string(data.release) : "") + ")";
}

int ExitCode(const Identification& identification) {
  return identification.fits.empty() ? 0 : ExitCode(identification.fits[identification.MainFit()].termination);
}

}  // namespace pendulum
