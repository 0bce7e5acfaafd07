// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace pendulum {

/// What systematic errors come from.
enum class ErrorSource { kRig, kCalibration, kClock, kSensor, kInconstancy, kFrictionLaw };

inline constexpr std::array kErrorSources = {ErrorSource::kRig,         ErrorSource::kCalibration,
                                             ErrorSource::kClock,       ErrorSource::kSensor,
                                             ErrorSource::kInconstancy, ErrorSource::kFrictionLaw};

/// "rig", "calibration", "clock", "sensor", "inconstancy", "friction_law".
std::string_view ErrorSourceName(ErrorSource source);

/// How an uncertainty was evaluated (GUM, JCGM 100:2008, 0.7): by statistics of observations, or by other means.
enum class EvaluationType { kA, kB };

/// One line of the error budget: a single cause, and what it adds to the errors of a fit.
struct BudgetLine {
  std::optional<ErrorSource> source;  ///< The source to which it belongs; absent: noise.
  EvaluationType type = EvaluationType::kA;
  std::string name;               ///< "rod_length", "gain", "clock", "calibration"
  std::string origin;             ///< Of its size: "assumed for a potentiometer", "stated with the rig"
  bool is_assumed = false;        ///< Nobody stated its size.
  std::optional<double> std_dev;  ///< Its size before the recording; absent if it is not one number.
  std::string unit;               ///< Of std_dev; "1" if relative.
  Eigen::VectorXd parts;          ///< P, the standard deviation that it alone causes in each parameter.
};

/// The systematic errors of one quantity: a standard deviation for each source, in the quantity's unit. Sources are
/// independent of each other.
class SystematicErrors {
 public:
  double Of(ErrorSource source) const { return std_dev_[static_cast<std::size_t>(source)]; }

  /// The errors by which recordings of one rig differ although nothing outside them does: parameters that change, and
  /// friction of another law.
  double OfMotion() const;

  /// Adds an independent error of the source in quadrature. std_dev >= 0
  void Add(ErrorSource source, double std_dev);

  /// The errors of this quantity times a factor.
  SystematicErrors Scaled(double factor) const;

  /// All sources in quadrature; absent if no source has an error.
  std::optional<double> Total() const;

 private:
  std::array<double, kErrorSources.size()> std_dev_{};
};

/// The statistical and the systematic error in quadrature. Absent if there is no statistical error, because a total
/// without it would be too small.
std::optional<double> TotalStdError(const std::optional<double>& std_error, const SystematicErrors& systematic);

enum class IntervalEnd { kLower, kUpper };

/// An end of the total 95 % interval: the distance from the estimate to this end of the statistical interval, and 1.96
/// systematic errors, in quadrature. Absent if the statistical interval has no such end.
std::optional<double> TotalIntervalEnd(IntervalEnd end, double estimate, const std::optional<double>& end95,
                                       const SystematicErrors& systematic);

/// The ends of an interval that may be open.
struct IntervalEnds95 {
  std::optional<double> lower, upper;
};

/// The total 95 % interval of a ParameterEstimate or DerivedQuantity, in its unit. It ends at the quantity's bounds:
/// friction is never negative.
template <typename Estimated>
IntervalEnds95 TotalInterval95(const Estimated& quantity) {
  const auto end = [&](IntervalEnd which, const std::optional<double>& end95) {
    return TotalIntervalEnd(which, quantity.estimate, end95, quantity.systematic);
  };
  const auto& possible = [&]() -> const auto& {
    if constexpr (requires { quantity.info; }) {
      return quantity.info;
    } else {
      return quantity.range;
    }
  }
  ();
  IntervalEnds95 ends = {end(IntervalEnd::kLower, quantity.lower95), end(IntervalEnd::kUpper, quantity.upper95)};
  if (ends.lower) ends.lower = std::max(*ends.lower, std::min(possible.lower, quantity.estimate));
  if (ends.upper) ends.upper = std::min(*ends.upper, std::max(possible.upper, quantity.estimate));
  return ends;
}

}  // namespace pendulum
