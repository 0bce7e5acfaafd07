// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/start/frequency_scan.h"

namespace pendulum {

inline constexpr double kTurn = 2 * kPi;

/// No recorded pendulum is shorter than 3 cm [Hz].
inline constexpr double kFastestHz = 3;

/// s, true seconds
double DurationOf(const Recording& recording);

/// Hz, true seconds
double SampleRateOf(const Recording& recording);

std::string Hz(double frequency);

/// Whether the law of gravity is linear, so that no length follows from the period.
bool IsLinear(const FitOptions& options);

/// Whether rig or options say how large the inertia is.
bool IsFrequencyKnown(const FitOptions& options);

/// The frequencies that a recording may have.
struct AllowedFrequencies {
  FrequencyRange range;  ///< rad/s
  bool bounded = false;  ///< Whether rig or user limit it; otherwise `range` is that of real pendulums.
};

/// 15 % around the rig's frequency, the user's fixed inertia or its bounds; otherwise up to 3 Hz, or 15 % around the
/// frequency of the user's start value. A linear oscillator has no fastest frequency, and faster ones give exactly the
/// same readings, so without bounds only those below half the sampling rate are searched.
AllowedFrequencies FindAllowedFrequencies(const Recording& used, const FitOptions& options);

/// A fit from one local minimum of the scan.
struct Alias {
  StartValues start;
  FitReport fit;
  double frequency = 0;  ///< Hz, small swings, true seconds
  double likelihood() const { return fit.statistics.log_likelihood; }
};

/// Fits from all local minima with a permitted frequency, the likeliest first, without duplicates.
Result<std::vector<Alias>> FitAliases(const Recording& used, const AllowedFrequencies& allowed, FitOptions options);

/// The likeliest fit and those whose -2 log L is within `within` of it, in the order of `aliases`.
std::vector<const Alias*> NearlyAsGood(const std::vector<Alias>& aliases, double within);

/// "0.079 kg m^2 (0.76 Hz), 0.0456 kg m^2 (1 Hz)": first those of which at least three samples show each period.
std::string ListOf(std::vector<const Alias*> aliases, double rate);

/// The flag that limits the frequency to 15 % around `frequency` [Hz]: "--bounds inertia=0.06:0.11".
std::string BoundsFlag(double frequency, const FitOptions& options);

}  // namespace pendulum
