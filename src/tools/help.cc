// SPDX-License-Identifier: Apache-2.0
#include "tools/help.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "pendulum/model/rig.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

/// A heading, and the flags below it in their order.
struct HelpHeading {
  std::string_view title;
  std::vector<std::string_view> flags;
};

constexpr std::string_view kOther = "Other";

/// The flags of all tools, the most used ones first. Keys of the rig follow --rig.
const std::vector<HelpHeading>& Headings() {
  static const std::vector<HelpHeading> headings = [] {
    std::vector<HelpHeading> all = {
        {"Input",
         {"data", "data_list", "manifest", "port", "baud", "time_column", "value_column", "unit", "sample_rate_hz",
          "calibration", "sensor", "resolution", "input_range", "bits", "range", "oversample", "window_s"}},
        {"Task", {"plan", "counts", "store_calibration", "info", "list"}},
        {"Window", {"from", "to", "release", "start"}},
        {"Model", {"model", "gravity", "shared", "fix", "init", "bounds", "prior", "closed_form_only", "order"}},
        {"Rig", {"rig"}},
        {"Simulation",
         {"set", "spread", "duration", "rate", "start_time", "jitter", "event_driven", "time_noise",
          "noise_correlation", "noise_freedom", "lose", "scenario", "runs", "count"}},
        {"Plan of a sensor", {"reference_voltage", "supply_voltage", "potentiometer_range_deg", "divider"}},
        {"Recording", {"seconds", "until_rest", "rate_hz", "overwrite", "fit"}},
        {"Noise and intervals", {"noise", "loss", "interval", "checks", "seed"}},
        {"Store and shards",
         {"store", "force", "retry_failed", "replace_by_failures", "dry_run", "shard", "scratch", "checkpoint_s",
          "shard_dir", "shard_count", "group_by", "trend_by"}},
        {"Service", {"address", "allowed_hosts", "token_file", "live", "docs"}},
        {"Limits",
         {"max_body_mb", "max_samples", "max_connections", "max_queue", "max_batch_runs", "fit_seconds",
          "request_seconds", "stop_seconds"}},
        {"Output",
         {"details", "quiet", "json", "report", "residuals", "series", "markdown", "terminal_plot", "plot", "out",
          "truth", "threads"}},
        {"About", {"help", "version", "completion"}}};
    for (HelpHeading& heading : all) {
      if (heading.title != "Rig") continue;
      for (const RigKey& key : RigKeys()) heading.flags.push_back(key.flag);
    }
    return all;
  }();
  return headings;
}

std::string FlagText(const FlagInfo& flag, std::size_t width) {
  constexpr int kWidth = 100;
  return Paragraph(flag.help, "  --" + flag.name + std::string(width - flag.name.size() + 2, ' '), kWidth);
}

std::string TitledFlags(std::string_view title, std::span<const FlagInfo> flags, std::size_t width) {
  if (flags.empty()) return {};
  std::string text = "\n" + std::string(title) + ":\n";
  for (const FlagInfo& flag : flags) text += FlagText(flag, width);
  return text;
}

std::size_t LongestName(std::span<const FlagInfo> flags, bool own) {
  std::size_t longest = 0;
  for (const FlagInfo& flag : flags) {
    if (flag.own == own) longest = std::max(longest, flag.name.size());
  }
  return longest;
}

/// The usage without the exit codes, and the exit codes.
struct UsageParts {
  std::string before, exit_codes;
};

UsageParts SplitUsage(std::string_view usage) {
  const std::size_t at = std::min(usage.find("Exit codes:"), usage.size());
  std::string before(usage.substr(0, at));
  while (before.ends_with("\n\n")) before.pop_back();
  std::string codes(usage.substr(at));
  while (codes.ends_with("\n\n")) codes.pop_back();
  return {before, codes.empty() ? "" : "\n" + codes};
}

}  // namespace

std::string_view HelpGroup(std::string_view flag) {
  for (const HelpHeading& heading : Headings()) {
    if (std::ranges::find(heading.flags, flag) != heading.flags.end()) return heading.title;
  }
  return kOther;
}

std::string HelpText(std::string_view usage, std::span<const FlagInfo> flags) {
  const std::size_t width = LongestName(flags, true);
  const UsageParts parts = SplitUsage(usage);
  std::string text = parts.before;
  for (const HelpHeading& heading : Headings()) {
    std::vector<FlagInfo> below;
    for (const std::string_view name : heading.flags) {
      const auto found = std::ranges::find(flags, name, &FlagInfo::name);
      if (found != flags.end() && found->own) below.push_back(*found);
    }
    text += TitledFlags(heading.title, below, width);
  }
  std::vector<FlagInfo> others;
  std::ranges::copy_if(flags, std::back_inserter(others),
                       [](const FlagInfo& flag) { return flag.own && HelpGroup(flag.name) == kOther; });
  return text + TitledFlags(kOther, others, width) + parts.exit_codes;
}

std::string FullHelpText(std::string_view usage, std::span<const FlagInfo> flags) {
  std::vector<FlagInfo> others;
  std::ranges::copy_if(flags, std::back_inserter(others), [](const FlagInfo& flag) { return !flag.own; });
  return HelpText(usage, flags) + TitledFlags("Flags of libraries", others, LongestName(flags, false));
}

}  // namespace pendulum
