// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/sections_json.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/text.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::sections_json_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(SectionsJson, HasEachKindOfBlock) {
  Table table{{{"name"}, {"value", true}, {"± error", false, 1}}, {{"inertia", "0.079", "± 0.001"}}};
  table.caution = "NO";
  const Sections sections = {{"Do the recordings agree?",
                              "a remark",
                              {Words{"a\u00A0b", Emphasis::kAlarm}, Facts{{"file", "a\x1B.csv", Emphasis::kCaution}},
                               std::move(table), Formula{"th'' = 0"}, Items{{"one"}, Emphasis::kNone}},
                              "drag",
                              2}};
  EXPECT_EQ(SectionsJson(sections), Json::parse(R"([{
    "id": "do-the-recordings-agree", "title": "Do the recordings agree?", "law": "drag", "recording": 2,
    "remark": "a remark", "blocks": [
      {"kind": "words", "text": "a b", "emphasis": "alarm"},
      {"kind": "facts", "rows": [{"name": "file", "text": "a?.csv", "emphasis": "caution"}]},
      {"kind": "table",
       "columns": [{"header": "name", "is_number": false, "joins": false},
                   {"header": "value", "is_number": true, "joins": false},
                   {"header": "± error", "is_number": false, "joins": true}],
       "rows": [["inertia", "0.079", "± 0.001"]], "caution": "NO", "rows_before": 0, "left_out": null},
      {"kind": "formula", "text": "th'' = 0"},
      {"kind": "items", "texts": ["one"], "emphasis": "none"}]}])"));
}

TEST(SectionsJson, HasNullForWhatIsAboutAll) {
  const Json section = SectionsJson(Sections{{"Data"}})[0];
  for (const char* key : {"law", "recording", "remark"}) EXPECT_TRUE(section[key].is_null()) << key;
}

// The page shows any of the laws in full.
TEST(SectionsJson, HasAllSectionsOfEveryFit) {
  for (const Identification& report : {ExampleComparedIdentification(), ExampleComparedJointIdentification()}) {
    std::set<std::string> titles, laws;
    for (const Json& section : SectionsJson(report)) {
      titles.insert(section["title"].get<std::string>());
      if (section["title"] == "Fit") laws.insert(section["law"].get<std::string>());
    }
    EXPECT_EQ(laws, (std::set<std::string>{"coulomb", "drag"}));
    for (const Section& section : ReportSections(report)) EXPECT_TRUE(titles.contains(section.title)) << section.title;
  }
}

}  // namespace
}  // namespace pendulum::sections_json_test
