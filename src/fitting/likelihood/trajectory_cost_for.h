// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>

#include "fitting/likelihood/block_samples.h"
#include "fitting/likelihood/cached_result.h"
#include "fitting/likelihood/depth_table.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/model/dual.h"
#include "pendulum/model/friction/friction_model.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Maximum number of steps: kStepsPerRadian for each radian of phase, plus kMaxSteps. A motion that needs more has a
/// time scale far from that of the start values. A period takes some 12 steps.
inline constexpr double kStepsPerRadian = 20;
inline constexpr double kMaxSteps = 10'000;

/// The cost of one friction law and start, with the number of parameters known at compile time.
template <FrictionModel F, StartKind kStart>
class TrajectoryCostFor final : public TrajectoryCost {
  static constexpr int kFriction = kFrictionParameters<F>;
  static constexpr int kParameters = kFriction + 4;
  static constexpr int kZero = kParameters - 1;
  static_assert(kParameters + 1 <= kMaxCompressed);
  static constexpr int kModel = kZero;  ///< Row of the model's reading, after its derivatives.
  /// Derivatives with respect to release time and zero need no dual number.
  using Dual = std::conditional_t<kStart == StartKind::kRelease, ReleaseDual<F>, MovingDual<F>>;
  template <typename T, int R, typename Sum>
  using Samples = BlockSamples<T, kStart == StartKind::kRelease, R, Sum>;
  static_assert(kSegmentRows<Dual, kStart == StartKind::kRelease> == kParameters);

 public:
  TrajectoryCostFor(Gravity gravity, const TrajectoryData& data)
      : TrajectoryCost(kParameters + (data.zero_motion_factors.empty() ? 0 : 1)),
        gravity_(gravity),
        data_(data),
        used_samples_(data.time.size()) {
    noise_.sigma = data.scale;
  }

  void set_tolerance(double tolerance) override { tolerance_ = tolerance; }
  void set_threads(int threads) override { threads_ = threads; }
  void set_used_samples(std::size_t count) override { used_samples_ = count; }

  void set_noise(const NoiseModel& noise) override {
    if (noise_.IsUncensoredGaussian() && noise.IsUncensoredGaussian()) {
      last_.value *= std::pow(noise_.sigma / noise.sigma, 2);
    } else {
      last_.parameters.clear();
    }
    noise_ = noise;
    if (noise_.family == NoiseFamily::kQuantized) levels_.Build(noise_.sigma / noise_.resolution);
  }

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    double deviance = 0;
    const auto work = [&](SampleBlock<1>& block, std::size_t first, int count, double& part) {
      auto& row = block.row[0];
      Read(p, row.data(), first, count, row.data());
      if (noise_.IsUncensoredGaussian()) {
        RowProducts<1> square;
        FindResiduals(row.data(), first, count, row.data());
        SumProducts(block, count, square);
        part = square[0];
        return;
      }
      part = 0;
      for (int i = 0; i < count; ++i) part += DevianceAt(first + i, row[i]).deviance;
    };
    if (!VisitSamples(values_, p, work, [&](double part) { deviance += part; })) return false;
    if (noise_.IsUncensoredGaussian()) deviance /= noise_.sigma * noise_.sigma;
    *sum = deviance + PriorSum(p);
    return std::isfinite(*sum);
  }

  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    if (is_stopped()) return false;
    if (!last_.IsAt(EvaluationKeyAt(p))) {
      if (!(data_.zero_motion_factors.empty() ? AddUp<1>(steady_, p, sums) : AddUp<2>(moving_, p, sums))) return false;
      last_.value = *sums;  // reuses the allocated memory
      last_.SetAt(EvaluationKeyAt(p));
    }
    *sums = last_.value;
    AddPriors(priors(), p, sums);
    return true;
  }

  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    if (is_stopped()) return false;
    readings->resize(static_cast<Eigen::Index>(used_samples_));
    const auto read = [&](const double* row, std::size_t first, int count) {
      Read(p, row, first, count, readings->data() + first);
    };
    const auto add = [](double /*part*/) {};
    if (jacobian == nullptr) {
      if (read_.IsAt(EvaluationKeyAt(p))) {
        *readings = read_.value;
        return true;
      }
      const auto work = [&](SampleBlock<1>& block, std::size_t first, int count, double& /*part*/) {
        read(block.row[0].data(), first, count);
      };
      return VisitSamples(values_, p, work, add);
    }
    jacobian->resize(readings->size(), count());
    const auto work = [&](SampleBlock<kParameters>& block, std::size_t first, int count, double& /*part*/) {
      read(block.row[kModel].data(), first, count);
      for (int j = 0; j < kZero; ++j) std::copy_n(block.row[j].data(), count, &(*jacobian)(first, j));
      jacobian->col(kZero).segment(first, count).setOnes();
      if (!data_.zero_motion_factors.empty())
        std::copy_n(&data_.zero_motion_factors[first], count, &(*jacobian)(first, kZero + 1));
    };
    Samples<Dual, kParameters, double> columns;
    return VisitSamples(columns, p, work, add);
  }

  bool Motion(std::span<const double> p, bool with_jacobian, MotionStates* states) const override {
    return with_jacobian ? FollowMotion<Dual>(p, states) : FollowMotion<double>(p, states);
  }

  /// The search asks whether the motion comes to rest, and the fit report asks when. Both ask at a point that was
  /// already evaluated.
  TraceSummary Trace(std::span<const double> p) const override {
    if (is_stopped()) return {};
    if (traced_.IsAt(EvaluationKeyAt(p))) return traced_.value;
    ++traces_;
    TraceOptions options = Options();
    const SegmentVisitor<double> nothing = [&](const Segment<double>&) { LimitStepsIfStopped(options); };
    traced_.SetAt(EvaluationKeyAt(p), TraceTrajectory(MakePendulum<double>(p), MakeStart<double>(p), options, nothing));
    return traced_.value;
  }

  bool is_stopped() const override { return data_.stop.stop_requested(); }

  /// At small angles a torque change alters the amplitude, in each half swing, by twice the change. The factor four is
  /// a safety margin.
  bool ComesToRest(std::span<const double> p, double torque_change) const override {
    constexpr double kSafe = 4;
    const TraceSummary trace = Trace(p);
    return trace.stop_time < data_.time.back() ||
           trace.smallest_reversal_margin < kSafe * 2 * trace.reversals * torque_change;
  }

 private:
  /// Computes readings from the model's values: adds the zero, and its motion if there is one.
  void Read(std::span<const double> p, const double* row, std::size_t first, int count, double* readings) const {
    const double zero = p[kZero];
    for (int i = 0; i < count; ++i) readings[i] = row[i] + zero;
    if (data_.zero_motion_factors.empty()) return;
    for (int i = 0; i < count; ++i) readings[i] += p[kZero + 1] * data_.zero_motion_factors[first + i];
  }

  /// Same result as noise_.DevianceAt, without an exponential and an error function for every quantized sample.
  SampleLikelihood DevianceAt(std::size_t sample, double reading) const {
    const double value = data_.value[sample];
    if (noise_.spread || noise_.averaging.motions)
      return noise_.ForSample(static_cast<Eigen::Index>(sample)).DevianceAt(value, reading);
    if (noise_.family != NoiseFamily::kQuantized || noise_.IsCensored(value)) return noise_.DevianceAt(value, reading);
    const double per_level = 1 / noise_.resolution;
    const double position = (value - reading) * per_level;
    const DepthTable::Curve level = levels_.At(0.5 - std::abs(position));
    return {std::max(2 * (levels_.best() - level.log), 0.0), std::copysign(level.slope * per_level, position),
            std::max(-level.curvature, 0.0) * per_level * per_level};
  }

  void FindResiduals(const double* readings, std::size_t first, int count, double* residuals) const {
    const double* const value = &data_.value[first];
    for (int i = 0; i < count; ++i) residuals[i] = value[i] - readings[i];
  }

  /// The rows of a block whose products are needed: derivatives, zero, the factor of the zero's motion if it moves, and
  /// residuals.
  template <int kBaseline>
  using Rows = SampleBlock<kZero + kBaseline + 1>;

  /// Sums of one block.
  template <int kBaseline>
  struct Part {
    RowProducts<kZero + kBaseline + 1> products;
    double deviance = 0;
  };

  /// Fills the rows after the derivatives and weights all rows; returns the deviance. Plain residuals are divided by σ
  /// only after all sums are complete.
  template <int kBaseline>
  double Prepare(const double* readings, std::size_t first, int count, Rows<kBaseline>& block) const {
    constexpr int kResidual = kZero + kBaseline;
    auto& residual = block.row[kResidual];
    std::fill_n(block.row[kZero].begin(), count, 1.0);
    if constexpr (kBaseline == 2) std::copy_n(&data_.zero_motion_factors[first], count, block.row[kZero + 1].begin());
    if (noise_.IsUncensoredGaussian()) {
      FindResiduals(readings, first, count, residual.data());
      return 0;
    }
    double deviance = 0;
    for (int i = 0; i < count; ++i) {
      const SampleLikelihood sample = DevianceAt(first + i, readings[i]);
      deviance += sample.deviance;
      const double root_weight = std::sqrt(sample.weight);
      residual[i] = root_weight > 0 ? sample.score / root_weight : 0.0;
      for (int j = 0; j < kResidual; ++j) block.row[j][i] *= root_weight;
    }
    return deviance;
  }

  /// kBaseline: number of parameters of the zero, 2 if it moves. Residuals are measured - modelled, so their
  /// derivatives are minus the model's.
  template <int kBaseline>
  bool AddUp(auto& samples, std::span<const double> p, Eigen::MatrixXd* sums) const {
    constexpr int kResidual = kZero + kBaseline;
    read_.parameters.clear();
    read_.value.resize(static_cast<Eigen::Index>(used_samples_));
    const auto work = [&](Rows<kBaseline>& block, std::size_t first, int count, Part<kBaseline>& part) {
      double* const readings = read_.value.data() + first;
      Read(p, block.row[kModel].data(), first, count, readings);
      part.deviance = Prepare<kBaseline>(readings, first, count, block);
      SumProducts(block, count, part.products);
    };
    Part<kBaseline> total{};
    const auto add = [&](const Part<kBaseline>& part) {
      total.deviance += part.deviance;
      for (std::size_t k = 0; k < total.products.size(); ++k) total.products[k] += part.products[k];
    };
    if (!VisitSamples(samples, p, work, add)) return false;
    read_.SetAt(EvaluationKeyAt(p));
    const double scale = noise_.IsUncensoredGaussian() ? 1 / (noise_.sigma * noise_.sigma) : 1.0;
    sums->resize(kResidual + 1, kResidual + 1);
    for (int i = 0, k = 0; i <= kResidual; ++i) {
      for (int j = 0; j <= i; ++j, ++k) {
        const double sign = i == kResidual && j < kResidual ? -1.0 : 1.0;
        (*sums)(i, j) = (*sums)(j, i) = sign * scale * total.products[k];
      }
    }
    if (!noise_.IsUncensoredGaussian()) (*sums)(kResidual, kResidual) = total.deviance;
    return sums->allFinite();
  }

  /// Parameter i as a T. If T is dual, its derivative with respect to parameter i is 1.
  template <typename T>
  static T AsParameter(double value, int i) {
    if constexpr (DualNumber<T>) {
      return T(value, i);
    } else {
      return value;
    }
  }

  template <typename T>
  Pendulum<F, T> MakePendulum(std::span<const double> p) const {
    Pendulum<F, T> pendulum{gravity_, AsParameter<T>(p[0], 0), {}};
    for (int i = 0; i < kFriction; ++i) pendulum.friction[i] = AsParameter<T>(p[1 + i], 1 + i);
    return pendulum;
  }

  template <typename T>
  Start<T> MakeStart(std::span<const double> p) const {
    constexpr int kAngle = 1 + kFriction;
    if constexpr (kStart == StartKind::kRelease) {
      return {kStart, p[kAngle + 1], AsParameter<T>(p[kAngle], kAngle), T(0.0)};
    } else {
      return {kStart, 0.0, AsParameter<T>(p[kAngle], kAngle), AsParameter<T>(p[kAngle + 1], kAngle + 1)};
    }
  }

  TraceOptions Options() const {
    TraceOptions options;
    options.end = std::nextafter(data_.time[used_samples_ - 1], kUnbounded);
    options.tolerance = tolerance_;
    options.max_steps =
        static_cast<int>(std::min(kStepsPerRadian * data_.natural_frequency * options.end + kMaxSteps, 1e9));
    return options;
  }

  /// A motion with a short period and few samples can take minutes. The tracer gives up as soon as no more steps are
  /// allowed.
  void LimitStepsIfStopped(TraceOptions& options) const {
    if (is_stopped()) options.max_steps = 0;
  }

  bool IsAdmissible(std::span<const double> p) const {
    if (!(p[0] > 0)) return false;
    return kStart == StartKind::kMoving || (p[kZero - 1] >= 0 && p[kZero - 1] <= data_.latest_release);
  }

  /// Traces the motion and passes each segment to take(segment).
  template <typename T, typename TakeSegment>
  bool Follow(std::span<const double> p, const TakeSegment& take) const {
    TraceOptions options = Options();
    const auto visit = [&](const Segment<T>& segment) {
      LimitStepsIfStopped(options);
      take(segment);
    };
    ++traces_;
    const SegmentVisitor<T> visitor = std::ref(visit);
    const TraceSummary summary = TraceTrajectory(MakePendulum<T>(p), MakeStart<T>(p), options, visitor);
    if (summary.outcome != TraceSummary::Outcome::kComplete) return false;
    if constexpr (DualNumber<T>) traced_.SetAt(EvaluationKeyAt(p), summary);
    return true;
  }

  /// Values and, for dual numbers, derivatives of angle, rate and acceleration. Rate and acceleration are slopes of the
  /// same segments.
  template <typename T>
  bool FollowMotion(std::span<const double> p, MotionStates* states) const {
    if (is_stopped() || !IsAdmissible(p)) return false;
    constexpr int kRows = kSegmentRows<T, kStart == StartKind::kRelease>;
    const auto size = static_cast<Eigen::Index>(used_samples_);
    std::array<Samples<T, kRows, double>, SensorModel::kStates> samples;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      samples[n].Restart({data_.time.data(), used_samples_}, threads_);
      states->value[n].resize(size);
      if constexpr (DualNumber<T>) states->jacobian[n].resize(size, kRows - 1);
    }
    const auto take = [&](int n, const Segment<T>& segment) {
      const auto work = [&](SampleBlock<kRows>& block, std::size_t first, int count, double& /*part*/) {
        std::copy_n(block.row[kRows - 1].data(), count, states->value[n].data() + first);
        for (int j = 0; j + 1 < kRows; ++j) std::copy_n(block.row[j].data(), count, &states->jacobian[n](first, j));
      };
      samples[n].AddSegment(segment, work, [](double /*part*/) {});
    };
    const bool traced = Follow<T>(p, [&](const Segment<T>& angle) {
      const Segment<T> rate = RateOf(angle);
      take(0, angle);
      take(1, rate);
      take(2, RateOf(rate));
    });
    return traced && samples[0].is_complete();
  }

  /// Traces the motion through all samples. EvaluateAt fills the first rows of each block: the derivatives with respect
  /// to all parameters except the zero, in their order, then the model's reading. For T = double only the reading.
  template <typename T, int R, typename Sum, typename Work, typename Add>
  bool VisitSamples(Samples<T, R, Sum>& samples, std::span<const double> p, const Work& work, const Add& add) const {
    if (is_stopped() || !IsAdmissible(p)) return false;
    samples.Restart({data_.time.data(), used_samples_}, threads_);
    const auto take = [&](const Segment<T>& segment) {
      if (data_.quantity == Quantity::kRate) {
        samples.AddSegment(RateOf(segment), work, add);
      } else {
        samples.AddSegment(segment, work, add);
      }
    };
    return Follow<T>(p, take) && samples.is_complete();
  }

  EvaluationKey EvaluationKeyAt(std::span<const double> p) const { return {p, tolerance_, used_samples_}; }

  Gravity gravity_;
  const TrajectoryData& data_;
  std::size_t used_samples_;
  double tolerance_ = 1e-10;
  int threads_ = 1;
  NoiseModel noise_;
  DepthTable levels_{1};                        // for quantized noise_
  mutable CachedResult<Eigen::MatrixXd> last_;  // sums without priors
  mutable CachedResult<TraceSummary> traced_;
  mutable CachedResult<Eigen::VectorXd> read_;
  // Memory that each evaluation reuses.
  mutable Samples<double, 1, double> values_;
  mutable Samples<Dual, kZero + 2, Part<1>> steady_;
  mutable Samples<Dual, kZero + 3, Part<2>> moving_;
};

}  // namespace pendulum
