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

void AddClosedForms(const MotionModel& model, const std::stop_token& stop, Identification& one) {
  auto forms = EstimateClosedForms(one.used, model, stop);
  if (!forms) {
    one.no_closed_forms = forms.error().message;
    return;
  }
  one.closed_forms = *std::move(forms);
  one.closed_forms_model = model.name;
}

/// A fit that failed or is not to be checked has an empty check.
void AddChecks(const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop,
               Identification& one) {
  if (!one.closed_forms) return;
  for (std::size_t m = 0; m < one.fits.size(); ++m) {
    const FitReport& fit = one.fits[m];
    one.checks.emplace_back();
    if (fit.termination == Termination::kFailed || !is_checked(m)) continue;
    const bool same = fit.model.name == one.closed_forms_model;
    const auto own = same ? Result<ClosedForms>(*one.closed_forms) : EstimateClosedForms(one.used, fit.model, stop);
    if (own) one.checks.back() = CheckClosedForms(one.used, *own, fit, one.rig, stop);
  }
}

/// The frequency that the rig's geometry predicts is rough, but not by a factor of two.
void WarnOfFrequency(const Sampling& sampling, Identification& one) {
  constexpr double kMaxRatio = 2;
  const double seen = sampling.frequency_hz, expected = sampling.expected_frequency_hz.value_or(seen);
  if (!(seen > 0) || (seen < kMaxRatio * expected && expected < kMaxRatio * seen)) return;
  one.warnings.push_back(
      {"frequency_differs_from_rig", "the pendulum swings at " + NumberText(seen, 3) + " Hz, but the rig predicts " +
                                         NumberText(expected, 3) +
                                         " Hz; check the unit of time and the units in the rig file (SI)"});
}

/// An undersampled swing shows no turning points; its fit has warned already.
void AddSampling(const FreeSwing& swing, Identification& one) {
  const double clock_scale = one.used.clock_scale;
  double half_period = swing.half_period;
  if (!(half_period > 0) && one.closed_forms) half_period = one.closed_forms->table.half_period / clock_scale;
  const bool is_seen = half_period > 0 && !(swing.undersampled && one.rig);
  const std::optional<double> seen = is_seen ? std::optional(half_period) : std::nullopt;
  std::optional<double> expected = ExpectedFrequency(one.rig);
  if (expected) *expected *= clock_scale;
  const bool is_fitted = swing.undersampled && !one.fits.empty() && ExitCode(one.fits[one.MainFit()].termination) == 0;
  if (expected && is_fitted) expected = 0.5 / swing.half_period;
  one.sampling = DescribeSampling(one.used, seen, expected);
  WarnOfFrequency(*one.sampling, one);
  if (swing.undersampled || one.used.edge) return;  // an event-driven recording has no sampling rate
  std::ranges::move(SamplingWarnings(*one.sampling), std::back_inserter(one.warnings));
}

}  // namespace

void AddConclusions(const FreeSwing& swing, const std::optional<MotionModel>& model,
                    const std::function<bool(std::size_t fit)>& is_checked, const std::stop_token& stop,
                    Identification& one) {
  if (model) {
    AddClosedForms(*model, stop, one);
    AddChecks(is_checked, stop, one);
  }
  AddSampling(swing, one);
}

}  // namespace pendulum
