// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

/// Rebuilds the uniform clock of a device from stamps that a host gave to packets of rows.
namespace pendulum {

/// Rows and their stamps, which do not decrease.
struct StampedRows {
  const Eigen::VectorXd& time;   ///< N x 1, in any unit.
  const Eigen::VectorXd& value;  ///< N x 1, of a smooth motion.
  double grid = 0;               ///< Spacing of the stamps, in the unit of time; 0: not known.
};

/// How the rows are grouped. The rows of a packet share a stamp, or have stamps much closer than the sampling interval.
struct Packets {
  Eigen::Index count = 0;
  double rows = 0;               ///< Median number of rows in a packet.
  bool has_inner_steps = false;  ///< Stamps increase within packets.
};

/// A uniform clock: row i was sampled at start + interval * i.
struct PacketClock {
  double start = 0;
  double interval = 0;  ///< > 0
  double std_dev = 0;   ///< Relative standard error of the interval.
};

enum class PacketClockVerdict {
  kFound,
  kTooFewPackets,  ///< Nothing contradicts uniform sampling, but too few packets prove it.
  kUneven,         ///< The rate changes, or rows are missing.
  kTrueStamps,     ///< The stamps may be right: the values do not show that the rows are sampled uniformly.
};

struct PacketClockSearch {
  PacketClockVerdict verdict = PacketClockVerdict::kUneven;
  PacketClock clock = {};
  Eigen::Index uneven_from = 0, uneven_to = 0;  ///< For kUneven: rows between which the rate differs most.
};

/// The packets of rows. Cost: one pass.
Packets FindPackets(const Eigen::VectorXd& time);

/// Finds the clock of rows that were sampled uniformly and stamped in packets. A stamp is late by a latency that is
/// never negative, and short for some packets. The clock therefore follows the lower envelope of the stamps: its
/// interval is that of a line through the earliest packet of each part of the recording, the base line. Packets of rows
/// that share a rounded stamp are treated in the same way, with the mean of the packets instead of the earliest.
///
/// kFound only if nothing contradicts uniform sampling without lost rows. The base line must be as straight as the
/// scatter of the packets allows, latencies as long as a packet must not come from lost packets, and the values must
/// change between packets as within packets. If stamps increase within packets, the values must prove this. Rows that
/// the device itself skips at regular intervals cannot be detected.
///
/// The standard error covers the scatter, the grid, and what lost rows could hide in the scatter.
PacketClockSearch FindPacketClock(const StampedRows& rows);

}  // namespace pendulum
