// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/closed_forms.h"

#include <algorithm>
#include <utility>

#include <boost/math/distributions/fisher_f.hpp>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// A law that turning points like these follow in fewer cases than this is none of theirs.
constexpr double kRejected = 0.01;

std::string Describe(const EnvelopeLaw& law) {
  return law.shape + " (" + law.term + " friction alone, p " + ProbabilityText(law.probability) + ")";
}

/// Which law the amplitudes follow.
std::string DescribeEnvelopes(const std::vector<EnvelopeLaw>& laws) {
  std::string followed, rejected;
  for (const EnvelopeLaw& law : laws) {
    std::string& list = law.probability >= kRejected ? followed : rejected;
    list += (list.empty() ? "" : ", ") + Describe(law);
  }
  if (laws.empty()) return "too few turning points to tell the law";
  if (followed.empty()) return "no single term of friction: neither " + rejected;
  return "as " + followed + (rejected.empty() ? "; the turning points exclude none" : "; not as " + rejected);
}

/// How the law that was fitted fails where one with all terms of friction does not: by the F test, which does not mind
/// turning points that scatter more than their errors.
std::string DescribeWrongLaw(const Decrement& decrement, const EnvelopeComparison& laws) {
  constexpr double kSurely = 1e-4;
  const int more = decrement.freedom - laws.richest_freedom;
  if (more < 1 || decrement.Probability() >= kRejected) return "";
  const double own = decrement.chi_square / decrement.freedom;
  const double richest = laws.richest_chi_square / laws.richest_freedom;
  const double f = std::max(0.0, decrement.chi_square - laws.richest_chi_square) / more / richest;
  const boost::math::fisher_f_distribution<double> law(more, laws.richest_freedom);
  if (boost::math::cdf(boost::math::complement(law, f)) >= kSurely) return "";
  return "chi2/dof of the turning points is " + NumberText(own, 3) + " with " + std::string(decrement.model.friction) +
         " friction and " + NumberText(richest, 3) + " with viscous, dry and quadratic";
}

}  // namespace

Result<ClosedForms> EstimateClosedForms(const Recording& recording, const MotionModel& model) {
  Recording timed = recording;
  const double origin = recording.time[0];
  timed.time = origin + recording.clock_scale * (recording.time.array() - origin);
  ClosedForms forms;
  forms.gravity = model.gravity;
  Result<Decrement> decrement = FitDecrement(timed, model);
  if (decrement) {
    forms.table = decrement->table;
    forms.decrement = *std::move(decrement);
  } else {
    forms.no_decrement = decrement.error().message;
    Result<PeakTable> table = LocatePeaks(timed);
    if (!table) return tl::unexpected(table.error());
    forms.table = *std::move(table);
  }
  forms.decay = TabulateDecay(forms.table);
  forms.linear = ApplyLogDecrement(forms.table, model.gravity);
  if (Result<EnvelopeComparison> laws = CompareEnvelopes(forms.table, model.gravity)) {
    if (forms.decrement) forms.wrong_law = DescribeWrongLaw(*forms.decrement, *laws);
    forms.envelopes = std::move(laws->single);
  }
  forms.envelope = DescribeEnvelopes(forms.envelopes);
  for (Peak& peak : forms.table.peaks) peak.time = origin + (peak.time - origin) / recording.clock_scale;
  return forms;
}

}  // namespace pendulum
