// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/motion_model.h"

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/registry.h"

namespace pendulum::motion_model_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

std::vector<std::string_view> Names(const auto& things) {
  std::vector<std::string_view> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

std::vector<std::string_view> ParameterNames(std::string_view model) {
  return Names(PhysicalParameters(FindMotionModel(model).value()));
}

TEST(MotionModels, HaveUniqueDocumentedNames) {
  const std::vector<std::string_view> names = Names(MotionModels());
  EXPECT_THAT(names, IsSupersetOf({"linear", "viscous", "coulomb", "drag"}));
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
}

TEST(MotionModels, LinearIsViscousFrictionWithLinearGravity) {
  const Result<MotionModel> model = FindMotionModel("linear");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->name, "linear");
  EXPECT_EQ(model->friction, "viscous");
  EXPECT_EQ(model->gravity, Gravity::kLinear);
}

// Asymmetric friction has a constant torque. Under linear gravity it has the same effect as a shift of the zero.
TEST(MotionModels, CombineFrictionAndGravityLawsThatAFitCanDetermine) {
  std::set<std::pair<std::string_view, std::string_view>> pairs;
  for (const MotionModel& model : MotionModels()) pairs.emplace(model.gravity.name(), model.friction);
  EXPECT_EQ(pairs.size(), GravityModels::kNames.size() * FrictionModels::kNames.size() - 2);
  EXPECT_EQ(pairs.count({"linear", "asymmetric"}), 0);
  EXPECT_EQ(pairs.count({"linear", "load"}), 0);
  EXPECT_EQ(pairs.size(), MotionModels().size());
  const Result<MotionModel> model = FindMotionModel("linear_coulomb");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->friction, "coulomb");
  EXPECT_EQ(model->gravity, Gravity::kLinear);
}

TEST(MotionModels, IncludeEachFrictionLawWithSineGravity) {
  FrictionModels::ForEach([]<typename F>() {
    const Result<MotionModel> model = FindMotionModel(F::kName);
    ASSERT_TRUE(model) << F::kName;
    EXPECT_EQ(model->name, F::kName);
    EXPECT_EQ(model->friction, F::kName);
    EXPECT_EQ(model->gravity, Gravity::kSine);
  });
}

TEST(FindMotionModels, GiveEachFrictionLawTheRequestedGravity) {
  EXPECT_THAT(Names(*FindMotionModels("viscous,coulomb", Gravity::kLinear)), ElementsAre("linear", "linear_coulomb"));
  EXPECT_THAT(Names(*FindMotionModels("linear_drag", Gravity::kLinear)), ElementsAre("linear_drag"));
  EXPECT_THAT(Names(*FindMotionModels("coulomb", Gravity::kSine)), ElementsAre("coulomb"));
  EXPECT_THAT(Names(*FindMotionModels("all", Gravity::kLinear)),
              ElementsAre("linear", "linear_coulomb", "linear_drag", "linear_stribeck", "linear_dahl"));
}

TEST(FindMotionModels, KnowUsualWordsForFriction) {
  EXPECT_THAT(Names(*FindMotionModels("dry,quadratic", {})), ElementsAre("coulomb", "drag"));
  EXPECT_THAT(Names(*FindMotionModels("dry", Gravity::kLinear)), ElementsAre("linear_coulomb"));
  EXPECT_FALSE(FindMotionModels("coulomb,dry", {}));
}

TEST(FindMotionModels, RefuseAModelThatContradictsTheGravity) {
  const auto linear = FindMotionModels("linear_coulomb", Gravity::kSine);
  ASSERT_FALSE(linear);
  EXPECT_EQ(
      linear.error().message(),
      "model linear_coulomb has the restoring torque linear, but --gravity says sin; leave --gravity out, or give "
      "--model coulomb");
  const auto asymmetric = FindMotionModels("asymmetric", Gravity::kLinear);
  ASSERT_FALSE(asymmetric);
  EXPECT_THAT(asymmetric.error().message(), HasSubstr("model asymmetric cannot be combined with --gravity linear"));
  EXPECT_FALSE(FindMotionModels("linear,viscous", Gravity::kLinear));  // the same model twice
}

TEST(FindMotionModel, ListsTheModelsForAnUnknownName) {
  for (const std::string_view wrong : {"Coulomb", "coulom", "", "viscous,coulomb"}) {
    const Result<MotionModel> model = FindMotionModel(wrong);
    ASSERT_FALSE(model) << wrong;
    EXPECT_EQ(model.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(model.error().message(), HasSubstr("no model '" + std::string(wrong) + "'"));
    for (const MotionModel& existing : MotionModels()) {
      EXPECT_THAT(model.error().message(), HasSubstr(std::string(existing.name)));
    }
  }
}

TEST(MotionModelNames, StartWithTheDocumentedNamesInOrder) {
  EXPECT_THAT(MotionModelNames(), testing::StartsWith("viscous, coulomb, drag"));
}

TEST(PhysicalParameters, AreInertiaAndFrictionInTheDocumentedOrder) {
  EXPECT_THAT(ParameterNames("linear"), ElementsAre("inertia", "viscous"));
  EXPECT_THAT(ParameterNames("viscous"), ElementsAre("inertia", "viscous"));
  EXPECT_THAT(ParameterNames("coulomb"), ElementsAre("inertia", "viscous", "coulomb"));
  EXPECT_THAT(ParameterNames("drag"), ElementsAre("inertia", "viscous", "coulomb", "drag"));
}

TEST(PhysicalParameters, HaveTheDocumentedUnitsWithAndWithoutARig) {
  const std::vector<ParameterInfo> infos = PhysicalParameters(FindMotionModel("drag").value());
  ASSERT_EQ(infos.size(), 4);
  std::vector<std::string_view> units;
  std::vector<std::string_view> relative_units;
  for (const ParameterInfo& info : infos) {
    units.push_back(info.unit);
    relative_units.push_back(info.relative_unit);
    EXPECT_TRUE(info.scales_with_gravity()) << info.name;
    EXPECT_EQ(info.lower, 0) << info.name;
    EXPECT_EQ(info.upper, kUnbounded) << info.name;
  }
  EXPECT_THAT(units, ElementsAre("kg m^2", "N m s/rad", "N m", "N m s^2/rad^2"));
  EXPECT_THAT(relative_units, ElementsAre("s^2", "s", "1", "s^2"));
}

TEST(ParameterInfo, AngleTimeAndRateDoNotScaleWithGravity) {
  for (const ParameterInfo& info : {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle, kRateBias}) {
    EXPECT_FALSE(info.scales_with_gravity()) << info.name;
    EXPECT_EQ(info.lower, -kUnbounded) << info.name;
    EXPECT_EQ(info.upper, kUnbounded) << info.name;
  }
}

TEST(AllParameters, HaveWordsAndAreListedOnce) {
  const std::vector<ParameterInfo> all = AllParameters();
  const std::vector<std::string_view> names = Names(all);
  EXPECT_THAT(names, IsSupersetOf({"inertia", "stribeck_rate", "release_angle", "pivot_x"}));
  EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
  for (const ParameterInfo& info : all) {
    EXPECT_NE(info.symbol, "") << info.name;
    EXPECT_NE(info.words, "") << info.name;
  }
}

}  // namespace
}  // namespace pendulum::motion_model_test
