// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/page_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::page_parts_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

TEST(ParameterNamesJson, HasTheSymbolTheWordsAndTheUnitWithoutARig) {
  const Json names = ParameterNamesJson();
  EXPECT_EQ(names["inertia"],
            Json({{"symbol", "I_O"}, {"words", "moment of inertia"}, {"unit_over_g", "s^2"}}));  // MODEL.md section 1
  EXPECT_EQ(names["zero_angle"], Json({{"symbol", "z"}, {"words", "zero of the sensor"}}));
}

TEST(ScriptText, CannotEndAScriptAndKeepsTheJson) {
  const Json json = {{"name", "</script><!--"}, {"value", 0.1}};
  EXPECT_THAT(ScriptText(json), Not(HasSubstr("<")));
  EXPECT_EQ(Json::parse(ScriptText(json)), json);
}

TEST(ScriptText, ReplacesInvalidUtf8) { EXPECT_EQ(ScriptText("a\xff"), "\"a\xef\xbf\xbd\""); }

TEST(FillPage, InsertsEachPartInItsPlace) {
  EXPECT_EQ(FillPage("<p>@A@</p>@B@.", {{"@A@", 1}, {"@B@", Json{{"b", nullptr}}}}), "<p>1</p>{\"b\":null}.");
}

TEST(FillPage, DoesNotSearchInsertedText) { EXPECT_EQ(FillPage("@A@ @B@", {{"@A@", "@B@"}, {"@B@", 2}}), "\"@B@\" 2"); }

}  // namespace
}  // namespace pendulum::page_parts_test
