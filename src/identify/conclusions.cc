// SPDX-License-Identifier: Apache-2.0
#include "identify/conclusions.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/base/format.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/fitting/swing/undersampled.h"

namespace pendulum {
namespace {

void AddClosedForms(const MotionModel& model, const std::stop_token& stop, IdentifiedRecording& recording) {
  auto forms = EstimateClosedForms(recording.used, model, stop);
  if (!forms) {
    recording.no_closed_forms = forms.error().message();
    return;
  }
  recording.closed_forms = *std::move(forms);
  recording.closed_forms_model = model.name;
}

/// Only if nothing else says that the law does not describe the readings. Closed forms of readings that were corrected
/// before the fit differ from it for this reason.
void WarnOfUnexplained(const ClosedFormCheck& check, FitReport& fit) {
  const bool is_doubted = fit.termination != Termination::kConverged || fit.HasWarning("lack_of_fit") ||
                          !fit.suspicions.empty() || fit.correction.size() > 0;
  if (check.unexplained.empty() || is_doubted) return;
  fit.warnings.push_back({.code = "closed_forms_differ",
                          .finding = check.unexplained,
                          .advice = "compare the laws: --models all",
                          .flags = {"models"}});
}

/// A fit that failed or is not to be checked has an empty check.
void AddChecks(const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop, std::size_t k,
               Identification& identification) {
  IdentifiedRecording& recording = identification.recordings[k];
  if (!recording.closed_forms) return;
  for (std::size_t m = 0; m < identification.fits.size(); ++m) {
    FitReport& fit = identification.FitOf(k, m);
    recording.checks.emplace_back();
    if (fit.termination == Termination::kFailed || !is_checked(m)) continue;
    const bool same = fit.model.name == recording.closed_forms_model;
    const auto own =
        same ? Result<ClosedForms>(*recording.closed_forms) : EstimateClosedForms(recording.used, fit.model, stop);
    if (!own) continue;
    recording.checks.back() = CheckClosedForms(recording.used, *own, fit, identification.si_rig(), stop);
    WarnOfUnexplained(recording.checks.back(), fit);
  }
}

/// The rig's geometry predicts the frequency only roughly, but an error of a factor of two means a wrong unit.
void WarnOfFrequency(const Sampling& sampling, IdentifiedRecording& recording) {
  constexpr double kMaxRatio = 2;
  const double seen = sampling.frequency_hz, expected = sampling.expected_frequency_hz.value_or(seen);
  if (!(seen > 0) || (seen < kMaxRatio * expected && expected < kMaxRatio * seen)) return;
  recording.warnings.push_back({.code = "frequency_differs_from_rig",
                                .finding = "the pendulum swings at " + NumberText(seen, 3) +
                                           " Hz, but the rig predicts " + NumberText(expected, 3) + " Hz",
                                .advice = "check the unit of time and the units in the rig file (SI)"});
}

/// An undersampled swing shows no turning points; its fit has warned already.
void AddSampling(const FreeSwing& swing, std::size_t k, Identification& identification) {
  IdentifiedRecording& recording = identification.recordings[k];
  const double clock_scale = recording.used.clock_scale;
  double half_period = swing.half_period;
  if (!(half_period > 0) && recording.closed_forms)
    half_period = recording.closed_forms->table.half_period / clock_scale;
  const bool is_seen = half_period > 0 && !(swing.undersampled && identification.si_rig());
  const std::optional<double> seen = is_seen ? std::optional(half_period) : std::nullopt;
  std::optional<double> expected = ExpectedFrequency(identification.rig);
  if (expected) *expected *= clock_scale;
  const bool is_fitted = swing.undersampled && !identification.fits.empty() &&
                         identification.FitOf(k, identification.MainFit()).termination == Termination::kConverged;
  if (expected && is_fitted) expected = 0.5 / swing.half_period;
  recording.sampling = DescribeSampling(recording.used, seen, expected);
  WarnOfFrequency(*recording.sampling, recording);
  if (swing.undersampled || recording.used.edge) return;  // an event-driven recording has no sampling rate
  std::ranges::move(SamplingWarnings(*recording.sampling), std::back_inserter(recording.warnings));
}

}  // namespace

void AddConclusions(const FreeSwing& swing, const std::optional<MotionModel>& model,
                    const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop, std::size_t k,
                    Identification& identification) {
  if (model) {
    AddClosedForms(*model, stop, identification.recordings[k]);
    AddChecks(is_checked, stop, k, identification);
  }
  AddSampling(swing, k, identification);
}

}  // namespace pendulum
