// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/plan_text.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/budget_sections.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Cells = std::vector<std::string>;

constexpr int kPlanDigits = 4;
constexpr int kDegreeDigits = 3;
constexpr int kErrorDigits = 2;

/// The number format of each parameter in the plan.
class Units {
 public:
  Units(const Plan& plan, const std::optional<Rig>& rig)
      : plan_(plan), gravity_torque_(rig ? std::optional(rig->gravity_torque.value) : std::nullopt) {}

  std::string Name(std::size_t i) const {
    return std::string(gravity_torque_ ? plan_.parameters[i].unit : plan_.parameters[i].relative_unit);
  }
  /// Factor from units of the restoring torque G to the report's unit.
  double Factor(std::size_t i) const {
    return plan_.parameters[i].scales_with_gravity() ? gravity_torque_.value_or(1.0) : 1.0;
  }
  bool IsPercent(std::size_t i) const { return i < plan_.physical && plan_.truth[i] != 0; }

 private:
  const Plan& plan_;
  std::optional<double> gravity_torque_;
};

/// An error with two digits, the most that PdgRounding gives an error; from 100 on with three, because two digits would
/// need a power of ten.
std::string ErrorText(double error) { return NumberText(error, error < 100 ? kErrorDigits : kErrorDigits + 1); }

std::string BiasCell(const std::optional<double>& share) {
  constexpr double kRounding = 1e-10;  // numerical error of the formulas, exact with linear viscous friction
  if (!share) return "-";
  return NumberText(std::abs(*share) < kRounding ? 0.0 : 100 * *share, kErrorDigits);
}

std::string ErrorCell(const Plan& plan, const Units& units, const std::optional<double>& error, std::size_t i) {
  if (!error) return "-";
  return ErrorText(units.IsPercent(i) ? 100 * *error / std::abs(plan.truth[i]) : units.Factor(i) * *error);
}

/// A value; angles and rates are also given in degrees.
std::string ValueText(double value, std::string_view unit) {
  std::string text = NumberText(value, kPlanDigits) + " " + std::string(unit);
  if (unit.substr(0, 3) != "rad") return text;
  return text + " (" + NumberText(value / kRadFromDeg, kDegreeDigits) + " deg" + std::string(unit.substr(3)) + ")";
}

/// Where the total error of a parameter comes from; of a rig no more, because the table is wide.
std::string SourceOf(const Plan& plan, std::size_t i) {
  const ParameterEstimate* const fitted = plan.fit->Find(plan.parameters[i].name);
  if (fitted == nullptr || !fitted->std_error) return "";
  return MainSourcesText(*fitted->std_error, fitted->systematic, std::nullopt);
}

/// Name, value, error and unit of a parameter.
Cells ValueCells(const Plan& plan, const Units& units, const std::optional<double>& error, std::size_t i) {
  const double value = units.Factor(i) * plan.truth[i];
  Cells cells = {std::string(plan.parameters[i].name), NumberText(value, kPlanDigits), "± -", units.Name(i)};
  if (!error) return cells;
  const ValueAndError text = PdgText(value, units.Factor(i) * *error);
  cells[1] = text.value;
  cells[2] = "± " + text.error;
  return cells;
}

/// The parameters of the base case and the bounds of their errors by noise.
std::string NoiseText(const Plan& plan, const Units& units, const PlanRow& base) {
  std::vector<Cells> rows;
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    const std::optional<double>& error = base.std_errors[i];
    rows.push_back(ValueCells(plan, units, error, i));
    rows.back().push_back(error && units.IsPercent(i) ? ErrorCell(plan, units, error, i) + " %" : "");
  }
  return std::string("[[Predicted standard errors]] (") +
         (plan.noise_of_levels ? "least squares" : "Cramér-Rao bound") + ")\n" +
         AlignedTable({{""}, {""}, {""}, {"", false, 1}, {""}}, rows, kTextIndent);
}

/// The parameters of the base case, their total errors, and where these come from.
std::string TotalText(const Plan& plan, const Units& units, const PlanRow& base) {
  std::vector<Cells> rows;
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    const std::optional<double>&total = base.total_errors[i], &noise = base.std_errors[i];
    rows.push_back(ValueCells(plan, units, total, i));
    rows.back().push_back(total && units.IsPercent(i) ? ErrorCell(plan, units, total, i) : "");
    rows.back().push_back(noise && units.IsPercent(i) ? ErrorCell(plan, units, noise, i) : "");
    rows.back().push_back(total ? SourceOf(plan, i) : "");
  }
  const bool has_bound = std::ranges::any_of(base.std_errors, [](const auto& error) { return error.has_value(); });
  const std::string_view noise = plan.noise_of_levels ? "least squares" : has_bound ? "Cramér-Rao bound" : "as fitted";
  return std::string("[[Predicted errors]] (noise: ").append(noise).append(")\n") +
         AlignedTable({{""}, {"value"}, {"± total"}, {"unit", false, 1}, {"%"}, {"noise %"}, {"error from"}}, rows,
                      kTextIndent);
}

/// The other recording that makes an error of inertia or friction smallest relative to what it is.
std::string BestChangeText(const Plan& plan, const Units& units, const PlanRow& base) {
  constexpr double kSmaller = 1.25;  // times
  const auto physical = std::span(base.total_errors).first(plan.physical);
  if (std::ranges::none_of(physical, [](const auto& error) { return error.has_value(); })) return "";
  double best = kSmaller;
  std::string text =
      "No other amplitude, duration, rate or resolution makes an error of inertia or friction a fifth smaller.";
  for (const PlanRow& row : plan.rows) {
    for (std::size_t i = 0; i < plan.physical; ++i) {
      const auto &now = base.total_errors[i], &then = row.total_errors[i];
      if (!units.IsPercent(i) || !now || !then || !(*now > best * *then)) continue;
      best = *now / *then;
      const auto error = [&](const std::optional<double>& of) {
        return std::string("±").append(kNoBreak).append(ErrorCell(plan, units, of, i)).append(kNoBreak).append("%");
      };
      text = "The recording that helps most: " + std::string(row.factor) + " " + ValueText(row.value, row.unit) + ": " +
             std::string(plan.parameters[i].name) + " " + error(then) + " instead of " + error(now) + ".";
    }
  }
  return text;
}

/// What makes the total errors smaller.
std::string InvestmentText(const Plan& plan, const Units& units, const PlanRow& base) {
  std::string text = LargestErrorText(*plan.fit);
  const std::string change = BestChangeText(plan, units, base);
  if (!change.empty()) text += (text.empty() ? "" : " ") + change;
  std::string assumed;
  for (const std::string& one : SensorAssumptions(plan.sensor)) assumed += (assumed.empty() ? "" : "; ") + one;
  if (!assumed.empty()) text += (text.empty() ? "" : " ") + std::string("Assumed: ") + assumed + ".";
  return text.empty() ? "" : Prose(text);
}

std::vector<Column> FactorColumns(const Plan& plan) {
  std::vector<Column> columns = {{"factor"}, {"value"}, {"", false, 1}};
  for (const ParameterInfo& info : plan.parameters) columns.push_back({std::string(info.name), true});
  columns.push_back({"linear bias", true});
  return columns;
}

/// A row with the unit of each column, and a blank line before each factor.
std::string FactorTable(const Plan& plan, const Units& units, std::vector<std::optional<double>> PlanRow::*errors,
                        const std::string& title) {
  const std::vector<Column> columns = FactorColumns(plan);
  Cells unit_cells(3);
  for (std::size_t i = 0; i < plan.parameters.size(); ++i) {
    unit_cells.push_back(units.IsPercent(i) ? "%" : units.Name(i));
  }
  unit_cells.emplace_back("%");
  std::vector<Cells> rows = {unit_cells};
  std::string_view factor;
  for (const PlanRow& row : plan.rows) {
    if (row.factor != factor) rows.emplace_back(columns.size());
    factor = row.factor;
    Cells cells = {std::string(factor), ValueText(row.value, row.unit), row.is_base ? "*" : ""};
    for (std::size_t i = 0; i < plan.parameters.size(); ++i)
      cells.push_back(ErrorCell(plan, units, (row.*errors)[i], i));
    cells.push_back(BiasCell(row.linear_bias));
    rows.push_back(cells);
  }
  return "\n[[One setting changed at a time" + title + "]] (* the recording as given)\n" +
         AlignedTable(columns, rows, kTextIndent);
}

bool HasMissingValues(const PlanRow& row) {
  const auto is_missing = [](const auto& error) { return !error; };
  return !row.linear_bias || std::ranges::any_of(row.std_errors, is_missing) ||
         (row.without_totals.empty() && std::ranges::any_of(row.total_errors, is_missing));
}

/// Explains why cells are "-".
std::string MissingText(const Plan& plan) {
  std::string text;
  bool others = false;
  for (const PlanRow& row : plan.rows) {
    const std::string name = std::string(row.factor) + " " + ValueText(row.value, row.unit);
    if (!row.reason.empty()) text += Paragraph(name + ": " + row.reason + ".", "    - ", kTextWidth);
    if (!row.without_totals.empty())
      text += Paragraph(name + ", total errors: " + row.without_totals + ".", "    - ", kTextWidth);
    others = others || (row.reason.empty() && HasMissingValues(row));
  }
  if (!others) return text;
  return text + Paragraph(
                    "no bound is known for this noise and sensor, or the readings do not determine the parameter; for "
                    "the linear formulas: less than one whole period.",
                    "    - ", kTextWidth);
}

std::string BiasText(const Plan& plan, bool has_bound) {
  const std::string formulas =
      "The linear formulas (inertia from damped period and logarithmic decrement, sin θ = θ; all whole periods, "
      "turning "
      "points without error) ";
  if (!has_bound) return formulas + "cannot be compared, because the standard error is not known.";
  if (!plan.amplitude_of_equal_bias) {
    return formulas + "are accurate up to " + NumberText(kLargestPlannedAmplitude) +
           " rad: their error stays below the standard error of inertia.";
  }
  const double amplitude = *plan.amplitude_of_equal_bias;
  return formulas + "have an error above the standard error of inertia beyond an amplitude of " +
         NumberText(amplitude, kDegreeDigits) + " rad (" + NumberText(amplitude / kRadFromDeg, kDegreeDigits) +
         " deg): there, fit the full equation.";
}

/// Warns that the bound assumes the right alias of the frequency.
std::string SlowText(const Plan& plan) {
  constexpr double kPerSwing = 7;  // samples; the limit of IsUndersampled
  const double frequency = 1 / (2 * kPi * std::sqrt(plan.truth.front()));
  const bool slow = std::ranges::any_of(
      plan.rows, [&](const PlanRow& row) { return row.factor == "rate" && row.value < kPerSwing * frequency; });
  if (!slow) return "";
  const auto hz = [](double value) { return NumberText(value, kDegreeDigits) + " Hz"; };
  return "Below " + hz(kPerSwing * frequency) + ", seven samples a swing, a fit needs a rig whose inertia bounds the " +
         "frequency; near " + hz(frequency) + " or " + hz(2 * frequency) +
         ", one or two samples a swing, the frequency stays ambiguous even with a rig. ";
}

std::string ReadingGuide(const Plan& plan, const std::optional<Rig>& rig) {
  std::string text = std::string("To know inertia to 0.1 %, choose a line") + (plan.fit ? " of the first table" : "") +
                     " with at most 0.1 under inertia; the last column gives the error of the linear formulas without "
                     "any noise. " +
                     SlowText(plan);
  if (plan.noise_of_levels) {
    text += "Levels without noise have no Cramér-Rao bound, so they are treated as white noise of " +
            NumberText(*plan.noise_of_levels, kPlanDigits) + " " + std::string(plan.parameters.back().unit) +
            " (their spacing over √12), as in least squares; a fit that uses the levels is more accurate. ";
  }
  if (plan.fit) return text;
  if (!rig)
    return text +
           "Torques and inertia are in units of the gravity torque G; with a rig, the error of G adds to theirs.";
  const auto [torque, error] = rig->gravity_torque;
  if (error == 0) return text + "The error of the rig's gravity torque G adds to those of inertia and torques.";
  return text + "The error of the rig's gravity torque G, " + ErrorText(100 * error / torque) +
         " %, adds to those of inertia and torques.";
}

}  // namespace

std::string PlanText(const Plan& plan, const std::optional<Rig>& rig, TextExtent extent) {
  const Units units(plan, rig);
  const auto base = std::ranges::find_if(plan.rows, &PlanRow::is_base);
  std::string text =
      plan.fit ? TotalText(plan, units, *base) + InvestmentText(plan, units, *base) : NoiseText(plan, units, *base);
  if (!plan.without_totals.empty()) text += Prose("Without sensor, clock and rig: " + plan.without_totals + ".");
  const std::string bias = Prose(BiasText(plan, base->std_errors.front().has_value()));
  if (extent == TextExtent::kSummary) {
    return text + bias + Prose("More: --details (what another amplitude, duration, rate or resolution would give).");
  }
  if (plan.fit) text += FactorTable(plan, units, &PlanRow::total_errors, ": total errors");
  text += FactorTable(plan, units, &PlanRow::std_errors, plan.fit ? ": noise alone" : "");
  const std::string missing = MissingText(plan);
  return text + (missing.empty() ? "" : "\n" + missing) + "\n[[How to read it]]\n" + bias +
         Prose(ReadingGuide(plan, rig));
}

}  // namespace pendulum
