// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/batch/store.h"

/// Outcomes of runs, made by hand without fitting.
namespace pendulum::made_outcomes {

using Json = nlohmann::ordered_json;

/// A fit in the form of the result JSON, with the members that a store reads: one parameter of the rig, one of the run,
/// and a fixed one.
inline Json FitOf(const std::string& model, double inertia, const std::string& status = "converged") {
  const auto quantity = [](double estimate, const Json& std_error, const char* unit, bool fixed) {
    return Json{{"estimate", estimate},
                {"std_error", std_error},
                {"interval95", {nullptr, nullptr}},
                {"systematic_std_error", nullptr},
                {"unit", unit},
                {"fixed", fixed},
                {"at_bound", false}};
  };
  return {{"model", model},
          {"status", status},
          {"reason", status == "converged" ? "done" : "after 100 iterations"},
          {"parameters",
           {{"inertia", quantity(inertia, 1.0, "kg m^2", false)},
            {"release_angle", quantity(inertia / 100, 0.01, "rad", false)},
            {"viscous", quantity(0, nullptr, "N m s/rad", true)}}},
          {"derived", Json::object()},
          {"statistics", {{"rms_residual_rad", 0.001}}},
          {"noise", {{"model", "gaussian"}}},
          {"solver", {{"iterations", 3}, {"evaluations", 4}}}};
}

/// The result JSON of these fits, each with all its parameters and statistics, as result.schema.json divides them
/// between the fit and its part for the recording.
inline Json ResultOf(const std::vector<Json>& fits) {
  Json recording = {{"used_samples", 100}, {"fits", Json::array()}};
  Json shared = Json::array();
  for (const Json& fit : fits) {
    Json own = {{"model", fit.at("model")}, {"parameters", Json::object()}}, rest = fit;
    for (const char* key : {"noise", "statistics"}) {
      own[key] = fit.at(key);
      rest.erase(key);
    }
    for (const char* name : {"release_angle", "zero_angle"}) {
      if (!fit.at("parameters").contains(name)) continue;
      own["parameters"][name] = fit.at("parameters").at(name);
      rest["parameters"].erase(name);
    }
    recording["fits"].push_back(std::move(own));
    shared.push_back(std::move(rest));
  }
  return {{"recordings", {std::move(recording)}}, {"fits", std::move(shared)}, {"comparison", nullptr}};
}

/// The result of a run with these fits.
inline RunOutcome OutcomeOf(const std::vector<Json>& fits, const char* recommended = nullptr) {
  RunOutcome outcome;
  outcome.provenance.version = "1.2.3";
  outcome.provenance.cpu = "processor time";
  outcome.result = ResultOf(fits);
  if (recommended != nullptr) outcome.result["comparison"] = {{"recommended", recommended}};
  for (const Json& fit : fits) outcome.models.push_back(fit["model"]);
  return outcome;
}

/// A fit of the law viscous with these estimates of inertia and viscous friction, and independent standard errors.
inline Json FitWithCovariance(double inertia, double inertia_error, double viscous, double viscous_error) {
  Json fit = FitOf("viscous", inertia);
  const auto set = [&](const char* name, double value, double error) {
    Json& parameter = fit["parameters"][name];
    parameter["estimate"] = value;
    parameter["std_error"] = error;
    parameter["fixed"] = false;
  };
  set("inertia", inertia, inertia_error);
  set("viscous", viscous, viscous_error);
  fit["covariance"] = {{"names", {"inertia", "viscous"}},
                       {"matrix", {{inertia_error * inertia_error, 0}, {0, viscous_error * viscous_error}}}};
  return fit;
}

inline RunOutcome FailureOf(const Reason& reason, int exit_code) {
  RunOutcome outcome = OutcomeOf({});
  outcome.models = {"viscous"};
  outcome.result = nullptr;
  outcome.reason = reason;
  outcome.exit_code = exit_code;
  return outcome;
}

}  // namespace pendulum::made_outcomes
