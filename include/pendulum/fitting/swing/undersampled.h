// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/fitting/swing/fit_swing.h"

namespace pendulum {

/// Frequency of small swings by a rig's geometry, sqrt(G / I_O) / 2π [Hz, true seconds]; none without an inertia.
std::optional<double> ExpectedFrequency(const std::optional<Rig>& rig);

/// Whether turning points cannot be relied upon: fewer than 7 samples in a period 15 % shorter than the rig lets
/// expect; without that, below 6 Hz, 7 in the seen period, or where one of up to 3 Hz (3 cm long) would look the same.
bool IsUndersampled(const Recording& recording, const std::optional<Rig>& rig);

/// All of an undersampled recording, or its window, as one swing. `begins` and `ends` say so.
FreeSwing WholeRecording(const Recording& recording);

/// Fits a swing from each local minimum of a scan over frequency (ScanFrequencies) and keeps the likeliest: within 15 %
/// of what the rig's geometry lets expect, within bounds of inertia, else up to 3 Hz. In motion from the first reading
/// that is surely none of a hold. The trajectory needs no Nyquist rate, but other frequencies may explain the samples
/// too: those within 9 of -2 log L are listed (warning `ambiguous_frequency`), and the fit ends kNotIdentifiable
/// without errors. So it does where nothing bounds the frequency, unless the slowest is sampled well and no other
/// nearly explains the readings, and where a frequency beyond the rig's 15 % fits far better. kFailedPrecondition: a
/// release asked for, a constant reading. Others as FitRecording. Cost: two dozen fits.
Result<SwingFit> FitUndersampled(Recording recording, FreeSwing swing, const FitOptions& options);

}  // namespace pendulum
