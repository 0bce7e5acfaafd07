// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "batch/kept_result.h"
#include "pendulum/analysis/separate_estimates.h"
#include "pendulum/batch/store.h"

/// The rows of a store's tables. They are derived from the result JSON, so rows and JSON always agree.
namespace pendulum {

/// A row of table quantities.
struct QuantityRow {
  std::string name;
  bool derived = false;
  std::optional<double> estimate, std_error, lower95, upper95, systematic_std_error, total_std_error;
  /// Parts of systematic_std_error: of changes and of friction of another law together, of clock and calibration
  /// together.
  std::optional<double> inconstancy_std_error, source_std_error;
  std::string unit;
  bool fixed = false, at_bound = false;
};

/// A row of table fits, and its quantities.
struct FitRow {
  std::string model, status, reason;
  std::optional<std::int64_t> used_samples;
  std::optional<double> effective_samples;
  std::optional<std::string> residual_unit;
  std::optional<double> rms_residual, sigma;
  std::optional<std::string> noise_model;
  std::optional<double> lag1_correlation, log_likelihood, aic, aicc, bic, durbin_watson, ljung_box_p, runs_p;
  std::optional<std::int64_t> iterations, evaluations;
  std::optional<std::string> verdict;
  std::vector<QuantityRow> quantities;
};

namespace result_rows {

using Json = nlohmann::ordered_json;

/// The value of a member with this type, if there is one.
template <typename Value>
std::optional<Value> Get(const Json& object, std::string_view key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  return found->get<Value>();
}

/// The number whose key is this prefix with a unit, such as "sigma_rad", and the unit.
inline std::pair<std::optional<double>, std::optional<std::string>> GetWithUnit(const Json& object,
                                                                                std::string_view prefix) {
  if (!object.is_object()) return {};
  for (const auto& [key, value] : object.items()) {
    if (!key.starts_with(prefix) || !value.is_number()) continue;
    return {value.get<double>(), key.substr(prefix.size())};
  }
  return {};
}

/// The clock and the calibration of a result with a recording, as text.
inline std::string SourcesOf(const Json& result) {
  const Json& recording = *RecordingOf(result);
  return SourcesText(Get<double>(recording, "clock_scale").value_or(1),
                     Get<double>(recording, "clock_scale_std_dev").value_or(0),
                     recording.value("calibration", Json()).dump());
}

inline void SetErrorParts(const Json& json, QuantityRow& row) {
  const auto budget = json.find("error_budget");
  if (budget == json.end()) return;
  const double change = Get<double>(*budget, "inconstancy").value_or(0);
  const double law = Get<double>(*budget, "friction_law").value_or(0);
  if (change > 0 || law > 0) row.inconstancy_std_error = std::hypot(change, law);
  const double clock = Get<double>(*budget, "clock").value_or(0);
  const double calibration = Get<double>(*budget, "calibration").value_or(0);
  if (clock > 0 || calibration > 0) row.source_std_error = std::hypot(clock, calibration);
}

inline QuantityRow Quantity(const std::string& name, const Json& json, bool derived) {
  QuantityRow row;
  row.name = name;
  row.derived = derived;
  row.estimate = Get<double>(json, "estimate");
  row.std_error = Get<double>(json, "std_error");
  row.systematic_std_error = Get<double>(json, "systematic_std_error");
  row.total_std_error = Get<double>(json, "total_std_error");
  if (row.std_error && !row.total_std_error) {
    row.total_std_error = std::hypot(*row.std_error, row.systematic_std_error.value_or(0));
  }
  SetErrorParts(json, row);
  row.unit = Get<std::string>(json, "unit").value_or("");
  row.fixed = Get<bool>(json, "fixed").value_or(false);
  row.at_bound = Get<bool>(json, "at_bound").value_or(false);
  const auto interval = json.find("interval95");
  if (interval == json.end() || !interval->is_array()) return row;
  if ((*interval)[0].is_number()) row.lower95 = (*interval)[0].get<double>();
  if ((*interval)[1].is_number()) row.upper95 = (*interval)[1].get<double>();
  return row;
}

inline void SetStatistics(const Json& own, FitRow& row) {
  const Json& statistics = own["statistics"];
  const Json& noise = own["noise"];
  std::tie(row.rms_residual, row.residual_unit) = GetWithUnit(statistics, "rms_residual_");
  row.sigma = GetWithUnit(noise, "sigma_").first;
  row.noise_model = Get<std::string>(noise, "model");
  row.lag1_correlation = Get<double>(noise, "lag1_correlation");
  row.effective_samples = Get<double>(statistics, "effective_samples");
  row.log_likelihood = Get<double>(statistics, "log_likelihood");
  row.aic = Get<double>(statistics, "aic");
  row.aicc = Get<double>(statistics, "aicc");
  row.bic = Get<double>(statistics, "bic");
  row.durbin_watson = Get<double>(statistics, "durbin_watson");
  row.ljung_box_p = Get<double>(statistics, "ljung_box_p");
  row.runs_p = Get<double>(statistics, "runs_p");
}

/// own: the part of the fit for the recording.
inline FitRow Fit(const Json& recording, const Json& fit, const Json& own) {
  FitRow row;
  row.model = fit["model"].get<std::string>();
  row.status = fit["status"].get<std::string>();
  row.reason = fit["reason"].get<std::string>();
  row.used_samples = Get<std::int64_t>(recording, "used_samples");
  if (const auto summary = fit.find("summary"); summary != fit.end()) {
    row.verdict = Get<std::string>(*summary, "verdict");
  }
  SetStatistics(own, row);
  row.iterations = Get<std::int64_t>(fit["solver"], "iterations");
  row.evaluations = Get<std::int64_t>(fit["solver"], "evaluations");
  for (const Json* const part : {&fit, &own}) {
    for (const auto& [name, json] : (*part)["parameters"].items())
      row.quantities.push_back(Quantity(name, json, false));
  }
  for (const auto& [name, json] : fit["derived"].items()) row.quantities.push_back(Quantity(name, json, true));
  return row;
}

}  // namespace result_rows

/// One row per requested model.
inline std::vector<FitRow> FitRows(const RunOutcome& outcome) {
  std::vector<FitRow> rows;
  if (outcome.result.is_null()) {
    for (const std::string& model : outcome.models) {
      rows.emplace_back();
      rows.back().model = model;
      rows.back().status = "failed";
      rows.back().reason = outcome.reason.text();
    }
    return rows;
  }
  const auto& recording = *RecordingOf(outcome.result);
  const auto& fits = outcome.result["fits"];
  for (std::size_t m = 0; m < fits.size(); ++m)
    rows.push_back(result_rows::Fit(recording, fits[m], recording.at("fits").at(m)));
  return rows;
}

}  // namespace pendulum
