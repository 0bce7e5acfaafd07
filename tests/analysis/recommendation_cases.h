// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/model_comparison.h"
#include "pendulum/base/parallel.h"
#include "pendulum/model/friction/registry.h"
#include "tests/analysis/whole_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

/// A law for simulated recordings: friction in SI on the textbook's rig (N m s/rad, N m, N m s²/rad², rad/s).
struct TrueLaw {
  std::string_view model;
  std::vector<double> friction;
};

inline const std::array<TrueLaw, 4> kTrueLaws = {{{"viscous", {0.003}},
                                                  {"coulomb", {0.003, 0.004}},
                                                  {"drag", {0.001, 0.002, 0.002}},
                                                  {"stribeck", {0.002, 0.004, 0.008, 0.4}}}};

/// Held at 0.423 rad for 1.9 s, 100 Hz, 0.1985 degrees per count; the noise is given in counts.
inline SyntheticOptions LawRun(const TrueLaw& law, double duration, double noise_counts) {
  SyntheticOptions run = TextbookRun(law.model);
  const std::vector<ParameterInfo> infos = PhysicalParameters(run.model);
  for (std::size_t k = 0; k < law.friction.size(); ++k) {
    run.parameters[k + 1] = law.friction[k] / (infos[k + 1].scales_with_gravity() ? kTextbookTorque : 1.0);
  }
  run.duration = duration;
  run.noise = noise_counts * kCount;
  run.resolution = kCount;
  return run;
}

/// Number of recommendations of each registered law; an empty name means no recommendation. Predictions are skipped:
/// they count only if more than noise is left, and here only noise is left.
using Recommendations = std::map<std::string, int>;

inline Recommendations CountRecommendations(SyntheticOptions run, int count, std::uint64_t first_seed) {
  const std::vector<std::string> models(FrictionModels::kNames.begin(), FrictionModels::kNames.end());
  std::vector<std::string> recommended(static_cast<std::size_t>(count));
  ParallelFor(count, 0, [&](int i) {
    SyntheticOptions own = run;
    own.seed = first_seed + static_cast<std::uint64_t>(i);
    FitOptions options;
    options.interval = IntervalMethod::kCovariance;
    const Recording recording = *SimulateRecording(own);
    auto fitted = FitModels(recording, Whole(recording), options, models);
    if (!fitted) return;
    recommended[static_cast<std::size_t>(i)] =
        CompareModels(OnlyOne(*std::move(fitted)), options, {.predict = false}).recommended;
  });
  Recommendations counts;
  for (const std::string& name : recommended) ++counts[name];
  return counts;
}

}  // namespace pendulum
