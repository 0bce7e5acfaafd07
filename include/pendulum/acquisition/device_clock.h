// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace pendulum {

/// One instant on two clocks: when the last sample of a frame was taken, by the logger's clock, and when the host
/// received the frame.
struct Arrival {
  double device_time, host_time;  ///< s
};

/// Relative standard deviation of a ceramic resonator, the clock of an Uno or Mega. It is within 0.5 % of its nominal
/// frequency.
inline constexpr double kResonatorStdDev = 0.003;

/// The rate of a device's clock.
struct DeviceClock {
  double scale = 1;                   ///< True seconds per second of the device.
  double std_dev = kResonatorStdDev;  ///< Standard deviation of the scale.
  bool is_measured = false;           ///< If false, scale and std_dev are those of any resonator.
  /// The measured scale is impossible for a resonator (kMaxDeviation). One of the clocks is wrong, so it is not used.
  bool is_implausible = false;
};

/// The scale of a resonator differs from 1 by less than this.
inline constexpr double kMaxDeviation = 0.02;

/// Compares the device's clock with the host's, MODEL.md eqs. (12.1) and (12.2). A frame is never early and usually a
/// little late. Therefore only the earliest arrival in each part of the run (10 to 32 parts) counts, and a line is
/// fitted through these. Parts in which every frame was late are left out. The clock counts as not measured if there
/// are fewer than 150 arrivals or 10 s, or if the result is less certain than the rate of any resonator.
///
/// arrivals      N, both times increasing.
/// polling       s, the grid to which the host's times may be rounded up; a coarser grid may go undetected.
/// host_std_dev  Relative standard deviation of the rate of the host's clock.
DeviceClock FitDeviceClock(std::span<const Arrival> arrivals, double polling, double host_std_dev);

/// Interval at which a host polls a full-speed USB device, such as an Arduino [s].
inline constexpr double kUsbPolling = 1e-3;

/// Relative standard deviation of the rate of this computer's monotonic clock: 10e-6 if the system reports that a time
/// server corrects it, otherwise 30e-6 as for a quartz.
double HostClockStdDev();

}  // namespace pendulum
