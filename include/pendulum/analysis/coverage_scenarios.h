// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

/// What a parameter's row in a coverage study must satisfy to pass.
struct CoverageRule {
  /// The binomial 95 % interval of the coverage must overlap [lowest, highest]. highest = 1: intervals may be too wide.
  double lowest = 0.93, highest = 0.97;
  double largest_error = 1.1;  ///< Upper limit of rms error / Cramér-Rao bound.
};

/// The rule for a parameter whose true value is at its bound; its error has no Cramér-Rao bound.
inline constexpr CoverageRule kAtBoundRule = {0.94, 0.99};

/// A kind of recording with known true values, its fit options, and the rules for its intervals.
struct CoverageScenario {
  std::string name;         ///< As in --scenario: words and numbers, "white_0.25".
  std::string description;  ///< One line.
  SyntheticOptions run;     ///< Torques and inertia divided by G; ScenarioRun varies some values between recordings.
  FitOptions fit;
  CoverageRule rule;
  // Like the rig in `fit`, these may have errors; DrawErrors draws them for each recording.
  double clock_std_dev = 0;  ///< Relative, of the clock of time stamps.
  std::optional<Calibration> calibration =
      std::nullopt;          ///< Of readings in whole counts; `run` simulates angles without counts.
  SensorErrors sensor = {};  ///< Plausible sizes of what the sensor does; `run` simulates angles without counts.
  double count = 0;          ///< Spacing of the readings that such a sensor gives [rad].
};

/// All scenarios. They simulate the rig of datasets/textbook_rig.json. Most have viscous and dry friction and a
/// potentiometer of 0.1985 deg per count, sampled at 100 Hz. Others have readings without counts, or another sensor: a
/// gyro, an accelerometer, a camera or an encoder.
std::vector<CoverageScenario> CoverageScenarios();

/// The scenarios of a comma-separated list of names, "white_2.5,no_noise", in that order, or `all`. kInvalidArgument:
/// an empty list, an unknown name (the message lists the known names) or a repeated name.
Result<std::vector<CoverageScenario>> FindCoverageScenarios(const std::string& names);

/// The options of the recording with this seed. Its noise is independent of other seeds. The zero is shifted by at most
/// half a count and the release by at most half a sampling interval. The parameters of a sensor that has priors are
/// drawn from the priors.
SyntheticOptions ScenarioRun(const CoverageScenario& scenario, std::uint64_t seed);

/// True values behind one recording that its user knows only within standard errors.
struct DrawnErrors {
  double torque = 1;                ///< The true G over the rig's.
  double clock = 1;                 ///< True seconds per second of the recording.
  std::vector<double> calibration;  ///< The true coefficients; empty without a calibration.
  std::vector<double> sensor;  ///< The sizes of all effects, in the order of kSensorEffects; empty if there are none.
};

/// Draws the errors for this seed from their normal distributions.
DrawnErrors DrawErrors(const CoverageScenario& scenario, std::uint64_t seed);

/// The recording as its user gets it: in whole counts of the true calibration, converted by the known one, with time
/// stamps of a clock whose error is unknown; or as a sensor reads it that does what was drawn, to whole counts.
Recording WithErrors(Recording recording, const CoverageScenario& scenario, const DrawnErrors& drawn);

}  // namespace pendulum
