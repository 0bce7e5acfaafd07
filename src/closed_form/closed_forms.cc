// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/locate_turning_points.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// A law is rejected if the probability of its chi-square is smaller than this.
constexpr double kRejected = 0.01;

std::string Describe(const EnvelopeLaw& law) {
  return law.shape + " (" + law.term + " friction only, p " + ProbabilityText(law.probability) + ")";
}

/// A sentence that says which law the amplitudes follow.
std::string DescribeEnvelopes(const EnvelopeComparison& laws) {
  constexpr double kMaxDescribedChi2 = 10;
  const double richest = laws.richest_chi_square / laws.richest_freedom;
  if (richest > kMaxDescribedChi2) {
    return "not determined: with viscous, dry and quadratic friction together chi2/dof of the turning points is "
           "still " +
           NumberText(richest, 3);
  }
  std::string followed, rejected;
  for (const EnvelopeLaw& law : laws.single) {
    std::string& list = law.probability >= kRejected ? followed : rejected;
    list += (list.empty() ? "" : ", ") + Describe(law);
  }
  if (followed.empty()) return "no single friction term (excluded: " + rejected + ")";
  return "as " + followed + (rejected.empty() ? "; the turning points exclude none" : "; not as " + rejected);
}

/// Describes the misfit of the fitted law if all friction terms together fit much better; otherwise empty. Uses the F
/// test, which allows for turning points that scatter more than their errors.
std::string DescribeWrongLaw(const TurningPointFit& decrement, const EnvelopeComparison& laws) {
  constexpr double kMaxP = 1e-4;
  constexpr double kMaxRemainingShare = 0.5;  // other terms must explain at least half of what the law leaves
  const int more = decrement.freedom - laws.richest_freedom;
  if (more < 1 || decrement.Probability() >= kRejected) return "";
  const double own = decrement.chi_square / decrement.freedom;
  const double richest = laws.richest_chi_square / laws.richest_freedom;
  if (richest > kMaxRemainingShare * own) return "";
  const double f = std::max(0.0, decrement.chi_square - laws.richest_chi_square) / more / richest;
  if (!std::isfinite(f)) return "";
  if (FisherTail(f, more, laws.richest_freedom) >= kMaxP) return "";
  return "chi2/dof of the turning points is " + NumberText(own, 3) + " with " + std::string(decrement.model.friction) +
         " friction and " + NumberText(richest, 3) + " with viscous, dry and quadratic";
}

/// If turning points scatter about every law, their errors are too small. This enlarges them.
void Inflate(double scatter, TurningPointTable& table) {
  const double factor = std::max(scatter, 1.0);
  for (TurningPoint& point : table.points) point.covariance *= factor;
  table.zero.std_error *= std::sqrt(factor);
}

tl::unexpected<Status> Stopped() {
  return Error(StatusCode::kTryAgain, "the closed forms were stopped before they were done; give them more time");
}

}  // namespace

Result<ClosedForms> EstimateClosedForms(const Recording& recording, const MotionModel& model,
                                        const std::stop_token& stop) {
  if (!model.gravity.is_linear() && !recording.is_calibrated()) {
    return Error(StatusCode::kFailedPrecondition, "the readings are in " + recording.unit +
                                                      ", but closed forms of this model need an angle or a rate; "
                                                      "--closed_form_only gives closed forms for small angles");
  }
  const double origin = recording.time[0];
  const Recording timed = InTrueSeconds(TurningPointView(recording));
  ClosedForms forms;
  forms.gravity = model.gravity;
  Result<TurningPointFit> decrement = FitTurningPoints(timed, model, stop);
  if (stop.stop_requested()) return Stopped();
  if (decrement) {
    forms.table = decrement->table;
    forms.decrement = *std::move(decrement);
  } else {
    forms.no_decrement = decrement.error().message();
    ASSIGN_OR_RETURN(TurningPointTable table, LocateTurningPoints(timed));
    forms.table = std::move(table);
  }
  Result<EnvelopeComparison> laws = CompareEnvelopes(forms.table, model.gravity, stop);
  if (laws) {
    if (forms.decrement) forms.wrong_law = DescribeWrongLaw(*forms.decrement, *laws);
    Inflate(laws->richest_chi_square / laws->richest_freedom, forms.table);
    forms.envelope = DescribeEnvelopes(*laws);
    forms.envelopes = std::move(laws->single);
  } else {
    forms.envelope = "not determined: " + laws.error().message();
  }
  forms.decay = TabulateDecay(forms.table, stop);
  forms.linear = ApplyLogDecrement(forms.table, model.gravity, stop);
  if (stop.stop_requested()) return Stopped();
  for (TurningPoint& point : forms.table.points) point.time = origin + (point.time - origin) / recording.clock_scale;
  return forms;
}

}  // namespace pendulum
