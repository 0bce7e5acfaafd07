// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/simulation.h"

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::simulation_test {
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

SimulationFlags Flags(const std::string& set) {
  SimulationFlags flags;
  flags.set = set;
  return flags;
}

constexpr std::string_view kRelease = "release_angle=0.4,release_time=1.5";

TEST(MakeSimulation, DividesTorquesAndInertiaByTheRigsGravityTorque) {
  SimulationFlags flags =
      Flags("release_angle=0.4,inertia=0.06,viscous=0.003,coulomb=0.005,drag=0.001,release_time=1.5");
  flags.model = "drag";
  const Result<Simulation> simulation = MakeSimulation(flags, RoundRig());
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_THAT(simulation->synthetic.parameters,
              ElementsAre(DoubleEq(0.03), DoubleEq(0.0015), DoubleEq(0.0025), DoubleEq(0.0005)));
  EXPECT_EQ(simulation->synthetic.release_angle, 0.4);
  EXPECT_EQ(simulation->synthetic.release_time, 1.5);
  EXPECT_EQ(simulation->synthetic.model.friction, "drag");
  EXPECT_EQ(simulation->synthetic.model.gravity, Gravity::kSine);
  EXPECT_THAT(simulation->truth,
              ElementsAre(Pair("inertia", 0.06), Pair("viscous", 0.003), Pair("coulomb", 0.005), Pair("drag", 0.001),
                          Pair("release_angle", 0.4), Pair("release_time", 1.5), Pair("zero_angle", 0.0)));
}

TEST(MakeSimulation, UsesUnitsOfGravityTorqueWithoutARig) {
  const Result<Simulation> simulation =
      MakeSimulation(Flags("inertia=0.04,coulomb=0.002," + std::string(kRelease)), {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_THAT(simulation->synthetic.parameters, ElementsAre(0.04, 0, 0.002));
}

TEST(MakeSimulation, UsesTheRigsGeometricInertiaByDefault) {
  const Result<Simulation> simulation = MakeSimulation(Flags(std::string(kRelease)), RoundRig());
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_THAT(simulation->synthetic.parameters, ElementsAre(DoubleEq(0.04), 0, 0));
  EXPECT_THAT(simulation->truth.front(), Pair("inertia", 0.08));
}

TEST(MakeSimulation, StartsInMotionForAnAngleAndARate) {
  const Result<Simulation> simulation = MakeSimulation(Flags("inertia=0.04,initial_angle=0.1,initial_rate=-2"), {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->synthetic.start, StartKind::kMoving);
  EXPECT_EQ(simulation->synthetic.initial_angle, 0.1);
  EXPECT_EQ(simulation->synthetic.initial_rate, -2);
  EXPECT_THAT(simulation->truth,
              ElementsAre(Pair("inertia", 0.04), Pair("viscous", 0.0), Pair("coulomb", 0.0), Pair("initial_angle", 0.1),
                          Pair("initial_rate", -2.0), Pair("zero_angle", 0.0)));
}

TEST(MakeSimulation, ReadsSensorFlagsInTheColumnsUnit) {
  SimulationFlags flags = Flags("inertia=0.04,zero_angle=0.1," + std::string(kRelease));
  flags.noise = 2;
  flags.resolution = 0.5;
  flags.range = "-90,45";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->unit.column, "angle_deg");
  EXPECT_EQ(simulation->synthetic.quantity, Quantity::kAngle);
  EXPECT_EQ(simulation->synthetic.zero, 0.1);
  EXPECT_THAT(simulation->synthetic.noise, DoubleEq(2 * kRadPerDeg));
  EXPECT_THAT(simulation->synthetic.resolution, DoubleEq(0.5 * kRadPerDeg));
  ASSERT_TRUE(simulation->synthetic.range);
  EXPECT_THAT(simulation->synthetic.range->low, DoubleEq(-90 * kRadPerDeg));
  EXPECT_THAT(simulation->synthetic.range->high, DoubleEq(45 * kRadPerDeg));
}

TEST(MakeSimulation, PassesTheNoiseLawUnchanged) {
  SimulationFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.noise_correlation = -0.5;
  flags.noise_freedom = 3;
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->synthetic.noise_correlation, -0.5);
  EXPECT_EQ(simulation->synthetic.noise_freedom, 3);
}

TEST(MakeSimulation, GivesAGyroARateBiasInsteadOfAZeroAngle) {
  SimulationFlags flags = Flags("inertia=0.04,rate_bias=0.02," + std::string(kRelease));
  flags.unit = "rad_s";
  flags.noise = 2;
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->unit.column, "gyro_rad_s");
  EXPECT_EQ(simulation->synthetic.quantity, Quantity::kRate);
  EXPECT_EQ(simulation->synthetic.zero, 0.02);
  EXPECT_EQ(simulation->synthetic.noise, 2);
  flags.set = "inertia=0.04,zero_angle=0.02," + std::string(kRelease);
  const Result<Simulation> wrong = MakeSimulation(flags, {});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message(), HasSubstr("no parameter 'zero_angle'"));
}

TEST(MakeSimulation, AllowsAnyGravityWithAnyFriction) {
  SimulationFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.gravity = "linear";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->synthetic.model.friction, "coulomb");
  EXPECT_EQ(simulation->synthetic.model.gravity, Gravity::kLinear);
  EXPECT_EQ(simulation->synthetic.model.name, "linear_coulomb");
}

TEST(MakeSimulation, TreatsLinearViscousAsTheLinearModel) {
  SimulationFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.model = "linear";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  EXPECT_EQ(simulation->synthetic.model.friction, "viscous");
  EXPECT_EQ(simulation->synthetic.model.gravity, Gravity::kLinear);
}

TEST(MakeSimulation, ListsTheParametersOfTheModelForAnUnknownName) {
  SimulationFlags flags = Flags("inertia=0.04,coulomb=0.1," + std::string(kRelease));
  flags.model = "viscous";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(simulation.error().message(),
            "--set: model viscous has no parameter 'coulomb'; its parameters are inertia, viscous, release_angle, "
            "release_time, "
            "initial_angle, initial_rate, zero_angle");
}

TEST(SimulationOfRecording, ScattersTheTruthAboutTheSetValues) {
  SimulationFlags flags = Flags("inertia=0.06,viscous=0.003," + std::string(kRelease));
  flags.spread = "release_angle=0.01,inertia=0.001";
  flags.seed = 5;
  const Result<Simulation> simulation = MakeSimulation(flags, RoundRig());
  ASSERT_TRUE(simulation) << simulation.error().message();
  const Result<Simulation> second = SimulationOfRecording(*simulation, 1);
  ASSERT_TRUE(second) << second.error().message();
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

TEST(SimulationOfRecording, GivesOneTruthPerSeed) {
  SimulationFlags flags = Flags("inertia=0.06," + std::string(kRelease));
  flags.spread = "inertia=0.001";
  const Result<Simulation> from_1 = MakeSimulation(flags, {});
  flags.seed = 3;
  const Result<Simulation> from_3 = MakeSimulation(flags, {});
  ASSERT_TRUE(from_1 && from_3);
  EXPECT_EQ(SimulationOfRecording(*from_1, 2)->truth, SimulationOfRecording(*from_3, 0)->truth);
}

TEST(SimulationOfRecording, KeepsTheSetValuesWithoutASpread) {
  const Result<Simulation> simulation = MakeSimulation(Flags("inertia=0.06," + std::string(kRelease)), {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  const Result<Simulation> third = SimulationOfRecording(*simulation, 2);
  ASSERT_TRUE(third);
  EXPECT_EQ(third->truth, simulation->truth);
  EXPECT_EQ(third->synthetic.seed, 3);
}

TEST(SimulationOfRecording, RespectsTheOrderOfAModelsParameters) {
  SimulationFlags flags = Flags("inertia=0.06,coulomb=0.01,stiction=0.01,stribeck_rate=0.1," + std::string(kRelease));
  flags.model = "stribeck";
  flags.spread = "coulomb=0.001,stiction=0.001";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  for (int index = 0; index < 100; ++index) {
    const std::vector<double> parameters = SimulationOfRecording(*simulation, index)->synthetic.parameters;
    EXPECT_GE(parameters[3], parameters[2]) << index;
  }
}

TEST(MakeSimulation, LosesCountsAtTheGivenTimes) {
  SimulationFlags flags = Flags("inertia=0.04," + std::string(kRelease));
  flags.resolution = 0.5;
  flags.lose = "5.25:-3,8:1";
  const Result<Simulation> simulation = MakeSimulation(flags, {});
  ASSERT_TRUE(simulation) << simulation.error().message();
  ASSERT_EQ(simulation->synthetic.lost_counts.size(), 2U);
  EXPECT_EQ(simulation->synthetic.lost_counts[0].time, 5.25);
  EXPECT_EQ(simulation->synthetic.lost_counts[0].counts, -3);
  EXPECT_EQ(simulation->synthetic.lost_counts[1].time, 8);
  EXPECT_EQ(simulation->synthetic.lost_counts[1].counts, 1);
}

struct Refusal {
  std::string message;
  void (*spoil)(SimulationFlags&);
};

TEST(MakeSimulation, RefusesWrongFlagsAndNamesThem) {
  const std::vector<Refusal> refusals = {
      {"--model: there is no model 'tar'", [](SimulationFlags& f) { f.model = "tar"; }},
      {"--gravity is 'lunar'", [](SimulationFlags& f) { f.gravity = "lunar"; }},
      {"contradicts --model linear", [](SimulationFlags& f) { (f.model = "linear", f.gravity = "sin"); }},
      {"--unit is 'grad'", [](SimulationFlags& f) { f.unit = "grad"; }},
      {"'inertia' must be name=value", [](SimulationFlags& f) { f.set = "inertia"; }},
      {"'=1' must be name=value", [](SimulationFlags& f) { f.set = "=1"; }},
      {"--set viscous is '1kg'; it must be a number in SI units", [](SimulationFlags& f) { f.set += ",viscous=1kg"; }},
      {"--set viscous is 'nan'", [](SimulationFlags& f) { f.set += ",viscous=nan"; }},
      {"--set: inertia is given twice", [](SimulationFlags& f) { f.set += ",inertia=1"; }},
      {"viscous is -1; it must be at least 0", [](SimulationFlags& f) { f.set += ",viscous=-1"; }},
      {"inertia is 0; it must be positive", [](SimulationFlags& f) { f.set.replace(0, 12, "inertia=0"); }},
      {"--set lacks inertia", [](SimulationFlags& f) { f.set = "release_angle=0.4,release_time=1.5"; }},
      {"--set lacks the start", [](SimulationFlags& f) { f.set = "inertia=0.04"; }},
      {"if you mean 30 deg, give 0.5236",
       [](SimulationFlags& f) { f.set = "inertia=0.04,release_angle=30,release_time=1"; }},
      {"--set lacks the start", [](SimulationFlags& f) { f.set = "inertia=0.04,release_angle=0.4"; }},
      {"--set gives two starts", [](SimulationFlags& f) { f.set += ",initial_rate=1"; }},
      {"--duration is 0; it must be positive", [](SimulationFlags& f) { f.duration = 0; }},
      {"--rate is -1; it must be positive", [](SimulationFlags& f) { f.rate = -1; }},
      {"--jitter is nan; it must be 0 or more", [](SimulationFlags& f) { f.jitter = std::nan(""); }},
      {"--noise is -1; it must be 0 or more", [](SimulationFlags& f) { f.noise = -1; }},
      {"--noise_correlation is -1; it must be between", [](SimulationFlags& f) { f.noise_correlation = -1; }},
      {"--noise_correlation is nan", [](SimulationFlags& f) { f.noise_correlation = std::nan(""); }},
      {"--noise_freedom is 1.5; it must be 0 or above 2", [](SimulationFlags& f) { f.noise_freedom = 1.5; }},
      {"--resolution is -1; it must be 0 or more", [](SimulationFlags& f) { f.resolution = -1; }},
      {"--time_noise needs --event_driven", [](SimulationFlags& f) { f.time_noise = 1e-4; }},
      {"--oversample is 0; it must be a whole number, 1 to 64", [](SimulationFlags& f) { f.oversample = 0; }},
      {"--oversample is 65; it must be a whole number, 1 to 64", [](SimulationFlags& f) { f.oversample = 65; }},
      {"--window_s needs --oversample", [](SimulationFlags& f) { f.window_s = 0.001; }},
      {"no longer than a sampling interval, 0.01 s",
       [](SimulationFlags& f) { (f.oversample = 4, f.window_s = 0.02, f.rate = 100); }},
      {"--oversample simulates the means", [](SimulationFlags& f) { (f.oversample = 4, f.noise_correlation = 0.5); }},
      {"--event_driven needs --resolution", [](SimulationFlags& f) { f.event_driven = true; }},
      {"--event_driven simulates an encoder",
       [](SimulationFlags& f) { (f.event_driven = true, f.resolution = 0.1, f.jitter = 1e-4); }},
      {"it must be at most a fifth of --resolution",
       [](SimulationFlags& f) { (f.event_driven = true, f.resolution = 0.1, f.noise = 0.05); }},
      {"no wider than --range", [](SimulationFlags& f) { (f.resolution = 10, f.range = "0,1"); }},
      {"--range is '5'; it must be low,high", [](SimulationFlags& f) { f.range = "5"; }},
      {"--range is 'x'; it must be two numbers", [](SimulationFlags& f) { f.range = "x,1"; }},
      {"--range is '2,3'; it must be two numbers", [](SimulationFlags& f) { f.range = "1,2,3"; }},
      {"low must be less than high", [](SimulationFlags& f) { f.range = "1,1"; }},
      {"--set: 'inertia=0.04,' ends with a comma", [](SimulationFlags& f) { f.set = "inertia=0.04,"; }},
      {"--lose: '5' must be time:counts", [](SimulationFlags& f) { (f.resolution = 1, f.lose = "5"); }},
      {"--lose is 'x'; it must be a time in s", [](SimulationFlags& f) { (f.resolution = 1, f.lose = "x:1"); }},
      {"--lose: 1.5 counts; it must be a whole", [](SimulationFlags& f) { (f.resolution = 1, f.lose = "5:1.5"); }},
      {"--lose needs the size of a count; give --resolution", [](SimulationFlags& f) { f.lose = "5:1"; }},
      {"--unit px the readings are coordinates of a point; leave one of them out",
       [](SimulationFlags& f) { (f.resolution = 1, f.unit = "px", f.lose = "5:30"); }},
      {"--spread: 'inertia' must be name=value", [](SimulationFlags& f) { f.spread = "inertia"; }},
      {"--spread: model coulomb has no parameter 'drag'", [](SimulationFlags& f) { f.spread = "drag=1"; }},
      {"--spread: viscous is -1; it must be at least 0", [](SimulationFlags& f) { f.spread = "viscous=-1"; }},
      {"--spread inertia is 'inf'; it must be a number", [](SimulationFlags& f) { f.spread = "inertia=inf"; }},
      {"--spread: initial_rate belongs to a start other than that of --set",
       [](SimulationFlags& f) { f.spread = "initial_rate=1"; }},
  };
  for (const Refusal& refusal : refusals) {
    SimulationFlags flags = Flags("inertia=0.04," + std::string(kRelease));
    refusal.spoil(flags);
    const Result<Simulation> simulation = MakeSimulation(flags, {});
    ASSERT_FALSE(simulation) << refusal.message;
    EXPECT_EQ(simulation.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(simulation.error().message(), HasSubstr(refusal.message));
  }
}

}  // namespace
}  // namespace pendulum::simulation_test
