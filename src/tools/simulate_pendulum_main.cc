// SPDX-License-Identifier: Apache-2.0
// Simulates recordings of a pendulum's free swing, with the truth, or predicts what they will tell: flags, files and
// exit codes.
#include <optional>
#include <string>
#include <vector>

#include <gflags/gflags.h>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/report/plan_text.h"
#include "tools/output.h"
#include "tools/run_tool.h"
#include "tools/simulate_pendulum_files.h"
#include "tools/simulate_pendulum_options.h"

DEFINE_string(model, "coulomb", "Equation of motion, one of the models named above; default coulomb.");
DEFINE_string(gravity, "", "Law of gravity's torque, sin or linear; default the model's own.");
DEFINE_string(rig, "", "Rig file (JSON, SI units); without it torques and inertia are in units of the gravity torque.");
DEFINE_string(set, "",
              "Parameters, name=value,... in SI: inertia (default the rig's), the model's friction (default 0), "
              "release_angle and release_time or initial_angle and initial_rate, zero_angle (default 0) or, "
              "by --unit, rate_bias (default 0), rate_scale, acceleration_bias, acceleration_scale, axis, radius, "
              "pivot_x, pivot_y.");
DEFINE_string(
    spread, "",
    "Standard deviations, name=std_dev,... in SI, of a normal distribution about --set, from which the truth of each "
    "recording is drawn with the recording's seed and within the bounds of each parameter; default none.");
DEFINE_string(out, "", "Where to write the recording as CSV; - is standard output.");
DEFINE_string(truth, "", "Where to write the truth, the parameters, as JSON; - is standard output; default nowhere.");
DEFINE_string(manifest, "",
              "Where to list the recordings as CSV when all are written: path, id, rig, seed and the truth; - is "
              "standard output; default nowhere.");
DEFINE_bool(plan, false,
            "Makes no recording, but predicts the standard error of each parameter (Cramér-Rao), and how amplitude, "
            "duration, rate and resolution change it; default off.");
DEFINE_int32(count, 1, "Recordings, with seeds --seed, --seed + 1, ... in run_001.csv, run_002.csv, ...; default 1.");
DEFINE_uint64(seed, 1, "Seed of noise, jitter and --spread; default 1.");
DEFINE_int32(threads, 0, "Threads, on which the result does not depend; default 0, as many as there are cores.");
DEFINE_double(duration, 20, "Length of the recording, s; default 20.");
DEFINE_double(rate, 100, "Sampling rate, Hz; default 100.");
DEFINE_double(start_time, 0, "Clock at the first sample, s; default 0.");
DEFINE_double(jitter, 0,
              "Standard deviation of the sampling instants, s; the time stamps are the true instants; default 0.");
DEFINE_string(unit, "deg",
              "Unit of the recording: deg or rad (angle), deg_s or rad_s (gyro), volts (gyro of unknown scale), m_s2 "
              "(accelerometer), px or m (both coordinates of a point); default deg.");
DEFINE_double(noise, 0, "Standard deviation of the noise before quantization, in --unit; default 0.");
DEFINE_double(noise_correlation, 0,
              "AR(1): correlation of each sample's noise with the previous one; default 0, white.");
DEFINE_double(noise_freedom, 0,
              "Degrees of freedom, above 2, of Student's t noise; --noise is then its scale; default 0, Gaussian.");
DEFINE_bool(event_driven, false,
            "Rows of an encoder, only where its count changes; --resolution is then one count and --noise the error of "
            "an edge; default off.");
DEFINE_double(time_noise, 0, "Standard deviation of the error of an event's stamp, s; default 0.");
DEFINE_double(resolution, 0, "Spacing of the sensor's levels, in --unit; default 0, none.");
DEFINE_string(range, "", "Range of the sensor, low,high in --unit; its levels start at low; default unlimited.");
DEFINE_string(lose, "",
              "Lost counts, time:counts,... with times in s: from then on the readings are higher by this many times "
              "--resolution; default none.");

namespace pendulum {
namespace {

std::string Usage() {
  return "Recordings of a pendulum's free swing, simulated, with the truth.\n"
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
         "Exit codes: 0 done, 2 wrong flags, 3 rig not found, 4 unreadable rig, 5 the pendulum never moves, 70 a bug,\n"
         "73 an output cannot be written.\n"
         "\n";
}

SimulateFlags CurrentFlags(const std::vector<std::string>& positional) {
  SimulateFlags flags;
  flags.model = FLAGS_model;
  flags.gravity = FLAGS_gravity;
  flags.set = FLAGS_set;
  flags.spread = FLAGS_spread;
  flags.unit = FLAGS_unit;
  flags.duration = FLAGS_duration;
  flags.rate = FLAGS_rate;
  flags.jitter = FLAGS_jitter;
  flags.start_time = FLAGS_start_time;
  flags.noise = FLAGS_noise;
  flags.noise_correlation = FLAGS_noise_correlation;
  flags.noise_freedom = FLAGS_noise_freedom;
  flags.resolution = FLAGS_resolution;
  flags.event_driven = FLAGS_event_driven;
  flags.time_noise = FLAGS_time_noise;
  flags.range = FLAGS_range;
  flags.lose = FLAGS_lose;
  flags.seed = FLAGS_seed;
  flags.plan = FLAGS_plan;
  flags.count = FLAGS_count;
  flags.threads = FLAGS_threads;
  flags.rig = FLAGS_rig;
  flags.out = FLAGS_out;
  flags.truth = FLAGS_truth;
  flags.manifest = FLAGS_manifest;
  flags.positional = positional;
  return flags;
}

Result<std::optional<Rig>> RigOfFlag() {
  if (FLAGS_rig.empty()) return std::nullopt;
  return ReadRig(FLAGS_rig);
}

Result<void> WritePlan(const SimulateOptions& options, const std::optional<Rig>& rig) {
  SyntheticOptions planned = options.synthetic;
  planned.lost_counts.clear();
  const Result<Plan> plan = MakePlan(planned);
  if (!plan) return tl::unexpected(plan.error());
  return WriteOutputs(std::vector<Output>{{"-", PlanText(*plan, rig)}});
}

Result<void> Simulate(const SimulateFlags& flags) {
  const Result<std::optional<Rig>> rig = RigOfFlag();
  if (!rig) return tl::unexpected(rig.error());
  const Result<SimulateOptions> options = MakeSimulateOptions(flags, *rig);
  if (!options) return tl::unexpected(options.error());
  if (options->plan) return WritePlan(*options, *rig);
  return WriteRecordings(*options);
}

Result<int> Work(const std::vector<std::string>& positional) {
  return Simulate(CurrentFlags(positional)).map([] { return 0; });
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool({"simulate_pendulum", __FILE__, pendulum::Usage(), pendulum::Work}, argc, argv);
}
