// SPDX-License-Identifier: Apache-2.0
// The flags of RunFlags, for the mains of tools that fit recordings: included once, by the main.
#pragma once

#include <string>

#include <gflags/gflags.h>

#include "pendulum/model/motion_model.h"
#include "pendulum/request/run_flags.h"

inline const std::string kModelHelp = "Model of the motion, one of " + pendulum::MotionModelNames() +
                                      ", several of them between commas to compare, or all; default coulomb.";

DEFINE_string(rig, "", "Rig file (JSON, SI units) that gives the gravity torque; without it torques are in its units.");
DEFINE_string(calibration, "",
              "Calibration file (JSON) that turns counts or volts into an angle; default the file's own.");
DEFINE_string(model, "coulomb", kModelHelp.c_str());
DEFINE_string(start, "auto", "How the recording begins: auto (the data tell), release or moving; default auto.");
DEFINE_string(release, "", "Which free swing of a recording to fit: a number from 1, or all; default the longest.");
DEFINE_string(from, "", "Start of the window to fit, s on the file's clock; default where the free swing begins.");
DEFINE_string(to, "", "End of the window to fit, s on the file's clock; default where the free swing ends.");
DEFINE_string(fix, "", "Parameters to hold, name=value,... in SI (rad, s; torques as in the report); default none.");
DEFINE_string(init, "", "Where parameters begin, name=value,... as in --fix; default where the data say.");
DEFINE_string(bounds, "", "Bounds of parameters, name=low:high,... as in --fix, either may be left out; default none.");
DEFINE_string(prior, "", "What is known beforehand, name=mean:std_dev,... as in --fix; default nothing.");
DEFINE_string(time_column, "",
              "Column of times, name or number from 1 on, with :s, :ms or :us where the name tells no "
              "unit; none takes --sample_rate_hz instead; default by name.");
DEFINE_string(value_column, "",
              "Column of the angle or rate, name or number from 1 on; default by the unit in its name.");
DEFINE_string(unit, "",
              "Unit of the values: rad, deg, rad_s, deg_s, counts, volts, m_s2, px, m, cm or mm; default that in the "
              "column's name.");
DEFINE_string(sample_rate_hz, "", "Samples per second of a file without times; default its line # sample_rate_hz.");
DEFINE_string(resolution, "",
              "Spacing of the sensor's levels, in the file's unit; 0 is none; default the file's, or found in it.");
DEFINE_string(range, "", "What the sensor can show, low,high in the file's unit; readings there are censored.");
DEFINE_string(noise, "auto",
              "Noise of the readings: gaussian, quantized (rounded to levels), edges (rows that come when a count "
              "changes) or auto (edges of such rows, else quantized where rounding matters); default auto.");
DEFINE_string(loss, "none", "Robust alternative for recordings with outliers: huber, student or none; default none.");
DEFINE_string(interval, "auto",
              "95 % intervals by covariance, profile, bootstrap or auto (profile near a bound); default auto.");
DEFINE_string(seed, "", "Seed of the bootstrap and of posterior draws; default 1.");
DEFINE_string(
    threads, "",
    "Threads of the bootstrap, of long recordings and of several, 0 for all cores; the result does not depend on it; "
    "default 0.");

namespace pendulum {

/// The current values of the flags.
inline RunFlags CurrentRunFlags() {
  RunFlags flags;
  flags.rig = FLAGS_rig;
  flags.calibration = FLAGS_calibration;
  flags.model = FLAGS_model;
  flags.start = FLAGS_start;
  flags.release = FLAGS_release;
  flags.from = FLAGS_from;
  flags.to = FLAGS_to;
  flags.fix = FLAGS_fix;
  flags.init = FLAGS_init;
  flags.bounds = FLAGS_bounds;
  flags.prior = FLAGS_prior;
  flags.time_column = FLAGS_time_column;
  flags.value_column = FLAGS_value_column;
  flags.unit = FLAGS_unit;
  flags.sample_rate_hz = FLAGS_sample_rate_hz;
  flags.resolution = FLAGS_resolution;
  flags.range = FLAGS_range;
  flags.noise = FLAGS_noise;
  flags.loss = FLAGS_loss;
  flags.interval = FLAGS_interval;
  flags.seed = FLAGS_seed;
  flags.threads = FLAGS_threads;
  return flags;
}

}  // namespace pendulum
