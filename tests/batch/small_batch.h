// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "pendulum/batch/refit.h"
#include "pendulum/batch/store.h"
#include "pendulum/trajectory/synthetic.h"

/// Batches of short synthetic recordings in temporary folders.
namespace pendulum::small_batch {

/// A temporary folder that is removed with its content.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::path(testing::TempDir()) / (name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

  std::string Read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path_ / name, std::ios::binary).rdbuf();
    return text.str();
  }

  /// Sorted names of the files in the folder that begin with `prefix`.
  std::vector<std::string> Names(const std::string& prefix = "") const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(prefix)) names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
  }

 private:
  std::filesystem::path path_;
};

/// Simulation options with the true values in units of the restoring torque G: I_O / G = 0.0438 s^2, b / G = 0.0011 s,
/// τ_c / G = 0.0022.
inline SyntheticOptions Truth(std::uint64_t seed, double release_angle = 0.4) {
  SyntheticOptions options;
  options.parameters = {0.0438, 0.0011, 0.0022};
  options.release_angle = release_angle;
  options.release_time = 0.3;
  options.duration = 8;
  options.sample_rate = 40;
  options.noise = 0.002;
  options.seed = seed;
  return options;
}

/// A simulated recording as CSV with exact numbers.
inline std::string RecordingText(const SyntheticOptions& options) {
  const auto recording = SimulateRecording(options);
  if (!recording) {
    ADD_FAILURE() << recording.error().message();
    return "";
  }
  std::string text = "time_s,angle_rad\n";
  for (Eigen::Index i = 0; i < recording->size(); ++i) {
    constexpr std::size_t kMaxCharacters = 64;
    std::array<char, kMaxCharacters> line{};
    std::snprintf(line.data(), line.size(), "%.17g,%.17g\n", recording->time[i], recording->value[i]);
    text += line.data();
  }
  return text;
}

inline std::string RecordingText(std::uint64_t seed) { return RecordingText(Truth(seed)); }

inline constexpr const char* kRigText = R"({"gravity_torque": {"value": 1.8, "std_dev": 0.002}})";

/// Options for one thread and the models in this order.
inline IdentifyOptions OptionsFor(const std::vector<std::string>& models) {
  IdentifyOptions options;
  options.models = models;
  options.fit.model = models.front();
  options.fit.threads = 1;
  return options;
}

/// Options of a refit with one thread and the models in this order.
inline RefitOptions OptionsWith(const std::vector<std::string>& models) {
  RefitOptions options;
  options.run.models = models;
  options.run.fit.model = models.front();
  options.threads = 1;
  return options;
}

/// Writes `runs` recordings 0.csv, 1.csv ... and the manifest runs.csv, where their ids are a, b, ...
inline void WriteBatch(const Folder& folder, int runs) {
  std::string manifest = "path,id\n";
  for (int k = 0; k < runs; ++k) {
    folder.Write(std::to_string(k) + ".csv", RecordingText(static_cast<std::uint64_t>(k) + 1));
    manifest += std::to_string(k) + ".csv," + std::string(1, static_cast<char>('a' + k)) + "\n";
  }
  folder.Write("runs.csv", manifest);
}

/// Refits the manifest into the store with that path; fails the test on an error.
inline RefitCounts RefitInto(const std::filesystem::path& store_path, const std::filesystem::path& manifest,
                             const RefitOptions& options) {
  const auto source = OpenSource(manifest);
  auto store = Store::Open(store_path, Store::Mode::kWrite);
  if (!source || !store) {
    ADD_FAILURE() << (source ? store.error().message() : source.error().message());
    return {};
  }
  const auto counts = Refit(*source, *store, options);
  if (counts) return *counts;
  ADD_FAILURE() << counts.error().message();
  return {};
}

}  // namespace pendulum::small_batch
