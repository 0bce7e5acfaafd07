// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;
using Check = Result<void>;

constexpr std::string_view kForm =
    R"({"input": "counts", "angle_unit": "deg", "coefficients": [-49.6077, 0.1985]} with optional "schema_version", )"
    R"("covariance", "residual_std_dev" and "input_range")";

/// No sensor's curve needs more coefficients, and higher powers of a count overflow.
constexpr std::size_t kMaxCoefficients = 16;

/// Reads one calibration key by key. Every member function names the key in its error.
class CalibrationReader {
 public:
  CalibrationReader(const Json& json, const std::string& name) : json_(json), name_(name) {}

  Result<Calibration> Read();

 private:
  tl::unexpected<Status> Fault(std::string_view key, const std::string& sentence) const {
    return pendulum::Fault(name_, Quoted(key) + " " + sentence);
  }

  tl::unexpected<Status> Wrong(std::string_view key, const Json& value, const std::string& rule) const {
    return Fault(key, "is " + JsonForMessage(value) + "; it must be " + rule);
  }

  /// The value of an optional key; nullptr if the key is missing or null.
  const Json* Find(std::string_view key) const {
    const auto found = json_.find(key);
    return found == json_.end() || found->is_null() ? nullptr : &*found;
  }

  Check CheckKeys() const;
  Check ReadWord(std::string_view key, std::string_view one, std::string_view other, std::string& word) const;
  Check ReadNumbers(std::string_view key, const Json& json, std::vector<double>& numbers) const;
  Check ReadCoefficients();
  Check ReadCovariance();
  Check CheckCovariance() const;
  Check ReadResidual();
  Check ReadRange();

  const Json& json_;
  const std::string& name_;
  Calibration calibration_;
};

Check CalibrationReader::CheckKeys() const {
  constexpr std::array<std::string_view, 3> kNeeded = {"input", "angle_unit", "coefficients"};
  constexpr std::array<std::string_view, 4> kOptional = {"schema_version", "covariance", "residual_std_dev",
                                                         "input_range"};
  for (const auto& item : json_.items()) {
    if (std::ranges::find(kNeeded, item.key()) == kNeeded.end() &&
        std::ranges::find(kOptional, item.key()) == kOptional.end()) {
      return Fault(item.key(), "is not a key of a calibration; a calibration is " + std::string(kForm));
    }
  }
  for (const std::string_view key : kNeeded) {
    if (!json_.contains(key)) return Fault(key, "is missing; a calibration is " + std::string(kForm));
  }
  const Json* version = Find("schema_version");
  if (version != nullptr && *version != 1) return Wrong("schema_version", *version, "1");
  return {};
}

Check CalibrationReader::ReadWord(std::string_view key, std::string_view one, std::string_view other,
                                  std::string& word) const {
  const Json& json = *json_.find(key);
  if (json != one && json != other) return Wrong(key, json, Quoted(one) + " or " + Quoted(other));
  word = json.get<std::string>();
  return {};
}

Check CalibrationReader::ReadNumbers(std::string_view key, const Json& json, std::vector<double>& numbers) const {
  if (!json.is_array()) return Wrong(key, json, "an array of numbers");
  for (const Json& number : json) {
    if (!number.is_number()) return Fault(key, "holds " + JsonForMessage(number) + "; it must hold numbers");
    numbers.push_back(number.get<double>());
  }
  return {};
}

Check CalibrationReader::ReadCoefficients() {
  std::vector<double>& coefficients = calibration_.coefficients;
  RETURN_IF_ERROR(ReadNumbers("coefficients", *json_.find("coefficients"), coefficients));
  if (coefficients.empty()) return Fault("coefficients", "is empty; it must hold at least an offset and a slope");
  if (coefficients.size() > kMaxCoefficients) {
    return Fault("coefficients", "has " + std::to_string(coefficients.size()) + " numbers; there may be at most " +
                                     std::to_string(kMaxCoefficients));
  }
  if (std::all_of(coefficients.begin() + 1, coefficients.end(), [](double each) { return each == 0; })) {
    return Fault("coefficients", "has no slope, so that every reading would be the same angle; give [offset, slope]");
  }
  return {};
}

Check CalibrationReader::ReadCovariance() {
  const Json* json = Find("covariance");
  if (json == nullptr) return {};
  const std::size_t size = calibration_.coefficients.size();
  const std::string count = std::to_string(size);
  const std::string shape = "one row of " + count + " numbers for each of the " + count + " coefficients";
  if (!json->is_array() || json->size() != size) return Wrong("covariance", *json, shape);
  const auto order = static_cast<Eigen::Index>(size);
  calibration_.covariance.resize(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    std::vector<double> row;
    RETURN_IF_ERROR(ReadNumbers("covariance", (*json)[i], row));
    if (row.size() != size) {
      return Fault("covariance", "has a row of " + std::to_string(row.size()) + " numbers; it must be " + shape);
    }
    calibration_.covariance.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), order);
  }
  return CheckCovariance();
}

/// Checks that the matrix is symmetric and no correlation exceeds 1, both up to the rounding of a file.
Check CalibrationReader::CheckCovariance() const {
  constexpr double kRounding = 1e-6;
  const Eigen::MatrixXd& matrix = calibration_.covariance;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (!(matrix(i, i) >= 0)) {
      return Fault("covariance", "has the variance " + NumberText(matrix(i, i)) + "; variances must be 0 or more");
    }
    for (Eigen::Index j = 0; j < i; ++j) {
      const double scale = std::sqrt(matrix(i, i)) * std::sqrt(matrix(j, j));
      if (std::abs(matrix(i, j) - matrix(j, i)) > kRounding * scale) {
        return Fault("covariance", "is not symmetric: the mirrored elements " + NumberText(matrix(i, j)) + " and " +
                                       NumberText(matrix(j, i)) + " must be equal");
      }
      if (std::abs(matrix(i, j)) > (1 + kRounding) * scale) {
        return Fault("covariance", "has the covariance " + NumberText(matrix(i, j)) +
                                       ", larger than the product of its standard deviations, " + NumberText(scale));
      }
    }
  }
  return {};
}

Check CalibrationReader::ReadResidual() {
  const Json* json = Find("residual_std_dev");
  if (json == nullptr) return {};
  if (!json->is_number() || json->get<double>() < 0) return Wrong("residual_std_dev", *json, "a number, 0 or more");
  calibration_.residual_std_dev = json->get<double>();
  return {};
}

Check CalibrationReader::ReadRange() {
  const Json* json = Find("input_range");
  if (json == nullptr) return {};
  std::vector<double> ends;
  RETURN_IF_ERROR(ReadNumbers("input_range", *json, ends));
  if (ends.size() != 2 || !(ends[0] < ends[1])) return Wrong("input_range", *json, "two increasing numbers or null");
  calibration_.input_range = SensorRange{ends[0], ends[1]};
  return {};
}

Result<Calibration> CalibrationReader::Read() {
  RETURN_IF_ERROR(CheckKeys());
  RETURN_IF_ERROR(ReadWord("input", "counts", "volts", calibration_.input));
  RETURN_IF_ERROR(ReadWord("angle_unit", "deg", "rad", calibration_.angle_unit));
  for (const auto read : {&CalibrationReader::ReadCoefficients, &CalibrationReader::ReadCovariance,
                          &CalibrationReader::ReadResidual, &CalibrationReader::ReadRange}) {
    RETURN_IF_ERROR((this->*read)());
  }
  calibration_.source = json_;
  return std::move(calibration_);
}

double RadFrom(const std::string& angle_unit) { return angle_unit == "deg" ? kRadFromDeg : 1.0; }

}  // namespace

double Calibration::Angle(double reading) const {
  double sum = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * reading + coefficients[k];
  return sum * RadFrom(angle_unit);
}

double Calibration::Slope(double reading) const {
  double sum = 0;
  for (std::size_t k = coefficients.size(); k-- > 1;) sum = sum * reading + static_cast<double>(k) * coefficients[k];
  return sum * RadFrom(angle_unit);
}

double Calibration::Reading(double angle, double near) const {
  constexpr int kMaxSteps = 50;
  constexpr double kSmallStep = 1e-12;
  double reading = near;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double change = (angle - Angle(reading)) / Slope(reading);
    if (!std::isfinite(change)) return near;
    reading += change;
    if (std::abs(change) <= kSmallStep * (1 + std::abs(reading))) break;
  }
  return reading;
}

double Calibration::RadFromUnit() const { return RadFrom(angle_unit); }

Result<Calibration> ParseCalibration(std::string_view text, const std::string& name) {
  ASSIGN_OR_RETURN(const Json json, ParseJsonObject(text, name, "calibration", kForm));
  return CalibrationReader(json, name).Read();
}

Result<Calibration> ReadCalibration(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const std::string text, ReadFile(path, "calibration", kMaxJsonBytes));
  return ParseCalibration(text, path.string());
}

}  // namespace pendulum
