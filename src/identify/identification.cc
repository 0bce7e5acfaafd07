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

/// The warnings of several recordings; of_recording(k) lists those of one. Each names its recording, or says that it
/// applies to all.
template <typename OfRecording>
std::vector<Warning> WarningsOfRecordings(const Identification& identification, const OfRecording& of_recording) {
  std::vector<std::vector<Warning>> recordings;
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) recordings.push_back(of_recording(k));
  std::vector<Warning> all;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    for (Warning warning : recordings[k]) {
      const bool of_each =
          std::ranges::all_of(recordings, [&](const auto& of) { return ContainsWarning(of, warning); });
      warning.about.recording = of_each ? WarningSubject::kEachRecording : static_cast<int>(k) + 1;
      if (!of_each) warning.about.recording_name = RecordingLabel(identification, k);
      if (!warning.assumed.empty() &&
          !std::ranges::all_of(recordings, [&](const auto& of) { return Assumes(of, warning); }))
        warning.assumed = RecordingLabel(identification, k) + ": " + warning.assumed;
      AddOnce({warning}, all);
    }
  }
  return all;
}

/// Adds the warnings of the fits. A warning that is not one of all fits names its law.
void AddNamed(const std::vector<FitReport>& fits, std::vector<Warning>& all) {
  for (const FitReport& fit : fits) {
    std::vector<Warning> named = fit.warnings;
    for (Warning& warning : named) {
      if (!IsWarningOfAll(fits, warning)) warning.about.law = fit.model.name;
    }
    AddOnce(named, all);
  }
}

/// The warnings of the identification, of the only recording, of the fits, and of each of several recordings.
/// add(fits, all) adds those of fits that are asked for.
template <typename Add>
std::vector<Warning> CollectWarnings(const Identification& identification, const Add& add) {
  std::vector<Warning> all;
  AddOnce(identification.warnings, all);
  if (!identification.is_joint()) AddOnce(identification.recordings.front().warnings, all);
  add(identification.fits, all);
  if (!identification.is_joint()) return all;
  const auto of_recording = [&](std::size_t k) {
    std::vector<Warning> own = identification.recordings[k].warnings;
    add(identification.recordings[k].own_fits, own);
    return own;
  };
  AddOnce(WarningsOfRecordings(identification, of_recording), all);
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
  data.left_out = swing.left_out;
}

const std::optional<Rig>& Identification::si_rig() const {
  static const std::optional<Rig> none;
  return rig && rig->gives_torque ? rig : none;
}

bool Identification::SharesMotion(std::size_t m) const {
  return across[m].shared.size() == PhysicalParameters(fits[m].model).size();
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
  return CollectWarnings(identification, AddNamed);
}

std::vector<Warning> WarningsOfFit(const Identification& identification, std::size_t fit) {
  return CollectWarnings(identification, [&](const std::vector<FitReport>& fits, std::vector<Warning>& all) {
    AddOnce(fits[fit].warnings, all);
  });
}

bool IsOneOfSeveral(const Identification& identification, std::size_t k) {
  const DataSummary& data = identification.recordings[k].data;
  const auto is_match = [&](const IdentifiedRecording& other) { return other.data.path == data.path; };
  return data.release > 0 && std::ranges::count_if(identification.recordings, is_match) > 1;
}

std::string RecordingLabel(const Identification& identification, std::size_t k) {
  const DataSummary& data = identification.recordings[k].data;
  std::string label = "recording " + std::to_string(k + 1);
  if (data.path.empty()) return label;
  return label + " (" + data.path +
         (IsOneOfSeveral(identification, k) ? ", free swing " + std::to_string(data.release) : "") + ")";
}

int ExitCode(const Identification& identification) {
  return identification.fits.empty() ? 0 : ExitCode(identification.fits[identification.MainFit()].termination);
}

}  // namespace pendulum
