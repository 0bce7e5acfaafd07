// SPDX-License-Identifier: Apache-2.0
// hot_paths WHAT N runs the work of the benchmark WHAT N times; nothing else depends on N. Under valgrind
// --tool=callgrind, the difference between two runs is the instruction count of the additional repetitions; see
// scripts/benchmark.
#include <charconv>
#include <cmath>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "pendulum/trajectory/tolerance.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

void EvaluateSums(int count) {
  const EvaluationPoint point = MakeEvaluationPoint("coulomb", StartKind::kRelease);
  const auto cost = MakeTrajectoryCost(point.problem.model, StartKind::kRelease, point.problem.data);
  cost->set_tolerance(TraceTolerance(FitOptions().search.max_trace_error, point.problem.start.amplitude));
  std::vector<double> parameters = point.parameters;
  Eigen::MatrixXd sums;
  for (int i = 0; i < count; ++i) {
    parameters.back() = std::nextafter(parameters.back(), 1.0);  // the cost caches the sums of the last point
    if (!cost->Sums(parameters, &sums)) throw std::runtime_error("no trajectory");
  }
}

void FitAgain(int count, double counts_of_noise, std::optional<NoiseFamily> noise) {
  const Recording recording = ReferenceRecording(kSamples, counts_of_noise);
  FitOptions options;
  options.rig = ReferenceRig();
  options.noise = noise;
  for (int i = 0; i < count; ++i) {
    const FitReport fit = Expect(FitRecording(recording, options));
    if (fit.termination != Termination::kConverged) throw std::runtime_error(fit.reason);
  }
}

/// The work of each hot path, by the name of the benchmark that times it.
const std::map<std::string, std::function<void(int)>>& HotPaths() {
  static const std::map<std::string, std::function<void(int)>> paths = {
      {"sensitivities/coulomb/release", EvaluateSums},
      {"fit", [](int count) { FitAgain(count, 1, FitOptions().noise); }},
      {"fit/counts:0.5/gaussian", [](int count) { FitAgain(count, 0.5, NoiseFamily::kGaussian); }},
      {"fit/counts:0.5/quantized", [](int count) { FitAgain(count, 0.5, NoiseFamily::kQuantized); }},
  };
  return paths;
}

int Run(const std::string& what, const std::string& times) {
  const auto path = HotPaths().find(what);
  int count = 0;
  const auto [end, error] = std::from_chars(times.data(), times.data() + times.size(), count);
  if (path == HotPaths().end() || error != std::errc() || end != times.data() + times.size() || count < 1) {
    std::cerr << "hot_paths: usage: hot_paths WHAT N; N is at least 1, WHAT one of";
    for (const auto& [name, unused] : HotPaths()) std::cerr << " " << name;
    std::cerr << "\n";
    return 2;
  }
  path->second(count);
  return 0;
}

}  // namespace
}  // namespace pendulum::benchmarks

int main(int argc, char** argv) {
  try {
    return pendulum::benchmarks::Run(argc == 3 ? argv[1] : "", argc == 3 ? argv[2] : "");
  } catch (const std::exception& error) {
    std::cerr << "hot_paths: " << error.what() << "\n";
    return 1;
  }
}
