// SPDX-License-Identifier: Apache-2.0
#include "tools/completion.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

/// The flags to complete.
std::vector<FlagInfo> OwnFlags(std::span<const FlagInfo> flags) {
  std::vector<FlagInfo> own;
  std::ranges::copy_if(flags, std::back_inserter(own), &FlagInfo::own);
  return own;
}

std::string JoinWords(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : separator).append(word);
  return text;
}

/// The beginning of the help of a flag, without characters that a shell would interpret.
std::string ShortHelp(const FlagInfo& flag) {
  constexpr std::size_t kLongest = 70;
  std::string text = flag.help.substr(0, std::min(flag.help.find(". "), flag.help.find("; ")));
  text = text.substr(0, text.find(": "));
  if (text.size() > kLongest) {
    text.resize(kLongest);
    text.resize(text.rfind(' '));
  }
  std::erase_if(text, [](char each) { return std::string_view("'\"`$\\[]:").find(each) != std::string_view::npos; });
  while (text.ends_with('.') || text.ends_with(',')) text.pop_back();
  return text;
}

std::string BashScript(const std::string& tool, const std::vector<FlagInfo>& flags) {
  std::vector<std::string> all, files, others;
  std::string choices;
  for (const FlagInfo& flag : flags) {
    all.push_back("--" + flag.name);
    if (flag.type == "bool") continue;
    if (!flag.words.empty()) {
      choices += "    --" + flag.name + ") words='" + JoinWords(flag.words, " ") + "' ;;\n";
    } else {
      (flag.is_path ? files : others).push_back("--" + flag.name);
    }
  }
  std::string script = "# bash completion of " + tool + ", made by " + tool + " --completion bash\n_" + tool + "() {\n";
  script +=
      "  local current=${COMP_WORDS[COMP_CWORD]} flag=${COMP_WORDS[COMP_CWORD - 1]} words= first=\n"
      "  COMPREPLY=()\n"
      "  # Bash splits --flag=value at the equals sign.\n"
      "  if [[ $current == '=' ]]; then\n"
      "    current=\n"
      "  elif [[ $flag == '=' ]]; then\n"
      "    flag=${COMP_WORDS[COMP_CWORD - 2]}\n"
      "  fi\n"
      "  if [[ $flag == -[!-]* ]]; then flag=-$flag; fi\n"
      "  case $flag in\n" +
      choices;
  if (!others.empty()) script += "    " + JoinWords(others, " | ") + ") return ;;\n";
  if (!files.empty()) script += "    " + JoinWords(files, " | ") + ") words='<file>' ;;\n";
  script +=
      "  esac\n"
      "  if [[ -z $words && $current == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '" +
      JoinWords(all, " ") +
      "' -- \"$current\")\n"
      "  elif [[ -z $words || $words == '<file>' ]]; then\n"
      "    compopt -o filenames 2> /dev/null\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
      "  else\n"
      "    if [[ $current == *,* ]]; then first=${current%,*},; fi  # a list\n"
      "    mapfile -t COMPREPLY < <(compgen -P \"$first\" -W \"$words\" -- \"${current##*,}\")\n"
      "  fi\n"
      "}\n"
      "complete -F _" +
      tool + " " + tool + "\n";
  return script;
}

std::string ZshScript(const std::string& tool, const std::vector<FlagInfo>& flags) {
  std::string script = "#compdef " + tool + "\n# zsh completion of " + tool + ", made by " + tool +
                       " --completion zsh\n_arguments -S \\\n";
  for (const FlagInfo& flag : flags) {
    std::string value;
    if (flag.type != "bool") {
      value = ":" + flag.name + ":";
      if (!flag.words.empty()) value += "(" + JoinWords(flag.words, " ") + ")";
      if (flag.is_path) value += "_files";
    }
    script += "  '--" + flag.name + (value.empty() ? "" : "=") + "[" + ShortHelp(flag) + "]" + value + "' \\\n";
  }
  return script + "  '*:file:_files'\n";
}

std::string FishScript(const std::string& tool, const std::vector<FlagInfo>& flags) {
  std::string script = "# fish completion of " + tool + ", made by " + tool + " --completion fish\n";
  for (const FlagInfo& flag : flags) {
    std::string value;
    if (flag.type != "bool") value = flag.is_path ? " -r -F" : " -x";
    if (flag.type != "bool" && !flag.is_path && !flag.words.empty()) {
      value.append(" -a '").append(JoinWords(flag.words, " ")).append("'");
    }
    script.append("complete -c ").append(tool).append(" -l ").append(flag.name).append(value);
    script.append(" -d '").append(ShortHelp(flag)).append("'\n");
  }
  return script;
}

}  // namespace

Result<std::string> CompletionScript(std::string_view shell, std::string_view tool, std::span<const FlagInfo> flags) {
  const std::vector<FlagInfo> own = OwnFlags(flags);
  if (shell == "bash") return BashScript(std::string(tool), own);
  if (shell == "zsh") return ZshScript(std::string(tool), own);
  if (shell == "fish") return FishScript(std::string(tool), own);
  return BadFlag("--completion is '" + std::string(shell) + "'; it must be bash, zsh or fish");
}

}  // namespace pendulum
