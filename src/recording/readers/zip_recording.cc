// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/zip_recording.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "pendulum/recording/readers/columns/line_reader.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/name_list.h"
#include "recording/readers/columns/runs.h"
#include "recording/readers/content.h"
#include "recording/readers/mat/mat_recording.h"
#include "recording/readers/text/row_reader.h"
#include "recording/readers/zip_members.h"

namespace pendulum {
namespace {

using Member = ZipMembers::Member;

/// What the first lines of a member show.
struct MemberSummary {
  const Member* member = nullptr;
  std::vector<std::string> candidates;  // Names of columns; one empty name for a MAT-file, which is not examined.
  std::optional<Status> fault;          // Why the member cannot be read.
};

/// "MEMBER/COLUMN", each shortened as for a message.
std::string QuotedMemberAndColumn(const std::string& member, const std::string& column) {
  std::string pair = Quoted(member);
  if (column.empty()) return pair;
  pair.back() = '/';
  return pair + Quoted(column).substr(1);
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
    return candidates;
  }
  for (const std::size_t i : csv::CandidatesOf(columns, options.unit)) candidates.push_back(columns[i].written);
  return candidates;
}

MemberSummary SummarizeMember(const ZipMembers& zip, const Member& member, const ReadOptions& options) {
  constexpr std::size_t kHeadBytes = std::size_t{1} << 16;
  MemberSummary summary{&member, {}, {}};
  const Result<std::string> begin = zip.Unpack(member, kHeadBytes);
  if (!begin) {
    summary.fault = begin.error();
    return summary;
  }
  const Content content = ContentOf(begin->substr(0, kContentBytes));
  if (content == Content::kMat) summary.candidates.emplace_back();
  if (content != Content::kText) return summary;
  const std::string_view lines(begin->data(), begin->size() < kHeadBytes ? begin->size() : begin->rfind('\n') + 1);
  const auto columns = ReadColumnNames(LineReader(lines, zip.NameOf(member)));
  if (columns) summary.candidates = CandidatesIn(*columns, options);
  return summary;
}

/// The member that --value_column names, alone or before a slash. Removes the name of the member from the option. Whole
/// paths have priority over file names. nullptr: no such member. kInvalidArgument: two files have this name.
Result<const Member*> FindNamed(const ZipMembers& zip, const std::string& name, ReadOptions& options) {
  const std::string& flag = options.value_column;
  const auto is_named = [&](std::string_view path) {
    return flag.starts_with(path) && (flag.size() == path.size() || flag[path.size()] == '/');
  };
  const auto file_of = [](const Member& member) { return member.path.substr(member.path.rfind('/') + 1); };
  const auto take = [&](const Member& member, std::size_t size) {
    options.value_column.erase(0, std::min(size + 1, flag.size()));
    return &member;
  };
  const Member* by_file = nullptr;
  for (const Member& member : zip.members()) {
    if (is_named(member.path)) return take(member, member.path.size());
  }
  for (const Member& member : zip.members()) {
    if (!is_named(file_of(member))) continue;
    if (by_file != nullptr && file_of(member) == file_of(*by_file)) {
      return Error(StatusCode::kInvalidArgument, name + ": --value_column is " + Quoted(flag) + ", but both " +
                                                     Quoted(by_file->path) + " and " + Quoted(member.path) +
                                                     " have this name; give the path within the zip file");
    }
    by_file = &member;
  }
  return by_file == nullptr ? by_file : take(*by_file, file_of(*by_file).size());
}

tl::unexpected<Status> NoMember(const ZipMembers& zip, const std::string& name) {
  if (zip.Has("xl/workbook.xml"))
    return pendulum::Fault(name, "this is an Excel workbook; save its sheet as CSV and give the CSV file");
  std::vector<std::string> members;
  for (const Member& member : zip.members()) members.push_back(Quoted(member.path));
  if (members.empty()) return pendulum::Fault(name, "this zip file contains no recording; give another file");
  return pendulum::Fault(name, "none of its files " + ListOf(members) +
                                   " has a column of times and one of an angle or a rate; choose with --value_column "
                                   "\"FILE/COLUMN\", or name another recording");
}

/// Chooses the member to read.
Result<const Member*> ChooseMember(const ZipMembers& zip, const std::string& name, ReadOptions& options,
                                   std::vector<Warning>& warnings) {
  constexpr std::size_t kMaxMembers = 1000, kMaxWarnings = 8;  // A malicious zip file may contain a million members.
  Result<const Member*> named = FindNamed(zip, name, options);
  if (!named || *named != nullptr) return named;
  if (zip.members().size() == 1) return &zip.members().front();
  std::vector<MemberSummary> summaries;
  std::vector<std::string> candidates;
  std::optional<Status> fault;  // For the first unreadable member.
  for (std::size_t i = 0; i < std::min(zip.members().size(), kMaxMembers); ++i) {
    MemberSummary summary = SummarizeMember(zip, zip.members()[i], options);
    if (summary.fault && warnings.size() < kMaxWarnings)
      warnings.push_back({"unreadable_member", summary.fault->message});
    if (summary.fault && !fault) fault = summary.fault;
    if (summary.candidates.empty()) continue;
    for (const std::string& column : summary.candidates)
      candidates.push_back(QuotedMemberAndColumn(summary.member->path, column));
    summaries.push_back(std::move(summary));
  }
  if (summaries.size() == 1) return summaries.front().member;
  if (summaries.empty() && fault) return tl::unexpected(*std::move(fault));
  if (summaries.empty()) return NoMember(zip, name);
  return pendulum::Fault(name, "columns " + SeveralQuantities(candidates));
}

Result<Recording> ReadMember(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  switch (ContentOf(bytes.substr(0, kContentBytes))) {
    case Content::kText: return ReadRows(LineReader(bytes, name), options);
    case Content::kMat: return ReadMat(bytes, name, options);
    case Content::kZip:
      return pendulum::Fault(name, "this is a zip file in a zip file; unpack it and give the unpacked file");
    case Content::kForeign: break;
  }
  return ForeignContent(bytes, name);
}

}  // namespace

Result<Recording> ReadZip(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const Result<ZipMembers> zip = ZipMembers::Open(bytes, name);
  if (!zip) return tl::unexpected(zip.error());
  ReadOptions rest = options;
  std::vector<Warning> warnings;
  const Result<const Member*> member = ChooseMember(*zip, name, rest, warnings);
  if (!member) return tl::unexpected(member.error());
  const std::size_t max_bytes = options.most_unpacked_bytes;
  const Result<std::string> text = zip->Unpack(**member, max_bytes + 1);
  if (!text) return tl::unexpected(text.error());
  if (text->size() > max_bytes) {
    return pendulum::Fault(zip->NameOf(**member),
                           "it unpacks to more than " + std::to_string(max_bytes) +
                               " bytes, too many for a recording; give a smaller file, or split it");
  }
  Result<Recording> recording = ReadMember(*text, zip->NameOf(**member), rest);
  if (!recording) return recording;
  Result<std::string> sha256 = Sha256(bytes);
  if (!sha256) return tl::unexpected(std::move(sha256).error());
  recording->path = name;
  recording->warnings.insert(recording->warnings.begin(), warnings.begin(), warnings.end());
  recording->sha256 = *std::move(sha256);
  return recording;
}

}  // namespace pendulum
