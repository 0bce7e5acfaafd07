// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/folder.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "recording/readers/columns/runs.h"
#include "recording/readers/columns/several_quantities.h"
#include "recording/readers/columns/swing_choice.h"
#include "recording/readers/content.h"
#include "recording/readers/text/labelled_rows.h"
#include "recording/readers/text/phone_log.h"
#include "recording/readers/text/row_reader.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxMembers = 1000;  // A malicious zip file may contain a million members.

/// What the first lines of a member show.
struct MemberSummary {
  std::size_t index = 0;
  std::vector<std::string> candidates;  // Names of columns; one empty name for a member that is not examined.
  bool is_examined = true;
  std::optional<Status> fault;  // Why the member cannot be read.
};

/// The flag that chooses a column of a member, or the member alone.
std::string FlagOf(const std::string& member, const std::string& column = "") {
  return "--value_column " + member + (column.empty() ? "" : "/" + column);
}

/// "MEMBER/COLUMN", each shortened as for a message.
std::string QuotedMemberAndColumn(const std::string& member, const std::string& column) {
  std::string pair = Quoted(member);
  if (column.empty()) return pair;
  pair.back() = '/';
  return pair + Quoted(column).substr(1);
}

/// Whether a member has two or more columns of a rate, which --value_column combined combines.
bool HasAxes(const std::vector<csv::TableColumn>& columns) {
  const auto is_rate = [](const csv::TableColumn& column) {
    return csv::MeaningOf(column.meaning).kind == csv::Kind::kRate;
  };
  return std::ranges::count_if(columns, is_rate) > 1;
}

/// The columns that could be the quantity; empty without a time.
std::vector<std::string> CandidatesIn(const std::vector<csv::TableColumn>& columns, const ReadOptions& options) {
  std::vector<std::string> candidates;
  const auto is_time = [](const csv::TableColumn& column) { return csv::IsTime(column.meaning); };
  const std::string time = csv::TimeFlagOf(columns, options.time_column).column;
  const bool is_named = !time.empty() && csv::IndexOf(columns, time) < columns.size();
  if (options.sample_rate_hz == 0 && !is_named && std::ranges::none_of(columns, is_time)) return candidates;
  if (!options.value_column.empty()) {
    const std::size_t named = csv::IndexOf(columns, options.value_column);
    if (named < columns.size()) candidates.push_back(columns[named].written);
    if (named == columns.size() && options.value_column == csv::kCombined && HasAxes(columns)) {
      candidates.emplace_back(csv::kCombined);
    }
    return candidates;
  }
  for (const std::size_t i : csv::CandidatesOf(columns, options.unit)) candidates.push_back(columns[i].written);
  return candidates;
}

MemberSummary SummarizeMember(const Folder& folder, std::size_t index, const ReadOptions& options) {
  constexpr std::size_t kHeadBytes = std::size_t{1} << 16;
  MemberSummary summary{index, {}, true, {}};
  Result<std::string> begin = folder.read(index, kHeadBytes);
  if (!begin) {
    summary.fault = begin.error();
    return summary;
  }
  const Content content = ContentOf(std::string_view(*begin).substr(0, kContentBytes));
  if (content == Content::kForeign) return summary;
  if (content == Content::kReturns) std::ranges::replace(*begin, '\r', '\n');
  if (content != Content::kText && content != Content::kReturns && content != Content::kLabelled) {
    summary.candidates.emplace_back();
    summary.is_examined = content == Content::kMat;
    return summary;
  }
  if (begin->size() >= kHeadBytes) begin->resize(begin->rfind('\n') + 1);
  if (content == Content::kLabelled) begin = csv::TableOfLabelledRows(*begin, folder.name_of(index));
  if (!begin) {
    summary.fault = begin.error();
    return summary;
  }
  const auto columns = ReadColumnNames(LineReader(*begin, folder.name_of(index)));
  if (columns) summary.candidates = CandidatesIn(*columns, options);
  return summary;
}

/// The member that --value_column names, alone or before a slash. Removes the name of the member from the option. Whole
/// paths have priority over file names. std::nullopt: no such member. kInvalidArgument: two files have this name.
Result<std::optional<std::size_t>> FindNamed(const Folder& folder, ReadOptions& options) {
  const std::string& flag = options.value_column;
  const auto is_named = [&](std::string_view path) {
    return !path.empty() && flag.starts_with(path) && (flag.size() == path.size() || flag[path.size()] == '/');
  };
  const auto file_of = [&](std::size_t i) { return folder.paths[i].substr(folder.paths[i].rfind('/') + 1); };
  const auto take = [&](std::size_t i, std::size_t size) {
    options.value_column.erase(0, std::min(size + 1, flag.size()));
    return i;
  };
  std::optional<std::size_t> by_file;
  for (std::size_t i = 0; i < folder.paths.size(); ++i) {
    if (is_named(folder.paths[i])) return take(i, folder.paths[i].size());
  }
  for (std::size_t i = 0; i < folder.paths.size(); ++i) {
    if (!is_named(file_of(i))) continue;
    if (by_file && file_of(i) == file_of(*by_file)) {
      return WithTry(
          ErrorAt(StatusCode::kInvalidArgument, folder.name,
                  "--value_column is " + Quoted(flag) + ", but both " + Quoted(folder.paths[*by_file]) + " and " +
                      Quoted(folder.paths[i]) + " have this name; give the path within the " + folder.kind),
          {FlagOf(folder.paths[*by_file] + flag.substr(file_of(i).size()))});
    }
    by_file = i;
  }
  if (by_file) take(*by_file, file_of(*by_file).size());
  return by_file;
}

std::string Upper(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

/// What to give as --value_column.
std::string FlagExample(const Folder& folder) { return "\"" + Upper(folder.member) + "/COLUMN\""; }

tl::unexpected<Status> NoMember(const Folder& folder) {
  std::vector<std::string> members;
  for (const std::string& path : folder.paths) members.push_back(Quoted(path));
  if (members.empty()) {
    return Fault(folder.name, "this " + folder.kind + " contains no recording; give another file");
  }
  return Fault(folder.name, "none of its " + folder.member + "s " + ListWithAnd(members) +
                                " has a column of times and one of an angle or a rate; choose with --value_column " +
                                FlagExample(folder) + ", or name another recording");
}

/// The values of --value_column that choose a candidate.
std::vector<std::string> ValuesOf(const Folder& folder, const std::vector<MemberSummary>& summaries) {
  std::vector<std::string> values;
  for (const MemberSummary& summary : summaries) {
    const std::string& path = folder.paths[summary.index];
    for (const std::string& column : summary.candidates) {
      values.push_back(path);
      if (!column.empty()) values.back().append("/").append(column);
    }
  }
  return values;
}

/// Chooses the member by the names of columns. std::nullopt: no header tells.
Result<std::optional<std::size_t>> ChooseByNames(const Folder& folder, const ReadOptions& options,
                                                 std::vector<Warning>& warnings) {
  constexpr std::size_t kMaxWarnings = 8;
  std::vector<MemberSummary> summaries;
  std::optional<Status> fault;  // For the first unreadable member.
  for (std::size_t i = 0; i < std::min(folder.paths.size(), kMaxMembers); ++i) {
    MemberSummary summary = SummarizeMember(folder, i, options);
    if (summary.fault && warnings.size() < kMaxWarnings)
      warnings.push_back(
          {.code = "unreadable_member", .finding = summary.fault->sentence, .about = {.file = summary.fault->place}});
    if (summary.fault && !fault) fault = summary.fault;
    if (!summary.candidates.empty()) summaries.push_back(std::move(summary));
  }
  if (std::ranges::any_of(summaries, &MemberSummary::is_examined)) {
    std::erase_if(summaries, [](const MemberSummary& summary) { return !summary.is_examined; });
  }
  if (summaries.size() == 1) return summaries.front().index;
  if (summaries.empty() && fault) return tl::unexpected(*std::move(fault));
  if (summaries.empty()) return std::nullopt;
  std::vector<std::string> candidates;
  std::optional<std::size_t> usual, gyro;
  std::size_t gyros = 0;
  for (const MemberSummary& summary : summaries) {
    const std::string& path = folder.paths[summary.index];
    if (path == "Raw Data") usual = summary.index;
    if (csv::IsPhoneGyro(path, summary.candidates)) {
      gyro = summary.index;
      ++gyros;
    }
    for (const std::string& column : summary.candidates) candidates.push_back(QuotedMemberAndColumn(path, column));
  }
  if (!usual && gyros == 1) usual = gyro;
  if (!usual) {
    const MemberSummary& first = summaries.front();
    const std::string flag = FlagOf(folder.paths[first.index], first.candidates.front());
    auto several = WithTry(Fault(folder.name, "columns " + SeveralQuantities(candidates)), {flag});
    if (options.preview != nullptr) {
      options.preview->questions = {{several.value().message(), {"value_column"}, {flag}, ValuesOf(folder, summaries)}};
    }
    return several;
  }
  const std::string member = folder.member + " " + Quoted(folder.paths[*usual]);
  const std::string flag = "--value_column " + FlagExample(folder);
  warnings.push_back({.code = "member_assumed",
                      .finding = member + " was read, although others have columns of a swing too",
                      .advice = "choose another with " + flag,
                      .flags = {"value_column"},
                      .assumed = member + " (" + flag + ")",
                      .about = {.file = folder.name}});
  return usual;
}

Result<Recording> ReadWhole(const Folder& folder, std::size_t index, const ReadOptions& options,
                            const MemberReader& read) {
  const std::size_t max_bytes = options.most_unpacked_bytes;
  if (options.preview != nullptr && folder.paths.size() > 1) options.preview->member = folder.paths[index];
  const Result<std::string> bytes = folder.read(index, max_bytes + 1);
  if (!bytes) return tl::unexpected(bytes.error());
  if (bytes->size() <= max_bytes) return read(*bytes, folder.name_of(index), options);
  return Fault(folder.name_of(index), "it unpacks to more than " + std::to_string(max_bytes) +
                                          " bytes, too many for a recording; give a smaller file, or split it");
}

/// The error if no member can be read, with that of the first member and the flags that it needs.
tl::unexpected<Status> NoneReadable(const Folder& folder, const Status& first) {
  constexpr std::string_view kFlag = "--value_column ";
  std::vector<std::string> flags;
  bool has_column = false;
  for (const std::string& flag : first.try_flags) {
    const bool is_column = flag.starts_with(kFlag);
    has_column |= is_column;
    flags.push_back(is_column ? FlagOf(folder.paths.front(), flag.substr(kFlag.size())) : flag);
  }
  if (!flags.empty() && !has_column) flags.push_back(FlagOf(folder.paths.front()));
  tl::unexpected<Status> none = NoMember(folder);
  none.value().sentence += ". The first " + folder.member + " says: " + first.message();
  return WithTry(std::move(none), std::move(flags));
}

/// Tries to read each member. Returns the recording of the only one that can be read.
Result<Recording> ReadOnlyReadable(const Folder& folder, const ReadOptions& options, const MemberReader& read) {
  constexpr std::size_t kMaxTried = 20;
  if (folder.paths.empty()) return NoMember(folder);
  if (folder.paths.size() > kMaxTried) {
    return Fault(folder.name, "it has " + std::to_string(folder.paths.size()) + " " + folder.member +
                                  "s, and no header shows which one is the recording; choose one with --value_column " +
                                  FlagExample(folder));
  }
  std::vector<std::size_t> readable;
  std::optional<Status> fault;  // Of the first member.
  Result<Recording> only;
  for (std::size_t i = 0; i < folder.paths.size(); ++i) {
    ReadOptions alone = options;
    TablePreview tried;
    if (options.preview != nullptr) {
      tried.format = options.preview->format;
      alone.preview = &tried;
    }
    Result<Recording> recording = ReadWhole(folder, i, alone, read);
    if (options.preview != nullptr && (recording || i == 0)) *options.preview = std::move(tried);
    if (!recording && i == 0) fault = recording.error();
    if (!recording) continue;
    readable.push_back(i);
    only = std::move(recording);
  }
  if (readable.empty()) return NoneReadable(folder, *std::move(fault));
  if (readable.size() == 1) return only;
  std::vector<std::string> names;
  for (const std::size_t i : readable) names.push_back(Quoted(folder.paths[i]));
  return WithTry(Fault(folder.name, "its " + folder.member + "s " + ListWithAnd(names) + " could " +
                                        (names.size() == 2 ? "both" : "all") +
                                        " be the recording; choose one with --value_column " + FlagExample(folder)),
                 {FlagOf(folder.paths[readable.front()])});
}

}  // namespace

Result<Recording> ReadOnlyMember(const Folder& folder, const ReadOptions& options, const MemberReader& read) {
  ReadOptions rest = options;
  std::vector<Warning> warnings;
  Result<std::optional<std::size_t>> member = FindNamed(folder, rest);
  if (member && !*member && folder.paths.size() == 1) *member = 0;
  if (member && !*member) member = ChooseByNames(folder, rest, warnings);
  if (!member) return tl::unexpected(member.error());
  Result<Recording> recording =
      *member ? ReadWhole(folder, **member, rest, read) : ReadOnlyReadable(folder, rest, read);
  if (recording) recording->warnings.insert(recording->warnings.begin(), warnings.begin(), warnings.end());
  return recording;
}

}  // namespace pendulum
