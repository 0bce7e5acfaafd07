// SPDX-License-Identifier: Apache-2.0
// Error rates of TestHomogeneity and of joint fits, for simulated sets of five recordings (coverage_scenarios.h): how
// often recordings of one rig are reported as disagreeing, how often a recording of another rig is found, and how often
// joint 95 % intervals contain the true values.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/coverage_scenarios.h"
#include "pendulum/analysis/homogeneity.h"
#include "pendulum/base/parallel.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::homogeneity_errors_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Each;
using testing::Ge;
using testing::Le;

constexpr int kRuns = 5;
const std::vector<std::string> kShared = {"inertia", "viscous", "coulomb"};
constexpr std::array<double, 3> kTruth = {0.079, 0.003, 0.004};  // SI, of the scenarios

/// Recordings of one rig and the separate fit to each of them.
struct Set {
  FitOptions options;
  std::vector<Recording> recordings;
  std::vector<FitReport> alone;

  Homogeneity Compare() const {
    std::vector<RunAlone> runs;
    for (std::size_t k = 0; k < alone.size(); ++k) {
      runs.push_back({"recording " + std::to_string(k + 1), recordings[k], alone[k], options, nullptr});
    }
    return TestHomogeneity(runs, kShared);
  }

  JointFit FitTogether() const {
    std::vector<JointRun> runs;
    for (std::size_t k = 0; k < alone.size(); ++k) runs.push_back({recordings[k], alone[k], options});
    return Must(FitJointly(runs, kShared));
  }
};

CoverageScenario ScenarioOf(const std::string& name) { return Must(FindCoverageScenarios(name)).front(); }

/// Five releases from 0.35 to 0.55 rad. Run `other`, if there is one, has `factor` times the inertia.
Set MakeSet(const CoverageScenario& scenario, int number, int other = -1, double factor = 1) {
  Set set{scenario.fit, {}, {}};
  set.options.interval = IntervalMethod::kCovariance;
  for (int k = 0; k < kRuns; ++k) {
    SyntheticOptions run = ScenarioRun(scenario, static_cast<std::uint64_t>(1000 + kRuns * number + k));
    run.release_angle = 0.35 + 0.05 * k;
    if (k == other) run.parameters[0] *= factor;
    set.recordings.push_back(Must(SimulateRecording(run)));
    set.alone.push_back(Fit(set.recordings.back(), set.options));
  }
  return set;
}

/// Standard errors from the sum of the information, (Σ C⁻¹)⁻¹. Empty if a separate fit has no covariance of all shared
/// parameters.
Eigen::VectorXd AddedErrors(const Set& set) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const FitReport& fit : set.alone) {
    if (fit.covariance_names.size() < 3 || fit.covariance_names[2] != kShared[2]) return {};
    information += fit.covariance.topLeftCorner<3, 3>().inverse();
  }
  return information.inverse().diagonal().cwiseSqrt();
}

/// Result of one set.
struct Outcome {
  bool converged = false, disagrees = false;
  std::array<bool, 3> covered = {};
  Eigen::VectorXd joint_error, added_error;  // 3, or empty
  double single_error = 0;                   // standard error of inertia, mean over the recordings
};

Outcome Judge(const Set& set) {
  Outcome outcome;
  outcome.disagrees = !set.Compare().agrees();
  const JointFit joint = set.FitTogether();
  outcome.converged = joint.whole.termination == Termination::kConverged;
  if (!outcome.converged) return outcome;
  for (std::size_t j = 0; j < 3; ++j) {
    const ParameterEstimate& parameter = *joint.whole.Find(kShared[j]);
    outcome.covered[j] = *parameter.lower95 <= kTruth[j] && kTruth[j] <= *parameter.upper95;
  }
  if (joint.whole.covariance.rows() < 3) return outcome;
  outcome.joint_error = joint.whole.covariance.diagonal().cwiseSqrt();
  outcome.added_error = AddedErrors(set);
  for (const FitReport& fit : set.alone) outcome.single_error += *fit.Find("inertia")->std_error / kRuns;
  return outcome;
}

/// Sums over sets.
struct Tally {
  int converged = 0, disagree = 0;
  std::array<int, 3> covered = {};
  int with_errors = 0;  // sets in which all recordings have covariances; the means are over these
  Eigen::Array3d joint_over_added = Eigen::Array3d::Zero();
  double inertia_over_single = 0;
};

Tally TallySets(const std::string& scenario_name, int count) {
  const CoverageScenario scenario = ScenarioOf(scenario_name);
  std::vector<Outcome> outcomes(static_cast<std::size_t>(count));
  ParallelFor(count, 0, [&](int i) { outcomes[static_cast<std::size_t>(i)] = Judge(MakeSet(scenario, i)); });
  Tally tally;
  for (const Outcome& outcome : outcomes) {
    tally.converged += outcome.converged ? 1 : 0;
    tally.disagree += outcome.disagrees ? 1 : 0;
    for (std::size_t j = 0; j < 3; ++j) tally.covered[j] += outcome.covered[j] ? 1 : 0;
    if (outcome.joint_error.size() == 0 || outcome.added_error.size() == 0) continue;
    ++tally.with_errors;
    tally.joint_over_added += outcome.joint_error.array() / outcome.added_error.array();
    tally.inertia_over_single += outcome.joint_error[0] / outcome.single_error;
  }
  tally.joint_over_added /= tally.with_errors;
  tally.inertia_over_single /= tally.with_errors;
  return tally;
}

/// For sets of five recordings, one of which has 3 % more inertia: counts how often only this recording is named.
int CountNamed(const std::string& scenario_name, int count) {
  const CoverageScenario scenario = ScenarioOf(scenario_name);
  std::vector<char> named(static_cast<std::size_t>(count));
  ParallelFor(count, 0, [&](int i) {
    const int other = i % kRuns;
    const Homogeneity result = MakeSet(scenario, i, other, 1.03).Compare();
    named[static_cast<std::size_t>(i)] = !result.agrees() && result.disagreeing == std::vector<int>{other} ? 1 : 0;
  });
  return static_cast<int>(std::ranges::count(named, 1));
}

// Of 200 trials at 1 %, more than 7 hits happen once in 1000 times; of 200 at 95 %, fewer than 180 or more than 199
// hits happen once in 300 times. The information of the recordings adds up. Inertia hardly correlates with friction, so
// its error falls by √5. The ratio of the release angles, 1.6, makes the single errors unequal, so their mean is not
// exactly √5 times as large.
TEST(HomogeneityErrors, AreRightInWhiteNoise) {
  const Tally tally = TallySets("white_2.5", 200);
  EXPECT_EQ(tally.converged, 200);
  EXPECT_THAT(tally.disagree, Le(7));
  EXPECT_THAT(tally.covered, Each(AllOf(Ge(180), Le(199))));
  EXPECT_GT(tally.with_errors, 100);
  EXPECT_THAT(tally.joint_over_added, Each(DoubleNear(1, 0.02)));
  EXPECT_THAT(tally.inertia_over_single, AllOf(Ge(0.38), Le(1 / std::sqrt(5.0))));
}

// Of 100 trials at 1 %, more than 5 hits happen once in 2000 times. At a correlation of 0.9 intervals of single
// recordings cover 91 % or more (coverage_scenarios.h): of 100, fewer than 82 hits happen once in 400 times.
TEST(HomogeneityErrors, AreRightForAutocorrelatedNoise) {
  const Tally tally = TallySets("ar_0.9", 100);
  EXPECT_EQ(tally.converged, 100);
  EXPECT_THAT(tally.disagree, Le(5));
  EXPECT_THAT(tally.covered, Each(Ge(82)));
  EXPECT_GT(tally.with_errors, 50);
  EXPECT_THAT(tally.joint_over_added, Each(DoubleNear(1, 0.05)));
  EXPECT_THAT(tally.inertia_over_single, AllOf(Ge(0.38), Le(0.46)));
}

/// Two recordings with white noise and three with autocorrelated noise, of one rig.
Set MakeMixedSet(int number) {
  Set set = MakeSet(ScenarioOf("ar_0.9"), number);
  const Set white = MakeSet(ScenarioOf("white_0.5"), number);
  for (const std::size_t k : {1, 3}) {
    set.recordings[k] = white.recordings[k];
    set.alone[k] = white.alone[k];
  }
  return set;
}

// Deviations over errors have an rms of 1 ± 7 % for 100 sets; the tolerance is three times that.
TEST(HomogeneityErrors, AreRightIfSomeRecordingsAreAutocorrelated) {
  constexpr int kSets = 100;
  std::vector<double> squares(kSets, 0.0);
  ParallelFor(kSets, 0, [&](int i) {
    const JointFit joint = MakeMixedSet(i).FitTogether();
    const ParameterEstimate& inertia = *joint.whole.Find("inertia");
    squares[static_cast<std::size_t>(i)] =
        std::pow((inertia.estimate - kTruth[0]) / inertia.std_error.value_or(1e-9), 2);
  });
  const double rms = std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / kSets);
  EXPECT_THAT(rms, DoubleNear(1, 0.21));
}

TEST(HomogeneityErrors, FindTheRecordingWithAnotherInertia) {
  EXPECT_THAT(CountNamed("white_2.5", 100), Ge(95));
  EXPECT_THAT(CountNamed("ar_0.9", 100), Ge(95));
}

}  // namespace
}  // namespace pendulum::homogeneity_errors_test
