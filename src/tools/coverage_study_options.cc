// SPDX-License-Identifier: Apache-2.0
#include "tools/coverage_study_options.h"

#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

constexpr int kMaxRecordings = 1'000'000;
constexpr int kMaxThreads = 1024;
constexpr int kMaxRuns = 100;

Result<void> CheckWhole(const std::string& flag, int value, int min_value, int max_value) {
  if (value >= min_value && value <= max_value) return {};
  return BadFlag(flag + " is " + std::to_string(value) + "; it must be " + std::to_string(min_value) + " to " +
                 std::to_string(max_value));
}

std::string Command(const CoverageFlags& flags) {
  return "coverage_study --scenario " + flags.scenario + " --count " + std::to_string(flags.count) + " --seed " +
         std::to_string(flags.seed) + (flags.runs > 1 ? " --runs " + std::to_string(flags.runs) : "");
}

}  // namespace

std::vector<NamedFile> CoverageStudyOptions::Outputs() const {
  if (list || markdown.empty()) return {};
  return {{"--markdown", markdown}};
}

Result<CoverageStudyOptions> MakeCoverageStudyOptions(const CoverageFlags& flags) {
  if (!flags.positional.empty()) return BadFlag("'" + flags.positional.front() + "' does not belong to a flag");
  RETURN_IF_ERROR(CheckWhole("--count", flags.count, 1, kMaxRecordings));
  RETURN_IF_ERROR(CheckWhole("--runs", flags.runs, 1, kMaxRuns));
  RETURN_IF_ERROR(CheckWhole("--threads", flags.threads, 0, kMaxThreads));
  CoverageStudyOptions options;
  options.list = flags.list;
  if (!flags.list && flags.scenario.empty()) {
    return BadFlag(
        "--scenario is missing; give names of scenarios, separated by commas, or all; --list shows the names");
  }
  auto scenarios = FindCoverageScenarios(flags.scenario.empty() ? "all" : flags.scenario);
  if (!scenarios) return Within("--scenario", scenarios.error());
  options.scenarios = *std::move(scenarios);
  options.study.count = flags.count;
  options.study.runs = flags.runs;
  options.study.seed = flags.seed;
  options.study.threads = flags.threads;
  options.markdown = flags.markdown;
  options.command = Command(flags);
  return options;
}

}  // namespace pendulum
