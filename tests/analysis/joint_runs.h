// SPDX-License-Identifier: Apache-2.0
// Several recordings of the textbook's rig, each fitted alone.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/analysis/homogeneity.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

/// 20 s of the rig released at `angle`, with white noise of 2 mrad.
inline SyntheticOptions ReleasedRun(std::string_view model, double angle, std::uint64_t seed) {
  SyntheticOptions run = TextbookRun(model);
  run.release_angle = angle;
  run.noise = 0.002;
  run.seed = seed;
  return run;
}

/// Runs released at 0.3, 0.4 ... rad, with seeds from `seed` on.
inline std::vector<SyntheticOptions> SeveralRuns(int count, std::uint64_t seed, std::string_view model = "coulomb") {
  std::vector<SyntheticOptions> runs;
  for (int k = 0; k < count; ++k) {
    runs.push_back(ReleasedRun(model, 0.3 + 0.1 * k, seed + static_cast<std::uint64_t>(k)));
  }
  return runs;
}

/// Recordings with a fit each, as input of TestHomogeneity. The object cannot be moved: runs refer to it.
class FittedAlone {
 public:
  explicit FittedAlone(FitOptions options) : options_(std::move(options)) {}
  FittedAlone(const FittedAlone&) = delete;
  FittedAlone& operator=(const FittedAlone&) = delete;

  FittedAlone(const std::vector<SyntheticOptions>& runs, FitOptions options) : FittedAlone(std::move(options)) {
    for (const SyntheticOptions& run : runs) Add(Must(SimulateRecording(run)));
  }

  void Add(Recording recording) {
    fits_.push_back(pendulum::Fit(recording, options_));
    recordings_.push_back(std::move(recording));
  }

  void TestConstancies() {
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      constancies_.push_back(TestConstancy(recordings_[k], fits_[k], options_));
    }
  }

  std::vector<RunAlone> Runs() const {
    std::vector<RunAlone> runs;
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      const Constancy* const constancy = k < constancies_.size() ? &constancies_[k] : nullptr;
      runs.push_back({"recording " + std::to_string(k + 1), recordings_[k], fits_[k], options_, constancy});
    }
    return runs;
  }

  const FitOptions& options() const { return options_; }
  const Recording& RecordingOf(std::size_t k) const { return recordings_[k]; }
  const Constancy& ConstancyOf(std::size_t k) const { return constancies_[k]; }
  FitReport& Fit(std::size_t k) { return fits_[k]; }
  const FitReport& Fit(std::size_t k) const { return fits_[k]; }

 private:
  FitOptions options_;
  std::deque<Recording> recordings_;
  std::deque<FitReport> fits_;
  std::deque<Constancy> constancies_;
};

}  // namespace pendulum
