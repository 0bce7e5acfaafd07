// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum::csv {

/// The sampling rate [Hz] that a line above a table states: `fs: 50 Hz`, `Sample Rate (Hz),50`, `Abtastrate = 1 kHz`,
/// `dt = 0.02 s`, `interval_ms: 20`, `FPS: 30`; 0 for other lines.
double SampleRateIn(std::string_view line);

}  // namespace pendulum::csv
