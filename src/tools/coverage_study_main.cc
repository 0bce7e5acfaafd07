// SPDX-License-Identifier: Apache-2.0
// Simulates and fits recordings of many kinds and reports how often the 95 % intervals contain the true values: flags,
// progress, files and exit codes.
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "pendulum/analysis/coverage.h"
#include "pendulum/base/try.h"
#include "pendulum/report/coverage_text.h"
#include "tools/coverage_study_options.h"
#include "tools/output.h"
#include "tools/progress_line.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

constexpr std::string_view kName = "coverage_study";

constexpr const char* kUsage =
    "Do the 95 % intervals of fit_pendulum contain the truth 95 % of the time? Simulates recordings, fits them and "
    "counts.\n"
    "\n"
    "  coverage_study --scenario white_0.25,to_rest --count 1000\n"
    "\n"
    "Exit codes: 0 done, even if a line of the tables fails, 2 wrong flags, 70 a bug, 73 an output cannot be written.\n"
    "\n";

using Flags = CoverageFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"scenario", &Flags::scenario, "Names of scenarios, separated by commas, or all; --list shows them."},
      {"count", &Flags::count, "Number of recordings of each scenario; default 1000."},
      {"runs", &Flags::runs,
       "Number of recordings in each of --count sets; those of a set are of one rig, released from different angles, "
       "and fitted together. Default 1: each recording is fitted alone."},
      {"seed", &Flags::seed, "Seed of the first recording; recording i has seed + i; default 1."},
      {"threads", &Flags::threads, "Number of threads; it does not change the result; default 0, one per core."},
      {"markdown", &Flags::markdown,
       "Where to write the tables as Markdown, besides the text; - is standard output, instead of the text; default "
       "nowhere."},
      {"list", &Flags::list, "Lists the scenarios and exits; default off."},
  };
}

Result<std::vector<Output>> MakeOutputs(const CoverageStudyOptions& options) {
  if (options.list) return std::vector<Output>{{"-", CoverageScenarioList(options.scenarios)}};
  ProgressLine line(STDERR_FILENO);
  std::vector<CoverageStudy> studies;
  for (const CoverageScenario& scenario : options.scenarios) {
    CoverageOptions study_options = options.study;
    study_options.progress = [&](int done) {
      line.Show({"simulating and fitting " + scenario.name, done, study_options.count});
    };
    ASSIGN_OR_RETURN(auto study, StudyCoverage(scenario, study_options));
    studies.push_back(std::move(study));
  }
  std::vector<Output> outputs;
  if (!options.markdown.empty()) outputs.push_back({options.markdown, CoverageMarkdown(studies, options.command)});
  if (!IsStandardOutput(options.markdown)) outputs.push_back({"-", CoverageText(studies)});
  return outputs;
}

Result<int> Work(const Flags& flags) {
  ASSIGN_OR_RETURN(const auto options, MakeCoverageStudyOptions(flags));
  RETURN_IF_ERROR(CheckOutputs(options.Outputs(), {}));
  ASSIGN_OR_RETURN(const auto outputs, MakeOutputs(options));
  return WriteOutputs(outputs).map([] { return 0; });
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work, argc,
                           argv);
}
