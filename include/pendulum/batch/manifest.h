// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// One run of a batch, as listed in a manifest.
struct ManifestEntry {
  std::int64_t position = 0;       ///< Index among all entries, from 0.
  std::string id;                  ///< Unique among the entries.
  std::string path;                ///< Path of the recording, relative to the manifest's folder.
  std::string rig;                 ///< Path of its rig file, also relative; empty: the rig of the whole batch.
  std::string calibration;         ///< Path of its calibration file, also relative; empty: as for the whole batch.
  std::optional<double> from, to;  ///< Ends of its window, s on the file's clock; std::nullopt: the batch's.
  std::string models;              ///< "viscous,coulomb" or "all"; empty: the models of the whole batch.
  std::string columns = "{}";      ///< The manifest's other columns: a JSON object of texts.
  std::string place;               ///< "runs.csv:7", for messages; empty if the entry comes from no text file.
};

/// Receives the entries one by one; an error ends the reading.
using EntrySink = std::function<Result<void>(const ManifestEntry&)>;

/// Reads a manifest: CSV (RFC 4180, also with semicolons or tabs) whose header has the column `path`, and optionally
/// `id` (default: the path), `rig`, `calibration`, `from_s`, `to_s`, `models`; other columns are kept. The listed files
/// are not checked here. Only one row is in memory. kNotFound: no such file. kDataLoss: invalid CSV, no column `path`,
/// a repeated column, a column whose name is nearly one of these, a row with too few or too many fields, an empty path,
/// an invalid window or model; the message has file, line and column.
Result<void> ReadManifest(const std::filesystem::path& path, const EntrySink& take);

}  // namespace pendulum
