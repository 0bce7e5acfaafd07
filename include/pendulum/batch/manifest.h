// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// One run of a batch, as a manifest names it.
struct ManifestEntry {
  std::int64_t position = 0;       ///< Among all entries, from 0.
  std::string id;                  ///< Unlike that of any other entry.
  std::string path;                ///< Of the recording, as the manifest has it: relative to the manifest's folder.
  std::string rig;                 ///< Path of its rig file, likewise; empty: that of the whole batch.
  std::string calibration;         ///< Path of its calibration file, likewise; empty: that of the whole batch.
  std::optional<double> from, to;  ///< Ends of its window, s on the file's clock; none: as of the whole batch.
  std::string models;              ///< "viscous,coulomb" or "all"; empty: those of the whole batch.
  std::string columns = "{}";      ///< What else the manifest says of it: a JSON object of texts.
  std::string place;               ///< "runs.csv:7", for messages; empty where an entry has none.
};

/// What takes the entries one by one; an error ends the reading.
using TakeEntry = std::function<Result<void>(const ManifestEntry&)>;

/// Reads a manifest: CSV (RFC 4180, also with semicolons or tabs) whose header has the column `path`, and may have
/// `id` (else the path), `rig`, `calibration`, `from_s`, `to_s`, `models`; other columns are carried through. A file is
/// not looked for here. Memory: one row. kNotFound: no such file. kDataLoss: no CSV text, no column `path`, a column
/// twice, a row of another length, no path, a window or models that are none; the message has file, line and column.
Result<void> ReadManifest(const std::filesystem::path& path, const TakeEntry& take);

}  // namespace pendulum
