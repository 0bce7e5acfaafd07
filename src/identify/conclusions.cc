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

void AddClosedForms(const MotionModel& model, const std::stop_token& stop, Identification& identification) {
  auto forms = EstimateClosedForms(identification.used, model, stop);
  if (!forms) {
    identification.no_closed_forms = forms.error().message;
    return;
  }
  identification.closed_forms = *std::move(forms);
  identification.closed_forms_model = model.name;
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
void AddChecks(const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop,
               Identification& identification) {
  if (!identification.closed_forms) return;
  for (std::size_t m = 0; m < identification.fits.size(); ++m) {
    FitReport& fit = identification.fits[m];
    identification.checks.emplace_back();
    if (fit.termination == Termination::kFailed || !is_checked(m)) continue;
    const bool same = fit.model.name == identification.closed_forms_model;
    const auto own = same ? Result<ClosedForms>(*identification.closed_forms)
                          : EstimateClosedForms(identification.used, fit.model, stop);
    if (!own) continue;
    identification.checks.back() = CheckClosedForms(identification.used, *own, fit, identification.si_rig(), stop);
    WarnOfUnexplained(identification.checks.back(), fit);
  }
}

/// The rig's geometry predicts the frequency only roughly, but an error of a factor of two means a wrong unit.
void WarnOfFrequency(const Sampling& sampling, Identification& identification) {
  constexpr double kMaxRatio = 2;
  const double seen = sampling.frequency_hz, expected = sampling.expected_frequency_hz.value_or(seen);
  if (!(seen > 0) || (seen < kMaxRatio * expected && expected < kMaxRatio * seen)) return;
  identification.warnings.push_back({.code = "frequency_differs_from_rig",
                                     .finding = "the pendulum swings at " + NumberText(seen, 3) +
                                                " Hz, but the rig predicts " + NumberText(expected, 3) + " Hz",
                                     .advice = "check the unit of time and the units in the rig file (SI)"});
}

/// An undersampled swing shows no turning points; its fit has warned already.
void AddSampling(const FreeSwing& swing, Identification& identification) {
  const double clock_scale = identification.used.clock_scale;
  double half_period = swing.half_period;
  if (!(half_period > 0) && identification.closed_forms)
    half_period = identification.closed_forms->table.half_period / clock_scale;
  const bool is_seen = half_period > 0 && !(swing.undersampled && identification.si_rig());
  const std::optional<double> seen = is_seen ? std::optional(half_period) : std::nullopt;
  std::optional<double> expected = ExpectedFrequency(identification.rig);
  if (expected) *expected *= clock_scale;
  const bool is_fitted = swing.undersampled && !identification.fits.empty() &&
                         ExitCode(identification.fits[identification.MainFit()].termination) == 0;
  if (expected && is_fitted) expected = 0.5 / swing.half_period;
  identification.sampling = DescribeSampling(identification.used, seen, expected);
  WarnOfFrequency(*identification.sampling, identification);
  if (swing.undersampled || identification.used.edge) return;  // an event-driven recording has no sampling rate
  std::ranges::move(SamplingWarnings(*identification.sampling), std::back_inserter(identification.warnings));
}

}  // namespace

void AddConclusions(const FreeSwing& swing, const std::optional<MotionModel>& model,
                    const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop,
                    Identification& identification) {
  if (model) {
    AddClosedForms(*model, stop, identification);
    AddChecks(is_checked, stop, identification);
  }
  AddSampling(swing, identification);
}

}  // namespace pendulum
