// SPDX-License-Identifier: Apache-2.0
#include "tools/shell_command.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// The name of the flag in an argument, with underscores: "time_column" for "-time-column=1:ms"; empty for other
/// arguments.
std::string FlagName(std::string_view argument) {
  if (argument.size() < 2 || argument[0] != '-') return {};
  argument.remove_prefix(argument[1] == '-' ? 2 : 1);
  std::string name(argument.substr(0, argument.find('=')));
  std::ranges::replace(name, '-', '_');
  return name == "models" ? "model" : name;
}

struct TryFlag {
  std::string name;
  std::vector<std::string> words;  ///< The flag and its value, if it has one.
};

TryFlag ParseTryFlag(const std::string& flag) {
  const std::size_t space = flag.find(' ');
  if (space == std::string::npos) return {FlagName(flag), {flag}};
  return {FlagName(flag.substr(0, space)), {flag.substr(0, space), flag.substr(space + 1)}};
}

}  // namespace

std::string ShellCommand(std::span<const std::string> words) {
  std::string command;
  for (const std::string& word : words) command += (command.empty() ? "" : " ") + ShellWord(word);
  return command;
}

std::string CommandToTry(std::span<const std::string> words, std::span<const std::string> try_flags) {
  std::map<std::string, std::size_t> lengths;  // name of each flag to try, and number of its words
  std::vector<std::string> added;
  std::string data;  // of --data, which the command has named without the flag
  for (const std::string& flag : try_flags) {
    const TryFlag parsed = ParseTryFlag(flag);
    lengths[parsed.name] = parsed.words.size();
    if (parsed.name == "data") data = parsed.words.back();
    added.insert(added.end(), parsed.words.begin(), parsed.words.end());
  }
  std::vector<std::string> command;
  std::size_t i = 0;
  for (; i < words.size() && words[i] != "--"; ++i) {
    if (i > 0 && words[i] == data) continue;
    const auto found = lengths.find(FlagName(words[i]));
    if (i == 0 || found == lengths.end()) {
      command.push_back(words[i]);
    } else if (found->second == 2 && words[i].find('=') == std::string::npos) {
      ++i;  // its value
    }
  }
  command.insert(command.end(), added.begin(), added.end());
  if (i < words.size()) command.insert(command.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
  return ShellCommand(command);
}

}  // namespace pendulum
