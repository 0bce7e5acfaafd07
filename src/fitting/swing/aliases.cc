// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/aliases.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/fitting/start/scan_starts.h"
#include "pendulum/fitting/swing/undersampled.h"

namespace pendulum {
namespace {

double TorqueOf(const FitOptions& options) { return options.rig ? options.rig->gravity_torque.value : 1.0; }

/// Frequency of small swings in rad/s for an inertia in the units of the options.
double FrequencyOf(double inertia, const FitOptions& options) { return std::sqrt(TorqueOf(options) / inertia); }

/// Without those whose frequency is that of a likelier one.
std::vector<Alias> WithoutDuplicates(std::vector<Alias> aliases, double duration) {
  constexpr double kSame = 0.1;  // cycles over the recording
  std::vector<Alias> distinct;
  for (Alias& alias : aliases) {
    const bool known = std::ranges::any_of(
        distinct, [&](const Alias& other) { return std::abs(other.frequency - alias.frequency) * duration < kSame; });
    if (!known) distinct.push_back(std::move(alias));
  }
  return distinct;
}

}  // namespace

double DurationOf(const Recording& recording) {
  return recording.clock_scale * (recording.time[recording.size() - 1] - recording.time[0]);
}

double SampleRateOf(const Recording& recording) {
  return DescribeSampling(recording, std::nullopt, std::nullopt).rate_hz / recording.clock_scale;
}

std::string Hz(double frequency) { return NumberText(frequency, 3) + " Hz"; }

bool IsLinear(const FitOptions& options) {
  const Result<MotionModel> model = ModelOf(options);
  return model && model->gravity.is_linear();
}

bool IsFrequencyKnown(const FitOptions& options) {
  const auto names = [](const auto& map) { return map.contains(kInertia.name); };
  return ExpectedFrequency(options.rig) || names(options.bounds) || names(options.initial) || names(options.fixed) ||
         names(options.priors);
}

AllowedFrequencies FindAllowedFrequencies(const Recording& used, const FitOptions& options) {
  const double fastest = IsLinear(options) ? 0.5 * SampleRateOf(used) : kFastestHz;
  AllowedFrequencies allowed{{kTurn / DurationOf(used), kTurn * fastest}, false};
  if (const auto expected = ExpectedFrequency(options.rig)) {
    allowed = {{(1 - kExpectedWithin) * kTurn * *expected, (1 + kExpectedWithin) * kTurn * *expected}, true};
  }
  for (const auto* values : {&options.initial, &options.fixed}) {
    const auto inertia = values->find(kInertia.name);
    if (inertia == values->end() || !(inertia->second > 0)) continue;
    if (values == &options.initial && allowed.bounded) continue;  // a start value is no limit
    const double frequency = FrequencyOf(inertia->second, options);
    const double within = values == &options.fixed ? 0 : kExpectedWithin;  // a start value is a guess
    allowed = {{(1 - within) * frequency, (1 + within) * frequency}, values == &options.fixed};
  }
  const auto bounds = options.bounds.find(kInertia.name);
  if (bounds == options.bounds.end()) return allowed;
  if (bounds->second.lower > 0) allowed.range.high = FrequencyOf(bounds->second.lower, options);
  if (bounds->second.upper < kUnbounded) allowed.range.low = FrequencyOf(bounds->second.upper, options);
  allowed.bounded = allowed.bounded || (bounds->second.lower > 0 && bounds->second.upper < kUnbounded);
  return allowed;
}

Result<std::vector<Alias>> FitAliases(const Recording& used, const AllowedFrequencies& allowed, FitOptions options) {
  constexpr double kBeyond = 1.02;  // the limits of a range are not exact bounds
  ASSIGN_OR_RETURN(const MotionModel model, ModelOf(options));
  ASSIGN_OR_RETURN(std::vector<StartValues> starts, ScanStarts(used, model, allowed.range, options));
  std::optional<Status> error;
  std::vector<Alias> aliases;
  for (StartValues& start : starts) {
    options.search.start_values = start;
    Result<FitReport> fit = FitRecording(used, options);
    if (!fit) error = fit.error();
    if (!fit || fit->termination == Termination::kFailed) continue;
    const double frequency = FrequencyOf(fit->Find(kInertia.name)->estimate, options) / kTurn;
    const bool inside =
        kTurn * frequency * kBeyond > allowed.range.low && kTurn * frequency < kBeyond * allowed.range.high;
    if (inside) aliases.push_back({std::move(start), *std::move(fit), frequency});
  }
  if (options.stop.stop_requested()) return FitStopped();
  if (aliases.empty() && error) return tl::unexpected(*error);
  std::ranges::stable_sort(aliases, std::ranges::greater(), &Alias::likelihood);
  return WithoutDuplicates(std::move(aliases), DurationOf(used));
}

std::vector<const Alias*> NearlyAsGood(const std::vector<Alias>& aliases, double within) {
  const double best = std::ranges::max_element(aliases, {}, &Alias::likelihood)->likelihood();
  std::vector<const Alias*> near;
  for (const Alias& alias : aliases) {
    if (2 * (best - alias.likelihood()) <= within) near.push_back(&alias);
  }
  return near;
}

std::string ListOf(std::vector<const Alias*> aliases, double rate) {
  constexpr double kMinPerPeriod = 3;
  std::ranges::stable_partition(aliases, [&](const Alias* alias) { return rate >= kMinPerPeriod * alias->frequency; });
  std::string list;
  for (const Alias* alias : aliases) {
    const ParameterEstimate& inertia = *alias->fit.Find(kInertia.name);
    list += (list.empty() ? "" : ", ") + NumberText(inertia.estimate, 4) + " " + inertia.unit + " (" +
            Hz(alias->frequency) + ")";
  }
  return list;
}

std::string BoundsFlag(double frequency, const FitOptions& options) {
  const auto inertia_at = [&](double hz) { return TorqueOf(options) / std::pow(kTurn * hz, 2); };
  return "--bounds inertia=" + NumberText(inertia_at((1 + kExpectedWithin) * frequency), 3) + ":" +
         NumberText(inertia_at((1 - kExpectedWithin) * frequency), 3);
}

}  // namespace pendulum
