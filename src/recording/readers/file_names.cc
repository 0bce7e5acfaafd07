// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/file_names.h"

#include <algorithm>
#include <array>

namespace pendulum {
namespace {

constexpr std::array<std::string_view, 16> kEndings = {"csv", "dat", "fods",    "log", "lvm", "mat", "mot",  "npy",
                                                       "npz", "ods", "phyphox", "tsv", "txt", "xls", "xlsx", "zip"};

}  // namespace

bool HasRecordingName(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return false;
  std::string ending(name.substr(dot + 1));
  std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

std::string RecordingNames() {
  std::string names;
  for (const std::string_view ending : kEndings) {
    names += (names.empty() ? "" : ending == kEndings.back() ? " and " : ", ") + ("*." + std::string(ending));
  }
  return names;
}

}  // namespace pendulum
