// SPDX-License-Identifier: Apache-2.0
#include "reference_run.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/nesting.h"
#include "pendulum/recording/window.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::benchmarks {
namespace {

constexpr double kCount = 0.1985 * kRadFromDeg;
constexpr double kFinestTolerance = 1e-17;

FitOptions OptionsFor(std::string_view model, StartKind start) {
  FitOptions options;
  options.model = model;
  options.start = start == StartKind::kRelease ? StartKind::kRelease : StartKind::kMoving;
  options.rig = ReferenceRig();
  return options;
}

/// Least-squares estimates and their standard errors.
struct Optimum {
  Parameters estimates;
  Parameters std_errors;
};

/// Gauss-Newton steps at the finest tolerance, from the result of FitRecording.
Optimum FindOptimum() {
  FitOptions options = OptionsFor("coulomb", StartKind::kRelease);
  const FitReport report = Expect(FitRecording(ReferenceRecording(), options));
  const FitProblem problem = Expect(MakeFitProblem(ReferenceRecording(), options));
  const auto cost = MakeTrajectoryCost(problem.model, StartKind::kRelease, problem.data);
  cost->set_tolerance(kFinestTolerance);
  std::vector<double> parameters;
  for (std::size_t i = 0; i < kTruth.size(); ++i) {
    parameters.push_back(report.parameters[i].estimate / problem.si_per_internal[i]);
  }
  for (int step = 0; step < 5; ++step) {
    Eigen::MatrixXd sums;
    cost->Sums(parameters, &sums);
    const Eigen::MatrixXd normal = sums.topLeftCorner<6, 6>();
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    Eigen::Map<Eigen::VectorXd>(parameters.data(), 6) -=
        scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * sums.col(6).head<6>());
  }
  Optimum optimum{};
  for (std::size_t i = 0; i < kTruth.size(); ++i) {
    optimum.estimates[i] = parameters[i] * problem.si_per_internal[i];
    optimum.std_errors[i] = report.parameters[i].std_error.value();
  }
  return optimum;
}

std::unique_ptr<TrajectoryCost> FinestCost(const EvaluationPoint& point) {
  auto cost = MakeTrajectoryCost(point.problem.model, point.problem.start.start, point.problem.data);
  cost->set_tolerance(kFinestTolerance);
  return cost;
}

}  // namespace

const Rig& ReferenceRig() {
  static const Rig rig = Expect(
      ParseRig(R"({"bob_mass": 0.380, "rod_mass": 0.095, "rod_length": 0.43, "gravity": 9.81})", "reference rig"));
  return rig;
}

Recording ReferenceRecording(int samples, double counts) {
  SyntheticOptions options;
  const double torque = ReferenceRig().gravity_torque.value;
  options.parameters = {kTruth[0] / torque, kTruth[1] / torque, kTruth[2] / torque};
  options.release_angle = kTruth[3];
  options.release_time = kTruth[4];
  options.zero = kTruth[5];
  options.sample_rate = samples / options.duration;
  options.noise = counts * kCount;
  options.resolution = kCount;
  return Expect(SimulateRecording(options));
}

std::string ReferenceCsv() {
  const Recording recording = ReferenceRecording();
  std::string text = "# resolution: 0.1985\ntime_s,angle_deg\n";
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double angle_deg = std::round(recording.value[i] / kCount) * 1985 / 10000;
    text += NumberText(recording.time[i]) + "," + NumberText(angle_deg) + "\n";
  }
  return text;
}

EvaluationPoint MakeEvaluationPoint(std::string_view model, StartKind start, int samples) {
  Recording recording = ReferenceRecording(samples);
  if (start == StartKind::kMoving) recording = Expect(SelectWindow(recording, kTruth[4] + 0.1, std::nan("")));
  EvaluationPoint point{Expect(MakeFitProblem(recording, OptionsFor(model, start))), {}};
  point.parameters = point.problem.first_guess;
  const std::vector<ParameterInfo> known =
      FitParameters(Expect(FindMotionModel("coulomb")), StartKind::kRelease, Quantity::kAngle);
  for (std::size_t i = 0; i < point.parameters.size(); ++i) {
    const auto named = [&](const ParameterInfo& info) { return info.name == point.problem.infos[i].name; };
    const auto found = std::find_if(known.begin(), known.end(), named);
    if (found == known.end()) continue;
    point.parameters[i] = kTruth[found - known.begin()] / point.problem.si_per_internal[i];
  }
  if (const OrderedPair order = FindOrderedPair(point.problem.model); order.larger >= 0) {
    point.parameters[static_cast<std::size_t>(order.larger)] =
        2 * point.parameters[static_cast<std::size_t>(order.smaller)];
  }
  return point;
}

double MaxReadingError(const EvaluationPoint& point, const Eigen::VectorXd& readings) {
  const auto cost = FinestCost(point);
  Eigen::VectorXd reference;
  if (!cost->Readings(point.parameters, &reference, nullptr)) return kUnbounded;
  return (readings - reference).cwiseAbs().maxCoeff();
}

double MaxJacobianError(const EvaluationPoint& point, const Eigen::MatrixXd& jacobian) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd reference;
  if (!FinestCost(point)->Readings(point.parameters, &readings, &reference)) return kUnbounded;
  double error = 0;
  for (Eigen::Index j = 0; j < jacobian.cols(); ++j) {
    const Eigen::VectorXd column = reference.col(j) / point.problem.si_per_internal[j];
    error = std::max(error, (jacobian.col(j) - column).lpNorm<Eigen::Infinity>() / column.lpNorm<Eigen::Infinity>());
  }
  return error;
}

double DistanceFromOptimum(const Parameters& estimates) {
  static const Optimum optimum = FindOptimum();
  double distance = 0;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    distance = std::max(distance, std::abs(estimates[i] - optimum.estimates[i]) / optimum.std_errors[i]);
  }
  return distance;
}

}  // namespace pendulum::benchmarks
