// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/warning.h"

#include <algorithm>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

void Append(const std::string& part, const std::string& separator, std::string& message) {
  if (part.empty()) return;
  if (!message.empty()) message += separator;
  message += part;
}

std::string RecordingOf(const WarningSubject& about) {
  return about.recording == WarningSubject::kEachRecording ? "each recording" : about.recording_name;
}

std::string LineOf(const WarningSubject& about) {
  if (about.line == 0) return about.file;
  return about.file + ":" + std::to_string(about.line);
}

}  // namespace

std::string MessageText(const Warning& warning) {
  std::string text;
  for (const std::string& part : {RecordingOf(warning.about), warning.about.law, LineOf(warning.about)})
    Append(part, ": ", text);
  Append(warning.finding, ": ", text);
  for (const std::string& part : {warning.explanation, warning.advice}) Append(part, "; ", text);
  return text;
}

std::string TextWithoutLaw(Warning warning) {
  warning.about.law.clear();
  return MessageText(warning);
}

std::string ShortText(const Warning& warning, const std::string& recording) {
  const WarningSubject& about = warning.about;
  const bool is_inside = !recording.empty() && about.file.starts_with(recording + ":");
  std::string place = is_inside ? about.file.substr(recording.size() + 1) : "";
  if (about.line > 0) Append("line " + std::to_string(about.line), ", ", place);
  std::string text = RecordingOf(warning.about);
  Append(place, ": ", text);
  Append(warning.finding, ": ", text);
  if (!warning.flags.empty()) Append(Capitalized(warning.advice), ". ", text);
  return text;
}

const Warning* FindWarning(const std::vector<Warning>& warnings, WarningCode code) {
  const auto found = std::ranges::find_if(warnings, [&](const Warning& warning) { return warning.code == code; });
  return found == warnings.end() ? nullptr : &*found;
}

bool HasWarning(const std::vector<Warning>& warnings, WarningCode code) {
  return FindWarning(warnings, code) != nullptr;
}

}  // namespace pendulum
