// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/fitting/swing/fit_swing.h"

namespace pendulum {

/// Frequency of small swings from a rig's geometry, sqrt(G / I_O) / 2π [Hz, true seconds]; std::nullopt without an
/// inertia.
std::optional<double> ExpectedFrequency(const std::optional<Rig>& rig);

/// Whether turning points are unreliable: fewer than 7 samples in a period 15 % shorter than the rig predicts. Without
/// a prediction, below 6 Hz: fewer than 7 samples in the observed period, or aliasing of a frequency up to 3 Hz (a
/// pendulum 3 cm long) would look the same.
bool IsUndersampled(const Recording& recording, const std::optional<Rig>& rig);

/// All of an undersampled recording, or its window, as one swing; `begins` and `ends` give this reason.
FreeSwing WholeRecording(const Recording& recording);

/// Fits a swing from each local minimum of a scan over frequency (ScanFrequencies) and keeps the likeliest.
///
/// The scan covers 15 % around the frequency that the rig's geometry predicts, or the bounds of the inertia; otherwise
/// up to 3 Hz. The swing is in motion from the first reading that certainly follows a hold. The trajectory needs no
/// Nyquist rate, but other frequencies may explain the samples too: those within 9 of -2 log L are listed (warning
/// `ambiguous_frequency`). Then the fit ends kNotIdentifiable without errors. It ends so as well if nothing bounds the
/// frequency, unless the slowest solution is well sampled and no other nearly explains the readings. The third case is
/// a far better fit at a frequency outside the rig's 15 %.
///
/// kFailedPrecondition: a release is requested, or the reading is constant. Other errors as FitRecording.
/// Cost: two dozen fits.
Result<SwingFit> FitUndersampled(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
