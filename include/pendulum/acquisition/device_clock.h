// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace pendulum {

/// An instant on two clocks: when a frame's last sample was taken, by the logger's clock, and when the host had it.
struct Arrival {
  double device_time, host_time;  ///< s
};

/// Of a ceramic resonator, which is what an Uno or Mega counts with: within 0.5 % of its nominal frequency.
inline constexpr double kResonatorStdDev = 0.003;

/// How long a second of a device is.
struct DeviceClock {
  double scale = 1;                   ///< True seconds in one of the device's.
  double std_dev = kResonatorStdDev;  ///< Of the scale.
  bool is_measured = false;           ///< Else it is what is known of any resonator.
  /// What was measured is beyond any resonator (kMostDeviation): one of the clocks is wrong, and it is not used.
  bool is_implausible = false;
};

inline constexpr double kMostDeviation = 0.02;

/// The device's clock against the host's, MODEL.md eqs. (65) and (66): a frame is never early and mostly a little late,
/// so of each stretch of the run (10 to 32 of them) only the earliest arrival counts, and a line goes through these;
/// stretches in which everything was late are left out. Not measured where there are fewer than 150 arrivals or 10 s,
/// or the result would be no better than what is known of any resonator. arrivals      N, both times rising. polling s,
/// the grid that the host's times may be rounded up to; a coarser one may pass unseen. host_std_dev  Of the rate of the
/// host's own clock, relative.
DeviceClock FitDeviceClock(std::span<const Arrival> arrivals, double polling, double host_std_dev);

/// How often a host asks a USB device of full speed, such as an Arduino, s.
inline constexpr double kUsbPolling = 1e-3;

/// Relative standard deviation of the rate of this computer's monotonic clock: 10e-6 where the system says that it is
/// kept in step with a time server, which slews it, else 30e-6, that of a quartz.
double HostClockStdDev();

}  // namespace pendulum
