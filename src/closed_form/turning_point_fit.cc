// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_point_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pendulum/base/distributions.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/half_swing_map.h"
#include "pendulum/closed_form/locate_turning_points.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The least-squares problem for x = (zero, natural frequency, friction (K), amplitude and time of each run).
///
/// Turning points outside the runs are not used. Amplitude and time of a run are those of its first turning point. The
/// readings of a rate sensor peak between turning points of the angle; the amplitude and time of a run are then those
/// of the turning point before the first peak.
class TurningPointProblem {
 public:
  TurningPointProblem(const TurningPointTable& table, const MotionModel& model, std::vector<bool> included,
                      const std::stop_token& stop)
      : table_(table), model_(model), stop_(stop), included_(std::move(included)), runs_(table.Runs()) {
    for (const auto& [first, last] : runs_) {
      rows_.push_back(2 * points_);
      points_ += static_cast<Index>(last - first + 1);
    }
    for (const TurningPoint& point : table.points) {
      const Eigen::Matrix2d root = point.covariance.llt().matrixL();
      whitening_.emplace_back(root.inverse());
    }
  }

  Index friction() const { return static_cast<Index>(included_.size()); }
  Index unknowns() const { return 2 + friction() + 2 * static_cast<Index>(runs_.size()); }
  Index observations() const { return 2 * points_; }

  /// The unknowns that are fitted.
  std::vector<Index> Free() const {
    std::vector<Index> free;
    for (Index i = 0; i < unknowns(); ++i) {
      const bool left_out = i >= 2 && i < 2 + friction() && !included_[static_cast<std::size_t>(i - 2)];
      if (!left_out) free.push_back(i);
    }
    return free;
  }

  /// Start values: no friction, and periods and amplitudes as in the table.
  VectorXd Start() const {
    VectorXd x = VectorXd::Zero(unknowns());
    x[0] = table_.zero.value;
    const double amplitude = table_.Amplitude(runs_[0].first);
    const bool is_rate = table_.quantity == Quantity::kRate;
    x[1] = kPi / table_.half_period;
    const double angle = AngleAmplitude(table_.quantity, amplitude, x[1], model_.gravity);
    x[1] *= model_.gravity.PeriodRatio(0.8 * angle);  // most swings of the run have smaller amplitudes
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const Index at = 2 + friction() + 2 * static_cast<Index>(r);
      x[at] = AngleAmplitude(table_.quantity, table_.Amplitude(runs_[r].first), x[1], model_.gravity);
      x[at + 1] = table_.points[runs_[r].first].time - (is_rate ? 0.5 * table_.half_period : 0.0);
    }
    return x;
  }

  /// The difference between table and model, in standard errors. Returns std::nullopt if the model does not swing so
  /// far, or when stopped.
  std::optional<VectorXd> Residuals(const VectorXd& x) const {
    VectorXd residuals(observations());
    if (!SetAll(x, residuals)) return std::nullopt;
    return residuals;
  }

  /// Converts derivatives (F x observations) with respect to the residuals to derivatives with respect to (time, value)
  /// of each turning point in the table.
  MatrixXd ByPoints(const MatrixXd& by_residuals) const {
    MatrixXd by_points = MatrixXd::Zero(by_residuals.rows(), 2 * static_cast<Index>(table_.points.size()));
    Index row = 0;
    for (const auto& [first, last] : runs_) {
      for (std::size_t i = first; i <= last; ++i, row += 2) {
        by_points.middleCols<2>(2 * static_cast<Index>(i)) = by_residuals.middleCols<2>(row) * whitening_[i];
      }
    }
    return by_points;
  }

  /// Forward differences. Their relative error of 1e-6 does not matter to Gauss-Newton.
  MatrixXd Jacobian(const VectorXd& x, const VectorXd& residuals, const std::vector<Index>& free) const {
    constexpr double kStep = 1e-7;
    MatrixXd jacobian(residuals.size(), static_cast<Index>(free.size()));
    for (Index k = 0; k < jacobian.cols(); ++k) {
      VectorXd moved = x;
      const Index i = free[static_cast<std::size_t>(k)];
      const double step = kStep * Scale(i, x);
      moved[i] += step;
      VectorXd there = residuals;
      const auto set = [&] { return i < 2 + friction() ? SetAll(moved, there) : SetRun(RunOf(i), moved, there); };
      if (!set()) {  // try the other direction
        moved[i] = x[i] - step;
        there = residuals;
        if (!set()) there = residuals;
      }
      jacobian.col(k) = (there - residuals) / (moved[i] - x[i]);
    }
    return jacobian;
  }

 private:
  /// The size of a significant change of an unknown.
  double Scale(Index i, const VectorXd& x) const {
    const double amplitude = x[2 + friction()];
    const double peak_rate = x[1] * amplitude;
    if (i == 0) return table_.quantity == Quantity::kAngle ? amplitude : peak_rate;
    if (i == 1) return x[1];
    // Friction that is 1 percent of gravity at the largest rate.
    if (i < 2 + friction()) {
      const double unit = UnitTorque(i - 2, peak_rate);
      return unit > 0 ? 0.01 * amplitude / unit : std::max(std::abs(x[i]), 0.01);
    }
    return (i - friction()) % 2 == 0 ? amplitude : table_.half_period;
  }

  double UnitTorque(Index k, double rate) const {
    double torque = 1;
    FrictionModels::Visit(model_.friction, [&]<typename F>() {
      std::array<double, kFrictionParameters<F>> unit{};
      unit[static_cast<std::size_t>(k)] = 1;
      torque = F::Torque(rate, 1.0, unit.data());
    });
    return torque;
  }

  /// The run to which an unknown amplitude or time belongs.
  std::size_t RunOf(Index i) const { return static_cast<std::size_t>((i - 2 - friction()) / 2); }

  bool SetAll(const VectorXd& x, VectorXd& residuals) const {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (!SetRun(r, x, residuals)) return false;
    }
    return true;
  }

  /// The residuals of one run. Returns false if the model does not swing so far, or when stopped.
  bool SetRun(std::size_t r, const VectorXd& x, VectorXd& residuals) const {
    Index row = rows_[r];
    const std::span<const double> friction_parameters(x.data() + 2, included_.size());
    double amplitude = x[2 + friction() + 2 * static_cast<Index>(r)];
    double time = x[2 + friction() + 2 * static_cast<Index>(r) + 1];
    const bool is_rate = table_.quantity == Quantity::kRate;
    for (std::size_t i = runs_[r].first; i <= runs_[r].last; ++i) {
      if (stop_.stop_requested() || !(amplitude > 0 && amplitude < model_.gravity.top() && x[1] > 0)) return false;
      if (!is_rate) Add(i, time, x[0] + table_.Side(i) * amplitude, row, residuals);
      if (!is_rate && i == runs_[r].last) break;
      const double direction = is_rate ? table_.Side(i) : -table_.Side(i);
      const auto end = ComputeHalfSwing(model_, friction_parameters, amplitude, x[1], direction, is_rate);
      if (!end) return false;
      if (is_rate) Add(i, time + end->peak_delay, x[0] + table_.Side(i) * end->peak_rate, row, residuals);
      amplitude = end->amplitude;
      time += end->duration;
    }
    return true;
  }

  void Add(std::size_t point, double time, double value, Index& row, VectorXd& residuals) const {
    const TurningPoint& seen = table_.points[point];
    residuals.segment<2>(row) = whitening_[point] * Eigen::Vector2d(seen.time - time, seen.value - value);
    row += 2;
  }

  const TurningPointTable& table_;
  const MotionModel& model_;
  const std::stop_token& stop_;
  std::vector<bool> included_;
  std::vector<TurningPointRun> runs_;
  std::vector<Index> rows_;                 // index of the first residual of each run
  std::vector<Eigen::Matrix2d> whitening_;  // for each turning point in the table
  Index points_ = 0;                        // number of turning points in the runs
};

/// The result of a least-squares fit with the unknowns `free`.
struct LeastSquares {
  VectorXd x;
  MatrixXd inverse;   // (JᵀJ)⁻¹ over `free`
  MatrixXd jacobian;  // J, of the residuals at x
  double sum = 0;
};

/// Levenberg-Marquardt with Marquardt's scaling. It stops when the remaining Newton step is below a hundredth of the
/// standard errors, which are multiplied by sqrt(chi2 / dof) if this factor exceeds 1.
std::optional<LeastSquares> Solve(const TurningPointProblem& problem, VectorXd x, const std::vector<Index>& free) {
  constexpr int kMaxSteps = 100;
  constexpr double kSmallStep = 1e-4;  // squared, in standard errors
  constexpr double kMaxDamping = 1e12;
  std::optional<VectorXd> residuals = problem.Residuals(x);
  if (!residuals) return std::nullopt;
  double damping = 1e-3;
  for (int step = 0; step < kMaxSteps && damping < kMaxDamping; ++step) {
    const MatrixXd jacobian = problem.Jacobian(x, *residuals, free);
    const MatrixXd normal = jacobian.transpose() * jacobian;
    const VectorXd gradient = jacobian.transpose() * *residuals;
    const MatrixXd inverse = normal.ldlt().solve(MatrixXd::Identity(normal.rows(), normal.cols()));
    const double left = gradient.dot(inverse * gradient);
    const double sum = residuals->squaredNorm();
    const double scatter = sum / std::max(static_cast<double>(jacobian.rows() - jacobian.cols()), 1.0);
    if (std::abs(left) < kSmallStep * std::max(scatter, 1.0)) return LeastSquares{x, inverse, jacobian, sum};
    bool better = false;
    while (!better && damping < kMaxDamping) {
      MatrixXd damped = normal;
      damped.diagonal() *= 1 + damping;
      VectorXd trial = x;
      trial(free) -= damped.ldlt().solve(gradient);
      std::optional<VectorXd> there = problem.Residuals(trial);
      better = there && there->squaredNorm() <= residuals->squaredNorm();
      damping = better ? 0.1 * damping : 10 * damping;
      if (!better) continue;
      x = std::move(trial);
      residuals = std::move(there);
    }
  }
  return std::nullopt;
}

double ProbabilityBeyond(double chi_square, int freedom) {
  if (!std::isfinite(chi_square)) return 0;
  return ChiSquareTail(chi_square, freedom);
}

/// Converts the unknowns of the fit to the quantities of TurningPointFit, with ω0 becoming I = 1/ω0², and their errors.
void Report(const TurningPointProblem& problem, const LeastSquares& solution, const std::vector<Index>& free,
            TurningPointFit& decrement) {
  const auto size = static_cast<Index>(2 + decrement.friction.size());
  const double frequency = solution.x[1];
  VectorXd factor = VectorXd::Ones(size);
  factor[1] = -2 / (frequency * frequency * frequency);
  const double scale = std::max(1.0, solution.sum / decrement.freedom);
  decrement.covariance = MatrixXd::Zero(size, size);
  for (Index i = 0; i < static_cast<Index>(free.size()); ++i) {
    for (Index j = 0; j < static_cast<Index>(free.size()); ++j) {
      const Index a = free[static_cast<std::size_t>(i)];
      const Index b = free[static_cast<std::size_t>(j)];
      if (a < size && b < size) decrement.covariance(a, b) = scale * solution.inverse(i, j) * factor[a] * factor[b];
    }
  }
  const MatrixXd follow = problem.ByPoints(-solution.inverse * solution.jacobian.transpose());
  decrement.gradient = MatrixXd::Zero(size, follow.cols());
  for (Index i = 0; i < static_cast<Index>(free.size()); ++i) {
    const Index a = free[static_cast<std::size_t>(i)];
    if (a < size) decrement.gradient.row(a) = factor[a] * follow.row(i);
  }
  const VectorXd errors = decrement.covariance.diagonal().cwiseSqrt();
  decrement.zero = {solution.x[0], errors[0]};
  decrement.inertia = {1 / (frequency * frequency), errors[1]};
  for (Index k = 2; k < size; ++k) decrement.friction[static_cast<std::size_t>(k - 2)] = {solution.x[k], errors[k]};
}

/// The static torque of the fitted friction.
double RestTorque(const TurningPointFit& decrement) {
  double torque = 0;
  FrictionModels::Visit(decrement.model.friction, [&]<typename F>() {
    std::array<double, kFrictionParameters<F>> friction{};
    for (std::size_t k = 0; k < friction.size(); ++k) friction[k] = decrement.friction[k].value;
    torque = F::Torque(0.0, 1.0, friction.data());
  });
  return torque;
}

/// Whether the law has no reference. The turning points give no start value for a reference.
bool IsLinear(const MotionModel& model) {
  bool linear = true;
  FrictionModels::Visit(model.friction, [&]<typename F>() { linear = !HasReference<F>; });
  return linear;
}

/// The shape of the envelope for a single friction term.
std::string_view EnvelopeShape(std::string_view term) {
  if (term == kViscous.name) return "exponential";
  if (term == kCoulomb.name) return "straight line";
  return term == kDrag.name ? "hyperbola" : "";
}

Result<TurningPointFit> FitFrom(const TurningPointTable& table, const MotionModel& model,
                                const std::vector<bool>& included, const std::stop_token& stop,
                                std::optional<VectorXd>& start) {
  TurningPointFit decrement{model, table, {}, {}, std::vector<Estimate>(included.size()), {}, {}, 0, 0};
  const TurningPointProblem problem(table, model, included, stop);
  const std::vector<Index> free = problem.Free();
  decrement.freedom = static_cast<int>(problem.observations()) - static_cast<int>(free.size());
  if (decrement.freedom < 1) {
    return Error(StatusCode::kFailedPrecondition,
                 std::to_string(problem.observations() / 2) + " turning points are too few for the " +
                     std::to_string(free.size()) + " unknowns of the closed form; record for longer");
  }
  if (!start || start->size() != problem.unknowns()) start = problem.Start();
  const std::optional<LeastSquares> solution = Solve(problem, *start, free);
  if (stop.stop_requested()) {
    return Error(StatusCode::kTryAgain,
                 "the least-squares fit of the turning points was stopped before it was done; give it more time");
  }
  if (!solution) {
    return Error(StatusCode::kFailedPrecondition,
                 "the turning points do not follow " + std::string(model.friction) +
                     " friction: their least-squares fit does not converge; try another model");
  }
  start = solution->x;
  decrement.chi_square = solution->sum;
  Report(problem, *solution, free, decrement);
  return decrement;
}

}  // namespace

double TurningPointFit::Probability() const { return ProbabilityBeyond(chi_square, freedom); }

Result<TurningPointFit> FitTurningPoints(const TurningPointTable& table, const MotionModel& model,
                                         const std::vector<bool>& included, const std::stop_token& stop) {
  std::optional<VectorXd> start;
  return FitFrom(table, model, included, stop, start);
}

Result<TurningPointFit> FitTurningPoints(const Recording& recording, const MotionModel& model,
                                         const std::stop_token& stop) {
  if (!IsLinear(model)) {
    return Error(StatusCode::kFailedPrecondition,
                 "there is no closed form for " + std::string(model.friction) +
                     " friction, because it is not linear in its parameters; use a fit");
  }
  Result<TurningPointTable> table = LocateTurningPoints(recording);
  if (!table) return tl::unexpected(table.error());
  const std::vector<bool> all(PhysicalParameters(model).size() - 1, true);
  std::optional<VectorXd> start;
  Result<TurningPointFit> decrement = FitFrom(*table, model, all, stop, start);
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds && decrement; ++round) {
    const Kink kink{RestTorque(*decrement), 1 / std::sqrt(decrement->inertia.value)};
    if (kink.sticking_angle == 0) break;
    table = LocateTurningPoints(recording, kink);
    if (!table) return tl::unexpected(table.error());
    decrement = FitFrom(*table, model, all, stop, start);
  }
  return decrement;
}

Result<EnvelopeComparison> CompareEnvelopes(const TurningPointTable& table, Gravity gravity,
                                            const std::stop_token& stop) {
  const MotionModel richest = {"drag", "drag", gravity};
  const std::vector<ParameterInfo> infos = PhysicalParameters(richest);
  const std::size_t terms = infos.size() - 1;
  std::optional<VectorXd> start;
  ASSIGN_OR_RETURN(const TurningPointFit all, FitFrom(table, richest, std::vector<bool>(terms, true), stop, start));
  start->segment(2, static_cast<Index>(terms)).setZero();
  const double scale = std::max(1.0, all.chi_square / all.freedom);
  EnvelopeComparison laws{{}, all.chi_square, all.freedom};
  for (std::size_t k = 0; k < terms; ++k) {
    std::vector<bool> alone(terms, false);
    alone[k] = true;
    std::optional<VectorXd> from = start;
    const Result<TurningPointFit> one = FitFrom(table, richest, alone, stop, from);
    if (!one && one.error().code == StatusCode::kTryAgain) return tl::unexpected(one.error());
    if (!one) continue;
    const std::string_view name = infos[k + 1].name;
    laws.single.push_back({std::string(name), std::string(EnvelopeShape(name)), one->chi_square, one->freedom,
                           ProbabilityBeyond(one->chi_square / scale, one->freedom)});
  }
  return laws;
}

}  // namespace pendulum
