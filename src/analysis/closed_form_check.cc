// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/closed_form_check.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/analysis/difference_causes.h"
#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/rig_verdict.h"
#include "pendulum/base/format.h"
#include "pendulum/closed_form/locate_turning_points.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/model/friction/viscous.h"
#include "pendulum/model/geometric_inertia.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One quantity that a formula gives.
struct FormulaRow {
  std::string quantity, method;
  std::string parameter;  ///< The fit's counterpart: a parameter or "damping_ratio".
  std::string amplitude;  ///< Effect of finite amplitude, if there is one.
};

/// K formulas that are applied together; in units of the restoring torque G.
struct FormulaGroup {
  std::vector<FormulaRow> rows;
  std::string assumption;  // what the formulas assume in addition to the model
  VectorXd value, error;   // K
  MatrixXd gradient;       // K x 2 M
  FormulaValues apply;     // applies the formulas to another recording
};

constexpr std::string_view kDampingRatio = "damping_ratio";

std::optional<std::size_t> TurningPointAt(const TurningPointTable& table, double time) {
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    if (std::abs(table.points[i].time - time) < 0.5 * table.half_period) return i;
  }
  return std::nullopt;
}

VectorXd LinearValues(const LogDecrement& linear) {
  return Eigen::Vector4d(linear.damping_ratio.value, linear.inertia.value, linear.viscous.value,
                         linear.corrected_inertia.value);
}

/// The textbook's formulas. For a simulated recording they start at the turning point at the same time as in `used` and
/// use as many periods, or one period fewer if the last turning point is missing.
FormulaGroup LinearFormulas(const ClosedForms& forms, const Recording& used) {
  const LogDecrement& linear = *forms.linear;
  FormulaGroup group;
  const std::string small = "finite amplitude, while the formula assumes small angles";
  group.rows = {{"damping_ratio_log_decrement", "log decrement", std::string(kDampingRatio), small},
                {"inertia_small_angle", "damped period and log decrement, small angles", "inertia", small},
                {"viscous_log_decrement", "log decrement", "viscous", small},
                {"inertia_elliptic_period", "the same period corrected by the elliptic integral", "inertia",
                 "the decay of the amplitude within each half swing, for which the elliptic integral uses the mean"}};
  group.assumption = "the formula's friction, which is only viscous";
  if (forms.gravity.is_linear()) group.rows.pop_back();  // nothing to correct
  group.value = LinearValues(linear);
  group.error = Eigen::Vector4d(linear.damping_ratio.std_error, linear.inertia.std_error, linear.viscous.std_error,
                                linear.corrected_inertia.std_error);
  group.gradient = linear.gradient;
  const double first = used.clock_scale * (forms.table.points[linear.first].time - used.time[0]);
  const int periods = linear.periods;
  const Kink kink = forms.table.kink;
  group.apply = [=](const Recording& recording, Gravity gravity) -> std::optional<VectorXd> {
    const Result<TurningPointTable> table = LocateTurningPoints(recording, kink);
    const std::optional<std::size_t> from = table ? TurningPointAt(*table, first) : std::nullopt;
    if (!from) return std::nullopt;
    std::optional<LogDecrement> there = ApplyLogDecrement(*table, gravity, *from, periods);
    // The last turning point may be missing.
    if (!there) there = ApplyLogDecrement(*table, gravity, *from, periods - 1);
    if (!there) return std::nullopt;
    return LinearValues(*there);
  };
  return group;
}

VectorXd DecrementValues(const TurningPointFit& decrement) {
  VectorXd values(2 + static_cast<Index>(decrement.friction.size()));
  values[0] = decrement.zero.value;
  values[1] = decrement.inertia.value;
  for (Index k = 2; k < values.size(); ++k) values[k] = decrement.friction[static_cast<std::size_t>(k - 2)].value;
  return values;
}

FormulaGroup DecrementFormulas(const ClosedForms& forms, Quantity quantity, const std::stop_token& stop) {
  const TurningPointFit& decrement = *forms.decrement;
  FormulaGroup group;
  const std::string method = "least squares over all turning points";
  const auto add = [&](std::string_view name) {
    group.rows.push_back({std::string(name) + "_turning_points", method, std::string(name), "finite amplitude"});
  };
  group.assumption = "the turning points, found on polynomials";
  add(quantity == Quantity::kAngle ? kZeroAngle.name : kRateBias.name);
  for (const ParameterInfo& info : PhysicalParameters(decrement.model)) add(info.name);
  group.value = DecrementValues(decrement);
  group.error = decrement.covariance.diagonal().cwiseSqrt();
  group.gradient = decrement.gradient;
  group.apply = [model = decrement.model, stop](const Recording& recording,
                                                Gravity gravity) -> std::optional<VectorXd> {
    MotionModel with_gravity = model;
    with_gravity.gravity = gravity;
    const Result<TurningPointFit> there = FitTurningPoints(recording, with_gravity, stop);
    if (!there) return std::nullopt;
    return DecrementValues(*there);
  };
  return group;
}

/// The fit's estimates and their dependence on the readings.
class FitSide {
 public:
  FitSide(const FitReport& fit, const FittedMotion& motion) : fit_(fit), motion_(motion) {}

  struct Value {
    double value = 0;
    std::optional<double> std_error;  ///< 0 if the parameter was fixed.
    double scale = 1;                 ///< The report's unit per unit of the closed form.
    std::string unit, reason;
    VectorXd weights;  ///< P: derivatives with respect to the parameters.
  };

  std::optional<Value> Find(const std::string& name, double gravity_torque) const {
    if (name == kDampingRatio) return DampingRatio();
    for (std::size_t i = 0; i < fit_.parameters.size(); ++i) {
      const ParameterEstimate& parameter = fit_.parameters[i];
      if (parameter.info.name != name) continue;
      Value value{parameter.estimate, parameter.std_error, 1, parameter.unit, parameter.reason, {}};
      if (parameter.fixed || parameter.at_bound) value.std_error = 0;
      if (parameter.info.scales_with_gravity()) value.scale = gravity_torque;
      value.weights = VectorXd::Unit(static_cast<Index>(fit_.parameters.size()), static_cast<Index>(i));
      return value;
    }
    return std::nullopt;
  }

  /// Standard deviation of (closed form - fit) that noise of this size and autocorrelation causes. `influence` (N) and
  /// `weights` (P) are in the report's units.
  std::optional<double> DifferenceDeviation(const VectorXd& influence, const VectorXd& weights, double noise,
                                            const Autocorrelation& autocorrelation) {
    if (!Linearize()) return std::nullopt;
    const VectorXd difference = influence - solver_.transpose() * weights;
    const double sum = CorrelatedSum(autocorrelation, motion_.instants(), difference)(0, 0);
    return noise * std::sqrt(std::max(sum, 0.0));
  }

 private:
  /// ζ = b / (2 sqrt(I)) in units of the restoring torque G. The weights are relative derivatives, so the units of b
  /// and I do not matter.
  std::optional<Value> DampingRatio() const {
    const auto found = std::ranges::find(fit_.derived, kDampingRatio, &DerivedQuantity::name);
    const ParameterEstimate* inertia = fit_.Find(kInertia.name);
    const ParameterEstimate* viscous = fit_.Find(kViscous.name);
    if (found == fit_.derived.end() || viscous == nullptr) return std::nullopt;
    Value value{found->estimate, found->std_error, 1, "1", "", {}};
    if (viscous->at_bound || viscous->fixed) value.std_error = value.std_error.value_or(0);
    value.weights = VectorXd::Zero(static_cast<Index>(fit_.parameters.size()));
    value.weights[inertia - fit_.parameters.data()] = -0.5 * found->estimate / inertia->estimate;
    if (viscous->estimate != 0) {
      value.weights[viscous - fit_.parameters.data()] = found->estimate / viscous->estimate;
    }
    return value;
  }

  /// (JᵀJ)⁻¹ Jᵀ over the parameters that have a standard error, with columns scaled to equal size.
  bool Linearize() {
    if (solver_.size() > 0) return true;
    MatrixXd jacobian;
    if (!motion_.Readings(motion_.instants(), &jacobian)) return false;
    std::vector<Index> free;
    for (std::size_t i = 0; i < fit_.parameters.size(); ++i) {
      if (fit_.parameters[i].std_error) free.push_back(static_cast<Index>(i));
    }
    const MatrixXd part = jacobian(Eigen::all, free);
    const VectorXd norm = part.colwise().norm();
    const MatrixXd scaled = part * norm.cwiseInverse().asDiagonal();
    const MatrixXd inverse =
        norm.cwiseInverse().asDiagonal() * (scaled.transpose() * scaled).ldlt().solve(MatrixXd(scaled.transpose()));
    solver_ = MatrixXd::Zero(jacobian.cols(), jacobian.rows());
    for (Index i = 0; i < static_cast<Index>(free.size()); ++i)
      solver_.row(free[static_cast<std::size_t>(i)]) = inverse.row(i);
    return solver_.allFinite();
  }

  const FitReport& fit_;
  const FittedMotion& motion_;
  MatrixXd solver_;  // P x N
};

/// Sets z and the verdict if the difference has a standard deviation.
void SetAgreement(double deviation, ClosedFormRow& row) {
  if (!(deviation > 0)) return;
  row.z = (row.closed_form - row.fit) / deviation;
  row.agrees = std::abs(*row.z) < kAgrees;
}

class Checker {
 public:
  Checker(const Recording& used, const ClosedForms& forms, const FitReport& fit, const FittedMotion& motion,
          double gravity_torque)
      : used_(used), forms_(forms), fit_(fit), gravity_torque_(gravity_torque), motion_(motion), side_(fit, motion) {}

  void Add(const FormulaGroup& group, std::vector<ClosedFormRow>& rows) {
    std::optional<FormulaStages> stages;
    bool tried = false;
    for (Index k = 0; k < static_cast<Index>(group.rows.size()); ++k) {
      const FormulaRow& formula = group.rows[static_cast<std::size_t>(k)];
      const auto fitted = side_.Find(formula.parameter, gravity_torque_);
      if (!fitted) continue;
      ClosedFormRow row{formula.quantity,
                        formula.method,
                        fitted->unit,
                        fitted->scale * group.value[k],
                        fitted->scale * group.error[k],
                        fitted->value,
                        fitted->std_error,
                        {},
                        {},
                        ""};
      const std::optional<double> deviation = Deviation(row, *fitted, group.gradient.row(k));
      if (!deviation) row.why = "the fit has no standard error" + (fitted->reason.empty() ? "" : ": " + fitted->reason);
      if (deviation) SetAgreement(*deviation, row);
      if (row.agrees == false && !std::exchange(tried, true)) {
        stages = ApplyInStages(motion_, used_, fit_.model.gravity, group.apply);
      }
      if (row.agrees == false && !stages) row.why = "the formula cannot be applied to the fitted motion itself";
      if (row.agrees == false && stages) {
        const DifferenceCauses causes = SplitDifference(*stages, k, fitted->scale, row.closed_form, row.fit);
        row.cause = causes.Largest();
        row.why = DescribeCauses(causes, *deviation, row.unit, NamesOf(group, formula));
      }
      rows.push_back(std::move(row));
    }
  }

 private:
  /// Standard deviation of the difference. For a wrong law the residuals are misfit, not noise. The deviation is then
  /// computed from the scatter about the polynomials of the turning points, but is at least the closed form's standard
  /// error. For white residuals and clearly different variances it is Hausman's. Otherwise it is computed from the
  /// residuals and their autocorrelation.
  std::optional<double> Deviation(const ClosedFormRow& row, const FitSide::Value& fitted, const VectorXd& gradient) {
    constexpr double kSmallDifference = 0.25;
    if (!fitted.std_error) return std::nullopt;
    const double own = *row.std_error * *row.std_error;
    const double hausman = own - *fitted.std_error * *fitted.std_error;
    const bool white = fit_.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite;
    if (white && forms_.wrong_law.empty() && hausman > kSmallDifference * own) return std::sqrt(hausman);
    const VectorXd influence = fitted.scale * InfluenceOf(forms_.table, gradient.transpose(), used_.size());
    if (!forms_.wrong_law.empty()) {
      const auto noise = side_.DifferenceDeviation(influence, fitted.weights, forms_.table.noise, {});
      return std::max(noise.value_or(0), *row.std_error);
    }
    return side_.DifferenceDeviation(influence, fitted.weights, fit_.statistics.rms_residual,
                                     fit_.noise.autocorrelation);
  }

  CauseNames NamesOf(const FormulaGroup& group, const FormulaRow& formula) const {
    return {group.assumption, formula.amplitude, DescribeMisfit()};
  }

  /// Names the property of the readings that the fitted law lacks.
  std::string DescribeMisfit() const {
    constexpr double kFarMore = 3;  // chi2/dof, far above the 1 that the turning points' standard errors explain
    if (!forms_.wrong_law.empty()) return "the friction law (" + forms_.wrong_law + ")";
    std::string misfit = "features of the recording that the fitted motion lacks";
    const double scatter = forms_.decrement ? forms_.decrement->chi_square / forms_.decrement->freedom : 0;
    if (scatter < kFarMore) return misfit;
    return misfit + " (its turning points follow none of the friction laws: chi2/dof " + NumberText(scatter, 3) + ")";
  }

  const Recording& used_;
  const ClosedForms& forms_;
  const FitReport& fit_;
  double gravity_torque_;
  const FittedMotion& motion_;
  FitSide side_;
};

std::string Percent(double ratio) {
  return NumberText(std::abs(100 * (ratio - 1)), 2) + (ratio > 1 ? " % larger" : " % smaller");
}

/// Adds rows for the rig's own inertia and for a point mass.
void AddGeometry(const Rig& rig, const FitReport& fit, std::vector<ClosedFormRow>& rows) {
  const ParameterEstimate* fitted = fit.Find(kInertia.name);
  if (fitted == nullptr) return;
  const std::optional<double> fit_error = fitted->fixed ? 0.0 : fitted->std_error;
  for (const GeometricInertia& inertia : GeometricInertias(rig, fitted->estimate)) {
    ClosedFormRow row{inertia.is_point_mass ? "inertia_point_mass" : "inertia_geometry",
                      inertia.is_point_mass ? "all mass at the end of the rod" : "the rig file",
                      fitted->unit,
                      inertia.value,
                      inertia.std_error,
                      fitted->estimate,
                      fit_error,
                      {},
                      {},
                      ""};
    const std::string percent = Percent(inertia.value / fitted->estimate) + " than the fit's";
    if (!inertia.std_error || !fit_error) {
      row.why = percent + "; the " + (inertia.std_error ? "fit" : "rig file") + " gives no errors to compare it with";
    } else {
      const double of_fit = fitted->std_error ? ErrorBesideRig(*fitted) : 0;
      const double error = std::hypot(inertia.difference_std_error, of_fit);
      SetAgreement(error, row);
      const double of_bob = inertia.is_point_mass ? 0 : PointBobError(rig, inertia.value);
      const bool may_be_bob = std::abs(inertia.value - fitted->estimate) < kAgrees * std::hypot(error, of_bob);
      if (row.agrees == false)
        row.why = percent + ", more than all errors allow" + (may_be_bob ? " if the bob is a point" : "");
    }
    rows.push_back(std::move(row));
  }
}

/// Says whether a point mass is a good enough model of this rig; empty without such a row.
std::string DescribePointMass(const std::vector<ClosedFormRow>& rows) {
  const auto row = std::ranges::find(rows, "inertia_point_mass", &ClosedFormRow::quantity);
  if (row == rows.end()) return "";
  constexpr double kMaxDifference = 0.01;  // used if the rig gives no standard errors
  const double ratio = row->closed_form / row->fit;
  const bool is_adequate = row->agrees.value_or(std::abs(ratio - 1) < kMaxDifference);
  return std::string("; a point mass is ") + (is_adequate ? "" : "not ") + "an adequate model: its inertia is " +
         Percent(ratio) + " than the fit's";
}

double Rms(const VectorXd& measured, const VectorXd& modelled) {
  return std::sqrt((measured - modelled).squaredNorm() / static_cast<double>(measured.size()));
}

TextbookOverlay MakeOverlay(const Recording& used, const LogDecrement& linear, const FitReport& fit,
                            const FittedMotion& motion) {
  TextbookOverlay overlay;
  const FittedMotion textbook = motion.WithViscous(linear.inertia.value, linear.viscous.value);
  const auto sine = textbook.WithGravity(Gravity::kSine).Readings(motion.instants());
  const auto small = textbook.WithGravity(Gravity::kLinear).Readings(motion.instants());
  if (!sine || !small) return overlay;
  overlay.linear = *small;
  overlay.nonlinear = *sine;
  overlay.linear_rms = Rms(used.value, *small);
  overlay.nonlinear_rms = Rms(used.value, *sine);
  overlay.fitted_rms = fit.statistics.rms_residual;
  return overlay;
}

/// With parameters from the linear formulas the linear model may be nearer than the nonlinear one: the parameters
/// absorb the longer period of large swings.
std::string DescribeOverlay(const TextbookOverlay& overlay, const LogDecrement& linear, const std::string& unit) {
  const auto rms = [&](double value) { return NumberText(value, 2) + " " + unit; };
  std::string text = "With inertia and damping from the linear formulas the residuals of the linear model are " +
                     rms(overlay.linear_rms) + " rms, those of the nonlinear one " + rms(overlay.nonlinear_rms) +
                     ", those of the fit " + rms(overlay.fitted_rms);
  constexpr double kClearly = 1.1;
  if (!(overlay.nonlinear_rms > kClearly * overlay.linear_rms)) return text;
  const double excess = linear.inertia.value / linear.corrected_inertia.value - 1;
  return text +
         ": the linear model looks better because its parameters were found with it. Its inertia contains the longer "
         "period of large swings" +
         (excess > 0 ? " (" + NumberText(100 * excess, 2) + " % of it)" : "") +
         ", which the nonlinear model adds a second time";
}

std::string Summarize(const std::vector<ClosedFormRow>& rows, const std::string& wrong_law) {
  const auto judged = std::ranges::count_if(rows, [](const ClosedFormRow& row) { return row.agrees.has_value(); });
  const auto agree = std::ranges::count_if(rows, [](const ClosedFormRow& row) { return row.agrees == true; });
  if (judged == 0) return "there are no errors to compare the closed forms with";
  return std::to_string(agree) + " of " + std::to_string(judged) + " closed forms agree with the fit within " +
         NumberText(kAgrees) + " standard deviations of the difference" + DescribePointMass(rows) +
         (wrong_law.empty() ? "" : "; wrong friction law: " + wrong_law);
}

std::string DescribeUnexplained(const std::vector<ClosedFormRow>& rows, const std::string& wrong_law) {
  if (!wrong_law.empty()) return "the turning points follow another friction law: " + wrong_law;
  const ClosedFormRow* farthest = nullptr;
  for (const ClosedFormRow& row : rows) {
    if (row.cause != DifferenceCause::kRecording || !(std::abs(*row.z) >= kUnexplained)) continue;
    if (farthest == nullptr || std::abs(*row.z) > std::abs(*farthest->z)) farthest = &row;
  }
  if (farthest == nullptr) return "";
  return "the closed form " + farthest->quantity + " is " + NumberText(std::abs(*farthest->z), 2) +
         " standard deviations from the fit, and " + farthest->why;
}

}  // namespace

ClosedFormCheck CheckClosedForms(const Recording& used, const ClosedForms& forms, const FitReport& fit,
                                 const std::optional<Rig>& rig, const std::stop_token& stop) {
  ClosedFormCheck check;
  if (fit.termination == Termination::kFailed) return check;
  const FittedMotion motion(used, fit, rig, stop);
  Checker checker(used, forms, fit, motion, rig ? rig->gravity_torque.value : 1.0);
  if (forms.linear) checker.Add(LinearFormulas(forms, used), check.rows);
  if (forms.decrement) checker.Add(DecrementFormulas(forms, fit.quantity, stop), check.rows);
  if (rig) AddGeometry(*rig, fit, check.rows);
  if (forms.linear) {
    check.overlay = MakeOverlay(used, *forms.linear, fit, motion);
    if (check.overlay.linear.size() > 0) {
      check.overlay.summary = DescribeOverlay(check.overlay, *forms.linear, fit.reading_unit);
    }
  }
  check.summary = Summarize(check.rows, forms.wrong_law);
  check.unexplained = DescribeUnexplained(check.rows, forms.wrong_law);
  return check;
}

}  // namespace pendulum
