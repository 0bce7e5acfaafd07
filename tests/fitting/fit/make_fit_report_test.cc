// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/make_fit_report.h"

#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::make_fit_report_test {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Reports on given parameters as if a solver had found them.
FitReport ReportAt(const SyntheticOptions& run, const std::vector<double>& parameters, bool usable = true) {
  const Recording recording = Must(SimulateRecording(run));
  const FitOptions options = ModelOptions(run.model.name);
  const FitProblem problem = Must(MakeFitProblem(recording, options));
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Solution solution;
  solution.parameters = parameters;
  solution.usable = usable;
  solution.message = "what the solver says";
  if (usable) {
    EXPECT_TRUE(cost->SumOfSquares(parameters, &solution.sum));
  }
  MaximizeLikelihood(*cost, problem, options, solution);  // Gaussian noise: finds sigma, changes no parameter
  EXPECT_EQ(solution.parameters, parameters);
  return MakeFitReport({recording, options, problem, *cost, solution});
}

void ExpectNoErrors(const FitReport& report) {
  for (const ParameterEstimate& parameter : report.parameters) {
    EXPECT_FALSE(parameter.std_error) << parameter.info.name;
    EXPECT_FALSE(parameter.lower95 || parameter.upper95) << parameter.info.name;
    EXPECT_FALSE(parameter.reason.empty()) << parameter.info.name;
  }
  for (const DerivedQuantity& quantity : report.derived) EXPECT_FALSE(quantity.std_error) << quantity.name;
  EXPECT_THAT(report.covariance_names, IsEmpty());
  EXPECT_EQ(report.covariance.size(), 0);
}

// ---- Convergence ---------------------------------------------------------------------------------------------------

TEST(MakeFitReport, APointOneStandardErrorAwayIsNotConverged) {
  const FitReport fit = FitOwnModel(NoisyRun());
  std::vector<double> parameters;
  for (const ParameterEstimate& parameter : fit.parameters) parameters.push_back(parameter.estimate);
  EXPECT_EQ(ReportAt(NoisyRun(), parameters).termination, Termination::kConverged);
  parameters[1] += *fit.parameters[1].std_error;
  const FitReport report = ReportAt(NoisyRun(), parameters);
  EXPECT_EQ(report.termination, Termination::kNotConverged);
  EXPECT_THAT(report.reason, HasSubstr("the estimates are still "));
  EXPECT_THAT(report.reason, HasSubstr("standard errors from the minimum"));
  EXPECT_EQ(report.parameters[1].estimate, parameters[1]);
  ExpectNoErrors(report);
  EXPECT_GT(report.statistics.rms_residual, 0.0015);  // statistics are present
}

TEST(MakeFitReport, AnUnusableSolutionIsFailed) {
  const FitReport report = ReportAt(NoisyRun(), Truth(NoisyRun()), false);
  EXPECT_EQ(report.termination, Termination::kFailed);
  EXPECT_THAT(report.reason, HasSubstr("the pendulum does not swing"));
  EXPECT_EQ(report.parameters.size(), 6);
  ExpectNoErrors(report);
}

TEST(MakeFitReport, AFitStoppedEarlyIsNotConverged) {
  FitOptions options = ModelOptions("coulomb");
  options.search.max_iterations = 1;
  options.initial = {{"inertia", 0.08}};  // the default start values need only one iteration
  const FitReport report = Fit(Must(SimulateRecording(NoisyRun())), options);
  EXPECT_EQ(report.termination, Termination::kNotConverged);
  EXPECT_EQ(ExitCode(report.termination), 1);
  ExpectNoErrors(report);
}

// ---- At a bound ----------------------------------------------------------------------------------------------------

TEST(MakeFitReport, AParameterAtItsBoundIsMarkedAndExcludedFromTheCovariance) {
  constexpr int kSeeds = 200;
  int at_bound = 0;
  constexpr std::uint64_t kProfiles = 40;  // each costs as much as 36 fits
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    FitOptions options = ModelOptions("coulomb");
    if (seed > kProfiles) options.interval = IntervalMethod::kCovariance;
    const FitReport report = Fit(Must(SimulateRecording(NoisyRun("viscous", seed))), options);
    ASSERT_EQ(report.termination, Termination::kConverged) << "seed " << seed << ": " << report.reason;
    const ParameterEstimate& coulomb = *report.Find("coulomb");
    ASSERT_EQ(coulomb.at_bound, coulomb.estimate == 0) << "seed " << seed;
    if (!coulomb.at_bound) continue;
    ++at_bound;
    EXPECT_FALSE(coulomb.std_error);
    EXPECT_EQ(coulomb.reason, "at its bound");
    EXPECT_EQ(*coulomb.lower95, 0);
    if (seed <= kProfiles) {
      EXPECT_GT(coulomb.upper95.value(), 0);
    } else {
      EXPECT_FALSE(coulomb.upper95);
      EXPECT_EQ(coulomb.open_interval, OpenInterval::kAtBound);
    }
    EXPECT_THAT(report.covariance_names,
                ElementsAre("inertia", "viscous", "release_angle", "release_time", "zero_angle"));
    EXPECT_EQ(report.covariance.rows(), 5);
    EXPECT_TRUE(report.Find("viscous")->std_error);
  }
  // An unbounded estimate would be below 0 for half of the seeds; four standard deviations of a binomial count.
  EXPECT_NEAR(at_bound, kSeeds / 2, 4 * std::sqrt(kSeeds * 0.25));
}

TEST(MakeFitReport, TheIntervalAtABoundEndsAtTheChiSquareRise) {
  int at_bound = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = Must(SimulateRecording(NoisyRun("viscous", seed)));
    const FitReport report = Fit(recording, ModelOptions("coulomb"));
    if (!report.Find("coulomb")->at_bound) continue;
    ++at_bound;
    FitOptions options = ModelOptions("coulomb");
    options.fixed["coulomb"] = *report.Find("coulomb")->upper95;
    const double rise = Fit(recording, options).residual.squaredNorm() - report.residual.squaredNorm();
    EXPECT_THAT(rise / (report.noise.sigma * report.noise.sigma), DoubleNear(3.841, 0.1)) << "seed " << seed;
  }
  EXPECT_GT(at_bound, 3);
}

// If dry friction were exactly 0, as its estimate is, the error of viscous friction would be less than half.
TEST(MakeFitReport, ErrorsAllowForAParameterAtItsBound) {
  int at_bound = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Recording recording = Must(SimulateRecording(NoisyRun("viscous", seed)));
    const FitReport report = Fit(recording, ModelOptions("coulomb"));
    if (!report.Find("coulomb")->at_bound) continue;
    ++at_bound;
    const ParameterEstimate& viscous = *report.Find("viscous");
    EXPECT_NEAR(*viscous.t95 * *viscous.std_error, viscous.estimate - *viscous.lower95, 1e-12);
    const FitReport without = Fit(recording, ModelOptions("viscous"));
    EXPECT_GT(*viscous.std_error, 2 * *without.Find("viscous")->std_error);
    const auto decay_of = [](const FitReport& fit) {
      return *std::ranges::find(fit.derived, "decay_time", &DerivedQuantity::name);
    };
    EXPECT_NEAR(*decay_of(report).std_error / decay_of(report).estimate, *viscous.std_error / viscous.estimate, 1e-3);
  }
  EXPECT_GT(at_bound, 3);
}

// Where the profile has no end, the error is that of a fit without bounds.
TEST(MakeFitReport, ErrorsBesideABoundNeedNoInterval) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Recording recording = Must(SimulateRecording(NoisyRun("viscous", seed)));
    FitOptions options = ModelOptions("coulomb");
    options.interval = IntervalMethod::kCovariance;
    const FitReport report = Fit(recording, options);
    if (!report.Find("coulomb")->at_bound) continue;
    const FitReport without = Fit(recording, ModelOptions("viscous"));
    EXPECT_GT(*report.Find("viscous")->std_error, 2 * *without.Find("viscous")->std_error) << "seed " << seed;
  }
}

// ---- Not identifiable ----------------------------------------------------------------------------------------------

/// A cost whose data depend on the parameters only through `seen` * p, as in an experiment with too little information.
class BlindCost final : public TrajectoryCost {
 public:
  BlindCost(TrajectoryCost& cost, Eigen::MatrixXd seen)
      : TrajectoryCost(static_cast<int>(seen.cols())), cost_(cost), seen_(std::move(seen)) {}

  bool Sums(std::span<const double> parameters, Eigen::MatrixXd* sums) const override {
    if (!cost_.Sums(parameters, sums)) return false;
    Eigen::MatrixXd extended = Eigen::MatrixXd::Identity(sums->rows(), sums->cols());
    extended.topLeftCorner(seen_.rows(), seen_.cols()) = seen_;
    *sums = (extended.transpose() * *sums * extended).eval();
    return true;
  }
  bool SumOfSquares(std::span<const double> p, double* sum) const override { return cost_.SumOfSquares(p, sum); }
  bool Readings(std::span<const double> p, Eigen::VectorXd* readings, Eigen::MatrixXd* jacobian) const override {
    return cost_.Readings(p, readings, jacobian);
  }
  TraceSummary Trace(std::span<const double> p) const override { return cost_.Trace(p); }
  bool ComesToRest(std::span<const double> p, double change) const override { return cost_.ComesToRest(p, change); }
  bool Motion(std::span<const double>, bool, MotionStates*) const override { return false; }
  void set_tolerance(double) override {}
  void set_used_samples(std::size_t) override {}
  void set_threads(int) override {}
  void set_noise(const NoiseModel& noise) override { cost_.set_noise(noise); }

 private:
  TrajectoryCost& cost_;
  Eigen::MatrixXd seen_;
};

FitReport ReportOfBlindCost(const Eigen::MatrixXd& seen) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitOptions options = ModelOptions("coulomb");
  const FitProblem problem = Must(MakeFitProblem(recording, options));
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Solution solution = Solve(*cost, problem.first_guess, problem.solve);
  MaximizeLikelihood(*cost, problem, options, solution);
  BlindCost blind(*cost, seen);
  return MakeFitReport({recording, options, problem, blind, solution});
}

TEST(MakeFitReport, NamesAnUndeterminedCombination) {
  Eigen::MatrixXd seen = Eigen::MatrixXd::Identity(6, 6);
  seen(2, 2) = 0;
  seen(1, 2) = 0.7;  // dry friction acts like more viscous friction
  const FitReport report = ReportOfBlindCost(seen);
  EXPECT_EQ(report.termination, Termination::kNotIdentifiable);
  EXPECT_EQ(ExitCode(report.termination), 1);
  EXPECT_EQ(report.reason, "the recording determines only a combination of viscous and coulomb; fix one of them");
  ExpectNoErrors(report);
  EXPECT_EQ(report.parameters[0].reason, "the fit is not_identifiable");
  EXPECT_THAT(report.statistics.rms_residual, DoubleNear(0.002, 2e-4));
}

TEST(MakeFitReport, NamesUndeterminedParameters) {
  Eigen::MatrixXd seen = Eigen::MatrixXd::Identity(6, 6);
  seen(5, 5) = 0;
  const FitReport report = ReportOfBlindCost(seen);
  EXPECT_EQ(report.termination, Termination::kNotIdentifiable);
  EXPECT_EQ(report.reason, "the recording does not depend on zero_angle; fix it");
  EXPECT_EQ(ReportOfBlindCost(Eigen::MatrixXd::Identity(6, 6)).termination, Termination::kConverged);
}

// ---- Noise ---------------------------------------------------------------------------------------------------------

TEST(MakeFitReport, ExplainsTheNoiseFamily) {
  // The noise is 0.58 counts. The sensor's range cuts off the hold, which is about 30 counts beyond it.
  SyntheticOptions run = NoisyRun();
  run.resolution = kCount;
  run.range = SensorRange{-0.32, 0.32};
  const FitReport report = FitOwnModel(run);
  EXPECT_EQ(report.noise.family, NoiseFamily::kQuantized);
  EXPECT_THAT(report.noise.why,
              HasSubstr("rounding is not small, so each reading is treated as an interval of one level"));
  EXPECT_THAT(report.noise.sigma / run.noise, DoubleNear(1, 0.1));
}

TEST(MakeFitReport, StatisticsMatchTheShownResidualsOfQuietReadings) {
  // Here the estimates are means of the posterior, not the likeliest values.
  SyntheticOptions run = TextbookRun("viscous");
  run.resolution = kCount;
  run.noise = 0.05 * kCount;
  const FitReport report = FitOwnModel(run);
  ASSERT_THAT(report.std_error_method, HasSubstr("posterior"));
  const double rms = std::sqrt(report.residual.squaredNorm() / static_cast<double>(report.residual.size()));
  EXPECT_THAT(report.statistics.rms_residual / rms, DoubleNear(1, 1e-12));
  EXPECT_THAT(std::sqrt(report.covariance(1, 1)) / report.parameters[1].std_error.value(), DoubleNear(1, 1e-12));
}

// ---- Fixed parameters ----------------------------------------------------------------------------------------------

TEST(MakeFitReport, AFixedParameterKeepsItsValueAndHasNoError) {
  for (const std::string name : {"inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle"}) {
    SCOPED_TRACE(name);
    const Recording recording = Must(SimulateRecording(NoisyRun()));
    FitOptions options = ModelOptions("coulomb");
    const FitReport free = Fit(recording, options);
    options.fixed[name] = free.Find(name)->estimate + *free.Find(name)->std_error;
    const FitReport report = Fit(recording, options);
    EXPECT_EQ(report.termination, Termination::kConverged) << report.reason;
    const ParameterEstimate& fixed = *report.Find(name);
    EXPECT_TRUE(fixed.fixed);
    EXPECT_THAT(fixed.estimate, DoubleNear(options.fixed[name], 1e-15));
    EXPECT_FALSE(fixed.std_error || fixed.lower95 || fixed.upper95 || fixed.closed_form);
    EXPECT_EQ(fixed.reason, "fixed");
    EXPECT_THAT(report.covariance_names, Not(Contains(name)));
    EXPECT_EQ(report.covariance.rows(), 5);
    for (const ParameterEstimate& other : report.parameters) {
      if (other.fixed) continue;
      EXPECT_LE(*other.std_error, 1.01 * *free.Find(other.info.name)->std_error) << other.info.name;
    }
    // A shift of a parameter by one standard error raises χ² by 1, if the other parameters are free.
    const double rise = report.residual.squaredNorm() - free.residual.squaredNorm();
    EXPECT_THAT(rise / (free.noise.sigma * free.noise.sigma), DoubleNear(1, 0.05));
  }
}

TEST(MakeFitReport, AFixedInertiaUsesTheRigsUnits) {
  FitOptions options = ModelOptions("coulomb");
  options.rig = Must(ParseRig(R"({"gravity_torque": {"value": 2.5, "std_dev": 0.02}})", "rig.json"));
  options.fixed["inertia"] = 2.5 * 0.079 / kTextbookTorque;
  const FitReport report = Fit(Must(SimulateRecording(NoisyRun())), options);
  EXPECT_EQ(report.termination, Termination::kConverged) << report.reason;
  EXPECT_DOUBLE_EQ(report.Find("inertia")->estimate, options.fixed["inertia"]);
  EXPECT_FALSE(report.Find("inertia")->systematic.Total());  // a fixed value is taken as exact
  EXPECT_TRUE(report.Find("viscous")->systematic.Total());
}

TEST(MakeFitReport, AllParametersMayBeFixed) {
  FitOptions options = ModelOptions("viscous");
  const SyntheticOptions run = NoisyRun("viscous");
  const std::vector<double> truth = Truth(run);
  const std::vector<ParameterInfo> infos = FitParameters(run.model, run.start, run.quantity);
  for (std::size_t i = 0; i < infos.size(); ++i) options.fixed[std::string(infos[i].name)] = truth[i];
  const FitReport report = Fit(Must(SimulateRecording(run)), options);
  EXPECT_EQ(report.termination, Termination::kConverged) << report.reason;
  EXPECT_THAT(report.noise.sigma, DoubleNear(0.002, 2e-4));
  EXPECT_EQ(report.covariance.size(), 0);
}

}  // namespace
}  // namespace pendulum::make_fit_report_test
