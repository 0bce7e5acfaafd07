// SPDX-License-Identifier: Apache-2.0
#include "fitting/likelihood/sensed_cost.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "fitting/likelihood/cached_result.h"

namespace pendulum {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The data without its sensor: the readings are the angle, with zero 0.
TrajectoryData WithoutSensor(const TrajectoryData& data) {
  TrajectoryData unsensed = data;
  unsensed.quantity = Quantity::kAngle;
  unsensed.sensor = {};
  return unsensed;
}

/// The motion of another cost as a sensor reads it. Parameters: M of the motion, then S of the sensor.
class SensedCost final : public TrajectoryCost {
 public:
  SensedCost(int count, const TrajectoryData& data, const MotionModel& model, StartKind start)
      : TrajectoryCost(count),
        data_(data),
        data_without_sensor_(WithoutSensor(data)),
        motion_(MakeTrajectoryCost(model, start, data_without_sensor_)),
        used_samples_(data.time.size()) {
    noise_.sigma = data.scale;
  }

  void set_tolerance(double tolerance) override {
    tolerance_ = tolerance;
    motion_->set_tolerance(tolerance);
  }
  void set_used_samples(std::size_t count) override {
    used_samples_ = count;
    motion_->set_used_samples(count);
  }
  void set_noise(const NoiseModel& noise) override {
    noise_ = noise;
    last_.Forget();
  }
  void set_threads(int threads) override { motion_->set_threads(threads); }

  bool Readings(std::span<const double> p, VectorXd* readings, MatrixXd* jacobian) const override {
    if (jacobian == nullptr && read_.IsAt(EvaluationKeyAt(p))) {
      *readings = read_.value;
      return true;
    }
    MotionStates states;
    if (!motion_->Motion(MotionParameters(p), jacobian != nullptr, &states)) return false;
    traces_ = motion_->traces();
    ApplySensor(states, p, readings, jacobian);
    read_.SetAt(EvaluationKeyAt(p), *readings);
    return readings->allFinite();
  }

  bool Motion(std::span<const double> p, bool with_jacobian, MotionStates* states) const override {
    return motion_->Motion(MotionParameters(p), with_jacobian, states);
  }

  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    VectorXd readings;
    if (!Readings(p, &readings, nullptr)) return false;
    *sum = PriorSum(p);
    for (Index i = 0; i < readings.size(); ++i) {
      *sum += noise_.ForSample(i).DevianceAt(data_.value[i], readings[i]).deviance;
    }
    return std::isfinite(*sum);
  }

  bool Sums(std::span<const double> p, MatrixXd* sums) const override {
    if (!last_.IsAt(EvaluationKeyAt(p))) {
      VectorXd readings;
      MatrixXd jacobian;
      if (!Readings(p, &readings, &jacobian)) return false;
      AddUp(readings, std::move(jacobian), sums);
      if (!sums->allFinite()) return false;
      last_.SetAt(EvaluationKeyAt(p), *sums);
    }
    *sums = last_.value;
    AddPriors(priors(), p, sums);
    return true;
  }

  TraceSummary Trace(std::span<const double> p) const override { return motion_->Trace(MotionParameters(p)); }

  bool ComesToRest(std::span<const double> p, double torque_change) const override {
    return motion_->ComesToRest(MotionParameters(p), torque_change);
  }

  bool is_stopped() const override { return motion_->is_stopped(); }

 private:
  EvaluationKey EvaluationKeyAt(std::span<const double> p) const { return {p, tolerance_, used_samples_}; }

  /// Parameters of the motion, with 0 for its zero.
  std::vector<double> MotionParameters(std::span<const double> p) const {
    const auto motion = p.first(p.size() - static_cast<std::size_t>(data_.sensor.size()));
    std::vector<double> parameters(motion.begin(), motion.end());
    parameters.push_back(0);
    return parameters;
  }

  /// Computes the readings and, unless null, their derivatives by the chain rule.
  void ApplySensor(const MotionStates& states, std::span<const double> p, VectorXd* readings,
                   MatrixXd* jacobian) const {
    const Index samples = states.value[0].size();
    const int sensor_size = data_.sensor.size();
    const auto motion_size = static_cast<Index>(p.size()) - sensor_size;
    readings->resize(samples);
    if (jacobian != nullptr) jacobian->resize(samples, static_cast<Index>(p.size()));
    for (Index i = 0; i < samples; ++i) {
      const SensorModel::Response seen =
          data_.sensor.At({states.value[0][i], states.value[1][i], states.value[2][i]}, &p[motion_size]);
      (*readings)[i] = seen.reading;
      if (jacobian == nullptr) continue;
      jacobian->row(i).head(motion_size) = seen.by_state[0] * states.jacobian[0].row(i) +
                                           seen.by_state[1] * states.jacobian[1].row(i) +
                                           seen.by_state[2] * states.jacobian[2].row(i);
      for (int k = 0; k < sensor_size; ++k) (*jacobian)(i, motion_size + k) = seen.by_parameter[k];
    }
  }

  /// Residuals are measured - modelled, so their derivatives are minus the model's.
  void AddUp(const VectorXd& readings, MatrixXd jacobian, MatrixXd* sums) const {
    const Index size = jacobian.cols();
    VectorXd residual(readings.size());
    double deviance = 0;
    for (Index i = 0; i < readings.size(); ++i) {
      const SampleLikelihood sample = noise_.ForSample(i).DevianceAt(data_.value[i], readings[i]);
      deviance += sample.deviance;
      const double root_weight = std::sqrt(sample.weight);
      residual[i] = root_weight > 0 ? sample.score / root_weight : 0.0;
      jacobian.row(i) *= root_weight;
    }
    sums->resize(size + 1, size + 1);
    sums->topLeftCorner(size, size) = jacobian.transpose() * jacobian;
    sums->topRightCorner(size, 1) = -jacobian.transpose() * residual;
    sums->bottomLeftCorner(1, size) = sums->topRightCorner(size, 1).transpose();
    (*sums)(size, size) = deviance;
  }

  const TrajectoryData& data_;
  const TrajectoryData data_without_sensor_;
  std::unique_ptr<TrajectoryCost> motion_;
  std::size_t used_samples_;
  double tolerance_ = 1e-10;
  NoiseModel noise_;
  mutable CachedResult<MatrixXd> last_;  // sums without priors
  mutable CachedResult<VectorXd> read_;
};

}  // namespace

std::unique_ptr<TrajectoryCost> MakeSensedCost(const MotionModel& model, StartKind start, const TrajectoryData& data) {
  const auto motion_size = static_cast<int>(PhysicalParameters(model).size()) + 2;
  return std::make_unique<SensedCost>(motion_size + data.sensor.size(), data, model, start);
}

}  // namespace pendulum
