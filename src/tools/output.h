// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/staged_file.h"
#include "pendulum/base/status.h"
#include "pendulum/report/section_text.h"

namespace pendulum {

/// A file from the command line and its flag (for messages): {"--json", "fit.json"}.
struct NamedFile {
  std::string flag;
  std::string path;
};

/// A text and the path of its file.
struct Output {
  std::string path;
  std::string text;
};

/// The path of output `index` (0-based) of `count`: unchanged for a single output, otherwise run_001.csv for run.csv.
std::string NumberedPath(const std::string& path, int index, int count);

/// True for "-" and its other names, /dev/stdout and /dev/fd/1.
bool IsStandardOutput(const std::string& path);

/// Checks before any work that the outputs can be written, and leaves no trace. Existing files are examined, and one
/// file is opened in each folder; the time is proportional to the number of outputs.
///
/// kInvalidArgument: two outputs are the same file (a character device such as /dev/null may be repeated), or an output
/// is an input or the target of standard output. kCannotWrite: a directory, no such directory, no permission.
Result<void> CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

/// Writes the outputs: files first, then standard output, pipes and devices in the given order.
///
/// A file is written next to its final path under a temporary name, synchronised with the disk unless that is deferred,
/// and renamed when all files are complete. Readers see the old file or the new one, never a part. A replaced file
/// keeps its permissions; a symbolic link stays and its target is replaced. kCannotWrite: the path and the system's
/// message.
Result<void> WriteOutputs(std::span<const Output> outputs, Durability durability = Durability::kSynchronised);

/// Writes piece(0) to piece(count - 1) in order, like one text of WriteOutputs. A file is written piece by piece and is
/// never whole in memory; the text of a stream is. If a piece is an error, nothing is written.
Result<void> WritePieces(const std::string& path, int count, const std::function<Result<std::string>(int)>& piece);

/// Writes one piece of a text; an error ends the writing.
using PieceSink = std::function<Result<void>(std::string_view)>;

/// Writes the pieces that `run` passes to its argument. A file appears when it is complete; a stream gets each piece at
/// once. kCannotWrite; errors of `run`.
Result<void> WriteStreamed(const std::string& path, const std::function<Result<void>(const PieceSink&)>& run);

/// Synchronises the file system of the file `path`, so that all writes survive a loss of power. kCannotWrite.
Result<void> SynchroniseFileSystem(const std::string& path);

/// The incomplete recording on disk, named PATH.part. It can be read at any time, so a crash or a loss of power costs
/// at most a second of data. A stream has no part file.
class PartFile {
 public:
  /// `path`: final path of the recording; empty: none.
  explicit PartFile(const std::string& path);
  PartFile(const PartFile&) = delete;
  PartFile(PartFile&&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  PartFile& operator=(PartFile&&) = delete;
  ~PartFile();

  /// Whether a part file exists, from an earlier recording.
  bool Exists() const;

  /// Creates the part file, or empties an existing one. kCannotWrite.
  Result<void> Open();

  /// kCannotWrite.
  Result<void> Append(std::string_view text);

  /// Writes the appended text to the disk. kCannotWrite.
  Result<void> Synchronise();

  /// Deletes the part file. To be called when the complete recording is written.
  void Remove();

  const std::string& path() const { return path_; }

 private:
  std::string path_;  // empty for a stream
  int descriptor_ = -1;
};

/// Whether output to a file descriptor may be coloured: it is a terminal with colours (TERM is set and not "dumb"), and
/// NO_COLOR is absent or empty (https://no-color.org).
bool WantsColour(int descriptor);

/// Whether lines on a file descriptor can be redrawn: it is a terminal with cursor control.
bool CanRedraw(int descriptor);

struct TerminalSize {
  std::size_t columns = 80, rows = 24;
};

/// Current size of the terminal; a usual size if it is unknown.
TerminalSize SizeOfTerminal(int descriptor);

/// Colour and width of a text for a file descriptor: those of its terminal, with 40 to 100 columns; elsewhere plain,
/// with 80 columns.
TextStyle TextStyleFor(int descriptor);

}  // namespace pendulum
