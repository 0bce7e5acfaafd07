// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/rig_verdict.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/model/geometric_inertia.h"

namespace pendulum {
namespace {

std::string ExcessText(double excess) {
  return NumberText(100 * std::abs(excess), 2) + (excess > 0 ? " % larger" : " % smaller");
}

/// What makes the fitted inertia larger or smaller than the geometry's.
std::string CausesOf(double excess) {
  return excess > 0 ? "a wrong mass or length, a support that yields, the extent of the bob, or gears and a motor"
                    : "a wrong mass or length, or a spring, cable or hose at the axis";
}

void SetTexts(RigVerdict& verdict) {
  const std::string excess = ExcessText(verdict.excess);
  const std::string size = "the fitted inertia is " + excess + " than the rig's";
  if (!verdict.z) {
    verdict.finding = size + "; the fit gives no standard deviation, so this is no verdict";
    return;
  }
  const std::string z = "z " + NumberText(*verdict.z, 2);
  if (!verdict.differs()) {
    verdict.finding = "the fitted inertia agrees with the rig's: " + excess + " (" + z + ")";
    return;
  }
  verdict.finding = size + " (" + z + "), more than all errors allow: " + CausesOf(verdict.excess) +
                    " can cause this, and one swing cannot tell which";
  verdict.advice = "record a swing with another bob mass, and check the rig's values";
  verdict.brief = "The rig disagrees: inertia " + excess + " (" + z + "): mass, length" +
                  (verdict.excess > 0 ? ", support, bob or gear" : " or spring");
}

}  // namespace

double ErrorBesideRig(const ParameterEstimate& inertia) {
  const double wider = std::max(inertia.t95.value_or(kNormal95) / kNormal95, 1.0);
  double variance = std::pow(wider * *inertia.std_error, 2);
  for (const ErrorSource source : kErrorSources) {
    if (source != ErrorSource::kRig) variance += std::pow(inertia.systematic.Of(source), 2);
  }
  return std::sqrt(variance);
}

double PointBobError(const Rig& rig, double geometric) {
  constexpr double kOfAPoint = 0.05;
  const bool is_from_masses =
      rig.source.is_object() && rig.source.contains("bob_mass") && !rig.source.contains("inertia");
  return is_from_masses ? kOfAPoint * geometric : 0;
}

std::string RigVerdict::text() const { return finding + (advice.empty() ? "" : "; " + advice); }

bool RigVerdict::differs() const { return z && std::abs(*z) > kRigDiffers; }

std::optional<RigVerdict> JudgeInertia(const std::optional<Rig>& rig, const FitReport& fit) {
  if (!rig || !rig->gives_torque || fit.termination != Termination::kConverged) return std::nullopt;
  const ParameterEstimate* const inertia = fit.Find(kInertia.name);
  if (inertia == nullptr || inertia->fixed || !(inertia->estimate > 0)) return std::nullopt;
  const std::vector<GeometricInertia> all = GeometricInertias(*rig, inertia->estimate);
  const auto own = std::ranges::find(all, false, &GeometricInertia::is_point_mass);
  if (own == all.end() || !(own->value > 0)) return std::nullopt;
  RigVerdict verdict{own->value, inertia->estimate, inertia->estimate / own->value - 1, {}, "", "", ""};
  if (inertia->std_error) {
    const double error =
        std::hypot(own->difference_std_error, ErrorBesideRig(*inertia), PointBobError(*rig, own->value));
    if (error > 0) verdict.z = (verdict.fitted - verdict.geometric) / error;
  }
  SetTexts(verdict);
  return verdict;
}

}  // namespace pendulum
