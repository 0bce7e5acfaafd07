// SPDX-License-Identifier: Apache-2.0
#include "tools/run_tool.h"

#include <csignal>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <glog/logging.h>

#include "pendulum/base/try.h"
#include "tools/flags.h"
#include "tools/output.h"
#include "tools/shell_command.h"

namespace pendulum {
namespace {

/// The words of the command line, as the user gave them.
std::vector<std::string>& GivenCommand() {
  static std::vector<std::string> words;
  return words;
}

Result<int> Run(const Tool& tool, int argc, char** argv) {
  ASSIGN_OR_RETURN(const ParsedFlags flags, ParseFlags(argc, argv, tool.main_file, tool.usage));
  if (flags.answer.empty()) return tool.work(flags.positional);
  RETURN_IF_ERROR(WriteOutputs(std::vector<Output>{{"-", flags.answer}}));
  return 0;
}

}  // namespace

void PrintError(std::string_view name, const Status& error) {
  PrintMessage(name, error.message());
  if (!error.try_flags.empty()) std::cerr << "try: " << CommandToTry(GivenCommand(), error.try_flags) << '\n';
}

void PrintMessage(std::string_view name, std::string_view sentence) { std::cerr << name << ": " << sentence << '\n'; }

void RegisterRunFlags(RunFlags& values, RunFlags& defaults) {
  for (const RunFlag& flag : RunFlagTable()) {
    const auto add = [&](auto* value) {
      gflags::FlagRegisterer(flag.name.data(), flag.help.c_str(), __FILE__, value,
                             std::get<decltype(value)>(flag.In(defaults)));
    };
    std::visit(add, flag.In(values));
  }
}

int RunTool(const Tool& tool, int argc, char** argv) {
  GivenCommand().assign(argv, argv + argc);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres' remarks on trial steps are of no use to users
  if (!google::IsGoogleLoggingInitialized()) google::InitGoogleLogging(argv[0]);
  std::signal(SIGXFSZ, SIG_IGN);  // A file size limit then causes an ordinary write error.
  try {
    const Result<int> code = Run(tool, argc, argv);
    if (code) return *code;
    PrintError(tool.name, code.error());
    return ExitCode(code.error().code);
  } catch (const std::exception& error) {
    PrintMessage(tool.name, std::string("internal error: ") + error.what());
    return ExitCode(StatusCode::kInternal);
  }
}

}  // namespace pendulum
