// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary_json.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/batch/summary.h"
#include "tests/batch/made_outcomes.h"
#include "tests/batch/made_store.h"
#include "tests/batch/schema_check.h"

namespace pendulum::summary_json_test {
namespace {

using made_outcomes::FailureOf;
using made_outcomes::FitOf;
using made_outcomes::OutcomeOf;
using made_store::ManifestOf;
using schema_check::SchemaCheck;
using testing::IsEmpty;
using testing::SizeIs;
using Json = nlohmann::ordered_json;

namespace fs = std::filesystem;

class SummaryJsonTest : public made_store::MadeStoreTest {};

TEST_F(SummaryJsonTest, MatchesItsSchema) {
  const char* const path = "include/pendulum/report/summary.schema.json";
  if (!fs::exists(path)) GTEST_SKIP() << "there is no " << path;
  std::ifstream file(path);
  const Json schema = Json::parse(file);
  const SchemaCheck check(schema);
  const std::string manifest = ManifestOf(30, ",rig no,date", [](std::size_t i) {
    return (i % 2 == 0 ? ",A," : ",B,") + std::string("2026-01-") + (i < 9 ? "0" : "") + std::to_string(i + 1);
  });
  Store store = StoreOf(manifest, [](std::size_t i) -> std::optional<RunOutcome> {
    if (i == 0) return std::nullopt;
    if (i == 1) return FailureOf({"run1.csv", "no swing"}, 5);
    const double value = (i % 2 == 0 ? 10 : 90) + (i == 9 ? 500 : static_cast<double>(i % 3));
    return OutcomeOf({FitOf("viscous", value), FitOf("coulomb", value, i == 2 ? "not_converged" : "converged")});
  });
  for (const SummaryOptions& options :
       {SummaryOptions{"rig no", "date"}, SummaryOptions{"rig no", ""}, SummaryOptions{}}) {
    const Json summary = ToJson(Summarize(store, options).value());
    EXPECT_THAT(check.Faults(summary), IsEmpty()) << options.group_by;
    for (const Json& key : schema["required"]) EXPECT_TRUE(summary.contains(key.get<std::string>())) << key;
  }
  EXPECT_THAT(check.Faults({{"schema_version", 1}}), SizeIs(testing::Gt(8U)));  // the check detects violations
}

}  // namespace
}  // namespace pendulum::summary_json_test
