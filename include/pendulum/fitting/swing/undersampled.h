// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/base/warning.h"
#include "pendulum/fitting/swing/fit_swing.h"

namespace pendulum {

/// Frequency of small swings from a rig's geometry, sqrt(G / I_O) / 2π [Hz, true seconds]; std::nullopt without an
/// inertia.
std::optional<double> ExpectedFrequency(const std::optional<Rig>& rig);

/// Whether a recording is sampled too slowly to find turning points reliably. With a prediction from the rig: fewer
/// than 7 samples per period at a frequency 15 % above the prediction. Without a prediction: the sample rate is below 6
/// Hz, and the observed period has fewer than 7 samples. It is also true with fewer than 12 samples if there is no free
/// swing, or if the samples could be an alias of a frequency up to 3 Hz (a pendulum 3 cm long).
bool IsUndersampled(const Recording& recording, const std::optional<Rig>& rig);

/// The assumption that the samples show each swing; std::nullopt if the rig or the options determine the
/// frequency, or if no faster pendulum would look the same. half_period [s] on the recording's clock.
std::optional<Warning> AssumedFrequency(const Recording& used, double half_period, const FitOptions& options);

/// For a fit that leaves more than noise although the samples show its periods: FitUndersampled of the same readings,
/// unless it finds the same frequency or nothing at all.
std::optional<SwingFit> FitFasterAlias(const SwingFit& slow, const FitOptions& options);

/// All of an undersampled recording, or of its window, as one swing; `begins` says that it is undersampled.
FreeSwing WholeRecording(const Recording& recording);

/// Fits a swing from each local minimum of a scan over frequency (ScanFrequencies) and keeps the likeliest.
///
/// The scan covers 15 % around the frequency that the rig's geometry predicts, or the bounds of the inertia; otherwise
/// up to 3 Hz, or to half the sampling rate for a linear oscillator. The fit begins in motion, at the first reading
/// that certainly follows a hold. The trajectory needs no Nyquist rate, but other frequencies may explain the samples
/// too. The fit ends kNotIdentifiable without errors, with the warning `ambiguous_frequency`, in these cases:
/// - -2 log L of another frequency is within 9 of the best one, and the samples do not show either of them, with at
///   least 8 samples per period. The message lists these frequencies.
/// - The samples show only two phases of the swing.
/// - Neither rig nor bounds limit the frequency. Exceptions: the samples show the slowest solution, or they are nearly
///   as dense and no other frequency explains the readings nearly as well.
/// - A frequency outside the rig's 15 % fits far better.
///
/// kFailedPrecondition: a release is requested, the reading is constant, or it is an acceleration along the rod. Other
/// errors as FitRecording. Cost: two dozen fits.
Result<SwingFit> FitUndersampled(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
