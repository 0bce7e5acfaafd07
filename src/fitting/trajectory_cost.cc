// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/trajectory_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "block_samples.h"
#include "depth_table.h"
#include "pendulum/model/dual.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// A trial that asks for more steps than this has a time scale far from that of the start values: a period takes
/// some 12.
constexpr double kStepsPerRadian = 20;
constexpr double kMostSteps = 10'000;

template <FrictionModel F, StartKind kStart>
class TrajectoryCostFor final : public TrajectoryCost {
  static constexpr int kFriction = kFrictionParameters<F>;
  static constexpr int kParameters = kFriction + 4;
  /// Derivatives carried by the trajectory; those for release time and zero need no dual number.
  static constexpr int kCarried = kStart == StartKind::kRelease ? kFriction + 2 : kFriction + 3;
  static constexpr int kZero = kParameters - 1;
  static_assert(kParameters + 1 <= kMostCompressed);
  static constexpr int kModel = kZero;  ///< Row of the model's reading, behind its derivatives.
  using Dual = pendulum::Dual<kCarried>;
  template <typename T, int R, typename Sum>
  using Samples = BlockSamples<T, kStart == StartKind::kRelease, R, Sum>;
  static_assert(kSegmentRows<Dual, kStart == StartKind::kRelease> == kParameters);

 public:
  TrajectoryCostFor(Gravity gravity, const TrajectoryData& data)
      : gravity_(gravity), data_(data), used_samples_(data.time.size()), count_(kParameters + (data.drifts ? 1 : 0)) {
    set_num_residuals(count_ + 1);
    mutable_parameter_block_sizes()->assign(count_, 1);
    noise_.sigma = data.scale;
  }

  void set_tolerance(double tolerance) override { tolerance_ = tolerance; }
  void set_threads(int threads) override { threads_ = threads; }
  void set_used_samples(std::size_t count) override { used_samples_ = count; }

  void set_noise(const NoiseModel& noise) override {
    if (noise_.IsPlain() && noise.IsPlain()) {
      last_.value *= std::pow(noise_.sigma / noise.sigma, 2);
    } else {
      last_.parameters.clear();
    }
    noise_ = noise;
    if (noise_.family == NoiseFamily::kQuantized) levels_.Build(noise_.sigma / noise_.resolution);
  }

  /// A trial whose step is taken is asked for its derivatives next: these cost little more than the residuals alone.
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::array<double, kParameters + 1> values{};
    for (int i = 0; i < count_; ++i) values[i] = *parameters[i];
    const std::span<const double> p(values.data(), count_);
    if (jacobians != nullptr) {
      trials_since_step_ = 0;
      if (!Sums(p, &scratch_)) return false;
      CompressResiduals(scratch_, residuals, jacobians);
      return true;
    }
    std::fill_n(residuals, count_, 0.0);
    double sum = 0;
    const bool likely_taken = trials_since_step_++ == 0;
    const bool valid = likely_taken ? Sums(p, &scratch_) : SumOfSquares(p, &sum);
    if (valid && likely_taken) sum = scratch_(count_, count_);
    residuals[count_] = std::sqrt(std::max(sum, 0.0));
    return valid;
  }

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    double deviance = 0;
    const auto work = [&](SampleBlock<1>& block, std::size_t first, int count, double& part) {
      auto& row = block.row[0];
      Read(p, row.data(), first, count, row.data());
      if (noise_.IsPlain()) {
        RowProducts<1> square;
        FindResiduals(row.data(), first, count, row.data());
        SumProducts(block, count, square);
        part = square[0];
        return;
      }
      part = 0;
      for (int i = 0; i < count; ++i) part += At(first + i, row[i]).deviance;
    };
    if (!VisitSamples(values_, p, work, [&](double part) { deviance += part; })) return false;
    if (noise_.IsPlain()) deviance /= noise_.sigma * noise_.sigma;
    *sum = deviance + PriorSum(p);
    return std::isfinite(*sum);
  }

  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    if (is_stopped()) return false;
    if (!last_.IsAt(p, *this)) {
      if (!(data_.drifts ? AddUp<2>(drifting_, p, sums) : AddUp<1>(steady_, p, sums))) return false;
      last_.SetAt(p, *this, *sums);
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
      if (read_.IsAt(p, *this)) {
        *readings = read_.value;
        return true;
      }
      const auto work = [&](SampleBlock<1>& block, std::size_t first, int count, double& /*part*/) {
        read(block.row[0].data(), first, count);
      };
      return VisitSamples(values_, p, work, add);
    }
    jacobian->resize(readings->size(), count_);
    const auto work = [&](SampleBlock<kParameters>& block, std::size_t first, int count, double& /*part*/) {
      read(block.row[kModel].data(), first, count);
      for (int j = 0; j < kZero; ++j) std::copy_n(block.row[j].data(), count, &(*jacobian)(first, j));
      jacobian->col(kZero).segment(first, count).setOnes();
      if (data_.drifts) jacobian->col(kZero + 1).segment(first, count) = data_.times().segment(first, count);
    };
    Samples<Dual, kParameters, double> columns;
    return VisitSamples(columns, p, work, add);
  }

  /// The search asks whether the motion comes to rest, the judgement when: at a point whose samples are known.
  TraceSummary Trace(std::span<const double> p) const override {
    if (is_stopped()) return {};
    if (traced_.IsAt(p, *this)) return traced_.value;
    ++traces_;
    TraceOptions options = Options();
    const std::function<void(const Segment<double>&)> nothing = [&](const Segment<double>&) {
      GiveUpIfStopped(options);
    };
    traced_.SetAt(p, *this, TraceTrajectory(MakePendulum<double>(p), MakeStart<double>(p), options, nothing));
    return traced_.value;
  }

  bool is_stopped() const override { return data_.stop.stop_requested(); }

  /// Each half swing loses twice the torque, which changes an amplitude by as much at small angles; four times to be
  /// safe.
  bool ComesToRest(std::span<const double> p, double torque_change) const override {
    constexpr double kSafe = 4;
    const TraceSummary trace = Trace(p);
    return trace.stop_time < data_.time.back() ||
           trace.smallest_reversal_margin < kSafe * 2 * trace.reversals * torque_change;
  }

 private:
  /// Readings of the model's values: what the sensor shows when the angle, or rate, is zero is added.
  void Read(std::span<const double> p, const double* row, std::size_t first, int count, double* readings) const {
    const double zero = p[kZero];
    for (int i = 0; i < count; ++i) readings[i] = row[i] + zero;
    if (!data_.drifts) return;
    for (int i = 0; i < count; ++i) readings[i] += p[kZero + 1] * data_.time[first + i];
  }

  /// As noise_.At, without an exponential and an error function for every sample of a level.
  SampleLikelihood At(std::size_t sample, double reading) const {
    const double value = data_.value[sample];
    if (noise_.spread) return noise_.ForSample(static_cast<Eigen::Index>(sample)).At(value, reading);
    if (noise_.family != NoiseFamily::kQuantized || noise_.IsCensored(value)) return noise_.At(value, reading);
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

  /// The rows of a block whose products are wanted: derivatives, zero, its drift if there is one, residuals.
  template <int kBaseline>
  using Rows = SampleBlock<kZero + kBaseline + 1>;

  /// Of one block.
  template <int kBaseline>
  struct Part {
    RowProducts<kZero + kBaseline + 1> products;
    double deviance = 0;
  };

  /// Completes the rows behind the derivatives and weighs them all; gives the deviance. Plain residuals are divided by
  /// σ when all are summed up.
  template <int kBaseline>
  double Prepare(const double* readings, std::size_t first, int count, Rows<kBaseline>& block) const {
    constexpr int kResidual = kZero + kBaseline;
    auto& residual = block.row[kResidual];
    std::fill_n(block.row[kZero].begin(), count, 1.0);
    if constexpr (kBaseline == 2) std::copy_n(data_.time.begin() + first, count, block.row[kZero + 1].begin());
    if (noise_.IsPlain()) {
      FindResiduals(readings, first, count, residual.data());
      return 0;
    }
    double deviance = 0;
    for (int i = 0; i < count; ++i) {
      const SampleLikelihood sample = At(first + i, readings[i]);
      deviance += sample.deviance;
      const double root_weight = std::sqrt(sample.weight);
      residual[i] = root_weight > 0 ? sample.score / root_weight : 0.0;
      for (int j = 0; j < kResidual; ++j) block.row[j][i] *= root_weight;
    }
    return deviance;
  }

  /// kBaseline parameters for the zero: itself, and its drift. Residuals are measured - modelled: their derivatives are
  /// minus the model's.
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
    read_.SetAt(p, *this);
    const double scale = noise_.IsPlain() ? 1 / (noise_.sigma * noise_.sigma) : 1.0;
    sums->resize(kResidual + 1, kResidual + 1);
    for (int i = 0, k = 0; i <= kResidual; ++i) {
      for (int j = 0; j <= i; ++j, ++k) {
        const double sign = i == kResidual && j < kResidual ? -1.0 : 1.0;
        (*sums)(i, j) = (*sums)(j, i) = sign * scale * total.products[k];
      }
    }
    if (!noise_.IsPlain()) (*sums)(kResidual, kResidual) = total.deviance;
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

  /// A motion of a short period and few samples takes minutes: the tracer refuses it as soon as it may make no more
  /// steps.
  void GiveUpIfStopped(TraceOptions& options) const {
    if (is_stopped()) options.max_steps = 0;
  }

  bool IsAdmissible(std::span<const double> p) const {
    if (!(p[0] > 0)) return false;
    return kStart == StartKind::kMoving || (p[kZero - 1] >= 0 && p[kZero - 1] <= data_.latest_release);
  }

  /// Traces the motion through all samples. The first rows of each block are EvaluateAt's: derivatives by all
  /// parameters but zero, in the parameters' order, then the model's reading; with T = double the reading alone.
  template <typename T, int R, typename Sum, typename Work, typename Add>
  bool VisitSamples(Samples<T, R, Sum>& samples, std::span<const double> p, const Work& work, const Add& add) const {
    if (is_stopped() || !IsAdmissible(p)) return false;
    samples.Restart({data_.time.data(), used_samples_}, threads_);
    TraceOptions options = Options();
    const auto visit = [&](const Segment<T>& segment) {
      GiveUpIfStopped(options);
      if (data_.quantity == Quantity::kAngle) {
        samples.Take(segment, work, add);
      } else {
        samples.Take(RateOf(segment), work, add);
      }
    };
    ++traces_;
    // One tracer for all visitors: it is by far the most code here.
    const std::function<void(const Segment<T>&)> visitor = std::ref(visit);
    const TraceSummary summary = TraceTrajectory(MakePendulum<T>(p), MakeStart<T>(p), options, visitor);
    if (summary.outcome != TraceSummary::Outcome::kComplete || !samples.is_complete()) return false;
    if constexpr (DualNumber<T>) traced_.SetAt(p, *this, summary);
    return true;
  }

  /// Something known, and where: solver, active set, search and judgement ask for it at the same point, one by one.
  template <typename What>
  struct Known {
    std::vector<double> parameters;
    double tolerance = 0;
    std::size_t samples = 0;
    What value;

    bool IsAt(std::span<const double> p, const TrajectoryCostFor& cost) const {
      return std::ranges::equal(p, parameters) && tolerance == cost.tolerance_ && samples == cost.used_samples_;
    }
    void SetAt(std::span<const double> p, const TrajectoryCostFor& cost, const What& what) {
      value = what;
      SetAt(p, cost);
    }
    void SetAt(std::span<const double> p, const TrajectoryCostFor& cost) {
      parameters.assign(p.begin(), p.end());
      tolerance = cost.tolerance_;
      samples = cost.used_samples_;
    }
  };

  Gravity gravity_;
  const TrajectoryData& data_;
  std::size_t used_samples_;
  int count_;  // of parameters
  double tolerance_ = 1e-10;
  int threads_ = 1;
  NoiseModel noise_;
  DepthTable levels_{1};                 // of quantized noise_
  mutable Known<Eigen::MatrixXd> last_;  // sums without priors
  mutable Known<TraceSummary> traced_;
  mutable Known<Eigen::VectorXd> read_;
  mutable int trials_since_step_ = 0;  // of the solver that calls Evaluate
  // Room that evaluations leave to the next one.
  mutable Eigen::MatrixXd scratch_;
  mutable Samples<double, 1, double> values_;
  mutable Samples<Dual, kZero + 2, Part<1>> steady_;
  mutable Samples<Dual, kZero + 3, Part<2>> drifting_;
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
