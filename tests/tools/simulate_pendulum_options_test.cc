// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_options.h"

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::simulate_pendulum_options_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

constexpr double kRadPerDeg = 0.017453292519943295;  // π / 180

/// A rig of gravity torque 2 N m and geometric inertia 0.08 kg m².
Rig RoundRig() {
  Rig rig;
  rig.gravity_torque = {2.0, 0};
  rig.inertia = RigValue{0.08, 0};
  return rig;
}

SimulateFlags Flags(const std::string& set) {
  SimulateFlags flags;
  flags.set = set;
  flags.out = "run.csv";
  return flags;
}

constexpr std::string_view kRelease = "release_angle=0.4,release_time=1.5";

TEST(MakeSimulateOptions, DividesTorquesAndInertiaByTheGravityTorqueOfTheRig) {
  SimulateFlags flags = Flags("release_angle=0.4,inertia=0.06,viscous=0.003,coulomb=0.005,drag=0.001,release_time=1.5");
  flags.model = "drag";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, RoundRig());
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->synthetic.parameters,
              ElementsAre(DoubleEq(0.03), DoubleEq(0.0015), DoubleEq(0.0025), DoubleEq(0.0005)));
  EXPECT_EQ(options->synthetic.release_angle, 0.4);
  EXPECT_EQ(options->synthetic.release_time, 1.5);
  EXPECT_EQ(options->synthetic.model.friction, "drag");
  EXPECT_EQ(options->synthetic.model.gravity, Gravity::kSine);
  EXPECT_THAT(options->truth,
              ElementsAre(Pair("inertia", 0.06), Pair("viscous", 0.003), Pair("coulomb", 0.005), Pair("drag", 0.001),
                          Pair("release_angle", 0.4), Pair("release_time", 1.5), Pair("zero_angle", 0.0)));
}

TEST(MakeSimulateOptions, TakesValuesInUnitsOfTheGravityTorqueWithoutARig) {
  const Result<SimulateOptions> options =
      MakeSimulateOptions(Flags("inertia=0.04,coulomb=0.002," + std::string(kRelease)), {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->synthetic.parameters, ElementsAre(0.04, 0, 0.002));
}

TEST(MakeSimulateOptions, TakesTheGeometricInertiaOfTheRigWhenNoneIsSet) {
  const Result<SimulateOptions> options = MakeSimulateOptions(Flags(std::string(kRelease)), RoundRig());
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_THAT(options->synthetic.parameters, ElementsAre(DoubleEq(0.04), 0, 0));
  EXPECT_THAT(options->truth.front(), Pair("inertia", 0.08));
}

TEST(MakeSimulateOptions, StartsInMotionWhenAngleAndRateAreGiven) {
  const Result<SimulateOptions> options =
      MakeSimulateOptions(Flags("inertia=0.04,initial_angle=0.1,initial_rate=-2"), {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->synthetic.start, StartKind::kMoving);
  EXPECT_EQ(options->synthetic.initial_angle, 0.1);
  EXPECT_EQ(options->synthetic.initial_rate, -2);
  EXPECT_THAT(options->truth,
              ElementsAre(Pair("inertia", 0.04), Pair("viscous", 0.0), Pair("coulomb", 0.0), Pair("initial_angle", 0.1),
                          Pair("initial_rate", -2.0), Pair("zero_angle", 0.0)));
}

TEST(MakeSimulateOptions, ReadsTheSensorInTheUnitOfTheColumn) {
  SimulateFlags flags = Flags("inertia=0.04,zero_angle=0.1," + std::string(kRelease));
  flags.noise = 2;
  flags.resolution = 0.5;
  flags.range = "-90,45";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->unit.column, "angle_deg");
  EXPECT_EQ(options->synthetic.quantity, Quantity::kAngle);
  EXPECT_EQ(options->synthetic.zero, 0.1);
  EXPECT_THAT(options->synthetic.noise, DoubleEq(2 * kRadPerDeg));
  EXPECT_THAT(options->synthetic.resolution, DoubleEq(0.5 * kRadPerDeg));
  ASSERT_TRUE(options->synthetic.range);
  EXPECT_THAT(options->synthetic.range->low, DoubleEq(-90 * kRadPerDeg));
  EXPECT_THAT(options->synthetic.range->high, DoubleEq(45 * kRadPerDeg));
}

TEST(MakeSimulateOptions, HandsOnTheLawOfTheNoiseWithoutAUnit) {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.noise_correlation = -0.5;
  flags.noise_freedom = 3;
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->synthetic.noise_correlation, -0.5);
  EXPECT_EQ(options->synthetic.noise_freedom, 3);
}

TEST(MakeSimulateOptions, GivesAGyroARateBiasInsteadOfAZeroAngle) {
  SimulateFlags flags = Flags("inertia=0.04,rate_bias=0.02," + std::string(kRelease));
  flags.unit = "rad_s";
  flags.noise = 2;
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->unit.column, "gyro_rad_s");
  EXPECT_EQ(options->synthetic.quantity, Quantity::kRate);
  EXPECT_EQ(options->synthetic.zero, 0.02);
  EXPECT_EQ(options->synthetic.noise, 2);
  flags.set = "inertia=0.04,zero_angle=0.02," + std::string(kRelease);
  const Result<SimulateOptions> wrong = MakeSimulateOptions(flags, {});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("no parameter 'zero_angle'"));
}

TEST(MakeSimulateOptions, ChoosesGravityIndependentlyOfFriction) {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.gravity = "linear";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->synthetic.model.friction, "coulomb");
  EXPECT_EQ(options->synthetic.model.gravity, Gravity::kLinear);
}

TEST(MakeSimulateOptions, TakesLinearGravityWithViscousFrictionForTheLinearModel) {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.model = "linear";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->synthetic.model.friction, "viscous");
  EXPECT_EQ(options->synthetic.model.gravity, Gravity::kLinear);
}

TEST(MakeSimulateOptions, ListsTheNamesThatTheModelHasWhenOneIsUnknown) {
  SimulateFlags flags = Flags("inertia=0.04,coulomb=0.1," + std::string(kRelease));
  flags.model = "viscous";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_FALSE(options);
  EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(options.error().message,
            "--set: model viscous has no parameter 'coulomb'; its parameters are inertia, viscous, release_angle, "
            "release_time, "
            "initial_angle, initial_rate, zero_angle");
}

SimulateFlags PlanFlags() {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.plan = true;
  flags.out.clear();
  flags.noise = 0.1;
  return flags;
}

TEST(MakeSimulateOptions, PlansWithoutAnOutput) {
  const Result<SimulateOptions> options = MakeSimulateOptions(PlanFlags(), {});
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_TRUE(options->plan);
  EXPECT_THAT(options->synthetic.noise, DoubleEq(0.1 * kRadPerDeg));
  EXPECT_FALSE(MakeSimulateOptions(Flags("inertia=0.04," + std::string(kRelease)), {})->plan);
}

TEST(MakeSimulateOptions, PlansWithAResolutionAlone) {
  SimulateFlags flags = PlanFlags();
  flags.noise = 0;
  flags.resolution = 0.2;
  EXPECT_TRUE(MakeSimulateOptions(flags, {}));
}

TEST(OptionsOfRecording, ScattersTheTruthOfEachSeedAboutTheSetValues) {
  SimulateFlags flags = Flags("inertia=0.06,viscous=0.003," + std::string(kRelease));
  flags.spread = "release_angle=0.01,inertia=0.001";
  flags.count = 3;
  flags.seed = 5;
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, RoundRig());
  ASSERT_TRUE(options) << options.error().message;
  const Result<SimulateOptions> second = OptionsOfRecording(*options, 1);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->synthetic.seed, 6);
  const auto truth = [&](std::size_t i) { return second->truth[i].second; };
  EXPECT_THAT(second->truth,
              ElementsAre(Pair("inertia", testing::Ne(0.06)), Pair("viscous", 0.003), Pair("coulomb", 0.0),
                          Pair("release_angle", testing::Ne(0.4)), Pair("release_time", 1.5), Pair("zero_angle", 0.0)));
  EXPECT_THAT(truth(0), testing::DoubleNear(0.06, 0.006));  // six standard deviations
  EXPECT_THAT(truth(3), testing::DoubleNear(0.4, 0.06));
  // The rig's gravity torque is 2 N m.
  EXPECT_THAT(second->synthetic.parameters, ElementsAre(DoubleEq(truth(0) / 2), DoubleEq(0.0015), 0));
  EXPECT_EQ(second->synthetic.release_angle, truth(3));
}

TEST(OptionsOfRecording, GivesASeedTheSameTruthWhateverTheFirstSeed) {
  SimulateFlags flags = Flags("inertia=0.06," + std::string(kRelease));
  flags.spread = "inertia=0.001";
  flags.count = 3;
  const Result<SimulateOptions> from_1 = MakeSimulateOptions(flags, {});
  flags.seed = 3;
  const Result<SimulateOptions> from_3 = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(from_1 && from_3);
  EXPECT_EQ(OptionsOfRecording(*from_1, 2)->truth, OptionsOfRecording(*from_3, 0)->truth);
}

TEST(OptionsOfRecording, KeepsTheSetValuesWithoutASpread) {
  const Result<SimulateOptions> options = MakeSimulateOptions(Flags("inertia=0.06," + std::string(kRelease)), {});
  ASSERT_TRUE(options) << options.error().message;
  const Result<SimulateOptions> third = OptionsOfRecording(*options, 2);
  ASSERT_TRUE(third);
  EXPECT_EQ(third->truth, options->truth);
  EXPECT_EQ(third->synthetic.seed, 3);
}

TEST(OptionsOfRecording, KeepsTheOrderOfAModelsParameters) {
  SimulateFlags flags = Flags("inertia=0.06,coulomb=0.01,stiction=0.01,stribeck_rate=0.1," + std::string(kRelease));
  flags.model = "stribeck";
  flags.spread = "coulomb=0.001,stiction=0.001";
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
  ASSERT_TRUE(options) << options.error().message;
  for (int index = 0; index < 100; ++index) {
    const std::vector<double> parameters = OptionsOfRecording(*options, index)->synthetic.parameters;
    EXPECT_GE(parameters[3], parameters[2]) << index;
  }
}

struct Refusal {
  std::string message;
  void (*spoil)(SimulateFlags&);
};

TEST(MakeSimulateOptions, RefusesWrongFlagsAndNamesThem) {
  const std::vector<Refusal> refusals = {
      {"--model: there is no model 'tar'", [](SimulateFlags& f) { f.model = "tar"; }},
      {"--gravity is 'lunar'", [](SimulateFlags& f) { f.gravity = "lunar"; }},
      {"contradicts --model linear", [](SimulateFlags& f) { (f.model = "linear", f.gravity = "sin"); }},
      {"--unit is 'grad'", [](SimulateFlags& f) { f.unit = "grad"; }},
      {"'inertia' must be name=value", [](SimulateFlags& f) { f.set = "inertia"; }},
      {"'=1' must be name=value", [](SimulateFlags& f) { f.set = "=1"; }},
      {"--set viscous is '1kg'; it must be a number in SI units", [](SimulateFlags& f) { f.set += ",viscous=1kg"; }},
      {"--set viscous is 'nan'", [](SimulateFlags& f) { f.set += ",viscous=nan"; }},
      {"--set: inertia is given twice", [](SimulateFlags& f) { f.set += ",inertia=1"; }},
      {"viscous is -1; it must be at least 0", [](SimulateFlags& f) { f.set += ",viscous=-1"; }},
      {"inertia is 0; it must be positive", [](SimulateFlags& f) { f.set.replace(0, 12, "inertia=0"); }},
      {"--set lacks inertia", [](SimulateFlags& f) { f.set = "release_angle=0.4,release_time=1.5"; }},
      {"--set lacks the start", [](SimulateFlags& f) { f.set = "inertia=0.04"; }},
      {"--set lacks the start", [](SimulateFlags& f) { f.set = "inertia=0.04,release_angle=0.4"; }},
      {"--set gives two starts", [](SimulateFlags& f) { f.set += ",initial_rate=1"; }},
      {"--duration is 0; it must be positive", [](SimulateFlags& f) { f.duration = 0; }},
      {"--rate is -1; it must be positive", [](SimulateFlags& f) { f.rate = -1; }},
      {"--jitter is nan; it must be 0 or more", [](SimulateFlags& f) { f.jitter = std::nan(""); }},
      {"--noise is -1; it must be 0 or more", [](SimulateFlags& f) { f.noise = -1; }},
      {"--noise_correlation is -1; it must be between", [](SimulateFlags& f) { f.noise_correlation = -1; }},
      {"--noise_correlation is nan", [](SimulateFlags& f) { f.noise_correlation = std::nan(""); }},
      {"--noise_freedom is 1.5; it must be 0 or above 2", [](SimulateFlags& f) { f.noise_freedom = 1.5; }},
      {"--resolution is -1; it must be 0 or more", [](SimulateFlags& f) { f.resolution = -1; }},
      {"no wider than --range", [](SimulateFlags& f) { (f.resolution = 10, f.range = "0,1"); }},
      {"--range is '5'; it must be low,high", [](SimulateFlags& f) { f.range = "5"; }},
      {"--range is 'x'; it must be two numbers", [](SimulateFlags& f) { f.range = "x,1"; }},
      {"--range is '2,3'; it must be two numbers", [](SimulateFlags& f) { f.range = "1,2,3"; }},
      {"low must be less than high", [](SimulateFlags& f) { f.range = "1,1"; }},
      {"--out is missing", [](SimulateFlags& f) { f.out.clear(); }},
      {"'stray' belongs to no flag", [](SimulateFlags& f) { f.positional = {"stray"}; }},
      {"--set: 'inertia=0.04,' ends with a comma", [](SimulateFlags& f) { f.set = "inertia=0.04,"; }},
      {"--count is 0; it must be at least 1", [](SimulateFlags& f) { f.count = 0; }},
      {"--count 2 needs files", [](SimulateFlags& f) { (f.count = 2, f.out = "-"); }},
      {"--manifest lists files; give --out a file instead of -",
       [](SimulateFlags& f) { (f.manifest = "runs.csv", f.out = "-"); }},
      {"--threads is -1; it must be 0 to 1024", [](SimulateFlags& f) { f.threads = -1; }},
      {"--threads is 1025; it must be 0 to 1024", [](SimulateFlags& f) { f.threads = 1025; }},
      {"--spread: 'inertia' must be name=value", [](SimulateFlags& f) { f.spread = "inertia"; }},
      {"--spread: model coulomb has no parameter 'drag'", [](SimulateFlags& f) { f.spread = "drag=1"; }},
      {"--spread: viscous is -1; it must be at least 0", [](SimulateFlags& f) { f.spread = "viscous=-1"; }},
      {"--spread inertia is 'inf'; it must be a number", [](SimulateFlags& f) { f.spread = "inertia=inf"; }},
      {"--spread: initial_rate belongs to a start other than that of --set",
       [](SimulateFlags& f) { f.spread = "initial_rate=1"; }},
  };
  for (const Refusal& refusal : refusals) {
    SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
    refusal.spoil(flags);
    const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(options.error().message, HasSubstr(refusal.message));
  }
}

TEST(MakeSimulateOptions, RefusesWhatAPlanHasNoUseFor) {
  const std::vector<Refusal> refusals = {
      {"--out contradicts --plan, which makes no recording", [](SimulateFlags& f) { f.out = "-"; }},
      {"--truth contradicts --plan", [](SimulateFlags& f) { f.truth = "truth.json"; }},
      {"--count contradicts --plan", [](SimulateFlags& f) { f.count = 2; }},
      {"--spread contradicts --plan", [](SimulateFlags& f) { f.spread = "inertia=0.001"; }},
      {"--manifest contradicts --plan", [](SimulateFlags& f) { f.manifest = "runs.csv"; }},
      {"--plan needs --noise or --resolution", [](SimulateFlags& f) { f.noise = 0; }},
      {"'stray' belongs to no flag", [](SimulateFlags& f) { f.positional = {"stray"}; }},
  };
  for (const Refusal& refusal : refusals) {
    SimulateFlags flags = PlanFlags();
    refusal.spoil(flags);
    const Result<SimulateOptions> options = MakeSimulateOptions(flags, {});
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(options.error().message, HasSubstr(refusal.message));
  }
}

TEST(SimulateOptions, NumberTruthFilesAsTheRecordings) {
  SimulateFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  EXPECT_EQ(MakeSimulateOptions(flags, {})->Outputs(0).size(), 1);
  flags.truth = "truth.json";
  flags.count = 2;
  const std::vector<NamedFile> files = MakeSimulateOptions(flags, {})->Outputs(1);
  ASSERT_EQ(files.size(), 2);
  EXPECT_EQ(files[0].flag, "--out");
  EXPECT_EQ(files[0].path, "run_002.csv");
  EXPECT_EQ(files[1].flag, "--truth");
  EXPECT_EQ(files[1].path, "truth_002.json");
}

}  // namespace
}  // namespace pendulum::simulate_pendulum_options_test
