// SPDX-License-Identifier: Apache-2.0
// Fits a pendulum's equation of motion to a recording of its free swing: flags, files and exit codes.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gflags/gflags.h>
#include <unistd.h>

#include "pendulum/base/try.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/report/fit_plot.h"
#include "pendulum/report/json.h"
#include "pendulum/report/markdown.h"
#include "pendulum/report/result_summary.h"
#include "pendulum/report/series.h"
#include "pendulum/report/summary_text.h"
#include "pendulum/report/terminal_plot.h"
#include "pendulum/report/text.h"
#include "pendulum/report/text_parts.h"
#include "pendulum/web/report_page.h"
#include "tools/fit_pendulum_options.h"
#include "tools/fit_runs.h"
#include "tools/gnuplot.h"
#include "tools/output.h"
#include "tools/progress_line.h"
#include "tools/run_tool.h"
#include "tools/shell_command.h"

namespace pendulum {
namespace {

constexpr std::string_view kName = "fit_pendulum";

constexpr const char* kUsage =
    "Moment of inertia and friction of a pendulum, with error bars, from a recording of its free swing.\n"
    "\n"
    "  fit_pendulum run.csv\n"
    "  fit_pendulum run.csv --models all --report fit.html\n"
    "  fit_pendulum run.csv --bob_mass 380g --rod_mass 120g --rod_length 43cm --g 9.81\n"
    "  fit_pendulum monday.csv tuesday.csv --rig rig.json --json fit.json\n"
    "  fit_pendulum volts.csv --calibration table.csv --from 2 --to 30\n"
    "\n"
    "Exit codes: 0 converged, 1 fitted but not converged, not identifiable or not a free swing, 2 wrong flags,\n"
    "3 file not found, 4 unreadable data, calibration or rig, 5 no swing in the data or too little, 70 a bug,\n"
    "73 an output cannot be written.\n"
    "With several models, the code belongs to the recommended model; with recordings that are fitted separately, it\n"
    "is the largest. All fits that succeed are written. Several recordings are assumed to be of one rig and are\n"
    "fitted together; --shared none fits each separately.\n"
    "\n";

using Flags = FitPendulumFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"data", &Flags::data,
       "Recording, or several of one rig, separated by commas and fitted together (--shared). Files named without a "
       "flag "
       "are the same. CSV whose header names "
       "the columns and their units, such as time_s,angle_deg; exports of phyphox (CSV, zip), Tracker, Logger Pro, "
       "Graphical Analysis, Capstone and ROS; workbooks (xlsx, xls, ods); MAT-files; NumPy arrays; JSON; - is standard "
       "input."},
      {"data_list", &Flags::data_list, "File with one path of a recording per line, instead of --data; default none."},
      {"shared", &Flags::shared,
       "Parameters that several recordings share: all (inertia and friction), a list of names, or none (each recording "
       "is fitted separately); default all for several recordings, none for several releases of one recording."},
      {"json", &Flags::json, "Where to write the result as JSON; - is standard output; default nowhere."},
      {"residuals", &Flags::residuals,
       "Where to write samples and residuals as CSV; - is standard output; default nowhere."},
      {"series", &Flags::series,
       "Where to write samples, turning points and models as JSON; - is standard output; default nowhere."},
      {"report", &Flags::report,
       "Where to write the result as a page (HTML, one file); - is standard output; default nowhere."},
      {"plot", &Flags::plot,
       "Where to write a picture of swing, fit and residuals: a file that ends in .svg, .png or .pdf (needs gnuplot); "
       "default nowhere."},
      {"markdown", &Flags::markdown, "Where to write the result as Markdown; - is standard output; default nowhere."},
      {"details", &Flags::details, "Prints all of the result, and its summary last; default: the summary alone."},
      {"quiet", &Flags::quiet,
       "Prints a line for each parameter and nothing else: name, value, total standard error, unit; default off."},
      {"terminal_plot", &Flags::terminal_plot,
       "Draws recording, fit and residuals in the terminal (needs gnuplot); default off."},
  };
}

/// Adds the outputs of run `index` (0-based) of `count`, except the text for standard output. Errors as RunGnuplot.
Result<void> RenderFiles(const FitPendulumOptions& options, const Identification& run, int index, int count,
                         std::vector<Output>& outputs) {
  const auto recordings = static_cast<int>(run.recordings.size());
  if (!options.json.empty()) outputs.push_back({NumberedPath(options.json, index, count), ToJsonText(run)});
  for (int k = 0; k < recordings; ++k) {
    const auto path_of = [&](const std::string& path) {
      return run.is_joint() ? NumberedPath(path, k, recordings) : NumberedPath(path, index, count);
    };
    const auto at = static_cast<std::size_t>(k);
    if (!options.residuals.empty()) {
      outputs.push_back({path_of(options.residuals), ToResidualCsv(run, at, run.MainFit())});
    }
    if (!options.plot.empty()) {
      ASSIGN_OR_RETURN(auto picture, RunGnuplot(FitPlot(run, at, run.MainFit(), *PictureFormatOf(options.plot))));
      outputs.push_back({path_of(options.plot), std::move(picture)});
    }
  }
  if (!options.series.empty()) {
    outputs.push_back({NumberedPath(options.series, index, count), ToSeriesJsonText(run)});
  }
  if (!options.report.empty()) {
    outputs.push_back({NumberedPath(options.report, index, count), ToHtml(run, ShellCommand(gflags::GetArgvs()))});
  }
  if (!options.markdown.empty()) {
    outputs.push_back({NumberedPath(options.markdown, index, count), ToMarkdown(run)});
  }
  return {};
}

constexpr const char* kMore = "More: --details (all of it), --report fit.html (plots), --json fit.json.";

/// The result as text, with a plot of each recording if requested.
Result<std::string> TextOf(const FitPendulumOptions& options, const Identification& run) {
  std::string text;
  for (std::size_t k = 0; k < run.recordings.size() && options.terminal_plot; ++k) {
    ASSIGN_OR_RETURN(const auto drawn, RunGnuplot(TerminalPlot(run.recordings[k].used, run.FitOf(k, run.MainFit()))));
    text += (run.is_joint() ? Printable(RecordingLabel(run, k)) + "\n" : "") + PictureText(drawn) + "\n";
  }
  const TextStyle style = TextStyleFor(STDOUT_FILENO);
  if (options.quiet) return text + QuietText(run);
  return text + (options.details ? ToText(run, style) : SummaryText(SummarizeResult(run), kMore, style));
}

/// What must not be overlooked where only numbers are shown: that they should not be quoted, or not without a doubt.
void PrintVerdict(const Identification& run) {
  if (run.fits.empty() || run.fits[run.MainFit()].termination != Termination::kConverged) return;
  const FitSummary summary = SummarizeFit(run, run.MainFit());
  if (summary.emphasis != Emphasis::kNone) PrintMessage(kName, "warning: " + MessageAt(run.path(), summary.verdict));
}

/// Says which laws have no result. The summary says why, if it is shown.
void PrintFailures(const Identification& run, bool is_summarized) {
  for (std::size_t i = 0; i < run.fits.size(); ++i) {
    const FitReport& fit = run.fits[i];
    if (fit.termination == Termination::kConverged || (is_summarized && i != run.MainFit())) continue;
    const std::string outcome =
        "no result with " + std::string(fit.model.name) + " (" + std::string(TerminationName(fit.termination)) + ")";
    PrintMessage(kName, MessageAt(run.path(), is_summarized ? outcome : outcome + ": " + fit.reason));
  }
}

/// All outputs of all runs. Text tables are joined on standard output unless data go there. Runs that could not be
/// fitted are reported.
Result<std::vector<Output>> Render(const FitPendulumOptions& options, const std::vector<Result<Identification>>& runs) {
  const bool data_on_stdout =
      std::ranges::any_of(options.Outputs(), [](const NamedFile& output) { return IsStandardOutput(output.path); });
  const auto count = static_cast<int>(runs.size());
  std::vector<Output> outputs;
  std::string text;
  for (int i = 0; i < count; ++i) {
    const Result<Identification>& run = runs[static_cast<std::size_t>(i)];
    if (!run) {
      PrintError(kName, run.error());
      continue;
    }
    RETURN_IF_ERROR(RenderFiles(options, *run, i, count, outputs));
    ASSIGN_OR_RETURN(const auto part, TextOf(options, *run));
    text += (text.empty() ? "" : "\n") + part;
    if (options.quiet) PrintVerdict(*run);
    if (data_on_stdout) {
      for (const Warning& warning : AllWarnings(*run))
        PrintMessage(kName,
                     "warning: " + MessageAt(warning.about.file.empty() ? run->path() : "", MessageText(warning)));
    }
    PrintFailures(*run, !options.quiet && !data_on_stdout);
  }
  if (!data_on_stdout && !text.empty()) outputs.push_back({"-", text});
  return outputs;
}

Result<int> Work(const Flags& flags) {
  ASSIGN_OR_RETURN(auto options, MakeFitPendulumOptions(flags));
  ASSIGN_OR_RETURN(const auto setup, ReadSetup(options));
  const bool needs_gnuplot = options.terminal_plot || !options.plot.empty();
  if (const auto plots = needs_gnuplot ? CheckGnuplot() : Result<void>(); !plots) {
    return Within(options.terminal_plot ? "--terminal_plot" : "--plot", plots.error());
  }
  auto checked = CheckOutputs(options.Outputs(), setup.inputs);
  if (checked) checked = CheckNumberedOutputs(options, setup, setup.paths.size());
  if (!checked) return tl::unexpected(checked.error());
  std::optional<ProgressLine> line(STDERR_FILENO);
  options.fit.progress = line->Sink();
  ASSIGN_OR_RETURN(const auto runs, FitAll(options, setup));
  line.reset();
  ASSIGN_OR_RETURN(const auto outputs, Render(options, runs));
  RETURN_IF_ERROR(WriteOutputs(outputs));
  int worst = 0;
  for (const Result<Identification>& run : runs)
    worst = std::max(worst, run ? ExitCode(*run) : ExitCode(run.error().code));
  return worst;
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work, argc,
                           argv);
}
