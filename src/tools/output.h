// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/staged_file.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// A file the command line names, and the flag that names it (for messages): {"--json", "fit.json"}.
struct NamedFile {
  std::string flag;
  std::string path;
};

/// What is to be written where.
struct Output {
  std::string path;
  std::string text;
};

/// The path of output `index` (0-based) of `count`: the path itself when there is one, else run_001.csv for run.csv.
std::string NumberedPath(const std::string& path, int index, int count);

/// True for "-" and its other names, /dev/stdout and /dev/fd/1.
bool IsStandardOutput(const std::string& path);

/// Checks before any work is done that the outputs can be written; leaves no trace. A file that is there is looked at,
/// and in each folder one file is opened, so that the time is proportional to the number of outputs.
///
/// kInvalidArgument: two outputs are one file (a character device such as /dev/null may be named twice), or an output
/// is one of the inputs, or the file that standard output is redirected to. kCannotWrite: a directory, no such
/// directory, no permission.
Result<void> CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

/// Writes the outputs: files first, then standard output, pipes and devices in the order given.
///
/// A file is written beside its place under a temporary name, synchronised with the disk unless that is deferred, and
/// renamed once all files have come so far: whoever looks sees the old file or the new one, never a part. A replaced
/// file keeps its permissions; a symbolic link stays and its target is replaced. kCannotWrite: the system's own words
/// follow the path.
Result<void> WriteOutputs(std::span<const Output> outputs, Durability durability = Durability::kSynchronised);

/// Writes piece(0) to piece(count - 1) one after the other as WriteOutputs does one text; a file is never in memory as
/// a whole. Nothing is written where a piece is an error.
Result<void> WritePieces(const std::string& path, int count, const std::function<Result<std::string>(int)>& piece);

/// Takes a text piece by piece; an error ends the writing.
using TakePiece = std::function<Result<void>(std::string_view)>;

/// Writes what `run` gives to the function it is called with: a file is there once all of it is written, a stream gets
/// the pieces as they come. kCannotWrite; errors of `run`.
Result<void> WriteStreamed(const std::string& path, const std::function<Result<void>(const TakePiece&)>& run);

/// Makes all that was written to the file system of the file `path` survive a loss of power. kCannotWrite.
Result<void> SynchroniseFileSystem(const std::string& path);

}  // namespace pendulum
