// SPDX-License-Identifier: Apache-2.0
#include "service/guide_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

namespace fs = std::filesystem;

std::string_view TypeOf(const fs::path& file) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kTypes = {{
      {".css", "text/css; charset=utf-8"},
      {".html", "text/html; charset=utf-8"},
      {".ico", "image/x-icon"},
      {".js", "text/javascript; charset=utf-8"},
      {".json", "application/json"},
      {".png", "image/png"},
      {".svg", "image/svg+xml"},
  }};
  const std::string ending = file.extension().string();
  const auto* const found = std::ranges::find(kTypes, ending, &std::pair<std::string_view, std::string_view>::first);
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

/// Whether a folder contains a file; both paths are canonical.
bool Contains(const fs::path& folder, const fs::path& file) {
  const fs::path rest = file.lexically_relative(folder);
  return !rest.empty() && *rest.begin() != "..";
}

}  // namespace

Result<GuideFile> ReadGuideFile(const std::string& folder, std::string_view path) {
  std::error_code fault;
  const fs::path root = folder.empty() ? fs::path() : fs::canonical(folder, fault);
  if (fault || root.empty()) {
    return Error(StatusCode::kNotFound,
                 "the user guide is not installed; build it with scripts/docs, and start serve_pendulum with --docs "
                 "and the folder of the guide");
  }
  const fs::path file = fs::canonical(root / fs::path(path), fault);
  if (fault || !Contains(root, file) || !fs::is_regular_file(file, fault)) {
    return Error(StatusCode::kNotFound,
                 "the user guide has no file '" + std::string(path) + "'; /docs/index.html lists its pages");
  }
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{16} << 20U;
  ASSIGN_OR_RETURN(auto bytes, ReadFile(file, "guide", kMaxBytes));
  return GuideFile{TypeOf(file), std::move(bytes)};
}

}  // namespace pendulum
