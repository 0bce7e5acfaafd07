// SPDX-License-Identifier: Apache-2.0
#include "service/preview_answers.h"

#include <algorithm>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/json.h"
#include "pendulum/closed_form/window_reasons.h"
#include "pendulum/identify/identify.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/readers/columns/table_preview.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/request/run_flags.h"
#include "pendulum/service/fit_request.h"
#include "pendulum/service/problem.h"
#include "service/answers.h"
#include "service/samples_json.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// The flags of requests that a sentence names, without dashes, each once.
std::vector<std::string> FlagsIn(std::string_view sentence) {
  constexpr std::string_view kNameCharacters = "abcdefghijklmnopqrstuvwxyz_";
  std::vector<std::string> flags;
  for (std::size_t at = 0; (at = sentence.find("--", at)) != std::string_view::npos;) {
    at += 2;
    const std::string_view rest = sentence.substr(at);
    std::string name(rest.substr(0, rest.find_first_not_of(kNameCharacters)));
    const bool is_known = std::ranges::find(RunFlagTable(), name, &RunFlag::name) != RunFlagTable().end();
    if (is_known && std::ranges::find(flags, name) == flags.end()) flags.push_back(std::move(name));
  }
  return flags;
}

/// Adds the flags that the sentence of a question names to its options.
void AddNamedOptions(ReadQuestion& question) {
  for (std::string& flag : FlagsIn(question.sentence)) {
    if (std::ranges::find(question.options, flag) == question.options.end())
      question.options.push_back(std::move(flag));
  }
}

/// What a request for a fit reads: the answer of a preview before it becomes JSON.
struct Preview {
  TablePreview table;
  std::vector<Warning> assumptions;
  std::vector<ReadQuestion> missing;
  std::optional<Status> problem;       ///< Why the recording that was read cannot be fitted.
  std::optional<Recording> recording;  ///< As read.
  std::vector<FreeSwing> swings;
  int release = 0;  ///< The number of the swing that will be fitted, from 1; 0: none.
};

/// Values of the rig that are missing beside the given ones. Other errors of the rig become the problem.
void AskForRig(const IdentifyOptions& options, Preview& preview) {
  std::vector<Warning> notes;
  const auto rig = RigOfValues(options.rig_values, notes);
  if (rig) return;
  ReadQuestion question{rig.error().sentence, {}, rig.error().try_flags, {}};
  for (const std::string& flag : FlagsIn(question.sentence)) {
    const auto key = std::ranges::find(RigKeys(), flag, &RigKey::flag);
    if (key != RigKeys().end() && !options.rig_values.contains(key->name)) question.options.push_back(flag);
  }
  if (question.options.empty())
    preview.problem = rig.error();
  else
    preview.missing.push_back(std::move(question));
}

/// Chooses the window and checks the readings as a fit does.
void Prepare(const IdentifyOptions& options, std::optional<Rig> rig, Preview& preview) {
  preview.assumptions = preview.recording->warnings;
  IdentifyOptions own = options;
  const bool has_wrong_rig = !preview.missing.empty() || preview.problem;
  if (has_wrong_rig) own.rig_values.clear();  // the window hardly depends on it
  auto prepared = PrepareRecording(*preview.recording, own, std::move(rig));
  if (!prepared) {
    if (!preview.problem) preview.problem = prepared.error();
    return;
  }
  if (!has_wrong_rig) {
    if (const auto checked = CheckBeforeFit(own, *prepared); !checked) preview.problem = checked.error();
  }
  preview.assumptions = std::move(prepared->known.warnings);
  preview.swings = std::move(prepared->swings.found);
  preview.release = prepared->swings.chosen.front();
}

/// Reads the recording of a request. Errors as ReadBytesOfRun, except those that are questions; kTryAgain: the client
/// has gone. The limits of lines, bytes and unpacked bytes bound the time of reading and of the search for the window.
Result<Preview> MakePreview(FitRequest request, const std::stop_token& client_gone) {
  Preview preview;
  IdentifyOptions& options = request.options;
  options.read.preview = &preview.table;
  const bool has_rig_file = request.rig != nullptr;
  auto run = ReadBytesOfRun(options,
                            {std::move(request.data.front()), std::move(request.rig), std::move(request.calibration)});
  if (!run) {
    const Status& error = run.error();
    preview.missing = std::exchange(preview.table.questions, {});
    if (preview.missing.empty() && !error.try_flags.empty()) {
      preview.missing = {{error.message(), {}, error.try_flags, {}}};
    }
    if (preview.missing.empty()) return tl::unexpected(error);
    for (ReadQuestion& question : preview.missing) AddNamedOptions(question);
    preview.assumptions = preview.table.assumptions;
  }
  const bool describes_rig = has_rig_file || (run && !run->recording.rig_json.empty());
  if (!describes_rig && !options.rig_values.empty()) AskForRig(options, preview);
  if (!run) return preview;
  if (client_gone.stop_requested()) return FitStopped();
  preview.recording = std::move(run->recording);
  Prepare(options, std::move(run->rig), preview);
  return preview;
}

// ---- JSON -----------------------------------------------------------------------------------------------------------

/// A column as the flag takes it; the flag for the value names the member too.
std::string ValueColumn(const TablePreview& table, std::size_t index) {
  return (table.member.empty() ? "" : table.member + "/") + table.names.at(index);
}

Json ColumnsJson(const TablePreview& table) {
  Json columns = Json::array();
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    columns.push_back({{"name", table.names[i]}, {"value_column", ValueColumn(table, i)}});
  }
  return columns;
}

Json ChosenJson(const std::optional<TablePreview::Column>& column) {
  if (!column) return nullptr;
  return {{"column", column->index}, {"unit", TextOrNull(column->unit)}};
}

/// All values that the option may have in this request; empty if they are not words.
Json ValuesJson(const ReadQuestion& question, const TablePreview& table) {
  Json values = question.values;
  if (!question.values.empty() || question.options.empty()) return values;
  const std::string& option = question.options.front();
  if (option == "time_column") return table.names;
  if (option == "value_column") {
    for (std::size_t i = 0; i < table.names.size(); ++i) values.push_back(ValueColumn(table, i));
    return values;
  }
  const auto flag = std::ranges::find(RunFlagTable(), option, &RunFlag::name);
  if (flag == RunFlagTable().end()) return values;
  for (const FlagWord& word : flag->words) {
    if (!word.word.empty()) values.push_back(word.word);
  }
  return values;
}

Json MissingJson(const std::vector<ReadQuestion>& missing, const TablePreview& table) {
  Json list = Json::array();
  for (const ReadQuestion& question : missing) {
    list.push_back({{"options", question.options},
                    {"question", question.sentence},
                    {"values", ValuesJson(question, table)},
                    {"try", TryParameters(question.try_flags)}});
  }
  return list;
}

Json AssumptionsJson(const std::vector<Warning>& assumptions) {
  Json list = Json::array();
  for (const Warning& assumption : assumptions) {
    list.push_back(
        {{"code", assumption.code.text()}, {"message", MessageText(assumption)}, {"options", assumption.flags}});
  }
  return list;
}

/// How a swing begins. Only the fit tells a short hold from motion, or a noisy hold from an unsteady one.
std::string BeginsText(const WindowBegin& begins) {
  const bool may_be_hold =
      begins.reason == WindowBegin::Reason::kInMotion || begins.reason == WindowBegin::Reason::kUnsteadyHold;
  return Sentence(begins) + (may_be_hold ? ", unless the fit finds a hold" : "");
}

Json WindowJson(const Preview& preview) {
  if (preview.release == 0) return nullptr;
  const FreeSwing& swing = preview.swings.at(static_cast<std::size_t>(preview.release) - 1);
  Json releases = Json::array();
  for (const FreeSwing& found : preview.swings) releases.push_back({found.from, found.to});
  return {{"window_s", {swing.from, swing.to}},
          {"begins", TextOrNull(BeginsText(swing.begins))},
          {"ends", TextOrNull(Sentence(swing.ends))},
          {"release", preview.release},
          {"releases", std::move(releases)}};
}

/// The problem as POST /v1/fits would return it.
Json ProblemJson(const std::optional<Status>& problem) {
  return problem ? Json::parse(ProblemResponse(ProblemOf(*problem)).body) : Json(nullptr);
}

Json PreviewJson(const Preview& preview, const std::string& name) {
  constexpr Eigen::Index kMaxShown = 1000;
  const auto& recording = preview.recording;
  const bool is_calibrated = recording && recording->calibration;
  return {{"name", name},
          {"format", TextOrNull(preview.table.format)},
          {"member", TextOrNull(preview.table.member)},
          {"columns", ColumnsJson(preview.table)},
          {"rows", preview.table.rows},
          {"time", ChosenJson(preview.table.time)},
          {"value", ChosenJson(preview.table.value)},
          {"calibration", is_calibrated ? recording->calibration->source : Json(nullptr)},
          {"assumptions", AssumptionsJson(preview.assumptions)},
          {"missing", MissingJson(preview.missing, preview.table)},
          {"problem", ProblemJson(preview.problem)},
          {"samples", recording ? SamplesInOwnUnitJson(*recording, kMaxShown) : Json(nullptr)},
          {"window", WindowJson(preview)}};
}

}  // namespace

HttpResponse PostPreview(ServiceState& state, const Call& call) {
  auto request = ParseFitRequest(call.http, call.target, state.options.limits);
  if (!request) return ProblemResponse(request.error());
  const std::string name = request->data.front().name;
  const auto preview = MakePreview(*std::move(request), call.http.client_gone);
  if (!preview) return ProblemAnswer(preview.error());
  return JsonAnswer(PreviewJson(*preview, name));
}

}  // namespace pendulum
