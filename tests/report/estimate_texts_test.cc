// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/estimate_texts.h"

#include <gtest/gtest.h>

namespace pendulum::estimate_texts_test {
namespace {

using Json = nlohmann::ordered_json;

Json WithTexts(Json estimate) {
  AddTexts(estimate);
  return estimate;
}

TEST(AddTexts, RoundsTheValueToItsTotalError) {
  const Json inertia =
      WithTexts({{"estimate", 0.0790123}, {"std_error", 0.0012}, {"total_std_error", 0.0028}, {"unit", "kg m^2"}});
  EXPECT_EQ(inertia["text"], "0.0790 ± 0.0028");
  EXPECT_FALSE(inertia.contains("text_in_degrees"));
}

TEST(AddTexts, TakesTheStandardErrorIfThereIsNoOther) {
  EXPECT_EQ(WithTexts({{"estimate", 0.0790123}, {"std_error", 0.0012}, {"unit", "kg m^2"}})["text"], "0.0790 ± 0.0012");
  EXPECT_EQ(WithTexts({{"estimate", 0.079}, {"std_error", nullptr}, {"unit", "kg m^2"}})["text"], "0.079");
}

TEST(AddTexts, GivesAnglesInDegreesToo) {
  const Json angle = WithTexts({{"estimate", 0.5}, {"std_error", 0.01}, {"unit", "rad"}});
  EXPECT_EQ(angle["text"], "0.500 ± 0.010");
  EXPECT_EQ(angle["text_in_degrees"], "28.6 ± 0.6");  // 28.648 ± 0.573
}

TEST(AddTexts, SaysNothingOfAMissingValue) {
  const Json missing = WithTexts({{"estimate", nullptr}, {"std_error", nullptr}, {"unit", "rad"}});
  EXPECT_TRUE(missing["text"].is_null());
  EXPECT_FALSE(missing.contains("text_in_degrees"));
}

TEST(AddTextsOfParameters, ReachesFitsAndRecordings) {
  const Json fit = {{"parameters", {{"inertia", {{"estimate", 1}, {"std_error", 0.1}, {"unit", "s^2"}}}}}};
  Json result = {{"recordings", {{{"fits", {fit}}}}}, {"fits", {fit}}};
  AddTextsOfParameters(result);
  EXPECT_EQ(result["fits"][0]["parameters"]["inertia"]["text"], "1.00 ± 0.10");
  EXPECT_EQ(result["recordings"][0]["fits"][0]["parameters"]["inertia"]["text"], "1.00 ± 0.10");
  Json closed_forms_only = Json::object();
  AddTextsOfParameters(closed_forms_only);
  EXPECT_EQ(closed_forms_only, Json::object());
}

}  // namespace
}  // namespace pendulum::estimate_texts_test
