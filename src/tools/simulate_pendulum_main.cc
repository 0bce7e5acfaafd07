// SPDX-License-Identifier: Apache-2.0
// Simulates recordings of a pendulum's free swing and writes their true parameters, or predicts the standard errors of
// a fit: flags, files and exit codes.
#include <optional>
#include <string>
#include <vector>

#include "pendulum/analysis/plan.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/model/gravity/registry.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/report/plan_text.h"
#include "pendulum/request/planned_budget.h"
#include "tools/output.h"
#include "tools/run_tool.h"
#include "tools/simulate_pendulum_files.h"
#include "tools/simulate_pendulum_options.h"

namespace pendulum {
namespace {

std::string Usage() {
  return "Simulates recordings of a pendulum's free swing and writes their true parameters.\n"
         "\n"
         "  simulate_pendulum --model coulomb --rig rig.json --out run.csv --truth truth.json \\\n"
         "    --set inertia=0.079,viscous=0.003,coulomb=0.004,release_angle=0.423,release_time=1.9\n"
         "  simulate_pendulum --rig rig.json --out runs/run.csv --count 1000 --manifest runs.csv \\\n"
         "    --set inertia=0.079,release_angle=0.423,release_time=1.9 --spread inertia=0.002,viscous=0.001\n"
         "  simulate_pendulum --plan --rig rig.json --set inertia=0.079,release_angle=0.423,release_time=0 --noise "
         "0.05\n"
         "\n"
         "Models: " +
         MotionModelNames() +
         ".\n"
         "Exit codes: 0 done, 2 wrong flags, 3 rig or sensor not found, 4 unreadable rig or sensor, 5 the pendulum\n"
         "never moves, 70 a bug, 73 an output cannot be written.\n"
         "\n";
}

using Flags = SimulateFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  static const std::string gravity =
      "Law of the restoring torque: one of " + NameList(GravityModels::kNames) + "; default the model's own.";
  return {
      {"model", &Flags::model, "Model of the motion, one of the models named above; default coulomb."},
      {"gravity", &Flags::gravity, gravity.c_str()},
      {"rig", &Flags::rig,
       "Rig file (JSON, SI units); default none, with torques and inertia in units of the gravity torque."},
      {"set", &Flags::set,
       "True parameters, name=value,... in SI: inertia (default the rig's), the model's friction (default 0), either "
       "release_angle and release_time or initial_angle and initial_rate, and the parameters of the sensor: zero_angle "
       "(default 0) or, depending on --unit, rate_bias (default 0), rate_scale, acceleration_bias, acceleration_scale, "
       "axis, radius, pivot_x, pivot_y."},
      {"spread", &Flags::spread,
       "Standard deviations, name=std_dev,... in SI. The true parameters of each recording are drawn from a normal "
       "distribution about --set, with the recording's seed and within the bounds of each parameter; default none."},
      {"out", &Flags::out, "Where to write the recording as CSV; - is standard output."},
      // gflags asks back about a value "-" of a flag whose help has the word "true".
      {"truth", &Flags::truth,
       "Where to write the simulated parameter values as JSON; - is standard output; default nowhere."},
      {"manifest", &Flags::manifest,
       "Where to write a list of the recordings as CSV: path, id, rig, seed and the parameter values; it is written "
       "last; - is standard output; default nowhere."},
      {"plan", &Flags::plan,
       "Instead of simulating, predicts the error of each parameter by noise (Cramér-Rao), sensor, clock and rig, what "
       "makes it smaller, and how amplitude, duration, rate and resolution change it; default off."},
      {"sensor", &Flags::sensor,
       "In a plan: what the sensor may do to the readings, as in fit_pendulum; default assumed."},
      {"details", &Flags::details,
       "In a plan: prints what other amplitudes, durations, rates and resolutions would give; default off."},
      {"count", &Flags::count,
       "Number of recordings, with the seeds --seed, --seed + 1, ...; with --out run.csv they are run_001.csv, "
       "run_002.csv, ...; default 1."},
      {"seed", &Flags::seed, "Seed of noise, jitter and --spread; default 1."},
      {"threads", &Flags::threads, "Number of threads; it does not change the result; default 0, one per core."},
      {"duration", &Flags::duration, "Length of the recording, s; default 20."},
      {"rate", &Flags::rate, "Sampling rate, Hz; default 100."},
      {"start_time", &Flags::start_time, "Time stamp of the first sample, s; default 0."},
      {"jitter", &Flags::jitter,
       "Standard deviation of the sampling times, s; the time stamps are the true times; default 0."},
      {"unit", &Flags::unit,
       "Unit of the recording: deg or rad (angle), deg_s or rad_s (gyro), volts (gyro of unknown scale), m_s2 "
       "(accelerometer), px or m (both coordinates of a point); default deg."},
      {"noise", &Flags::noise, "Standard deviation of the noise before quantization, in --unit; default 0."},
      {"noise_correlation", &Flags::noise_correlation,
       "Correlation of the noise of successive samples (AR(1) noise); default 0, white noise."},
      {"noise_freedom", &Flags::noise_freedom,
       "Degrees of freedom, above 2, of noise with Student's t distribution; --noise is then its scale; default 0, "
       "Gaussian noise."},
      {"event_driven", &Flags::event_driven,
       "Writes the rows of an encoder, one for each change of its count; --resolution is then one count and --noise "
       "the error of an edge; default off."},
      {"time_noise", &Flags::time_noise,
       "With --event_driven: standard deviation of the error of a time stamp, s; default 0."},
      {"oversample", &Flags::oversample,
       "Each row is the mean of this many readings, 1 to 64; --noise and --resolution are those of one reading; "
       "default "
       "1."},
      {"window_s", &Flags::window_s,
       "With --oversample: window about the time stamp over which the readings are spread, s; default 0."},
      {"resolution", &Flags::resolution, "Spacing of the sensor's levels, in --unit; default 0, no levels."},
      {"range", &Flags::range, "Range of the sensor, low,high in --unit; its levels start at low; default unlimited."},
      {"lose", &Flags::lose,
       "Lost counts, time:counts,... with times in s: from each time on, the readings are higher by counts times "
       "--resolution; default none."},
  };
}

Result<std::optional<Rig>> RigOf(const Flags& flags) {
  if (flags.rig.empty()) return std::nullopt;
  return ReadRig(flags.rig);
}

Result<void> WritePlan(const SimulateOptions& options, const std::optional<Rig>& rig) {
  SyntheticOptions planned = options.synthetic;
  planned.lost_counts.clear();
  ASSIGN_OR_RETURN(Plan plan, MakePlan(planned));
  Simulation simulation = static_cast<const Simulation&>(options);
  simulation.synthetic = planned;
  AddTotalErrors(simulation, rig, options.sensor, plan);
  return WriteOutputs(
      std::vector<Output>{{"-", PlanText(plan, rig, options.details ? TextExtent::kAll : TextExtent::kSummary)}});
}

Result<void> Simulate(const SimulateFlags& flags) {
  ASSIGN_OR_RETURN(const std::optional<Rig> rig, RigOf(flags));
  ASSIGN_OR_RETURN(const SimulateOptions options, MakeSimulateOptions(flags, rig));
  if (options.plan) return WritePlan(options, rig);
  return WriteRecordings(options);
}

Result<int> Work(const Flags& flags) {
  return Simulate(flags).map([] { return 0; });
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool("simulate_pendulum", __FILE__, pendulum::Usage(), pendulum::FlagTable(), pendulum::Work,
                           argc, argv);
}
