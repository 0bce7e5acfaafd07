// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/json.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::json_test {
namespace {

using testing::StartsWith;

std::string FaultOf(const std::string& text) {
  const auto json = ParseJsonObject(text, "a.json", "rig", R"({"mass"})");
  EXPECT_FALSE(json.has_value()) << text;
  if (json) return "";
  EXPECT_EQ(json.error().code, StatusCode::kDataLoss);
  return json.error().message();
}

TEST(ParseJsonObject, KeepsTheOrderOfTheKeys) {
  const auto json = ParseJsonObject(R"( {"z": 1, "a": [2, {"z": 3}]} )", "a.json", "rig", "");
  ASSERT_TRUE(json.has_value());
  EXPECT_EQ(json->dump(), R"({"z":1,"a":[2,{"z":3}]})");
}

TEST(ParseJsonObject, ReportsThePlaceOfInvalidJson) {
  EXPECT_EQ(FaultOf("{\n\"a\": 1,\n}"),
            "a.json:3:1: this is not JSON (unexpected '}'; expected string literal); correct it here");
  EXPECT_THAT(FaultOf(""), StartsWith("a.json:1:1: this is not JSON"));
}

TEST(ParseJsonObject, RefusesJsonThatIsNotAnObject) {
  EXPECT_EQ(FaultOf("[1]"), R"(a.json: the rig is an array; it must be an object: {"mass"})");
}

TEST(ParseJsonObject, RefusesARepeatedKey) {
  EXPECT_EQ(FaultOf(R"({"a": {"b": 1, "b": 2}})"), R"(a.json: the key "b" is given twice; keep one of them)");
}

TEST(ParseJsonObject, RefusesNumbersBeyondADouble) {
  EXPECT_EQ(FaultOf(R"({"a": 1, "b": 1e999})"),
            R"(a.json: "b" is larger than a number can be (about 1e308); correct it)");
}

TEST(ParseJsonObject, RefusesMoreThan64KiB) {
  EXPECT_EQ(FaultOf(std::string(kMaxJsonBytes + 1, ' ')),
            "a.json: this is longer than 64 KiB, so it is not a rig; name a rig file");
}

TEST(JsonForMessage, ShowsNumbersAndStringsButOnlyTheKindOfOtherValues) {
  EXPECT_EQ(JsonForMessage(1.5), "1.5");
  EXPECT_EQ(JsonForMessage("a\nb"), R"("a\x0ab")");
  EXPECT_EQ(JsonForMessage(nullptr), "null");
  EXPECT_EQ(JsonForMessage(nlohmann::ordered_json::array()), "an array");
  EXPECT_EQ(JsonForMessage(nlohmann::ordered_json::object()), "an object");
}

// The UTF-8 encoding of U+FFFD is EF BF BD (Unicode 15, section 3.9).
TEST(JsonText, ReplacesInvalidUtf8) {
  EXPECT_EQ(JsonText("a\xFF"), "\"a\xEF\xBF\xBD\"");
  EXPECT_EQ(JsonText({{"a", 1}}), R"({"a":1})");
  EXPECT_EQ(JsonText({{"a", 1}}, 2), "{\n  \"a\": 1\n}");
}

TEST(ParseJsonObject, RefusesTooMuchDepthOrTooManyKeys) {
  const std::string deep = R"({"a": )" + std::string(30'000, '[') + std::string(30'000, ']') + "}";
  const auto refused = ParseJsonObject(deep, "rig.json", "rig", "{}");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("more than 32 nested brackets"));
  std::string keys = "{";
  for (int i = 0; i <= 4100; ++i) keys += (i == 0 ? "\"k" : ",\"k") + std::to_string(i) + "\":1";
  EXPECT_FALSE(ParseJsonObject(keys + "}", "rig.json", "rig", "{}"));
}

TEST(ParseJsonObject, AcceptsTheGivenNumberOfBytes) {
  const std::string text = R"({"a": ")" + std::string(100'000, 'x') + "\"}";
  EXPECT_FALSE(ParseJsonObject(text, "rig.json", "rig", "{}"));
  EXPECT_TRUE(ParseJsonObject(text, "rig.json", "rig", "{}", 200'000));
}

}  // namespace
}  // namespace pendulum::json_test
