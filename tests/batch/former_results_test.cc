// SPDX-License-Identifier: Apache-2.0
#include "batch/former_results.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pendulum::former_results_test {
namespace {

using Json = nlohmann::ordered_json;

// A path or a message that equals a former key or code is not a name and stays unchanged. Version 3 divides a fit
// between the parameters of the pendulum and what a recording has for itself.
TEST(ToCurrentResult, RenamesAndMovesWhatVersion1Had) {
  const std::string former = R"({
    "schema_version": 1,
    "tool": {"name": "fit_pendulum", "version": "0.1.0"},
    "data": {"path": "why", "sampling": {"seen_frequency_hz": 0.8}},
    "rig": null,
    "calibration": {"input": "counts"},
    "fits": [{
      "model": "viscous", "status": "converged", "reason": "done", "equation": "th'' = 0",
      "parameters": {"inertia": {"estimate": 0.07899931415926535}, "viscous": {"estimate": 0},
                     "edge_lag": {"estimate": 0.001}},
      "derived": {"damping_ratio": {"estimate": 1}},
      "covariance": {"names": ["inertia", "edge_lag"], "matrix": [[1, 2], [2, 3]]},
      "correlation": {"names": [], "matrix": []},
      "systematic_covariance": {"names": ["edge_lag"], "matrix": [[4]]},
      "std_error_method": "a", "interval_method": "b",
      "identifiability": [{"parameter": "viscous"}, {"parameter": "edge_lag"}],
      "noise": {"why": "the residuals are 3 resolutions"},
      "statistics": {"rms_residual_rad": 0.5, "bic": 2, "runs_p": 0.25},
      "closed_form": [{"z": null, "why": "no errors", "reason": "no errors"}, {"z": 1, "why": null}],
      "constancy": null, "constancy_reason": "too short",
      "solver": {"iterations": 3}}],
    "comparison": {"rows": [{"judged": true}]},
    "closed_forms": null,
    "warnings": [{"code": "left_out", "message": "left_out"}],
    "reason": "no turning points"})";
  const std::string current = R"({
    "schema_version": 3,
    "tool": {"name": "fit_pendulum", "version": "0.1.0"},
    "rig": null,
    "recordings": [{
      "path": "why", "sampling": {"apparent_frequency_hz": 0.8},
      "left_out": null,
      "calibration": {"input": "counts"},
      "closed_forms": null,
      "fits": [{
        "model": "viscous", "amplitude_rad": null,
        "parameters": {"hysteresis": {"estimate": 0.001}},
        "covariance": {"names": ["inertia", "hysteresis"], "matrix": [[1, 2], [2, 3]]},
        "correlation": {"names": [], "matrix": []},
        "systematic_covariance": {"names": ["hysteresis"], "matrix": [[4]]},
        "std_error_method": "a",
        "identifiability": [{"parameter": "hysteresis"}],
        "noise": {"reason": "the residuals are 3 resolutions"},
        "statistics": {"rms_residual_rad": 0.5, "bic": 2, "runs_p": 0.25},
        "closed_form": [{"z": null, "reason": "no errors"}, {"z": 1, "reason": null}],
        "constancy": null, "constancy_reason": "too short",
        "separate": "converged"}],
      "reason": "no turning points"}],
    "fits": [{
      "model": "viscous", "status": "converged", "reason": "done", "equation": "th'' = 0",
      "shared": ["inertia", "viscous"],
      "parameters": {"inertia": {"estimate": 0.07899931415926535}, "viscous": {"estimate": 0}},
      "derived": {"damping_ratio": {"estimate": 1}},
      "covariance": {"names": ["inertia"], "matrix": [[1]]},
      "correlation": {"names": [], "matrix": []},
      "systematic_covariance": {"names": [], "matrix": []},
      "std_error_method": "a", "interval_method": "b",
      "identifiability": [{"parameter": "viscous"}],
      "statistics": {"rms_residual_rad": 0.5, "bic": 2},
      "homogeneity": null,
      "solver": {"iterations": 3}}],
    "comparison": {"rows": [{"is_compared": true}]},
    "warnings": [{"code": "larger_motion_outside", "message": "left_out", "text": "left_out", "finding": "left_out",
                  "explanation": null, "advice": null, "flags": [], "assumed": null, "law": null, "recordings": [],
                  "parameters": []}]})";
  EXPECT_EQ(Json::parse(ToCurrentResult(former)).dump(1), Json::parse(current).dump(1));
}

// Its keys had the unit m_s^2 until shortly before version 3.
TEST(ToCurrentResult, WritesTheUnitOfAccelerationsAsItIsNow) {
  const std::string former = R"({
    "schema_version": 2, "data": {"resolution_m_s^2": 0.5},
    "fits": [{"model": "viscous", "status": "failed", "reason": "a", "parameters": {},
              "statistics": {"rms_residual_m_s^2": 0.25, "runs_p": null, "reason": "runs_p is not a finite number"}}],
    "warnings": [{"code": "gaps", "message": "a", "text": "b"}]})";
  const Json current = Json::parse(ToCurrentResult(former));
  const Json& recording = current["recordings"][0];
  EXPECT_EQ(recording["resolution_m_s2"], 0.5);
  EXPECT_EQ(recording["fits"][0]["statistics"]["rms_residual_m_s2"], 0.25);
  EXPECT_EQ(recording["fits"][0]["separate"], "failed: a");
  EXPECT_EQ(current["fits"][0]["statistics"].dump(), R"({"rms_residual_m_s2":0.25})");
  EXPECT_EQ(current["warnings"][0]["text"], "b");
}

TEST(ToCurrentResult, DoesNotChangeOtherTexts) {
  for (const std::string text :
       {"", "{}", "[1]", "no JSON", R"({"schema_version": 3, "why": 1})", R"({"schema_version": 2, "why": 1})"}) {
    EXPECT_EQ(ToCurrentResult(text), text);
  }
}

TEST(ToCurrentFit, GivesTheFitItsOwnPart) {
  const Json fit = Json::parse(ToCurrentFit(
      R"({"model": "viscous", "status": "converged", "reason": "done",
          "parameters": {"inertia": {"estimate": 1}, "viscous": {"estimate": 2}, "zero_angle": {"estimate": 3}}})"));
  EXPECT_EQ(fit["parameters"].dump(), R"({"inertia":{"estimate":1},"viscous":{"estimate":2}})");
  ASSERT_EQ(fit["recordings"].size(), 1);
  EXPECT_EQ(fit["recordings"][0]["parameters"].dump(), R"({"zero_angle":{"estimate":3}})");
  EXPECT_EQ(ToCurrentFit("no JSON"), "no JSON");
  EXPECT_EQ(ToCurrentFit(fit.dump()), fit.dump());  // it is current already
}

}  // namespace
}  // namespace pendulum::former_results_test
