// SPDX-License-Identifier: Apache-2.0
#include "tools/run_tool.h"

#include <csignal>
#include <exception>
#include <iostream>

#include <glog/logging.h>

#include "tools/flags.h"
#include "tools/output.h"

namespace pendulum {
namespace {

Result<int> Run(const Tool& tool, int argc, char** argv) {
  const Result<ParsedFlags> flags = ParseFlags(argc, argv, tool.main_file, tool.usage);
  if (!flags) return tl::unexpected(flags.error());
  if (flags->answer.empty()) return tool.work(flags->positional);
  if (const auto written = WriteOutputs(std::vector<Output>{{"-", flags->answer}}); !written) {
    return tl::unexpected(written.error());
  }
  return 0;
}

}  // namespace

void PrintMessage(std::string_view name, std::string_view sentence) { std::cerr << name << ": " << sentence << '\n'; }

void RegisterRunFlags(RunFlags& values, RunFlags& defaults) {
  for (const RunFlag& flag : RunFlagTable()) {
    const auto add = [&](auto member) {
      gflags::FlagRegisterer(flag.name.data(), flag.help.c_str(), __FILE__, &(values.*member), &(defaults.*member));
    };
    std::visit(add, flag.value);
  }
}

int RunTool(const Tool& tool, int argc, char** argv) {
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres' remarks on trial steps are of no use to users
  if (!google::IsGoogleLoggingInitialized()) google::InitGoogleLogging(argv[0]);
  std::signal(SIGXFSZ, SIG_IGN);  // A file size limit then causes an ordinary write error.
  try {
    const Result<int> code = Run(tool, argc, argv);
    if (code) return *code;
    PrintMessage(tool.name, code.error().message);
    return ExitCode(code.error().code);
  } catch (const std::exception& error) {
    PrintMessage(tool.name, std::string("internal error: ") + error.what());
    return ExitCode(StatusCode::kInternal);
  }
}

}  // namespace pendulum
