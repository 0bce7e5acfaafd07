// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/budget_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kNoise = "noise";

/// A line that stands for what the fit has of one kind in all parameters.
BudgetLine LineOf(const FitReport& fit, std::optional<ErrorSource> source, std::string origin, const auto& part_of) {
  const std::string_view name = source ? ErrorSourceName(*source) : kNoise;
  BudgetLine line{source, EvaluationType::kA, std::string(name), std::move(origin), false, std::nullopt, "", {}};
  line.parts.resize(static_cast<Eigen::Index>(fit.parameters.size()));
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    line.parts[static_cast<Eigen::Index>(i)] = part_of(fit.parameters[i]);
  }
  return line;
}

std::string_view TypeName(const BudgetLine& line) { return line.type == EvaluationType::kA ? "A" : "B"; }

/// The parameters that have an error.
std::vector<std::size_t> WithErrors(const FitReport& fit) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (fit.parameters[i].std_error) places.push_back(i);
  }
  return places;
}

/// Inertia and friction that have an error.
std::vector<std::size_t> PhysicalWithErrors(const FitReport& fit) {
  const std::vector<ParameterInfo> physical = PhysicalParameters(fit.model);
  std::vector<std::size_t> places = WithErrors(fit);
  std::erase_if(places, [&](std::size_t i) {
    return std::ranges::find(physical, fit.parameters[i].info.name, &ParameterInfo::name) == physical.end();
  });
  return places;
}

// ---- Where an error comes from --------------------------------------------------------------------------------------

/// What of the rig is measured.
std::string RigWords(const std::optional<Rig>& rig) {
  if (!rig || !rig->source.is_object()) return "rig";
  const auto has = [&](const char* key) { return rig->source.contains(key); };
  if (has("bob_mass")) return "masses and length";
  if (has("center_of_mass")) return "mass, center";
  if (has("gravity_torque")) return "gravity torque";
  if (has("stiffness")) return "stiffness";
  if (has("length")) return "length";
  return has("inertia") ? "known inertia" : "rig";
}

std::string SourceWords(ErrorSource source, const std::optional<Rig>& rig) {
  switch (source) {
    case ErrorSource::kRig: return RigWords(rig);
    case ErrorSource::kCalibration: return "calibration";
    case ErrorSource::kClock: return "clock";
    case ErrorSource::kSensor: return "sensor";
    case ErrorSource::kInconstancy: return "change in time";
    case ErrorSource::kFrictionLaw: return "another law";
  }
  return "";
}

/// "an encoder".
std::string WithArticle(const std::string& noun) {
  return (std::string_view("aeio").find(noun.front()) < 4 ? "an " : "a ") + noun;
}

// ---- How to make an error smaller -----------------------------------------------------------------------------------

struct Remedy {
  std::string_view name;  // of a line
  std::string_view text;
};

/// How to know the clock, the calibration or a value of the rig better.
constexpr std::array kRemedies = {Remedy{"clock", "compare the recorder's clock with a watch (--sensor)"},
                                  Remedy{"calibration", "calibrate at more angles"},
                                  Remedy{"bob_mass", "weigh the bob on better scales"},
                                  Remedy{"rod_mass", "weigh the rod on better scales"},
                                  Remedy{"mass", "weigh the pendulum on better scales"},
                                  Remedy{"rod_length", "measure the rod with calipers"},
                                  Remedy{"length", "measure the length better"},
                                  Remedy{"center_of_mass", "balance the pendulum on an edge"},
                                  Remedy{"gravity", "look up the local g"},
                                  Remedy{"gravity_torque", "weigh the pendulum held horizontal"},
                                  Remedy{"stiffness", "measure the stiffness with known torques"}};

/// How to make a line smaller; empty if nothing is known.
std::string_view RemedyOf(const BudgetLine& line) {
  const auto* const cause = std::ranges::find(kCauses, line.name, CauseName);
  if (cause != kCauses.end() && IsOfSensor(*cause)) return RemedyFor(*cause);
  const auto* const remedy = std::ranges::find(kRemedies, line.name, &Remedy::name);
  return remedy == kRemedies.end() ? "" : remedy->text;
}

/// The size of an error relative to an estimate: "± 0.35 %".
std::string RelativeText(double error, double estimate) {
  return "±" + std::string(kNoBreak) + NumberText(100 * error / std::abs(estimate), 2) + std::string(kNoBreak) + "%";
}

/// The total error without a line. Lines of one source may depend on each other, but not on other sources.
double ErrorWithout(double part, double of_source, double total) {
  const double others = total * total - of_source * of_source;
  return std::sqrt(std::max(others, 0.0) + std::max(of_source * of_source - part * part, 0.0));
}

}  // namespace

std::string MainSourcesText(double std_error, const SystematicErrors& systematic, const std::optional<Rig>& rig) {
  constexpr double kMost = 0.8;
  using Part = std::pair<double, std::optional<ErrorSource>>;  // variance; no source: noise
  std::vector<Part> parts = {{std_error * std_error, std::nullopt}};
  double total = parts.front().first;
  for (const ErrorSource source : kErrorSources) {
    parts.emplace_back(systematic.Of(source) * systematic.Of(source), source);
    total += parts.back().first;
  }
  std::ranges::stable_sort(parts, std::ranges::greater(), &Part::first);
  const auto short_name = [](const Part& part) -> std::string {
    if (!part.second) return std::string(kNoise);
    if (*part.second == ErrorSource::kInconstancy) return "change";
    return *part.second == ErrorSource::kFrictionLaw ? "law" : std::string(ErrorSourceName(*part.second));
  };
  if (parts[0].first < kMost * total) return short_name(parts[0]) + ", " + short_name(parts[1]);
  return parts[0].second ? SourceWords(*parts[0].second, rig) : std::string(kNoise);
}

std::vector<BudgetLine> BudgetOf(const FitReport& fit) {
  std::vector<BudgetLine> lines;
  if (fit.termination != Termination::kConverged) return lines;
  lines.push_back(LineOf(fit, std::nullopt, "the scatter of the readings",
                         [](const ParameterEstimate& parameter) { return parameter.std_error.value_or(0); }));
  constexpr double kRounding = 1e-9;  // of the error of noise: a lag is taken up by the release time
  for (BudgetLine line : fit.budget) {
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      double& part = line.parts[static_cast<Eigen::Index>(i)];
      if (!(part > kRounding * fit.parameters[i].std_error.value_or(HUGE_VAL))) part = 0;
    }
    lines.push_back(std::move(line));
  }
  constexpr std::array kOfReadings = {std::pair{ErrorSource::kInconstancy, "parts of the readings differ"},
                                      std::pair{ErrorSource::kFrictionLaw, "the readings suggest other friction"}};
  for (const auto& [source, origin] : kOfReadings) {
    lines.push_back(LineOf(fit, source, origin,
                           [&](const ParameterEstimate& parameter) { return parameter.systematic.Of(source); }));
  }
  std::erase_if(lines, [](const BudgetLine& line) { return !(line.parts.array() > 0).any(); });
  return lines;
}

Sections BudgetSections(const FitReport& fit) {
  const std::vector<BudgetLine> lines = BudgetOf(fit);
  if (lines.size() < 2) return {};
  Table table{{{"cause"}, {"its size", true}, {"type"}}};
  const std::vector<std::size_t> places = WithErrors(fit);
  for (const std::size_t i : places) table.columns.push_back({std::string(fit.parameters[i].info.name), true});
  table.columns.push_back({"where the size comes from"});
  for (const BudgetLine& line : lines) {
    std::vector<std::string> row = {InWords(line.name), line.std_dev ? PlainSizeText(*line.std_dev, line.unit) : "",
                                    std::string(TypeName(line))};
    for (const std::size_t i : places) {
      const double part = line.parts[static_cast<Eigen::Index>(i)];
      row.push_back(part > 0 ? NumberText(part, 2) : "");
    }
    row.push_back(line.origin);
    table.rows.push_back(std::move(row));
  }
  std::vector<std::string> total = {"total", "", ""};
  for (const std::size_t i : places) {
    const ParameterEstimate& parameter = fit.parameters[i];
    total.push_back(NumberText(*TotalStdError(parameter.std_error, parameter.systematic), 2));
  }
  total.emplace_back("");
  table.rows.push_back(std::move(total));
  Section section{"Error budget", "", {std::move(table)}};
  return {section.AddText(
      "Standard deviations, in the units of the parameters. Type A: from the statistics of readings; B: stated or "
      "assumed. What the readings say of the sensor makes its lines depend on each other; the total allows for that.")};
}

Json BudgetJson(const FitReport& fit) {
  Json budget = Json::array();
  for (const BudgetLine& line : BudgetOf(fit)) {
    Json parts = Json::object();
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      const double part = line.parts[static_cast<Eigen::Index>(i)];
      if (part > 0) parts[std::string(fit.parameters[i].info.name)] = part;
    }
    budget.push_back({{"name", line.name},
                      {"source", line.source ? ErrorSourceName(*line.source) : kNoise},
                      {"type", TypeName(line)},
                      {"origin", line.origin},
                      {"assumed", line.is_assumed},
                      {"std_dev", NumberOrNull(line.std_dev)},
                      {"unit", line.std_dev ? Json(line.unit) : Json(nullptr)},
                      {"parts", std::move(parts)}});
  }
  return budget;
}

std::string LargestErrorText(const FitReport& fit) {
  constexpr double kSmaller = 1.25;  // times
  const std::vector<BudgetLine> lines = BudgetOf(fit);
  double best = kSmaller;
  std::string text;
  for (const std::size_t i : PhysicalWithErrors(fit)) {
    const ParameterEstimate& parameter = fit.parameters[i];
    const auto part_of = [&](const BudgetLine& line) { return line.parts[static_cast<Eigen::Index>(i)]; };
    const BudgetLine& largest = *std::ranges::max_element(lines, {}, part_of);
    const std::string_view remedy = RemedyOf(largest);
    if (remedy.empty() || !largest.source || parameter.estimate == 0) continue;
    const double total = *TotalStdError(parameter.std_error, parameter.systematic);
    const double left = ErrorWithout(part_of(largest), parameter.systematic.Of(*largest.source), total);
    if (!(total > best * left)) continue;
    best = total / left;
    text = "Improve first: " + InWords(largest.name) + "; " + std::string(remedy) + ": " +
           std::string(parameter.info.name) + " " + RelativeText(total, parameter.estimate) + ", at best " +
           RelativeText(left, parameter.estimate) + ".";
  }
  return text;
}

std::vector<std::string> SensorAssumptions(const SensorErrors& sensor) {
  constexpr double kMatters = 1e-3;  // a quartz crystal is better
  std::vector<std::string> assumed;
  if (sensor.is_kind_assumed && !sensor.kind.empty()) assumed.push_back(WithArticle(sensor.kind) + " (--sensor)");
  const EffectSize& clock = sensor.Of(SensorEffect::kClock);
  if (clock.is_assumed && clock.std_dev >= kMatters) {
    assumed.push_back("clock ±" + PlainSizeText(clock.std_dev, "1") + " for " + clock.source + " (--sensor)");
  }
  return assumed;
}

}  // namespace pendulum
