// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/choose_swings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/closed_form/swing_information.h"
#include "pendulum/fitting/swing/clock_change.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// The swing between two ends that the user chose, in the form that FindFreeSwings returns.
FreeSwing GivenSwing(const Recording& part) {
  FreeSwing swing;
  swing.from = part.time[0];
  swing.to = part.time[part.size() - 1];
  swing.from_given = swing.to_given = true;
  swing.begins = {WindowBegin::Reason::kAsked};
  swing.ends = {WindowEnd::Reason::kAsked};
  return swing;
}

tl::unexpected<Status> NoSuchSwing(const std::string& path, int number, int count) {
  return ErrorAt(
      StatusCode::kInvalidArgument, path,
      "there is no free swing " + std::to_string(number) + " in the recording; it has " + std::to_string(count));
}

/// Warns of a change of the steps. Outside the chosen swings, it says that the clock may be wrong there or here, unless
/// it is near an end.
ChosenSwings WithWarning(ChosenSwings swings, const std::optional<StepChange>& change) {
  const auto has_change = [&](int k) {
    const FreeSwing& swing = swings.found[static_cast<std::size_t>(k - 1)];
    return swing.from < change->time && change->time < swing.to;
  };
  if (change && (!change->is_near_end || std::ranges::any_of(swings.chosen, has_change))) {
    swings.warnings.push_back(change->ToWarning());
  }
  return swings;
}

}  // namespace

Result<ChosenSwings> ChooseSwings(const Recording& recording, const SwingChoice& choice,
                                  const std::optional<Rig>& rig) {
  const bool from_given = !std::isnan(choice.from);
  const bool to_given = !std::isnan(choice.to);
  std::optional<Recording> selected;
  if (from_given || to_given) {
    ASSIGN_OR_RETURN(Recording part, SelectWindow(recording, choice.from, choice.to));
    selected = std::move(part);
  }
  const Recording* const part = selected ? &*selected : &recording;
  std::optional<StepChange> change;
  if (!from_given || !to_given) {
    const auto clock = CheckClock(*part, choice.is_spring || (rig && rig->is_spring));
    if (!clock) return Within(recording.path, clock.error());
    change = *clock;
  }
  if (IsUndersampled(*part, rig)) {
    if (choice.release > 1) return NoSuchSwing(recording.path, choice.release, 1);
    return WithWarning(ChosenSwings{{WholeRecording(*part)}, {1}, {}}, change);
  }
  if (from_given && to_given && choice.release == SwingChoice::kMostTelling)
    return ChosenSwings{{GivenSwing(*part)}, {1}};
  Result<std::vector<FreeSwing>> found = FindFreeSwings(*part, choice.is_spring || (rig && rig->is_spring));
  if (!found) return Within(recording.path, found.error());
  ChosenSwings swings{*std::move(found), {}, {}};
  const auto count = static_cast<int>(swings.found.size());
  if (choice.release > count) return NoSuchSwing(recording.path, choice.release, count);
  if (choice.release == SwingChoice::kAll) {
    for (int k = 1; k <= count; ++k) swings.chosen.push_back(k);
    return WithWarning(std::move(swings), change);
  }
  const auto best = std::ranges::max_element(
      swings.found, {}, [](const FreeSwing& swing) { return InformationOn(swing, swing.from, swing.to); });
  // If the user gave an end, the swing next to that end is chosen.
  int k = from_given ? 1 : to_given ? count : static_cast<int>(best - swings.found.begin()) + 1;
  if (choice.release > 0) k = choice.release;
  FreeSwing& swing = swings.found[static_cast<std::size_t>(k - 1)];
  if (from_given && choice.release == SwingChoice::kMostTelling) {
    swing.from = part->time[0];
    swing.from_given = true;
    swing.begins = {WindowBegin::Reason::kAsked};
  }
  if (to_given && choice.release == SwingChoice::kMostTelling) {
    swing.to = part->time[part->size() - 1];
    swing.to_given = true;
    swing.ends = {WindowEnd::Reason::kAsked};
  }
  swings.chosen = {k};
  return WithWarning(std::move(swings), change);
}

}  // namespace pendulum
