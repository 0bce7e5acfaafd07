// SPDX-License-Identifier: Apache-2.0
#include "batch/former_results.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pendulum::former_results_test {
namespace {

using Json = nlohmann::ordered_json;

// A path or a message that equals a former key or code is not a name and stays unchanged.
TEST(ToCurrentResult, RenamesKeysWarningCodesAndParametersOfVersion1) {
  const std::string former = R"({
    "schema_version": 1,
    "data": {"sampling": {"seen_frequency_hz": 0.8}, "path": "why"},
    "fits": [{
      "parameters": {"edge_lag": {"estimate": 0.001}, "inertia": {"estimate": 0.07899931415926535}},
      "covariance": {"names": ["inertia", "edge_lag"]},
      "noise": {"why": "the residuals are 3 resolutions"},
      "closed_form": [{"z": null, "why": "no errors", "reason": "no errors"}, {"z": 1, "why": null}],
      "homogeneity": {"disagreeing": [2], "amplitude_dependence": [{"rest_p": 0.5}]},
      "runs": [{"alone": "converged"}],
      "warnings": [{"code": "left_out", "message": "left_out"}]}],
    "comparison": {"rows": [{"judged": true}]}})";
  const std::string current = R"({
    "schema_version": 2,
    "data": {"sampling": {"apparent_frequency_hz": 0.8}, "path": "why"},
    "fits": [{
      "parameters": {"hysteresis": {"estimate": 0.001}, "inertia": {"estimate": 0.07899931415926535}},
      "covariance": {"names": ["inertia", "hysteresis"]},
      "noise": {"reason": "the residuals are 3 resolutions"},
      "closed_form": [{"z": null, "reason": "no errors"}, {"z": 1, "reason": null}],
      "homogeneity": {"outliers": [2], "amplitude_dependence": [{"p_of_remainder": 0.5}]},
      "runs": [{"separate": "converged"}],
      "warnings": [{"code": "larger_motion_outside", "message": "left_out"}]}],
    "comparison": {"rows": [{"is_compared": true}]}})";
  EXPECT_EQ(Json::parse(ToCurrentResult(former)), Json::parse(current));
}

TEST(ToCurrentResult, DoesNotChangeOtherTexts) {
  for (const std::string text : {"", "{}", "[1]", "no JSON", R"({"schema_version": 2, "why": 1})"}) {
    EXPECT_EQ(ToCurrentResult(text), text);
  }
}

}  // namespace
}  // namespace pendulum::former_results_test
