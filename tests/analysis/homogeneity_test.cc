// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/homogeneity.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/joint_runs.h"

namespace pendulum::homogeneity_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

const std::vector<std::string> kShared = {"inertia", "viscous", "coulomb"};

/// Options in SI with intervals from covariances.
FitOptions RigOptions(std::string_view model = "coulomb") {
  FitOptions options = ModelOptions(model);
  options.interval = IntervalMethod::kCovariance;
  options.rig = Rig{{kTextbookTorque, 0}, {}, {}};
  return options;
}

Homogeneity TestRuns(const std::vector<SyntheticOptions>& runs) {
  const FittedAlone alone(runs, RigOptions());
  return TestHomogeneity(alone.Runs(), kShared);
}

/// `count` runs; run `other` has `factor` times the inertia.
std::vector<SyntheticOptions> WithOther(int count, std::uint64_t seed, std::size_t other, double factor) {
  std::vector<SyntheticOptions> runs = SeveralRuns(count, seed);
  runs[other].parameters[0] *= factor;
  return runs;
}

// ---- Runs of one rig -----------------------------------------------------------------------------------------------

TEST(Homogeneity, IsConfirmedForRunsOfOneRig) {
  const Homogeneity result = TestRuns(SeveralRuns(5, 1));
  EXPECT_TRUE(result.agrees()) << result.verdict;
  ASSERT_TRUE(result.p);
  EXPECT_EQ(result.dof, 12);  // three parameters, four differences
  EXPECT_THAT(result.disagreeing, IsEmpty());
  EXPECT_THAT(result.reason, IsEmpty());
  EXPECT_THAT(result.verdict, StartsWith("the recordings agree on inertia, viscous, coulomb (chi-square "));
  EXPECT_THAT(result.amplitudes, SizeIs(5));
  EXPECT_TRUE(std::ranges::is_sorted(result.amplitudes));
}

/// Values and covariances of three parameters from each fit.
struct Alone {
  std::vector<Eigen::Vector3d> value;
  std::vector<Eigen::Matrix3d> precision;
};

Alone ValuesOf(const FittedAlone& fits, std::size_t count) {
  Alone alone;
  for (std::size_t k = 0; k < count; ++k) {
    const FitReport& fit = fits.Fit(k);
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) value[i] = fit.Find(kShared[static_cast<std::size_t>(i)])->estimate;
    alone.value.push_back(value);
    alone.precision.push_back(fit.covariance.topLeftCorner(3, 3).inverse());
  }
  return alone;
}

// Generalised least squares: Σ (p - m)' C⁻¹ (p - m) about m = (Σ C⁻¹)⁻¹ Σ C⁻¹ p. Student's t of 2000 samples is 1.001
// times as wide as a normal distribution. The errors may be larger by that factor, and the sum smaller by 0.002.
TEST(Homogeneity, HasTheChiSquareOfFullCovariances) {
  const FittedAlone fits(WithOther(4, 7, 1, 1.005), RigOptions());
  const Alone alone = ValuesOf(fits, 4);
  Eigen::Matrix3d precision = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    precision += alone.precision[k];
    sum += alone.precision[k] * alone.value[k];
  }
  const Eigen::Vector3d mean = precision.inverse() * sum;
  double expected = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d distance = alone.value[k] - mean;
    expected += distance.dot(alone.precision[k] * distance);
  }
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_THAT(result.statistic / expected, DoubleNear(1, 5e-3));
}

/// (value - weighted mean of the others) over the standard deviation of that difference.
double DistanceFromOthers(const std::vector<double>& value, const std::vector<double>& error, std::size_t k) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (i == k) continue;
    sum += value[i] / (error[i] * error[i]);
    weights += 1 / (error[i] * error[i]);
  }
  return (value[k] - sum / weights) / std::sqrt(error[k] * error[k] + 1 / weights);
}

TEST(Homogeneity, HasTheDistanceOfEachRunFromTheOtherRuns) {
  const FittedAlone fits(SeveralRuns(5, 11), RigOptions());
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  ASSERT_THAT(result.parameters, SizeIs(3));
  for (const SharedParameter& parameter : result.parameters) {
    SCOPED_TRACE(parameter.name);
    std::vector<double> value, error;
    for (std::size_t k = 0; k < 5; ++k) {
      value.push_back(fits.Fit(k).Find(parameter.name)->estimate);
      error.push_back(*fits.Fit(k).Find(parameter.name)->std_error);
    }
    for (std::size_t k = 0; k < 5; ++k) {
      const RunEstimate& run = parameter.runs[k];
      EXPECT_EQ(run.value, value[k]);
      EXPECT_THAT(*run.std_error / error[k], DoubleNear(1, 2e-3));
      EXPECT_THAT(*run.z, DoubleNear(DistanceFromOthers(value, error, k), 0.01));
    }
  }
}

// Cochran (1954), for one parameter; the true value is 0.079 kg m².
TEST(Homogeneity, DescribesEachParameter) {
  const Homogeneity result = TestRuns(SeveralRuns(5, 21));
  const SharedParameter& inertia = result.parameters.at(0);
  EXPECT_EQ(inertia.name, "inertia");
  EXPECT_EQ(inertia.unit, "kg m^2");
  EXPECT_EQ(inertia.dof, 4);
  double sum = 0, weights = 0, statistic = 0;
  for (const RunEstimate& run : inertia.runs) weights += std::pow(*run.std_error, -2);
  for (const RunEstimate& run : inertia.runs) sum += *run.value * std::pow(*run.std_error, -2) / weights;
  for (const RunEstimate& run : inertia.runs) statistic += std::pow((*run.value - sum) / *run.std_error, 2);
  EXPECT_THAT(inertia.mean, DoubleNear(sum, 1e-12));
  EXPECT_THAT(inertia.std_error, DoubleNear(1 / std::sqrt(weights), 1e-12));
  EXPECT_THAT(inertia.statistic, DoubleNear(statistic, 1e-6));
  EXPECT_THAT(inertia.mean, DoubleNear(0.079, 4 * inertia.std_error));
}

// ---- Runs of different rigs ----------------------------------------------------------------------------------------

TEST(Homogeneity, NamesTheRecordingWithAnotherInertia) {
  for (const std::size_t other : {0, 2, 4}) {
    const Homogeneity result = TestRuns(WithOther(5, 31 + other, other, 1.03));
    EXPECT_FALSE(result.agrees());
    EXPECT_THAT(result.disagreeing, ElementsAre(static_cast<int>(other)));
    const std::string name = "recording " + std::to_string(other + 1);
    EXPECT_THAT(result.verdict, StartsWith("the recordings do not agree on inertia (chi-square "));
    EXPECT_THAT(result.verdict, HasSubstr("; " + name + " disagrees with the others: its inertia is 3"));
    EXPECT_THAT(result.verdict, HasSubstr(" % larger; fit the others without it"));
  }
}

TEST(Homogeneity, NamesTwoOutliersOfFive) {
  std::vector<SyntheticOptions> runs = WithOther(5, 41, 1, 1.03);
  runs[3].parameters[0] *= 0.96;
  const Homogeneity result = TestRuns(runs);
  EXPECT_THAT(result.disagreeing, ElementsAre(1, 3)) << result.verdict;
  EXPECT_THAT(result.verdict, HasSubstr("fit the others without them"));
}

TEST(Homogeneity, NamesNeitherOfTwoDisagreeingRecordings) {
  const Homogeneity result = TestRuns(WithOther(2, 51, 1, 1.03));
  EXPECT_FALSE(result.agrees());
  EXPECT_THAT(result.disagreeing, IsEmpty());
  EXPECT_THAT(result.verdict, Not(HasSubstr("disagrees with the others")));
  EXPECT_THAT(result.verdict, HasSubstr("inertia"));
}

// Each run has a different inertia, with a scatter of 3 % far above the errors. There is no majority.
TEST(Homogeneity, NamesNoOutlierIfAllRecordingsScatter) {
  std::vector<SyntheticOptions> runs = SeveralRuns(5, 61);
  const double factors[] = {1.00, 0.96, 1.03, 0.985, 1.05};
  for (std::size_t k = 0; k < 5; ++k) runs[k].parameters[0] *= factors[k];
  const Homogeneity result = TestRuns(runs);
  EXPECT_FALSE(result.agrees());
  EXPECT_THAT(result.disagreeing, IsEmpty()) << result.verdict;
  // The standard deviation of the factors is 0.0357.
  const RandomEffects& scatter = result.parameters.at(0).scatter;
  EXPECT_THAT(scatter.between / 0.079, DoubleNear(0.0357, 0.001));
  EXPECT_THAT(result.verdict, HasSubstr("between recordings inertia scatters by 3.6 %"));
}

// Four runs scatter by a thousandth, many times their errors; the fifth run is thirty times as far away.
TEST(Homogeneity, NamesARecordingFarOutsideTheScatterOfTheOthers) {
  std::vector<SyntheticOptions> runs = SeveralRuns(5, 65);
  const double factors[] = {1.001, 0.9995, 1.03, 0.9985, 1.0005};
  for (std::size_t k = 0; k < 5; ++k) runs[k].parameters[0] *= factors[k];
  const Homogeneity result = TestRuns(runs);
  EXPECT_THAT(result.disagreeing, ElementsAre(2)) << result.verdict;
}

// ---- Bounds and undetermined parameters ----------------------------------------------------------------------------

/// Runs without viscous friction: in half of them the estimate without bounds is negative.
std::vector<SyntheticOptions> WithoutViscous(int count, std::uint64_t seed) {
  std::vector<SyntheticOptions> runs = SeveralRuns(count, seed);
  for (SyntheticOptions& run : runs) run.parameters[1] = 0;
  return runs;
}

TEST(Homogeneity, IgnoresBoundsInTheComparison) {
  const FittedAlone fits(WithoutViscous(8, 71), RigOptions());
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_TRUE(result.agrees()) << result.verdict;
  EXPECT_EQ(result.dof, 21);
  const SharedParameter& viscous = result.parameters.at(1);
  int at_bound = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    ASSERT_TRUE(viscous.runs[k].value) << k;
    EXPECT_LT(std::abs(*viscous.runs[k].value), 4 * *viscous.runs[k].std_error) << k;
    if (!fits.Fit(k).Find("viscous")->at_bound) continue;
    ++at_bound;
    EXPECT_LT(*viscous.runs[k].value, 0) << k;
  }
  EXPECT_GE(at_bound, 1);
  EXPECT_LE(at_bound, 7);
  EXPECT_THAT(viscous.mean, DoubleNear(0, 3.5 * viscous.std_error));
}

TEST(Homogeneity, IsNotTestedIfAllSharedParametersAreFixed) {
  FitOptions options = RigOptions();
  options.fixed = {{"inertia", 0.079}};
  const FittedAlone fits(SeveralRuns(2, 81), options);
  const Homogeneity result = TestHomogeneity(fits.Runs(), {"inertia"});
  EXPECT_FALSE(result.p);
  EXPECT_TRUE(result.agrees());
  EXPECT_THAT(result.parameters, IsEmpty());
  EXPECT_EQ(result.reason, "all shared parameters are fixed, so there is nothing to compare");
  EXPECT_EQ(result.verdict, "not tested: all shared parameters are fixed, so there is nothing to compare");
}

TEST(Homogeneity, SkipsFixedParameters) {
  FitOptions options = RigOptions();
  options.fixed = {{"viscous", 0.003}};
  const FittedAlone fits(SeveralRuns(3, 81), options);
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_EQ(result.dof, 4);
  EXPECT_THAT(result.parameters, ElementsAre(testing::Field(&SharedParameter::name, "inertia"),
                                             testing::Field(&SharedParameter::name, "coulomb")));
}

TEST(Homogeneity, IsNotTestedWithOneInformativeRecording) {
  FittedAlone fits(SeveralRuns(2, 91), RigOptions());
  fits.Fit(0).termination = Termination::kNotConverged;
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_FALSE(result.p);
  EXPECT_EQ(result.reason, "fewer than two recordings determine all shared parameters on their own");
}

TEST(Homogeneity, UsesInformativeRecordingsOnly) {
  FittedAlone fits(WithOther(4, 95, 3, 1.03), RigOptions());
  fits.Fit(0).termination = Termination::kNotConverged;
  const Homogeneity result = TestHomogeneity(fits.Runs(), kShared);
  EXPECT_EQ(result.dof, 6);
  EXPECT_FALSE(result.parameters.at(0).runs[0].value);
  EXPECT_THAT(result.disagreeing, ElementsAre(3));  // index among all recordings
}

}  // namespace
}  // namespace pendulum::homogeneity_test
