// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/systematic_errors.h"

#include "pendulum/base/distributions.h"

namespace pendulum {

std::string_view ErrorSourceName(ErrorSource source) {
  switch (source) {
    case ErrorSource::kRig: return "rig";
    case ErrorSource::kCalibration: return "calibration";
    case ErrorSource::kClock: return "clock";
    case ErrorSource::kSensor: return "sensor";
    case ErrorSource::kInconstancy: return "inconstancy";
    case ErrorSource::kFrictionLaw: return "friction_law";
  }
  return "";
}

double SystematicErrors::OfMotion() const {
  return std::hypot(Of(ErrorSource::kInconstancy), Of(ErrorSource::kFrictionLaw));
}

void SystematicErrors::Add(ErrorSource source, double std_dev) {
  double& own = std_dev_[static_cast<std::size_t>(source)];
  own = std::hypot(own, std_dev);
}

SystematicErrors SystematicErrors::Scaled(double factor) const {
  SystematicErrors scaled = *this;
  for (double& std_dev : scaled.std_dev_) std_dev *= std::abs(factor);
  return scaled;
}

std::optional<double> SystematicErrors::Total() const {
  double squares = 0;
  for (const double std_dev : std_dev_) squares += std_dev * std_dev;
  return squares > 0 ? std::optional(std::sqrt(squares)) : std::nullopt;
}

std::optional<double> TotalStdError(const std::optional<double>& std_error, const SystematicErrors& systematic) {
  if (!std_error) return std::nullopt;
  return std::hypot(*std_error, systematic.Total().value_or(0));
}

std::optional<double> TotalIntervalEnd(IntervalEnd end, double estimate, const std::optional<double>& end95,
                                       const SystematicErrors& systematic) {
  const std::optional<double> total = systematic.Total();
  if (!end95 || !total) return end95;
  const double distance = std::hypot(*end95 - estimate, kNormal95 * *total);
  return end == IntervalEnd::kLower ? estimate - distance : estimate + distance;
}

}  // namespace pendulum
