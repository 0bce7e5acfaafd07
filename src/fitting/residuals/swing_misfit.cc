// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/swing_misfit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include "pendulum/base/distributions.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLevel = 1e-3;         // of each test
constexpr std::size_t kMinPeriods = 9;  // fewer are too few to tell a harmonic from what lies beside it
constexpr double kMinSamples = 10;      // in a period

/// Times of the trajectory's maxima [s], each from a parabola through three samples.
std::vector<double> Maxima(const VectorXd& time, const VectorXd& fitted) {
  std::vector<double> maxima;
  for (Index i = 1; i + 1 < fitted.size(); ++i) {
    const double rise = fitted[i] - fitted[i - 1], fall = fitted[i] - fitted[i + 1];
    if (!(rise > 0 && fall >= 0)) continue;
    const double before = time[i] - time[i - 1], after = time[i + 1] - time[i];
    const double slope = rise / before * after - fall / after * before;
    const double bend = rise / before + fall / after;
    maxima.push_back(time[i] + 0.5 * slope / bend);
  }
  return maxima;
}

/// The residuals between the first and the last maximum of the swing, over its phase, and their sums of squares.
struct PhasedResiduals {
  /// Samples of one part of the recording.
  struct Part {
    double squares = 0, samples = 0;

    void Add(double residual) {
      squares += residual * residual;
      ++samples;
    }
  };

  std::vector<double> phase;  // in periods from the first maximum
  std::vector<double> z;
  double periods = 0;
  std::vector<Part> parts;  // each period, and what is before and after them
};

PhasedResiduals OverPhase(const VectorXd& time, const VectorXd& z, const std::vector<double>& maxima) {
  PhasedResiduals phased;
  phased.periods = static_cast<double>(maxima.size() - 1);
  phased.parts.resize(maxima.size() + 1);
  std::size_t period = 0;
  for (Index i = 0; i < time.size(); ++i) {
    if (time[i] < maxima.front() || time[i] >= maxima.back()) {
      phased.parts[maxima.size() - (time[i] < maxima.front() ? 1 : 0)].Add(z[i]);
      continue;
    }
    while (time[i] >= maxima[period + 1]) ++period;
    phased.parts[period].Add(z[i]);
    phased.phase.push_back(static_cast<double>(period) +
                           (time[i] - maxima[period]) / (maxima[period + 1] - maxima[period]));
    phased.z.push_back(z[i]);
  }
  return phased;
}

/// The mean power of the residuals at 2 width + 1 frequencies about a harmonic, one cycle of all periods apart.
double PowerAbout(const PhasedResiduals& residuals, double harmonic, int width) {
  double sum = 0;
  for (int k = -width; k <= width; ++k) {
    const double frequency = harmonic + k / residuals.periods;
    std::complex<double> amplitude = 0;
    for (std::size_t i = 0; i < residuals.z.size(); ++i)
      amplitude += std::polar(residuals.z[i], -2 * kPi * frequency * residuals.phase[i]);
    sum += std::norm(amplitude);
  }
  return sum / (2 * width + 1);
}

/// Whether the residuals have more power at a harmonic than halfway to the next ones on both sides.
bool PreferHarmonics(const PhasedResiduals& residuals) {
  constexpr int kMostHarmonics = 6;
  constexpr int kWidth = 2;  // a misfit changes slowly from period to period
  const double per_period = static_cast<double>(residuals.z.size()) / residuals.periods;
  const int harmonics = std::min(kMostHarmonics, static_cast<int>(per_period / 3) - 1);
  const int beside = std::clamp(static_cast<int>(residuals.periods / 4) - 1, kWidth, 6);
  double below = PowerAbout(residuals, 0.5, beside);
  for (int harmonic = 1; harmonic <= harmonics; ++harmonic) {
    const double above = PowerAbout(residuals, harmonic + 0.5, beside);
    const double ratio = PowerAbout(residuals, harmonic, kWidth) / std::sqrt(below * above);
    if (FisherTail(ratio, 2 * (2 * kWidth + 1), 4 * (2 * beside + 1)) < kLevel / harmonics) return true;
    below = above;
  }
  return false;
}

/// Whether the residuals of a period, or before or after all of them, scatter more than stationary noise does.
bool ChangeSize(const PhasedResiduals& residuals, double squared_inflation) {
  double squares = 0;
  for (const double z : residuals.z) squares += z * z;
  const double variance = squares / static_cast<double>(residuals.z.size());
  const auto tests = static_cast<double>(residuals.parts.size());
  return std::ranges::any_of(residuals.parts, [&](const PhasedResiduals::Part& part) {
    if (part.samples == 0) return false;
    const double freedom = part.samples / squared_inflation;
    return part.squares / (variance * squared_inflation) > ChiSquareQuantile(1 - kLevel / tests, freedom);
  });
}

}  // namespace

bool IsSwingMisfit(const VectorXd& time, const VectorXd& fitted, const VectorXd& z,
                   std::optional<double> squared_inflation) {
  const std::vector<double> maxima = Maxima(time, fitted);
  if (maxima.size() < kMinPeriods + 1) return true;
  const PhasedResiduals residuals = OverPhase(time, z, maxima);
  if (static_cast<double>(residuals.z.size()) < kMinSamples * residuals.periods) return true;
  return PreferHarmonics(residuals) || (squared_inflation && ChangeSize(residuals, std::max(*squared_inflation, 1.0)));
}

}  // namespace pendulum
