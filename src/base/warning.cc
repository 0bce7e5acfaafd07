// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/warning.h"

#include <algorithm>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

void Join(const std::string& text, const std::string& separator, std::string& all) {
  if (text.empty()) return;
  if (!all.empty()) all += separator;
  all += text;
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
    Join(part, ": ", text);
  Join(warning.finding, ": ", text);
  for (const std::string& part : {warning.explanation, warning.advice}) Join(part, "; ", text);
  return text;
}

std::string TextWithoutLaw(Warning warning) {
  warning.about.law.clear();
  return MessageText(warning);
}

std::string ShortText(const Warning& warning) {
  std::string text = RecordingOf(warning.about);
  if (warning.about.line > 0) Join("line " + std::to_string(warning.about.line), ": ", text);
  Join(warning.finding, ": ", text);
  if (!warning.flags.empty()) Join(Capitalized(warning.advice), ". ", text);
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
