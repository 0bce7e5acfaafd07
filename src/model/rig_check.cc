// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "model/rig_entry.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/rig_units.h"
#include "pendulum/model/rig_values.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSameWithin = 1.5;   // larger ratios are questioned
constexpr double kContradiction = 5;  // larger ratios are refused
constexpr double kUnitWithin = 1.6;   // a unit explains a ratio that it changes to less than this
constexpr double kOtherPlanet = 30;   // a length alone is refused if its g differs from the Earth's by more than this
constexpr int kDigits = 3;

/// A unit as on the command line, without blanks.
std::string FlagUnit(std::string_view unit) {
  std::string text(unit);
  std::erase(text, ' ');
  return text;
}

/// A value with its unit as on the command line: 0.43m, 380g.
std::string FlagValue(double value, std::string_view unit) { return NumberText(value) + FlagUnit(unit); }

/// `"rod_length" is 43 m: in cm? Write 0.43`
std::string Question(const RigKey& key, double value, const RigUnit& unit, const std::string& rig_name) {
  return KeyText(key, rig_name) + " is " + NumberText(value) + " " + std::string(key.unit) + ": in " +
         std::string(unit.name) + "? " +
         (IsGivenByFlags(rig_name) ? "Give " + KeyText(key, rig_name) + " " + FlagValue(value, unit.name)
                                   : "Write " + NumberText(unit.ToSi(value), 4));
}

// ---- Without the swing ---------------------------------------------------------------------------------------------

/// The range of values that are not odd.
struct UsualRange {
  double lower, upper;
};

/// A pendulum of the laboratory or of a large hall. Masses above 10 kg do not hang on less than a metre.
UsualRange UsualRangeOf(RigQuantity quantity, double length) {
  switch (quantity) {
    case RigQuantity::kMass: return {1e-6, length < 1 ? 10.0 : 50.0};
    case RigQuantity::kLength: return {1e-3, 10};
    case RigQuantity::kAcceleration: return {9.7, 9.9};
    case RigQuantity::kTorque:
    case RigQuantity::kStiffness: return {0, 1e4};
    case RigQuantity::kInertia: return {0, 1e3};
  }
  return {0, 1e30};
}

/// The longest length in the file; 1 m if there is none.
double LongestLength(const Json& source) {
  double longest = 0;
  for (const RigKey& key : RigKeys()) {
    if (key.quantity == RigQuantity::kLength && source.contains(key.name))
      longest = std::max(longest, ValueOfEntry(source.at(key.name)));
  }
  return longest > 0 ? longest : 1;
}

/// The smaller unit in which a value that is odd in SI is usual; nullptr if there is none.
const RigUnit* UsualUnit(const RigKey& key, double value, const UsualRange& usual) {
  for (const RigUnit& unit : kRigUnits) {
    const double in_si = unit.ToSi(value);
    if (unit.quantity == key.quantity && unit.ToSi(1) < 1 && in_si >= usual.lower && in_si <= usual.upper) return &unit;
  }
  return nullptr;
}

bool IsOdd(double value, const UsualRange& usual) {
  return value != 0 && !(value >= usual.lower && value <= usual.upper);
}

/// The flag of a value that was given by flags.
std::vector<std::string> FlagsOf(const RigKey& key, const Rig& rig) {
  return IsGivenByFlags(rig.name) ? std::vector{std::string(key.flag)} : std::vector<std::string>();
}

std::string OddityOf(const RigKey& key, double value, const UsualRange& usual, const std::string& rig_name) {
  if (const RigUnit* unit = UsualUnit(key, value, usual)) return Question(key, value, *unit, rig_name);
  return KeyText(key, rig_name) + " is " + NumberText(value) + " " + std::string(key.unit) +
         (key.quantity == RigQuantity::kAcceleration ? ", which is not the Earth's (9.78 to 9.83 m/s^2): correct it, "
                                                       "unless the pendulum is elsewhere or tilted"
                                                     : ": correct it if it is in another unit");
}

void QuestionValues(const Rig& rig, std::vector<Warning>& warnings) {
  for (const RigKey& key : RigKeys()) {
    if (!rig.source.contains(key.name)) continue;
    const double value = ValueOfEntry(rig.source.at(key.name));
    const UsualRange usual = UsualRangeOf(key.quantity, LongestLength(rig.source));
    if (!IsOdd(value, usual)) continue;
    warnings.push_back({.code = "rig_implausible",
                        .finding = "the rig: " + OddityOf(key, value, usual, rig.name),
                        .flags = FlagsOf(key, rig)});
  }
}

/// The value that converts the fit's ratios.
RigValue Converting(const Rig& rig) {
  if (rig.gives_torque) return rig.gravity_torque;
  if (rig.known_inertia) return *rig.known_inertia;
  return rig.length ? *rig.length : *rig.gravity;
}

/// What the conversion yields, in words.
std::string Converted(const Rig& rig) {
  if (rig.gives_torque) return "inertia and each friction torque";
  if (rig.known_inertia) return "the restoring torque and each friction torque";
  return rig.length ? "g" : "the effective length";
}

/// A value with a standard deviation, as it is given in the rig file or by flags.
std::string ErrorExample(const RigKey& key, const Rig& rig) {
  if (!IsGivenByFlags(rig.name)) return Quoted(key.name) + R"(: {"value": ..., "std_dev": ...})";
  return KeyText(key, rig.name) + " " + NumberText(ValueOfEntry(rig.source.at(std::string(key.name)))) + "+-..." +
         FlagUnit(key.unit);
}

/// How to give a standard deviation.
std::string HowToGiveError(const RigKey& key, const Rig& rig) {
  return (IsGivenByFlags(rig.name) ? "give it after the value: " : "write ") + ErrorExample(key, rig);
}

/// The tool that a nominal value is assumed to be measured with, and its error: "scales ±1 g".
std::string ToolText(RigQuantity quantity, double std_dev) {
  switch (quantity) {
    case RigQuantity::kMass: return "scales ±" + NumberText(std_dev * 1e3, kDigits) + " g";
    case RigQuantity::kLength: return "a ruler ±" + NumberText(std_dev * 1e3, kDigits) + " mm";
    case RigQuantity::kAcceleration: return "gravity ±" + NumberText(std_dev, kDigits);
    case RigQuantity::kTorque: return "a torque ±1 %";
    case RigQuantity::kStiffness: return "a stiffness ±1 %";
    case RigQuantity::kInertia: return "an inertia ±1 %";
  }
  return "";
}

/// The standard deviations that a rig has because nobody stated others, or that it has none.
void SayErrors(const Rig& rig, std::vector<Warning>& warnings) {
  std::vector<std::string> names, tools;
  std::map<RigQuantity, double> largest;  // of each quantity, the largest standard deviation
  const RigKey* first = nullptr;
  for (const RigKey& key : RigKeys()) {
    if (!rig.source.contains(key.name) || HasStdDev(rig.source.at(key.name))) continue;
    const double std_dev = StdDevOfEntry(key, rig.source.at(key.name));
    const bool is_converted =
        !rig.gives_torque || std::ranges::find(rig.errors, key.name, &RigError::key) != rig.errors.end();
    if (!(std_dev > 0) || !is_converted) continue;  // a rod that weighs nothing, or an inertia to compare with
    if (first == nullptr) first = &key;
    names.push_back(KeyText(key, rig.name));
    largest[key.quantity] = std::max(largest[key.quantity], std_dev);
  }
  for (const auto& [quantity, std_dev] : largest) tools.push_back(ToolText(quantity, std_dev));
  const RigValue converting = Converting(rig);
  const std::string share = NumberText(100 * converting.std_dev / converting.value, 2) + " %";
  if (first == nullptr) {
    const auto has_error = [&](const RigKey& key) {
      return rig.source.contains(key.name) && StdDevOfEntry(key, rig.source.at(key.name)) > 0;
    };
    if (std::ranges::any_of(RigKeys(), has_error)) return;
    warnings.push_back({.code = "rig_exact",
                        .finding = "the rig's standard deviations are 0, so its values count as exact",
                        .assumed = "rig exact, as stated"});
    return;
  }
  warnings.push_back(
      {.code = "rig_errors_assumed",
       .finding = NameList(names) + (names.size() == 1 ? " has" : " have") +
                  " no standard deviation; assumed: " + NameList(tools),
       .explanation = "all values of the rig together add a systematic error of " + share + " to " + Converted(rig),
       .advice = HowToGiveError(*first, rig) + ", 0 if it is exact",
       .flags = FlagsOf(*first, rig),
       .assumed = NameList(tools) + " (" + share + ": " +
                  (IsGivenByFlags(rig.name) ? KeyText(*first, rig.name) + " +-..." : R"("std_dev" in the rig)") + ")"});
}

// ---- With the swing ------------------------------------------------------------------------------------------------

/// How many times the larger one is the smaller one.
double Factor(double a, double b) { return std::max(a / b, b / a); }

/// A unit that makes the rig agree with the swing.
struct LikelyUnit {
  std::string question;  ///< "": there is none.
  std::string flag;      ///< The flag that gives the value in this unit.
};

LikelyUnit FindLikelyUnit(const Rig& rig, double gravity_over_inertia, const auto& predicted) {
  double best = kUnitWithin;
  LikelyUnit likely;
  for (const RigKey& key : RigKeys()) {
    if (!rig.source.contains(key.name)) continue;
    const double value = ValueOfEntry(rig.source.at(key.name));
    for (const RigUnit& unit : kRigUnits) {
      if (unit.quantity != key.quantity || unit.ToSi(1) == 1 || value == 0) continue;
      Json changed = rig.source;
      changed[key.name] = unit.ToSi(value);
      const Result<Rig> other = ParseRig(changed.dump(), rig.name);
      const std::optional<double> ratio = other ? predicted(*other) : std::nullopt;
      if (!ratio || !(Factor(*ratio, gravity_over_inertia) < best)) continue;
      best = Factor(*ratio, gravity_over_inertia);
      likely = {Question(key, value, unit, rig.name), "--" + std::string(key.flag) + " " + FlagValue(value, unit.name)};
    }
  }
  return likely;
}

/// The period of small swings [s].
std::string PeriodText(double gravity_over_inertia) {
  return NumberText(2 * kPi / std::sqrt(gravity_over_inertia), kDigits) + " s";
}

/// The error if the rig contradicts the swing. gives: what the rig says of G/I, with `predicted`.
tl::unexpected<Status> Contradiction(const Rig& rig, double predicted, double seen, const LikelyUnit& likely,
                                     const std::string& gives = "gives") {
  const std::string ratio = rig.is_spring ? "k/I" : "G/I";
  auto error = Fault(rig.name, "the rig " + gives + " " + ratio + " = " + NumberText(predicted, kDigits) +
                                   " 1/s^2, a period of " + PeriodText(predicted) + ", but the recording shows " +
                                   NumberText(seen, kDigits) + " 1/s^2, a period of " + PeriodText(seen) + "; " +
                                   (likely.question.empty() ? "correct the rig (SI units: kg, m, m/s^2, N m, kg m^2)"
                                                            : likely.question) +
                                   ". If the rig is right, correct the unit of the times with --time_column NAME:ms or "
                                   "--sample_rate_hz");
  return likely.flag.empty() ? error : WithTry(std::move(error), {likely.flag});
}

/// The largest G/I [1/s^2] that a body with its centre of mass at this distance can have: g/d, because I >= m d².
std::optional<double> LargestRatio(const Rig& rig) {
  if (!rig.source.contains("center_of_mass")) return std::nullopt;
  return rig.gravity->value / ValueOfEntry(rig.source.at("center_of_mass"));
}

/// The Earth's g over the length: what a rig with a length alone predicts.
std::optional<double> RatioOnEarth(const Rig& rig) {
  if (!rig.length) return std::nullopt;
  return kStandardGravity / rig.length->value;
}

/// The keys from which the rig's inertia follows.
std::string KeysOfInertia(const Rig& rig) {
  if (rig.source.contains("inertia")) return "inertia";
  return rig.source.contains("rod_length") ? "rod_length and the masses" : "mass and length";
}

Result<std::vector<Warning>> CompareLength(const Rig& rig, double gravity_over_inertia) {
  const double gravity = gravity_over_inertia * rig.length->value;
  const double on_earth = *RatioOnEarth(rig);
  if (Factor(gravity_over_inertia, on_earth) > kOtherPlanet)
    return Contradiction(rig, on_earth, gravity_over_inertia, FindLikelyUnit(rig, gravity_over_inertia, RatioOnEarth));
  constexpr double kEarthWithin = 1.1;
  if (Factor(gravity, kStandardGravity) < kEarthWithin) return {};
  return std::vector<Warning>{
      {.code = "rig_implausible",
       .finding = "the rig: length " + NumberText(rig.length->value) + " m gives g = " + NumberText(gravity, kDigits) +
                  " m/s^2, which is not the Earth's",
       .explanation = "the swing's effective length there is " +
                      NumberText(kStandardGravity / gravity_over_inertia, kDigits) + " m",
       .advice = "correct length, unless the pendulum is elsewhere, tilted, or not a small bob on a string"}};
}

/// Length and g predict another period than the swing shows.
std::vector<Warning> QuestionPeriod(const Rig& rig, double predicted, double seen) {
  return {{.code = "rig_implausible",
           .finding = "the rig: length " + NumberText(rig.length->value) + " m and g predict a period of " +
                      PeriodText(predicted) + ", but the swing has one of " + PeriodText(seen) +
                      ", an effective length of " + NumberText(rig.gravity->value / seen, kDigits) + " m",
           .advice = "correct length, unless the pendulum is not a small bob on a string"}};
}

}  // namespace

std::string UnitOfMass(const nlohmann::ordered_json& source, const RigKey& key) {
  if (key.quantity != RigQuantity::kMass || !source.contains(key.name)) return "";
  const double value = ValueOfEntry(source.at(key.name));
  const UsualRange usual = UsualRangeOf(key.quantity, LongestLength(source));
  const RigUnit* const unit = IsOdd(value, usual) ? UsualUnit(key, value, usual) : nullptr;
  return unit == nullptr ? "" : std::string(unit->name);
}

std::vector<Warning> QuestionRig(const Rig& rig) {
  std::vector<Warning> warnings;
  if (!rig.source.is_object()) return warnings;  // not from a file
  QuestionValues(rig, warnings);
  SayErrors(rig, warnings);
  return warnings;
}

std::optional<double> PredictedRatio(const Rig& rig) {
  if (rig.length && rig.gravity) return rig.gravity->value / rig.length->value;
  if (!rig.gives_torque || !rig.inertia) return std::nullopt;
  return rig.gravity_torque.value / rig.inertia->value;
}

Result<std::vector<Warning>> CompareRigWithSwing(const Rig& rig, double gravity_over_inertia) {
  if (!(gravity_over_inertia > 0) || !std::isfinite(gravity_over_inertia)) return {};
  const std::optional<double> predicted = PredictedRatio(rig);
  if (predicted) {
    const double factor = Factor(*predicted, gravity_over_inertia);
    if (factor > kContradiction) {
      return Contradiction(rig, *predicted, gravity_over_inertia,
                           FindLikelyUnit(rig, gravity_over_inertia, PredictedRatio));
    }
    if (factor < kSameWithin) return {};
    if (rig.length && rig.gravity && !rig.mass) return QuestionPeriod(rig, *predicted, gravity_over_inertia);
    const double times = *predicted / gravity_over_inertia;
    const bool is_given = rig.source.contains("inertia");
    return std::vector<Warning>{{.code = "inertia_differs_from_rig",
                                 .finding = "the fitted inertia is " + NumberText(times, kDigits) +
                                            " times the one that the rig's " + KeysOfInertia(rig) +
                                            (is_given ? " gives" : " give"),
                                 .advice = std::string("check these values") +
                                           (is_given ? "" : ", and whether the bob is a point mass at that distance"),
                                 .about = {.parameters = {"inertia"}}}};
  }
  const std::optional<double> largest = LargestRatio(rig);
  if (largest && gravity_over_inertia > kSameWithin * *largest)
    return Contradiction(rig, *largest, gravity_over_inertia, FindLikelyUnit(rig, gravity_over_inertia, LargestRatio),
                         "allows at most");
  return rig.length ? CompareLength(rig, gravity_over_inertia) : Result<std::vector<Warning>>{};
}

}  // namespace pendulum
