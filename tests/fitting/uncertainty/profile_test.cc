// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/profile.h"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/distributions/students_t.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::profile_test {
namespace {

using testing::HasSubstr;

double TwoSided95(double freedom) { return boost::math::quantile(boost::math::students_t(freedom), 0.975); }

// ---- A reparametrized straight line --------------------------------------------------------------------------------

/// A reparametrization of a line's slope: the slope as a function of the parameter, with its derivative and inverse.
struct SlopeMap {
  std::function<double(double)> slope, derivative, parameter;
};

/// Readings offset + slope(p) x: parameters p and offset, N residuals, no trajectory.
class LineCost final : public TrajectoryCost {
 public:
  LineCost(SlopeMap map, Eigen::VectorXd x, Eigen::VectorXd value)
      : TrajectoryCost(2), map_(std::move(map)), x_(std::move(x)), value_(std::move(value)) {}

  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    *readings = p[1] + map_.slope(p[0]) * x_.array();
    if (jacobian == nullptr) return true;
    jacobian->resize(x_.size(), 2);
    jacobian->col(0) = map_.derivative(p[0]) * x_;
    jacobian->col(1).setOnes();
    return true;
  }
  bool SumOfSquares(std::span<const double> p, double* sum) const override {
    Eigen::MatrixXd sums;
    Sums(p, &sums);
    *sum = sums(2, 2);
    return true;
  }
  bool Sums(std::span<const double> p, Eigen::MatrixXd* sums) const override {
    Eigen::VectorXd readings;
    Eigen::MatrixXd jacobian;
    Readings(p, &readings, &jacobian);
    Eigen::MatrixXd columns(x_.size(), 3);
    columns << -jacobian, value_ - readings;
    *sums = columns.transpose() * columns / (sigma_ * sigma_);
    return true;
  }
  bool Motion(std::span<const double>, bool, MotionStates*) const override { return false; }
  TraceSummary Trace(std::span<const double>) const override { return {}; }
  bool ComesToRest(std::span<const double>, double) const override { return false; }
  void set_tolerance(double) override {}
  void set_used_samples(std::size_t) override {}
  void set_threads(int) override {}
  void set_noise(const NoiseModel& noise) override { sigma_ = noise.sigma; }

 private:
  SlopeMap map_;
  Eigen::VectorXd x_;
  Eigen::VectorXd value_;
  double sigma_ = 1;
};

/// Twenty points about 0.2 + slope x, with the same residuals for every slope.
struct Line {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(20, -1, 1);
  Eigen::VectorXd value;

  explicit Line(double slope) {
    value = 0.2 + slope * x.array() + 0.1 * (7.3 * Eigen::ArrayXd::LinSpaced(20, 1, 20)).sin();
  }
  double Slope() const { return x.dot(value) / x.squaredNorm(); }  // x has mean 0
  double Sigma() const {
    return std::sqrt((value.array() - value.mean() - Slope() * x.array()).square().sum() / (20 - 2));
  }
  /// Half length of the textbook's 95 % interval of the slope, from t with N - 2 degrees of freedom.
  double HalfLength() const { return TwoSided95(18) * Sigma() / x.norm(); }
};

/// The profile of the reparametrized slope. Its parameter may have bounds; the search begins at `start`.
ProfileInterval ProfileOfLine(const Line& line, const SlopeMap& map, double start, double lower, double upper) {
  LineCost cost(map, line.x, line.value);
  FitProblem problem;
  problem.infos = {kInertia, kZeroAngle};
  problem.data.time.assign(line.x.begin(), line.x.end());
  problem.data.value.assign(line.value.begin(), line.value.end());
  problem.solve.lower = {lower, -kUnbounded};
  problem.solve.upper = {upper, kUnbounded};
  problem.solve.fixed = {false, false};
  NoiseModel noise;
  noise.sigma = line.Sigma();
  cost.set_noise(noise);
  Solution solution = Solve(cost, {start, 0}, problem.solve);
  solution.noise = noise;
  EXPECT_TRUE(cost.Readings(solution.parameters, &solution.readings, nullptr));
  const Optimum optimum = Linearize(problem.solve, cost, solution).value();
  return ProfileParameter(SolvedFitOf({Recording(), FitOptions(), problem, cost, solution}), optimum, 0);
}

const SlopeMap kNone = {[](double p) { return p; }, [](double) { return 1.0; }, [](double s) { return s; }};
const SlopeMap kExponential = {[](double p) { return std::exp(p); }, [](double p) { return std::exp(p); },
                               [](double s) { return std::log(s); }};
/// A slope that stays below 1 for any parameter value.
const SlopeMap kSaturating = {[](double p) { return p / (1 + p); }, [](double p) { return 1 / ((1 + p) * (1 + p)); },
                              [](double s) { return s / (1 - s); }};

/// A profile does not depend on the parametrization: the result is the line's interval, transformed to the parameter.
TEST(ProfileParameter, MatchesTheTransformedIntervalOfALine) {
  for (const SlopeMap* map : {&kNone, &kExponential, &kSaturating}) {
    const Line line(0.3);
    const ProfileInterval profile = ProfileOfLine(line, *map, map->parameter(0.25), map->parameter(0.05), 20);
    ASSERT_TRUE(profile.lower && profile.upper);
    // The search for an end stops when sqrt(rise of the deviance / threshold) is within 0.01 of 1. For a line this
    // ratio is the distance from the estimate divided by the half length.
    EXPECT_NEAR(map->slope(*profile.lower), line.Slope() - line.HalfLength(), 0.011 * line.HalfLength());
    EXPECT_NEAR(map->slope(*profile.upper), line.Slope() + line.HalfLength(), 0.011 * line.HalfLength());
    EXPECT_EQ(profile.open, OpenInterval::kClosed);
  }
}

TEST(ProfileParameter, IsOpenIfTheLikelihoodFallsTooLittle) {
  const Line line(0.97);
  ASSERT_GT(line.Slope() + line.HalfLength(), 1);  // no parameter value has such a slope
  const ProfileInterval profile = ProfileOfLine(line, kSaturating, 5, -0.5, kUnbounded);
  ASSERT_TRUE(profile.lower);
  EXPECT_NEAR(kSaturating.slope(*profile.lower), line.Slope() - line.HalfLength(), 0.011 * line.HalfLength());
  EXPECT_FALSE(profile.upper);
  EXPECT_EQ(profile.open, OpenInterval::kFlatLikelihood);
}

TEST(ProfileParameter, EndsAtABoundWithinTheInterval) {
  const Line line(0.3);
  const double bound = line.Slope() + 0.4 * line.HalfLength();
  const ProfileInterval profile = ProfileOfLine(line, kNone, 0.2, -1, bound);
  EXPECT_EQ(profile.upper, bound);
  EXPECT_NEAR(*profile.lower, line.Slope() - line.HalfLength(), 0.011 * line.HalfLength());
  EXPECT_EQ(profile.open, OpenInterval::kClosed);
}

/// If the bound excludes the line's own slope, the likelihood decreases from its value at the bound, not from its
/// maximum.
TEST(ProfileParameter, MeasuresTheDevianceFromTheBoundForAParameterAtItsBound) {
  const Line line(0.3);
  const double beyond = 0.5 * line.HalfLength();
  const ProfileInterval profile = ProfileOfLine(line, kNone, 1, line.Slope() + beyond, 5);
  EXPECT_DOUBLE_EQ(*profile.lower, line.Slope() + beyond);
  // At distance d from the maximum, the deviance has risen by d²: d² - beyond² = length².
  EXPECT_NEAR(*profile.upper - line.Slope(), std::hypot(line.HalfLength(), beyond), 0.011 * line.HalfLength());
}

TEST(ProfileParameter, HasNoEndsForAnUndeterminedParameter) {
  const SlopeMap nothing = {[](double) { return 0.3; }, [](double) { return 0.0; }, {}};
  const ProfileInterval profile = ProfileOfLine(Line(0.3), nothing, 1, -kUnbounded, kUnbounded);
  EXPECT_FALSE(profile.lower || profile.upper);
  EXPECT_EQ(profile.open, OpenInterval::kNotDetermined);
}

// ---- The curve -----------------------------------------------------------------------------------------------------

/// For a straight line the statistic is the parabola (t (slope - estimate) / half length)², t² at the ends.
TEST(ProfileParameter, IsAParabolaForALine) {
  const Line line(0.3);
  const double threshold = TwoSided95(18) * TwoSided95(18);
  for (const SlopeMap* map : {&kNone, &kExponential, &kSaturating}) {
    const ProfileInterval profile = ProfileOfLine(line, *map, map->parameter(0.25), map->parameter(0.05), 20);
    EXPECT_NEAR(profile.threshold, threshold, 1e-9 * threshold);
    ASSERT_GE(profile.points.size(), 9);
    for (const ProfilePoint& point : profile.points) {
      const double distance = (map->slope(point.value) - line.Slope()) / line.HalfLength();
      // The solver is accurate to 1e-10 of the sum of squares, 18 here.
      EXPECT_NEAR(point.statistic, threshold * distance * distance, 1e-6) << point.value;
    }
  }
}

TEST(ProfileParameter, HasPointsFromEndToEndIncludingTheEstimate) {
  const Line line(0.3);
  const ProfileInterval profile = ProfileOfLine(line, kExponential, kExponential.parameter(0.25), -5, 5);
  const std::vector<ProfilePoint>& points = profile.points;
  ASSERT_GE(points.size(), 9);
  const double longest = 0.3 * (*profile.upper - *profile.lower);
  int at_estimate = 0, at_ends = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    at_estimate += points[i].statistic == 0;
    // The ends are found to a hundredth of the statistic's root.
    at_ends += (points[i].value == *profile.lower || points[i].value == *profile.upper) &&
               std::abs(points[i].statistic / profile.threshold - 1) < 0.021;
    if (i == 0) continue;
    EXPECT_GT(points[i].value, points[i - 1].value);
    EXPECT_LT(points[i].value - points[i - 1].value, longest);
  }
  EXPECT_EQ(at_estimate, 1);
  EXPECT_EQ(at_ends, 2);
}

TEST(ProfileParameter, HasPointsOnOneSideOfABoundOnly) {
  const Line line(0.3);
  const double bound = line.Slope() + 0.5 * line.HalfLength();
  const ProfileInterval profile = ProfileOfLine(line, kNone, 1, bound, 5);
  ASSERT_GE(profile.points.size(), 5);
  EXPECT_EQ(profile.points.front().value, bound);
  EXPECT_EQ(profile.points.front().statistic, 0);
}

TEST(ProfileParameter, HasNoPointsForAnUndeterminedParameter) {
  const SlopeMap nothing = {[](double) { return 0.3; }, [](double) { return 0.0; }, {}};
  EXPECT_THAT(ProfileOfLine(Line(0.3), nothing, 1, -kUnbounded, kUnbounded).points, testing::IsEmpty());
}

// ---- Swings --------------------------------------------------------------------------------------------------------

TEST(ProfileParameter, MatchesTheCovarianceForAFineRecording) {
  const Recording recording = Must(SimulateRecording(ShortSwing()));
  FitOptions options = ModelOptions("coulomb");
  const FitReport covariance = Fit(recording, options);
  EXPECT_THAT(covariance.interval_method, HasSubstr("standard errors"));
  options.interval = IntervalMethod::kProfile;
  const FitReport profile = Fit(recording, options);
  EXPECT_EQ(profile.interval_method, "profile likelihood");
  for (std::size_t i = 0; i < 6; ++i) {
    const ParameterEstimate& a = covariance.parameters[i];
    const ParameterEstimate& b = profile.parameters[i];
    const double half_length = 0.5 * (*a.upper95 - *a.lower95);
    EXPECT_NEAR((*b.lower95 - *a.lower95) / half_length, 0, 0.03) << a.info.name;
    EXPECT_NEAR((*b.upper95 - *a.upper95) / half_length, 0, 0.03) << a.info.name;
  }
}

/// 10 s of the textbook rig without viscous friction, at 25 Hz.
SyntheticOptions WithoutViscous(std::uint64_t seed) {
  SyntheticOptions run = NoisyRun("coulomb", seed);
  run.sample_rate = 25;
  run.noise = 0.001;
  run.parameters[1] = 0;
  return run;
}

TEST(ProfileParameter, CoversATruthAtItsBound) {
  constexpr int kSeeds = 250;
  const std::vector<double> truth = Truth(WithoutViscous(1));
  std::vector<int> covered(truth.size());
  int at_bound = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const FitReport report = FitOwnModel(WithoutViscous(seed));
    ASSERT_EQ(report.termination, Termination::kConverged) << seed;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const ParameterEstimate& parameter = report.parameters[i];
      ASSERT_TRUE(parameter.lower95 && parameter.upper95) << seed << ", " << parameter.info.name;
      covered[i] += parameter.lower95 <= truth[i] && truth[i] <= parameter.upper95;
    }
    const ParameterEstimate& viscous = report.parameters[1];
    if (!viscous.at_bound) continue;
    ++at_bound;
    EXPECT_EQ(viscous.lower95, 0);
    EXPECT_GT(*viscous.upper95, 0);
    EXPECT_EQ(report.interval_method, "profile likelihood");
  }
  EXPECT_NEAR(at_bound, kSeeds / 2, 4 * std::sqrt(kSeeds * 0.25));
  // Only one end of a two-sided interval can exclude a true value at the bound.
  EXPECT_NEAR(covered[1], 0.975 * kSeeds, 4 * std::sqrt(kSeeds * 0.975 * 0.025));
  for (const std::size_t i : {0, 2, 3, 4, 5}) {
    EXPECT_NEAR(covered[i], 0.955 * kSeeds, 4 * std::sqrt(kSeeds * 0.05 * 0.95)) << i;
  }
}

/// The value of b at which the deviance of fits with b fixed has risen by t², by bisection over whole fits.
double ScannedUpper(const Recording& recording, const FitReport& report) {
  const double t = TwoSided95(static_cast<double>(recording.size()) - static_cast<double>(report.covariance.rows()));
  const double variance = report.noise.sigma * report.noise.sigma;
  double inside = report.Find("viscous")->estimate;
  double outside = 0.01;
  while (outside - inside > 1e-3 * outside) {
    FitOptions options = ModelOptions("coulomb");
    options.fixed["viscous"] = 0.5 * (inside + outside);
    const double rise = Fit(recording, options).residual.squaredNorm() - report.residual.squaredNorm();
    (rise / variance < t * t ? inside : outside) = options.fixed["viscous"];
  }
  return inside;
}

TEST(ProfileParameter, MatchesAScanOfWholeFitsAtABound) {
  int at_bound = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Recording recording = Must(SimulateRecording(WithoutViscous(seed)));
    const FitReport report = Fit(recording, ModelOptions("coulomb"));
    at_bound += report.Find("viscous")->at_bound;
    EXPECT_NEAR(*report.Find("viscous")->upper95 / ScannedUpper(recording, report), 1, 0.02) << "seed " << seed;
  }
  EXPECT_GT(at_bound, 2);
}

}  // namespace
}  // namespace pendulum::profile_test
