// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_manifest.h"

#include <filesystem>
#include <system_error>

#include "pendulum/base/format.h"
#include "pendulum/batch/export.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

/// The folder of a file with symbolic links resolved, so that ".." leads back.
fs::path RealFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  const fs::path real = fs::canonical(folder.empty() ? "." : folder, error);
  return error ? fs::absolute(folder, error) : real;
}

/// `folder` relative to `base`: "" for the same folder, otherwise with a slash at its end.
std::string SeenFrom(const fs::path& base, const fs::path& folder) {
  const fs::path relative = folder.lexically_relative(base);
  return relative == "." ? "" : (relative / "").string();
}

}  // namespace

Manifest::Manifest(const SimulateOptions& options) : options_(options) {
  const fs::path base = RealFolder(IsStandardOutput(options.manifest_out) ? "" : options.manifest_out);
  folder_ = SeenFrom(base, RealFolder(options.out));
  if (options.rig_path.empty()) return;
  const std::string name = fs::path(options.rig_path).filename().string();
  rig_ = CsvField(SeenFrom(base, RealFolder(options.rig_path)) + name);
}

std::string Manifest::Header() const {
  std::string header = rig_.empty() ? "path,id,seed" : "path,id,rig,seed";
  for (const auto& [name, value] : options_.truth) header += ",true_" + name;
  return header + "\n";
}

Result<std::string> Manifest::Row(int index) const {
  const Result<Simulation> made = SimulationOfRecording(options_, index);
  if (!made) return tl::unexpected(made.error());
  const fs::path path = NumberedPath(options_.out, index, options_.count);
  std::string row = CsvField(folder_ + path.filename().string()) + "," + CsvField(path.stem().string()) + ",";
  if (!rig_.empty()) row += rig_ + ",";
  row += std::to_string(made->synthetic.seed);
  for (const auto& [name, value] : made->truth) row += "," + NumberText(value);
  return row + "\n";
}

}  // namespace pendulum
