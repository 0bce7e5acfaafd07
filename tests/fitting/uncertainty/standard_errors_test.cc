// SPDX-License-Identifier: Apache-2.0
// Compares the covariance around a solution with numeric derivatives of the likelihood, and with the scatter of
// estimates over seeds.
#include "pendulum/fitting/uncertainty/standard_errors.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <boost/random/student_t_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::standard_errors_test {
namespace {

// ---- Numeric derivatives -------------------------------------------------------------------------------------------

/// The short swing in counts, with noise in counts.
Recording ShortSwingInCounts(double noise, std::uint64_t seed) {
  SyntheticOptions run = ShortSwing();
  run.resolution = kCount;
  run.noise = noise * kCount;
  run.seed = seed;
  return Must(SimulateRecording(run));
}

/// Minus the log-likelihood of P parameters and log σ around a solution.
using MinusLog = std::function<double(const Eigen::VectorXd& shift)>;

double MinusLogOf(const Fitted& fitted, const Eigen::VectorXd& readings, double sigma_shift) {
  NoiseModel noise = fitted.solution.noise;
  noise.sigma *= std::exp(sigma_shift);
  return -LogLikelihood(noise, fitted.recording.value, readings);
}

MinusLog Traced(const Fitted& fitted) {
  return [&](const Eigen::VectorXd& shift) {
    std::vector<double> p = fitted.solution.parameters;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += shift[static_cast<Eigen::Index>(i)];
    Eigen::VectorXd readings;
    EXPECT_TRUE(fitted.cost->Readings(p, &readings, nullptr));
    return MinusLogOf(fitted, readings, shift[shift.size() - 1]);
  };
}

/// The same for a trajectory that is linear in its parameters.
MinusLog Linearized(const Fitted& fitted) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  EXPECT_TRUE(fitted.cost->Readings(fitted.solution.parameters, &readings, &jacobian));
  return [=, &fitted](const Eigen::VectorXd& shift) {
    return MinusLogOf(fitted, readings + jacobian * shift.head(jacobian.cols()), shift[jacobian.cols()]);
  };
}

/// Second derivatives by central differences with these steps: four points for each pair.
Eigen::MatrixXd NumericInformation(const MinusLog& minus_log, const Eigen::VectorXd& steps) {
  const Eigen::Index size = steps.size();
  Eigen::MatrixXd information(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Eigen::VectorXd a = steps[i] * Eigen::VectorXd::Unit(size, i);
      const Eigen::VectorXd b = steps[j] * Eigen::VectorXd::Unit(size, j);
      const double sum = minus_log(a + b) + minus_log(-a - b) - minus_log(a - b) - minus_log(b - a);
      information(i, j) = information(j, i) = sum / (4 * steps[i] * steps[j]);
    }
  }
  return information;
}

/// Compares the errors of parameters and σ with the inverse of numeric second derivatives, relative to its size.
void ExpectInverse(const Errors& errors, const Fitted& fitted, const MinusLog& minus_log, double allowed) {
  Eigen::VectorXd steps(7);
  steps.head(6) = 0.03 * errors.covariance.diagonal().cwiseSqrt();
  steps[6] = 0.003;
  const Eigen::MatrixXd expected = NumericInformation(minus_log, steps).inverse();
  const double counted = 400.0 / (400 - 6);  // as if σ were estimated with N - F
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double size = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(errors.covariance(i, j) / counted / size, expected(i, j) / size, allowed) << i << ", " << j;
    }
  }
  EXPECT_NEAR(*errors.runs[0].sigma / fitted.solution.noise.sigma / std::sqrt(expected(6, 6)), 1, allowed);
}

TEST(ComputeErrors, MatchTheNumericInformationOnLevels) {
  for (const double noise : {0.15, 0.2, 0.5}) {
    SCOPED_TRACE(noise);
    FitOptions options = ModelOptions("coulomb");
    options.noise = NoiseFamily::kQuantized;
    Fitted fitted = FitWithInternals(ShortSwingInCounts(noise, 3), options);
    fitted.cost->set_tolerance(1e-15);
    const Errors errors = fitted.StandardErrors();
    ExpectInverse(errors, fitted, Linearized(fitted), 1e-3);
    // The curvature of the trajectory within a standard error is neglected, as usual in nonlinear least squares.
    ExpectInverse(errors, fitted, Traced(fitted), 1e-2);
  }
}

// ---- Scatter over seeds --------------------------------------------------------------------------------------------

/// For one number: its standard deviation over seeds, and the mean of its reported standard errors.
struct Scatter {
  double sum = 0, square = 0, mean_std_error = 0;
  double count = 0;

  void Add(double value, double std_error) {
    sum += value;
    square += value * value;
    mean_std_error += std_error;
    ++count;
  }
  double Ratio() const {
    const double mean = sum / count;
    return std::sqrt((square / count - mean * mean) * count / (count - 1)) / (mean_std_error / count);
  }
};

/// The scatter of each parameter, measured from its first estimate, and at last the scatter of σ.
std::vector<Scatter> ScatterOver(int seeds, const std::function<FitReport(std::uint64_t seed)>& fit) {
  std::vector<Scatter> scatter;
  std::vector<double> origin;
  for (int seed = 1; seed <= seeds; ++seed) {
    const FitReport report = fit(static_cast<std::uint64_t>(seed));
    EXPECT_EQ(report.termination, Termination::kConverged) << "seed " << seed << ": " << report.reason;
    scatter.resize(report.parameters.size() + 1);
    origin.resize(scatter.size(), 0.0);
    for (std::size_t i = 0; i < report.parameters.size(); ++i) {
      const ParameterEstimate& parameter = report.parameters[i];
      EXPECT_TRUE(parameter.std_error) << "seed " << seed << ", " << parameter.info.name;
      if (seed == 1) origin[i] = parameter.estimate;
      scatter[i].Add(parameter.estimate - origin[i], parameter.std_error.value_or(0));
    }
    scatter.back().Add(report.noise.sigma, report.noise.sigma_std_error.value_or(0));
  }
  return scatter;
}

/// Expects that the standard deviation over seeds equals the mean standard error, within four times its own error.
void ExpectTrueErrors(const std::vector<Scatter>& scatter) {
  const double allowed = 4 / std::sqrt(2 * scatter[0].count);
  for (std::size_t i = 0; i < scatter.size(); ++i) {
    EXPECT_NEAR(scatter[i].Ratio(), 1, allowed) << (i + 1 == scatter.size() ? "sigma" : "parameter ") << i;
  }
}

constexpr int kSeeds = 200;

TEST(ComputeErrors, MatchTheScatterOnLevels) {
  for (const double noise : {0.15, 0.5}) {
    SCOPED_TRACE(noise);
    FitOptions options = ModelOptions("coulomb");
    options.noise = NoiseFamily::kQuantized;
    options.interval = IntervalMethod::kCovariance;
    ExpectTrueErrors(
        ScatterOver(kSeeds, [&](std::uint64_t seed) { return Fit(ShortSwingInCounts(noise, seed), options); }));
  }
}

TEST(ComputeErrors, MatchTheScatterOfSigmaForWhiteNoise) {
  const auto fit = [](std::uint64_t seed) {
    SyntheticOptions run = ShortSwing();
    run.seed = seed;
    return FitOwnModel(run);
  };
  ExpectTrueErrors(ScatterOver(kSeeds, fit));
}

/// The short swing without noise.
Recording QuietShortSwing(double duration = 8) {
  SyntheticOptions run = ShortSwing();
  run.noise = 0;
  run.duration = duration;
  return Must(SimulateRecording(run));
}

TEST(ComputeErrors, MatchTheScatterOfRobustFitsWithOutliers) {
  const Recording quiet = QuietShortSwing();
  for (const NoiseFamily family : {NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    SCOPED_TRACE(family == NoiseFamily::kHuber ? "huber" : "student");
    FitOptions options = ModelOptions("coulomb");
    options.noise = family;
    options.interval = IntervalMethod::kCovariance;
    const auto fit = [&](std::uint64_t seed) {
      boost::random::student_t_distribution<double> student(3);
      return Fit(WithNoise(quiet, seed, [&](auto& generator) { return 0.001 * student(generator); }), options);
    };
    ExpectTrueErrors(ScatterOver(kSeeds, fit));
  }
}

TEST(ComputeErrors, MatchTheScatterForAutocorrelatedNoise) {
  const Recording quiet = QuietShortSwing(16);
  FitOptions options = ModelOptions("coulomb");
  options.interval = IntervalMethod::kCovariance;
  const auto fit = [&](std::uint64_t seed) {
    return Fit(WithNoise(quiet, seed, AutocorrelatedNoise(0.8, 0.002)), options);
  };
  ExpectTrueErrors(ScatterOver(kSeeds, fit));
}

}  // namespace
}  // namespace pendulum::standard_errors_test
