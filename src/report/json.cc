// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json.h"

#include <cmath>
#include <optional>
#include <string_view>

#include "pendulum/base/version.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 1;

/// An object whose missing numbers explain themselves.
class NumberObject {
 public:
  NumberObject& Set(const std::string& key, Json value) {
    object_[key] = std::move(value);
    return *this;
  }

  NumberObject& Set(const std::string& key, double value) {
    if (std::isfinite(value)) return Set(key, Json(value));
    Because(key + " is not a finite number");
    return Set(key, Json(nullptr));
  }

  /// A number that may be missing for the reason given.
  NumberObject& Set(const std::string& key, const std::optional<double>& value, const std::string& reason) {
    if (value) return Set(key, *value);
    Because(reason);
    return Set(key, Json(nullptr));
  }

  void Because(const std::string& reason) {
    if (!reason.empty() && reason_ != reason) reason_ += (reason_.empty() ? "" : "; ") + reason;
  }

  Json Done() {
    if (!reason_.empty()) object_["reason"] = reason_;
    return std::move(object_);
  }

 private:
  Json object_ = Json::object();
  std::string reason_;
};

Json NumberOrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json ResolutionJson(const DataSummary& data) { return data.resolution > 0 ? Json(data.resolution) : Json(nullptr); }

/// A key with its unit: sigma_rad_s.
std::string Named(const std::string& name, const std::string& unit) { return name + "_" + KeySuffix(unit); }

std::string WindowReason(const DataSummary& data) {
  return data.begins.empty() ? "" : "begins: " + data.begins + "; ends: " + data.ends;
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
      .Set(Named("resolution", data.unit), ResolutionJson(data))
      .Set("resolution_source", TextOrNull(data.resolution_source))
      .Set("clock_scale", data.clock_scale)
      .Set("clock_scale_std_dev", data.clock_scale_std_dev)
      .Set("window_s", Json::array({data.from, data.to}))
      .Set("window_reason", TextOrNull(WindowReason(data)))
      .Set("releases", Json(data.releases))
      .Set("release", data.release > 0 ? Json(data.release) : Json(nullptr))
      .Set("start", report.fits.front().start == StartKind::kRelease ? "release" : "moving")
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
      .Set(Named("sigma", fit.reading_unit), noise.sigma)
      .Set("sigma_std_error", NumberOrNull(noise.sigma_std_error))
      .Set(Named("resolution", fit.reading_unit), ResolutionJson(data))
      .Set("saturated_samples", Json(noise.censored))
      .Set("lag1_correlation", noise.lag1_correlation)
      .Set("correlation", Json(noise.correlation))
      .Done();
}

Json StatisticsJson(const FitReport& fit) {
  const FitStatistics& statistics = fit.statistics;
  return NumberObject()
      .Set(Named("rms_residual", fit.reading_unit), statistics.rms_residual)
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
Json FitJson(const FitReport& fit, const DataSummary& data) {
  const bool failed = fit.termination == Termination::kFailed;
  Json json;
  json["model"] = fit.model.name;
  json["status"] = TerminationName(fit.termination);
  json["reason"] = fit.reason;
  json["parameters"] = ParametersJson(fit);
  json["derived"] = DerivedJson(fit);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["noise"] = failed ? Json(nullptr) : NoiseJson(fit, data);
  json["systematic_covariance"] = SystematicJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["interval_method"] = TextOrNull(fit.interval_method);
  json["identifiability"] = IdentifiabilityJson(fit);
  json["statistics"] = failed ? Json(nullptr) : StatisticsJson(fit);
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
  Json json;
  json["schema_version"] = kSchemaVersion;
  json["tool"] = {{"name", "fit_pendulum"}, {"version", kVersion}};
  json["data"] = DataJson(report);
  json["rig"] = report.rig ? report.rig->source : Json(nullptr);
  json["calibration"] = report.calibration;
  json["fits"] = Json::array();
  for (const FitReport& fit : report.fits) json["fits"].push_back(FitJson(fit, report.data));
  json["warnings"] = WarningsJson(report);
  return json;
}

std::string ToJsonText(const RunReport& report) {
  constexpr int kIndent = 2;
  return ToJson(report).dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pendulum
