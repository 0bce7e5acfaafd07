// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json.h"

#include <cstddef>
#include <optional>
#include <utility>

#include "pendulum/base/version.h"
#include "pendulum/report/closed_form_json.h"
#include "pendulum/report/comparison_json.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 1;

Json ResolutionJson(const DataSummary& data) { return data.resolution > 0 ? Json(data.resolution) : Json(nullptr); }

std::string WindowReason(const DataSummary& data) {
  return data.begins.empty() ? "" : "begins: " + data.begins + "; ends: " + data.ends;
}

Json StartJson(const RunReport& report) {
  if (report.fits.empty()) return nullptr;
  return report.fits.front().start == StartKind::kRelease ? "release" : "moving";
}

Json DataJson(const RunReport& report) {
  const DataSummary& data = report.data;
  return NumberObject()
      .Set("path", TextOrNull(data.path))
      .Set("sha256", TextOrNull(data.sha256))
      .Set("samples", Json(data.samples))
      .Set("used_samples", Json(data.used_samples))
      .Set("duration_s", data.duration())
      .Set("sample_rate_hz", data.sample_rate())
      .Set(KeyWithUnit("resolution", data.unit), ResolutionJson(data))
      .Set("resolution_source", TextOrNull(data.resolution_source))
      .Set("clock_scale", data.clock_scale)
      .Set("clock_scale_std_dev", data.clock_scale_std_dev)
      .Set("window_s", Json::array({data.from, data.to}))
      .Set("window_reason", TextOrNull(WindowReason(data)))
      .Set("releases", Json(data.releases))
      .Set("release", data.release > 0 ? Json(data.release) : Json(nullptr))
      .Set("start", StartJson(report))
      .Set("sampling", SamplingJson(report.sampling))
      .Done();
}

Json IntervalJson(const std::optional<double>& lower, const std::optional<double>& upper) {
  if (!lower && !upper) return nullptr;
  return Json::array({NumberOrNull(lower), NumberOrNull(upper)});
}

Json ParameterJson(const ParameterEstimate& parameter) {
  NumberObject object;
  if (!parameter.open_interval.empty()) object.Because("the interval is open: " + parameter.open_interval);
  return object.Set("estimate", parameter.estimate)
      .Set("std_error", parameter.std_error, parameter.reason.empty() ? "not estimated" : parameter.reason)
      .Set("interval95", IntervalJson(parameter.lower95, parameter.upper95))
      .Set("systematic_std_error", NumberOrNull(parameter.systematic_std_error))
      .Set("unit", Json(parameter.unit))
      .Set("fixed", Json(parameter.fixed))
      .Set("at_bound", Json(parameter.at_bound))
      .Done();
}

Json ParametersJson(const FitReport& fit) {
  Json parameters = Json::object();
  for (const ParameterEstimate& parameter : fit.parameters) {
    parameters[std::string(parameter.info.name)] = ParameterJson(parameter);
  }
  return parameters;
}

Json DerivedJson(const FitReport& fit) {
  Json derived = Json::object();
  for (const DerivedQuantity& quantity : fit.derived) {
    derived[quantity.name] =
        NumberObject()
            .Set("estimate", quantity.estimate)
            .Set("std_error", quantity.std_error, "a parameter it comes from has no standard error")
            .Set("interval95", IntervalJson(quantity.lower95, quantity.upper95))
            .Set("unit", Json(quantity.unit))
            .Done();
  }
  return derived;
}

template <typename Element>
Json MatrixJson(const std::vector<std::string>& names, const Element& element) {
  Json matrix = Json::array();
  for (Eigen::Index row = 0; row < static_cast<Eigen::Index>(names.size()); ++row) {
    Json values = Json::array();
    for (Eigen::Index column = 0; column < static_cast<Eigen::Index>(names.size()); ++column) {
      values.push_back(NumberOrNull(element(row, column)));
    }
    matrix.push_back(std::move(values));
  }
  return {{"names", names}, {"matrix", std::move(matrix)}};
}

Json CovarianceJson(const FitReport& fit) {
  return MatrixJson(fit.covariance_names, [&](Eigen::Index i, Eigen::Index j) { return fit.covariance(i, j); });
}

Json CorrelationJson(const FitReport& fit) {
  return MatrixJson(fit.covariance_names, [&](Eigen::Index i, Eigen::Index j) { return Correlation(fit, i, j); });
}

Json SystematicJson(const FitReport& fit) {
  return MatrixJson(fit.systematic_names,
                    [&](Eigen::Index i, Eigen::Index j) { return fit.systematic_covariance(i, j); });
}

Json NoiseJson(const FitReport& fit, const DataSummary& data) {
  const NoiseEstimate& noise = fit.noise;
  return NumberObject()
      .Set("model", Json(NoiseFamilyName(noise.family)))
      .Set("why", Json(noise.why))
      .Set(KeyWithUnit("sigma", fit.reading_unit), noise.sigma)
      .Set("sigma_std_error", NumberOrNull(noise.sigma_std_error))
      .Set(KeyWithUnit("resolution", fit.reading_unit), ResolutionJson(data))
      .Set("saturated_samples", Json(noise.censored))
      .Set("lag1_correlation", noise.lag1_correlation)
      .Set("correlation", Json(noise.memory.Name()))
      .Done();
}

Json StatisticsJson(const FitReport& fit) {
  const FitStatistics& statistics = fit.statistics;
  return NumberObject()
      .Set(KeyWithUnit("rms_residual", fit.reading_unit), statistics.rms_residual)
      .Set("log_likelihood", statistics.log_likelihood)
      .Set("aic", statistics.aic)
      .Set("aicc", statistics.aicc)
      .Set("bic", statistics.bic)
      .Set("durbin_watson", statistics.durbin_watson)
      .Set("ljung_box_p", statistics.ljung_box_p)
      .Set("runs_p", statistics.runs_p)
      .Set("effective_samples", statistics.effective_samples)
      .Done();
}

Json IdentifiabilityJson(const FitReport& fit) {
  Json all = Json::array();
  for (const Identifiability& known : fit.identifiability) {
    all.push_back({{"parameter", known.parameter},
                   {"verdict", VerdictName(known.verdict)},
                   {"direction", known.direction},
                   {"advice", TextOrNull(known.advice)}});
  }
  return all;
}

/// What a failed fit does not have is null; its `reason` says why.
Json FitJson(const RunReport& report, std::size_t index) {
  const FitReport& fit = report.fits[index];
  const bool failed = fit.termination == Termination::kFailed;
  Json json;
  json["model"] = fit.model.name;
  json["status"] = TerminationName(fit.termination);
  json["reason"] = fit.reason;
  json["equation"] = failed ? Json(nullptr) : Json(FittedEquation(fit, report.rig));
  json["parameters"] = ParametersJson(fit);
  json["derived"] = DerivedJson(fit);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["noise"] = failed ? Json(nullptr) : NoiseJson(fit, report.data);
  json["systematic_covariance"] = SystematicJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["interval_method"] = TextOrNull(fit.interval_method);
  json["identifiability"] = IdentifiabilityJson(fit);
  json["statistics"] = failed ? Json(nullptr) : StatisticsJson(fit);
  json["closed_form"] = CheckJson(report.CheckOf(index));
  json["constancy"] = ConstancyJson(report.ConstancyOf(index));
  if (json["constancy"].is_null()) json["constancy_reason"] = NoConstancyReason(fit, report.ConstancyOf(index));
  json["solver"] = {{"iterations", fit.solver.iterations},
                    {"evaluations", fit.solver.evaluations},
                    {"termination", fit.solver.termination}};
  return json;
}

Json WarningsJson(const RunReport& report) {
  Json warnings = Json::array();
  for (const Warning& warning : AllWarnings(report)) {
    warnings.push_back({{"code", warning.code}, {"message", warning.message}});
  }
  return warnings;
}

}  // namespace

nlohmann::ordered_json ToJson(const RunReport& report) {
  Json fits = Json::array();
  for (std::size_t i = 0; i < report.fits.size(); ++i) {
    fits.push_back(FitJson(report, i));
  }
  NumberObject json;
  json.Set("schema_version", Json(kSchemaVersion))
      .Set("tool", Json{{"name", "fit_pendulum"}, {"version", kVersion}})
      .Set("data", DataJson(report))
      .Set("rig", report.rig ? report.rig->source : Json(nullptr))
      .Set("calibration", report.calibration)
      .Set("fits", std::move(fits))
      .Set("comparison", ComparisonJson(report))
      .Set("closed_forms", ClosedFormsJson(report))
      .Set("warnings", WarningsJson(report));
  if (!report.closed_forms) json.Because(report.no_closed_forms);
  return json.Done();
}

std::string ToJsonText(const RunReport& report) {
  constexpr int kIndent = 2;
  return ToJson(report).dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pendulum
