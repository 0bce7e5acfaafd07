// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/parameter.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/shown_motion.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

void AppendNumber(double value, std::string& text) {
  if (std::isfinite(value)) text += NumberText(value);
}

/// Rounds to seven digits, more than the resolution of any sensor.
double Shortened(double value) {
  constexpr double kDigits = 1e6;
  if (!std::isfinite(value) || value == 0) return value;
  const double scale = kDigits / std::pow(10.0, std::floor(std::log10(std::abs(value))));
  const double shortened = std::round(value * scale) / scale;
  return std::isfinite(shortened) ? shortened : value;
}

Json NumbersJson(const Eigen::VectorXd& values, SeriesDetail detail) {
  Json json = Json::array();
  json.get_ref<Json::array_t&>().reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values) {
    json.push_back(NumberOrNull(detail == SeriesDetail::kAll ? value : Shortened(value)));
  }
  return json;
}

/// The values as an array; null unless there is one value for each of the `samples` samples.
Json SamplesJson(const Eigen::VectorXd& values, Eigen::Index samples, SeriesDetail detail) {
  return values.size() == samples ? NumbersJson(values, detail) : Json(nullptr);
}

Json ExtremaJson(const Recording& used) {
  Json json = Json::array();
  if (used.quantity == Quantity::kAcceleration)
    return json;  // an acceleration does not turn where the
                  // pendulum does
  const Result<TurningPointTable> table = FindTurningPoints(used);
  if (!table) return json;
  for (const TurningPoint& point : table->points) json.push_back(Json::array({point.time, point.value}));
  return json;
}

void SetEstimate(const std::string& key, const std::optional<Estimate>& estimate, Json& json) {
  json[key] = estimate ? NumberOrNull(estimate->value) : Json(nullptr);
  json[key + "_std_error"] = estimate ? NumberOrNull(estimate->std_error) : Json(nullptr);
}

/// One turning point, numbered from 1.
Json PeakJson(const ClosedForms& forms, std::size_t i, const std::string& unit) {
  const TurningPoint& point = forms.table.points[i];
  const std::string quantity = forms.table.quantity == Quantity::kRate ? "rate" : "angle";
  const DecayRow decay = i < forms.decay.size() ? forms.decay[i] : DecayRow();
  Json json;
  json["number"] = i + 1;
  json["time_s"] = point.time;
  json["time_std_error"] = NumberOrNull(std::sqrt(point.covariance(0, 0)));
  json[KeyWithUnit(quantity, unit)] = point.value;
  json["std_error"] = NumberOrNull(std::sqrt(point.covariance(1, 1)));
  SetEstimate("zeta_pair", decay.pair, json);
  SetEstimate("zeta", decay.so_far, json);
  json["periods"] = decay.so_far ? Json(decay.periods) : Json(nullptr);
  return json;
}

Json PeaksJson(const std::optional<ClosedForms>& forms, const std::string& unit) {
  Json json = Json::array();
  if (!forms) return json;
  for (std::size_t i = 0; i < forms->table.points.size(); ++i) json.push_back(PeakJson(*forms, i, unit));
  return json;
}

/// Standard errors of the N fitted readings, from the covariance C of the estimates: sqrt(diag(J C J')), J the
/// readings' derivatives. Empty if there is no covariance, or if the trajectory cannot be computed.
Eigen::VectorXd FittedStdErrors(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig) {
  if (fit.covariance.rows() == 0 || fit.fitted.size() != used.size()) return {};
  const FittedMotion motion(used, fit, rig);
  Eigen::MatrixXd jacobian;
  if (!motion.Readings(motion.instants(), &jacobian)) return {};
  std::vector<Eigen::Index> columns;
  for (const std::string& name : fit.covariance_names) {
    columns.push_back(std::distance(fit.parameters.data(), fit.Find(name)));
  }
  Eigen::VectorXd std_errors(jacobian.rows());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {  // row by row: a million samples need no second jacobian
    const Eigen::RowVectorXd derivatives = jacobian(i, columns);
    std_errors[i] = std::sqrt(std::max(0.0, derivatives.dot(derivatives * fit.covariance)));
  }
  return std_errors;
}

/// Whether a band of two standard errors would be seen in a plot of the readings.
bool IsVisible(const Eigen::VectorXd& std_errors, const Eigen::VectorXd& readings) {
  constexpr double kLeastShare = 1e-3;  // of the range of the readings: a third of a pixel of 300
  const double range = readings.maxCoeff() - readings.minCoeff();
  return std_errors.size() > 0 && 2 * std_errors.maxCoeff() > kLeastShare * range;
}

Json ModelJson(const Recording& used, const FitReport& fit, const TextbookOverlay& overlay,
               const Eigen::VectorXd& std_errors, SeriesDetail detail) {
  const Eigen::Index samples = used.size();
  const bool has_band = detail == SeriesDetail::kAll || IsVisible(std_errors, used.value);
  Json json;
  json["fitted"] = SamplesJson(fit.fitted, samples, detail);
  json["fitted_std_error"] = has_band ? SamplesJson(std_errors, samples, detail) : Json(nullptr);
  json["residual"] = detail == SeriesDetail::kAll ? SamplesJson(fit.residual, samples, detail) : Json(nullptr);
  json["linear_closed_form"] = SamplesJson(overlay.linear, samples, detail);
  json["nonlinear_closed_form"] = SamplesJson(overlay.nonlinear, samples, detail);
  return json;
}

/// The fitted motion at equal steps; null if there is none or its trajectory cannot be computed.
Json MotionJson(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig, SeriesDetail detail) {
  const std::optional<ShownMotion> motion = MotionToShow(used, fit, rig, detail == SeriesDetail::kAll ? 1e5 : 2e4);
  if (!motion) return nullptr;
  Json json;
  json["start_s"] = motion->start;
  json["interval_s"] = motion->interval;
  json["angle_unit"] = fit.parameters[PhysicalParameters(fit.model).size()].unit;
  json["angle"] = NumbersJson(motion->angle, detail);
  json["rate"] = NumbersJson(motion->rate, detail);
  json["reading"] = motion->reading.size() > 0 ? NumbersJson(motion->reading, detail) : Json(nullptr);
  return json;
}

/// The fitted motion of each model; null if the samples themselves show the motion.
Json MotionsJson(const Identification& identification, std::size_t k, SeriesDetail detail) {
  const IdentifiedRecording& recording = identification.recordings[k];
  const Recording& used = recording.used;
  Json json;
  if (!HidesMotion(recording)) return json;
  for (std::size_t m = 0; m < identification.fits.size(); ++m) {
    const FitReport& fit = identification.FitOf(k, m);
    json[std::string(fit.model.name)] = MotionJson(used, fit, identification.si_rig(), detail);
  }
  return json;
}

Json ProfileJson(const ProfileCurve& curve) {
  Json json;
  for (const auto& [key, values] : {std::pair("value", &curve.value), std::pair("statistic", &curve.statistic)}) {
    json[key] = Json::array();
    for (const double value : *values) json[key].push_back(NumberOrNull(value));
  }
  json["threshold"] = NumberOrNull(curve.threshold);
  return json;
}

/// Profiles by model and parameter; null if no fit has one.
Json ProfilesJson(const Identification& identification, std::size_t k) {
  Json json;
  for (std::size_t m = 0; m < identification.fits.size(); ++m) {
    const FitReport& fit = identification.FitOf(k, m);
    for (const ProfileCurve& curve : fit.profiles) json[std::string(fit.model.name)][curve.name] = ProfileJson(curve);
  }
  return json;
}

}  // namespace

std::string ToResidualCsv(const Recording& used, const FitReport& fit, const TextbookOverlay& overlay) {
  constexpr std::size_t kTypicalLine = 120;  // bytes
  const std::array<std::pair<const char*, const Eigen::VectorXd*>, 5> columns = {
      {{"measured", &used.value},
       {"fitted", &fit.fitted},
       {"residual", &fit.residual},
       {"linear_closed_form", &overlay.linear},
       {"nonlinear_closed_form", &overlay.nonlinear}}};
  std::string text = "time_s";
  for (const auto& [name, values] : columns) text += "," + KeyWithUnit(name, used.value_unit());
  text += '\n';
  text.reserve(kTypicalLine * static_cast<std::size_t>(used.size() + 1));
  for (Eigen::Index i = 0; i < used.size(); ++i) {
    AppendNumber(used.time[i], text);
    for (const auto& [name, values] : columns) {
      text += ',';
      if (values->size() == used.size()) AppendNumber((*values)[i], text);
    }
    text += '\n';
  }
  return text;
}

std::string ToResidualCsv(const Identification& identification, std::size_t k, std::size_t fit) {
  const IdentifiedRecording& recording = identification.recordings[k];
  const ClosedFormCheck* const check = recording.CheckOf(fit);
  return ToResidualCsv(recording.used, identification.FitOf(k, fit),
                       check == nullptr ? TextbookOverlay() : check->overlay);
}

namespace {

Json RecordingSeriesJson(const Identification& identification, std::size_t k, SeriesDetail detail) {
  const IdentifiedRecording& recording = identification.recordings[k];
  const Recording& used = recording.used;
  const std::string unit = used.value_unit();
  Json json;
  json["time_s"] = SamplesJson(used.time, used.size(), SeriesDetail::kAll);
  json["measured"] = SamplesJson(used.value, used.size(), detail);
  json["unit"] = unit;
  json["extrema"] = ExtremaJson(used);
  json["peaks"] = PeaksJson(recording.closed_forms, unit);
  json["profiles"] = ProfilesJson(identification, k);
  json["models"] = Json::object();
  for (std::size_t m = 0; m < identification.fits.size(); ++m) {
    const FitReport& fit = identification.FitOf(k, m);
    const ClosedFormCheck* const check = recording.CheckOf(m);
    const bool has_overlay = check != nullptr && (detail == SeriesDetail::kAll || m == identification.MainFit());
    json["models"][std::string(fit.model.name)] =
        ModelJson(used, fit, has_overlay ? check->overlay : TextbookOverlay(),
                  FittedStdErrors(used, fit, identification.si_rig()), detail);
  }
  json["motions"] = MotionsJson(identification, k, detail);
  return json;
}

}  // namespace

nlohmann::ordered_json SeriesJson(const Identification& identification, SeriesDetail detail) {
  Json all = Json::array();
  for (std::size_t k = 0; k < identification.recordings.size(); ++k)
    all.push_back(RecordingSeriesJson(identification, k, detail));
  return all;
}

std::string ToSeriesJsonText(const Identification& identification) {
  return JsonText(SeriesJson(identification)) + "\n";
}

}  // namespace pendulum
