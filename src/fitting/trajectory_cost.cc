// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/trajectory_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include <Eigen/Cholesky>
#include <ceres/jet.h>

#include "depth_table.h"
#include "lanes.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// A trial that asks for more steps than this has a time scale far from that of the start values: a period takes
/// some 12.
constexpr double kStepsPerRadian = 20;
constexpr double kMostSteps = 10'000;

/// R, R^-T J'r and the rest of |r| from the sums (MODEL.md eq. (19)), by a pivoted Cholesky factor of J'J scaled to
/// unit diagonal: a direction that the data do not see gets a row of zeros, which Levenberg-Marquardt leaves alone.
/// Where J'J is a likelihood's information the rest may be negative; then R grows until it is none, a shorter step.
void CompressResiduals(const Eigen::MatrixXd& sums, double* residuals, double** jacobians) {
  constexpr double kRounding = 1e-15;  // of a diagonal of ones
  const Eigen::Index size = sums.rows() - 1;
  const Eigen::VectorXd norms = sums.diagonal().head(size).cwiseSqrt();
  const Eigen::VectorXd inverse = norms.unaryExpr([](double norm) { return norm > 0 ? 1 / norm : 0.0; });
  Eigen::MatrixXd correlation = inverse.asDiagonal() * sums.topLeftCorner(size, size) * inverse.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(correlation);
  const Eigen::VectorXd d = ldlt.vectorD();
  const Eigen::VectorXd root = d.unaryExpr([](double x) { return x > kRounding ? std::sqrt(x) : 0.0; });
  Eigen::VectorXd gradient = ldlt.transpositionsP() * (inverse.asDiagonal() * sums.col(size).head(size)).eval();
  ldlt.matrixL().solveInPlace(gradient);
  const Eigen::MatrixXd scaled = ldlt.transpositionsP() * Eigen::MatrixXd(norms.asDiagonal());
  const Eigen::MatrixXd factor = root.asDiagonal() * (ldlt.matrixU() * scaled);
  Eigen::Map<Eigen::VectorXd> seen(residuals, size);
  seen = root.unaryExpr([](double x) { return x > 0 ? 1 / x : 0.0; }).cwiseProduct(gradient);
  const double total = sums(size, size);
  const double longer = seen.squaredNorm() > total && total > 0 ? std::sqrt(seen.squaredNorm() / total) : 1.0;
  seen /= longer;
  residuals[size] = std::sqrt(std::max(total - seen.squaredNorm(), 0.0));
  for (Eigen::Index j = 0; j < size; ++j) {
    if (jacobians[j] == nullptr) continue;
    Eigen::Map<Eigen::VectorXd>(jacobians[j], size) = longer * factor.col(j);
    jacobians[j][size] = 0;
  }
}

template <FrictionModel F, StartKind kStart>
class TrajectoryCostFor final : public TrajectoryCost {
  static constexpr int kFriction = kFrictionParameters<F>;
  static constexpr int kParameters = kFriction + 4;
  /// Derivatives carried by the trajectory; those for release time and zero need no dual number.
  static constexpr int kCarried = kStart == StartKind::kRelease ? kFriction + 2 : kFriction + 3;
  static constexpr int kZero = kParameters - 1;
  using Dual = ceres::Jet<double, kCarried>;

 public:
  TrajectoryCostFor(Gravity gravity, const TrajectoryData& data)
      : gravity_(gravity), data_(data), used_samples_(data.time.size()), count_(kParameters + (data.drifts ? 1 : 0)) {
    set_num_residuals(count_ + 1);
    mutable_parameter_block_sizes()->assign(count_, 1);
    noise_.sigma = data.scale;
  }

  void set_tolerance(double tolerance) override { tolerance_ = tolerance; }
  void set_used_samples(std::size_t count) override { used_samples_ = count; }

  void set_noise(const NoiseModel& noise) override {
    if (noise_.IsPlain() && noise.IsPlain()) {
      last_.sums *= std::pow(noise_.sigma / noise.sigma, 2);
    } else {
      last_.parameters.clear();
    }
    noise_ = noise;
    if (noise_.family == NoiseFamily::kQuantized) levels_.Build(noise_.sigma / noise_.resolution);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::array<double, kParameters + 1> values{};
    for (int i = 0; i < count_; ++i) values[i] = *parameters[i];
    const std::span<const double> p(values.data(), count_);
    if (jacobians == nullptr) {
      std::fill_n(residuals, count_, 0.0);
      double sum = 0;
      const bool valid = SumOfSquares(p, &sum);
      residuals[count_] = std::sqrt(sum);
      return valid;
    }
    Eigen::MatrixXd sums;
    if (!Sums(p, &sums)) return false;
    CompressResiduals(sums, residuals, jacobians);
    return true;
  }

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    Lanes squares{};
    const bool plain = noise_.IsPlain();
    const double inverse_sigma = 1 / noise_.sigma;
    const auto add = [&](std::size_t first, int count, const std::array<Lanes, 1>& model) {
      for (int i = 0; i < count; ++i) {
        const double value = data_.value[first + i];
        const double reading = model[0][i] + Zero(p, first + i);
        const double residual = (value - reading) * inverse_sigma;
        squares[i] += plain ? residual * residual : At(value, reading).deviance;
      }
    };
    if (!VisitSamples<double>(p, add)) return false;
    *sum = PriorSum(p);
    for (const double square : squares) *sum += square;
    return std::isfinite(*sum);
  }

  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    const bool known =
        std::ranges::equal(p, last_.parameters) && last_.tolerance == tolerance_ && last_.samples == used_samples_;
    if (!known) {
      last_.parameters.clear();
      if (!(data_.drifts ? AddUp<2>(p, &last_.sums) : AddUp<1>(p, &last_.sums))) return false;
      last_.parameters.assign(p.begin(), p.end());
      last_.tolerance = tolerance_;
      last_.samples = used_samples_;
    }
    *sums = last_.sums;
    AddPriors(priors(), p, sums);
    return true;
  }

  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    const auto samples = static_cast<Eigen::Index>(used_samples_);
    readings->resize(samples);
    if (jacobian == nullptr) {
      return VisitSamples<double>(p, [&](std::size_t first, int count, const std::array<Lanes, 1>& model) {
        for (int i = 0; i < count; ++i) (*readings)[first + i] = model[0][i] + Zero(p, first + i);
      });
    }
    jacobian->resize(samples, count_);
    return VisitSamples<Dual>(p, [&](std::size_t first, int count, const std::array<Lanes, kParameters>& model) {
      for (int i = 0; i < count; ++i) {
        (*readings)[first + i] = model[0][i] + Zero(p, first + i);
        for (int j = 0; j < kZero; ++j) (*jacobian)(first + i, j) = model[1 + j][i];
        (*jacobian)(first + i, kZero) = 1;
        if (data_.drifts) (*jacobian)(first + i, kZero + 1) = data_.time[first + i];
      }
    });
  }

  /// The search asks whether the motion comes to rest, the judgement when: at the same point.
  TraceSummary Trace(std::span<const double> p) const override {
    if (std::ranges::equal(p, traced_.parameters) && traced_.tolerance == tolerance_ &&
        traced_.samples == used_samples_) {
      return traced_.summary;
    }
    ++traces_;
    const std::function<void(const Segment<double>&)> nothing = [](const Segment<double>&) {};
    traced_.summary = TraceTrajectory(MakePendulum<double>(p), MakeStart<double>(p), Options(), nothing);
    traced_.parameters.assign(p.begin(), p.end());
    traced_.tolerance = tolerance_;
    traced_.samples = used_samples_;
    return traced_.summary;
  }

  /// Each half swing loses twice the torque, which changes an amplitude by as much at small angles; four times to be
  /// safe.
  bool ComesToRest(std::span<const double> p, double torque_change) const override {
    constexpr double kSafe = 4;
    const TraceSummary trace = Trace(p);
    return trace.stop_time < data_.time.back() ||
           trace.smallest_reversal_margin < kSafe * 2 * trace.reversals * torque_change;
  }

 private:
  /// What the reading shows at sample i when the angle, or rate, is zero.
  double Zero(std::span<const double> p, std::size_t i) const {
    return data_.drifts ? p[kZero] + p[kZero + 1] * data_.time[i] : p[kZero];
  }

  /// As noise_.At, without an exponential and an error function for every sample of a level.
  SampleLikelihood At(double value, double reading) const {
    if (noise_.family != NoiseFamily::kQuantized || noise_.IsCensored(value)) return noise_.At(value, reading);
    const double per_level = 1 / noise_.resolution;
    const double position = (value - reading) * per_level;
    const DepthTable::Curve level = levels_.At(0.5 - std::abs(position));
    return {std::max(2 * (levels_.best() - level.log), 0.0), std::copysign(level.slope * per_level, position),
            std::max(-level.curvature, 0.0) * per_level * per_level};
  }

  /// kBaseline parameters for the zero: itself, and its drift.
  template <int kBaseline>
  bool AddUp(std::span<const double> p, Eigen::MatrixXd* sums) const {
    constexpr int kResidual = kZero + kBaseline;
    const bool plain = noise_.IsPlain();
    const double inverse_sigma = 1 / noise_.sigma;
    Lanes deviances{};
    Products<kResidual + 1> products;
    const auto add = [&](std::size_t first, int count, const std::array<Lanes, kParameters>& model) {
      std::array<Lanes, kResidual + 1> columns{};  // lanes beyond count stay zero
      for (int i = 0; i < count; ++i) {
        const double value = data_.value[first + i];
        const double reading = model[0][i] + Zero(p, first + i);
        double root_weight = inverse_sigma;
        columns[kResidual][i] = (value - reading) * inverse_sigma;
        if (!plain) {
          const SampleLikelihood sample = At(value, reading);
          deviances[i] += sample.deviance;
          root_weight = std::sqrt(sample.weight);
          columns[kResidual][i] = root_weight > 0 ? sample.score / root_weight : 0.0;
        }
        for (int j = 0; j < kZero; ++j) columns[j][i] = -model[1 + j][i] * root_weight;
        columns[kZero][i] = -root_weight;
        if constexpr (kBaseline == 2) columns[kZero + 1][i] = -data_.time[first + i] * root_weight;
      }
      products.Add(columns);
    };
    if (!VisitSamples<Dual>(p, add)) return false;
    *sums = products.Matrix();
    if (!plain) (*sums)(kResidual, kResidual) = std::accumulate(deviances.begin(), deviances.end(), 0.0);
    return sums->allFinite();
  }

  /// Parameter i as a T: carries its own derivative when T is dual.
  template <typename T>
  static T Carry(double value, int i) {
    if constexpr (DualNumber<T>) {
      return T(value, i);
    } else {
      return value;
    }
  }

  template <typename T>
  Pendulum<F, T> MakePendulum(std::span<const double> p) const {
    Pendulum<F, T> pendulum{gravity_, Carry<T>(p[0], 0), {}};
    for (int i = 0; i < kFriction; ++i) pendulum.friction[i] = Carry<T>(p[1 + i], 1 + i);
    return pendulum;
  }

  template <typename T>
  Start<T> MakeStart(std::span<const double> p) const {
    constexpr int kAngle = 1 + kFriction;
    if constexpr (kStart == StartKind::kRelease) {
      return {kStart, p[kAngle + 1], Carry<T>(p[kAngle], kAngle), T(0.0)};
    } else {
      return {kStart, 0.0, Carry<T>(p[kAngle], kAngle), Carry<T>(p[kAngle + 1], kAngle + 1)};
    }
  }

  TraceOptions Options() const {
    TraceOptions options;
    options.end = std::nextafter(data_.time[used_samples_ - 1], kUnbounded);
    options.tolerance = tolerance_;
    options.max_steps =
        static_cast<int>(std::min(kStepsPerRadian * data_.natural_frequency * options.end + kMostSteps, 1e9));
    return options;
  }

  bool IsAdmissible(std::span<const double> p) const {
    if (!(p[0] > 0)) return false;
    return kStart == StartKind::kMoving || (p[kZero - 1] >= 0 && p[kZero - 1] <= data_.latest_release);
  }

  /// Calls add(first sample, count <= kLanes, columns) for all samples: the model's reading, and with a dual T its
  /// derivatives with respect to all parameters but zero, in the parameters' order.
  template <typename T, typename Add>
  bool VisitSamples(std::span<const double> p, Add&& add) const {
    if (!IsAdmissible(p)) return false;
    constexpr int kColumns = DualNumber<T> ? kParameters : 1;
    Columns<kColumns> columns;
    std::array<Lanes, kColumns> model;
    std::size_t next = 0;
    const auto visit = [&](const Segment<T>& segment) {
      std::size_t end = next;
      while (end < used_samples_ && data_.time[end] < segment.end) ++end;
      if (end == next) return;
      FillColumns(segment, columns);
      for (; next < end; next += kLanes) {
        const int count = static_cast<int>(std::min<std::size_t>(kLanes, end - next));
        Lanes tau{};
        for (int i = 0; i < count; ++i) tau[i] = data_.time[next + i] - segment.start;
        columns.Evaluate(tau, model);
        add(next, count, model);
      }
      next = end;
    };
    ++traces_;
    // One tracer for all visitors: it is by far the most code here.
    const std::function<void(const Segment<T>&)> visitor = std::ref(visit);
    const TraceSummary summary = TraceTrajectory(MakePendulum<T>(p), MakeStart<T>(p), Options(), visitor);
    return summary.outcome == TraceSummary::Outcome::kComplete && next == used_samples_;
  }

  /// Coefficients of the reading, its carried derivatives and, for a release, its derivative with respect to release
  /// time, which is minus its time derivative: angle and rate, or rate and acceleration.
  template <typename T>
  void FillColumns(const Segment<T>& segment, auto& columns) const {
    const bool rate = data_.quantity == Quantity::kRate;
    columns.order = std::max(segment.order - (rate ? 1 : 0), 0);
    for (int k = 0; k <= columns.order; ++k) {
      const bool rest = segment.order == 0;
      const double factor = rate ? (rest ? 0.0 : k + 1.0) : 1.0;
      const T& source = segment.angle[rate && !rest ? k + 1 : k];
      auto& row = columns.coefficient[k];
      row[0] = factor * Value(source);
      if constexpr (DualNumber<T>) {
        for (int i = 0; i < kCarried; ++i) row[1 + i] = factor * source.v[i];
        if constexpr (kStart == StartKind::kRelease) {
          const int above = k + (rate ? 2 : 1);
          const double slope = above <= segment.order ? segment.angle[above].a * above * (rate ? above - 1 : 1) : 0.0;
          row[1 + kCarried] = -slope;
        }
      }
    }
  }

  Gravity gravity_;
  const TrajectoryData& data_;
  std::size_t used_samples_;
  int count_;  // of parameters
  double tolerance_ = 1e-10;
  NoiseModel noise_;
  DepthTable levels_{1};  // of quantized noise_

  /// Sums and where they were taken: solver, active set and judgement ask for them at the same point, one by one.
  struct SumsAt {
    std::vector<double> parameters;
    double tolerance = 0;
    std::size_t samples = 0;
    Eigen::MatrixXd sums;
  };
  mutable SumsAt last_;

  struct TraceAt {
    std::vector<double> parameters;
    double tolerance = 0;
    std::size_t samples = 0;
    TraceSummary summary;
  };
  mutable TraceAt traced_;
};

}  // namespace

void TrajectoryCost::AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) {
  problem.AddResidualBlock(this, nullptr, parameters);
}

std::unique_ptr<TrajectoryCost> MakeTrajectoryCost(const MotionModel& model, StartKind start,
                                                   const TrajectoryData& data) {
  std::unique_ptr<TrajectoryCost> cost;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    if (start == StartKind::kRelease) {
      cost = std::make_unique<TrajectoryCostFor<F, StartKind::kRelease>>(model.gravity, data);
    } else {
      cost = std::make_unique<TrajectoryCostFor<F, StartKind::kMoving>>(model.gravity, data);
    }
  });
  return cost;
}

}  // namespace pendulum
