// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/linear_fit.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// The smallest double above `time`; a part that ends at `time` does not contain it.
double NextDoubleAfter(double time);

/// A second fit to a part of the recording.
struct PartFit {
  Recording part;
  Eigen::Index first = 0;  ///< Index of the part's first sample among the used samples.
  FitReport fit;
  std::string reason;  ///< Why there is no fit; empty if it converged.

  bool converged() const { return reason.empty(); }
};

/// Parts of a fitted recording. Each part is fitted with a separate start; its search begins at the whole fit's motion.
/// Keeps references to the arguments.
class Parts {
 public:
  Parts(const Recording& used, const FitReport& fit, const FitOptions& options);

  /// Fits samples from <= time <= to [s, file's clock], with the parameters `held` fixed at the whole fit's estimates.
  PartFit Fit(double from, double to, const std::vector<std::string_view>& held) const;

  NoiseModel NoiseOf(const FitReport& fit) const;

  /// The whole fit's noise, with one σ of the residuals of all `fits`.
  NoiseModel PooledNoise(const std::vector<PartFit>& fits) const;

  /// The autocorrelation of the residuals of parts that follow each other, with that noise. The residuals of the whole
  /// fit would include its misfit, and one part alone may be too short to show any autocorrelation. If the residuals of
  /// the whole fit are not white, white is no candidate.
  Autocorrelation PooledAutocorrelation(const NoiseModel& noise, const std::vector<PartFit>& fits,
                                        const std::vector<LinearFit>& linear) const;

  /// Amplitude [rad] of the whole fit's swing at a time [s, file's clock]; 0 if the trajectory cannot be computed.
  double Amplitude(double time) const;

 private:
  double Instant(double time) const { return used_.clock_scale * (time - used_.time[0]); }

  const Recording& used_;
  const FitReport& fit_;
  FitOptions options_;
  std::optional<Trajectory> motion_;
  double inertia_ = 0;  // s²
  double low_ = -kInfinity, high_ = kInfinity;
};

inline constexpr std::size_t kMinHalfSwings = 6;

/// With fewer windows there is no trend.
inline constexpr std::size_t kMinWindows = 3;

/// Cuts half swings into parts of equal ∫ amplitude^(2/3) dt (MODEL.md eq. (9.6)). Inertia and friction then have about
/// equal errors in all parts, because their variances are proportional to 1 / (amplitude² duration³). Returns indices
/// into `ends` [s, file's clock], which has at least parts · kMinHalfSwings + 1 elements. Every part has at least
/// kMinHalfSwings half swings, three periods.
std::vector<std::size_t> CutEvenly(const std::vector<double>& ends, std::size_t parts, const Parts& fits);

/// "7 half swings are too few for ...".
std::string TooFewHalfSwings(const std::vector<double>& ends, const std::string& what, std::size_t needed);

}  // namespace pendulum
