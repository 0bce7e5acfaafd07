// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "model/rig_entry.h"
#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;
using namespace std::string_view_literals;

constexpr std::array kRigKeys = {
    RigKey{"bob_mass", "bob_mass", RigQuantity::kMass, "kg", "Mass of the bob at the end of the rod."},
    RigKey{"rod_mass", "rod_mass", RigQuantity::kMass, "kg", "Mass of the rod; 0 if it weighs nothing."},
    RigKey{"rod_length", "rod_length", RigQuantity::kLength, "m", "Distance from the pivot to the bob's centre."},
    RigKey{"gravity", "g", RigQuantity::kAcceleration, "m/s^2", "Gravitational acceleration, such as 9.81."},
    RigKey{"gravity_torque", "gravity_torque", RigQuantity::kTorque, "N m",
           "Gravity torque G with the pendulum held at 90 deg."},
    RigKey{"mass", "mass", RigQuantity::kMass, "kg", "Mass of the whole pendulum."},
    RigKey{"center_of_mass", "center_of_mass", RigQuantity::kLength, "m",
           "Distance from the pivot to the centre of mass of the whole pendulum."},
    RigKey{"length", "length", RigQuantity::kLength, "m",
           "Length of a string or bifilar pendulum, from the support to the bob's centre."},
    RigKey{"stiffness", "stiffness", RigQuantity::kStiffness, "N m/rad",
           "Stiffness k of a torsion spring or wire; N/m for a mass on a spring."},
    RigKey{"inertia", "inertia", RigQuantity::kInertia, "kg m^2",
           "Moment of inertia about the pivot, from geometry or CAD; kg for a mass on a spring."},
};

// ---- The descriptions of a rig -----------------------------------------------------------------------------------

/// The derivative with respect to one value, and the standard deviation of that value.
struct ErrorTerm {
  double derivative;
  double std_dev;
};

/// First-order propagation from independent errors: variance = sum of (derivative std_dev)².
RigValue Propagate(double value, std::initializer_list<ErrorTerm> terms) {
  double std_dev = 0;
  for (const ErrorTerm& term : terms) std_dev = std::hypot(std_dev, term.derivative * term.std_dev);
  return {value, std_dev};
}

RigValue Product(const RigValue& x, const RigValue& y) {
  return Propagate(x.value * y.value, {{y.value, x.std_dev}, {x.value, y.std_dev}});
}

/// Values by key; each key of the rig that is present.
using RigValues = std::map<std::string_view, RigValue>;

std::optional<RigValue> Find(const RigValues& values, std::string_view key) {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

/// MODEL.md eqs. (1.2) and (1.3).
void SetFromRodAndBob(const RigValues& values, Rig& rig) {
  const RigValue bob = values.at("bob_mass"), rod = values.at("rod_mass");
  const RigValue length = values.at("rod_length"), gravity = values.at("gravity");
  const double reduced_mass = bob.value + rod.value / 2;
  const double lever = gravity.value * length.value;
  rig.gravity_torque = Propagate(reduced_mass * lever, {{lever, bob.std_dev},
                                                        {lever / 2, rod.std_dev},
                                                        {reduced_mass * gravity.value, length.std_dev},
                                                        {reduced_mass * length.value, gravity.std_dev}});
  if (rig.inertia) return;
  const double square = length.value * length.value;
  const double first_moment = (rod.value / 3 + bob.value) * length.value;
  rig.inertia = Propagate(first_moment * length.value,
                          {{square, bob.std_dev}, {square / 3, rod.std_dev}, {2 * first_moment, length.std_dev}});
}

void SetFromTorque(const RigValues& values, Rig& rig) { rig.gravity_torque = values.at("gravity_torque"); }

/// MODEL.md eq. (1.2) in its first form: G = mass · center_of_mass · gravity.
void SetFromBody(const RigValues& values, Rig& rig) {
  rig.gravity_torque = Product(Product(values.at("mass"), values.at("center_of_mass")), values.at("gravity"));
}

void SetFromStiffness(const RigValues& values, Rig& rig) {
  rig.gravity_torque = values.at("stiffness");
  rig.is_spring = true;
}

/// A point mass on a string: G = m g l, I = m l². Without the mass, or without both the length and g, G is unknown.
void SetFromString(const RigValues& values, Rig& rig) {
  if (rig.mass && rig.gravity) {
    rig.gravity_torque = Product(Product(*rig.mass, *rig.length), *rig.gravity);
  } else {
    rig.gives_torque = false;
  }
  std::optional<RigValue> inertia = Find(values, "inertia");
  if (!inertia && rig.mass) {
    const double l = rig.length->value;
    inertia = Propagate(rig.mass->value * l * l,
                        {{l * l, rig.mass->std_dev}, {2 * rig.mass->value * l, rig.length->std_dev}});
  }
  if (!rig.gives_torque) rig.known_inertia = std::exchange(inertia, std::nullopt);
  rig.inertia = inertia;
}

void SetFromInertia(const RigValues& /*values*/, Rig& rig) {
  rig.known_inertia = std::exchange(rig.inertia, std::nullopt);
  rig.gives_torque = false;
}

/// One way to describe a rig: its keys, and a function that computes the rig from their values. A rig may also have
/// `inertia`.
struct Form {
  std::string_view identifying;  ///< The keys that only this form has, or that identify it if no other key does.
  std::string_view required;     ///< Keys that must exist.
  std::string_view optional;     ///< Keys that may exist.
  void (*set)(const RigValues& values, Rig& rig);
};

// Keys stand between spaces.
constexpr std::array kForms = {
    Form{" bob_mass rod_mass rod_length ", " bob_mass rod_mass rod_length gravity ", " ", SetFromRodAndBob},
    Form{" gravity_torque ", " gravity_torque ", " ", SetFromTorque},
    Form{" center_of_mass ", " mass center_of_mass gravity ", " ", SetFromBody},
    Form{" stiffness ", " stiffness ", " ", SetFromStiffness},
    Form{" length ", " length ", " gravity mass ", SetFromString},
    // Keys of several forms: each identifies a form only if no key above exists.
    Form{" inertia ", " inertia ", " mass gravity ", SetFromInertia},
    Form{" mass ", " mass center_of_mass gravity ", " ", SetFromBody},
    Form{" gravity ", " gravity ", " ", SetFromString}};

constexpr std::string_view kFormsText =
    R"({"bob_mass", "rod_mass", "rod_length", "gravity"} or {"gravity_torque"} or {"mass", "center_of_mass", )"
    R"("gravity"} or {"stiffness"} or {"length"}, {"gravity"} or both, with optional "mass", or {"inertia"})";

bool HasKey(std::string_view keys, std::string_view key) {
  return keys.find(" " + std::string(key) + " ") != std::string_view::npos;
}

bool IsKeyOf(const Form& form, std::string_view key) {
  return HasKey(form.required, key) || HasKey(form.optional, key) || key == kInertia.name;
}

// ---- From the object to numbers ----------------------------------------------------------------------------------

/// Whether all keys of the rig belong to the form and none is missing.
Result<void> CheckKeys(const Json& rig, const Form& form, const std::string& identifying_key, const std::string& name) {
  bool is_after = false;  // whether the identifying key stands before the present one
  for (const auto& item : rig.items()) {
    is_after = is_after || item.key() == identifying_key;
    if (IsKeyOf(form, item.key())) continue;
    const std::string other = Quoted(item.key());
    const std::string own = Quoted(identifying_key);
    const std::string& first = is_after ? own : other;
    return Fault(name, first + " and " + (is_after ? other : own) +
                           " belong to different descriptions of a rig, which cannot be mixed; a rig is " +
                           std::string(kFormsText));
  }
  std::vector<std::string> missing;
  for (const RigKey& key : kRigKeys) {
    if (HasKey(form.required, key.name) && !rig.contains(key.name)) missing.push_back(KeyText(key, name));
  }
  if (missing.empty()) return {};
  const bool is_one = missing.size() == 1;
  const RigKey& identifying = *std::ranges::find(kRigKeys, identifying_key, &RigKey::name);
  const bool is_rod = is_one && !rig.contains("rod_mass") && HasKey(form.required, "rod_mass");
  auto fault =
      Fault(name, NameList(missing) + (is_one ? " is" : " are") + " missing beside " + KeyText(identifying, name) +
                      (is_one ? "; add it" : "; add them") + (is_rod ? ", 0 for a string" : ""));
  return is_rod && IsGivenByFlags(name) ? WithTry(std::move(fault), {"--rod_mass 0g"}) : fault;
}

/// The kind of description that `rig` is. All keys of that kind are present, and no other key except `inertia`.
Result<Form> FindForm(const Json& rig, const std::string& name) {
  for (const auto& item : rig.items()) {
    if (std::ranges::find(kRigKeys, item.key(), &RigKey::name) != kRigKeys.end()) continue;
    return Fault(name, Quoted(item.key()) + " is not a key of a rig; a rig is " + std::string(kFormsText) +
                           ", each with optional \"inertia\"");
  }
  for (const Form& form : kForms) {
    for (const auto& item : rig.items()) {
      if (!HasKey(form.identifying, item.key())) continue;
      RETURN_IF_ERROR(CheckKeys(rig, form, item.key(), name));
      return form;
    }
  }
  return Fault(name, "the rig has no complete description; it must be " + std::string(kFormsText));
}

Result<double> ReadNumber(const Json& json, const std::string& key, bool may_be_zero, const std::string& name) {
  if (!json.is_number()) {
    return Fault(
        name, key + " is " + JsonForMessage(json) + R"(; it must be a number or {"value": number, "std_dev": number})");
  }
  const auto number = json.get<double>();
  if (number > 0 || (number == 0 && may_be_zero)) return number;
  return Fault(name, key + " is " + json.dump() + "; it must be " + (may_be_zero ? "0 or more" : "positive"));
}

/// The value of `key`, which must exist.
Result<RigValue> ReadValue(const Json& rig, const RigKey& key, const std::string& name) {
  const Json& json = *rig.find(key.name);
  const bool may_be_zero = key.name == "rod_mass";
  if (!json.is_object()) {
    ASSIGN_OR_RETURN(const double number, ReadNumber(json, Quoted(key.name), may_be_zero, name));
    return RigValue{number, StdDevOfEntry(key, json)};
  }
  for (const auto& item : json.items()) {
    const std::string& part = item.key();
    const bool is_value = part == "value";
    if (!is_value && part != "std_dev") {
      return Fault(name,
                   Quoted(part) + " is not a key of " + Quoted(key.name) + R"(; its keys are "value" and "std_dev")");
    }
    const Result<double> read =
        ReadNumber(item.value(), Quoted(part) + " of " + Quoted(key.name), may_be_zero || !is_value, name);
    if (!read) return tl::unexpected(read.error());
  }
  if (!json.contains("value")) return Fault(name, Quoted(key.name) + R"( has no "value"; add it)");
  return RigValue{ValueOfEntry(json), StdDevOfEntry(key, json)};
}

/// Whether products and squares of the value stay finite and nonzero.
bool IsUsable(const RigValue& value) {
  constexpr double kSmallest = 1e-30;
  constexpr double kLargest = 1e30;
  return value.value > kSmallest && value.value < kLargest && std::isfinite(value.std_dev);
}

/// The rig that the values describe, without its name, source and errors.
Rig RigOf(const Form& form, const RigValues& values) {
  Rig rig;
  rig.inertia = Find(values, "inertia");
  rig.gravity = Find(values, "gravity");
  rig.length = Find(values, "length");
  rig.mass = Find(values, "mass");
  form.set(values, rig);
  return rig;
}

/// The errors of all values that give the restoring torque.
std::vector<RigError> ErrorsOf(const Json& source, const Form& form, const RigValues& values) {
  std::vector<RigError> errors;
  for (const RigKey& key : kRigKeys) {
    if (!values.contains(key.name)) continue;
    RigValues alone = values;
    for (auto& [name, other] : alone) other.std_dev = name == key.name ? other.std_dev : 0;
    const Rig rig = RigOf(form, alone);
    const double of_torque = rig.gravity_torque.std_dev / rig.gravity_torque.value;
    if (of_torque > 0)
      errors.push_back({key.name, values.at(key.name).std_dev, !HasStdDev(source.at(key.name)), of_torque});
  }
  return errors;
}

}  // namespace

std::span<const RigKey> RigKeys() { return kRigKeys; }

double NominalStdDev(RigQuantity quantity, double value) {
  constexpr double kOfTool = 1e-3;  // 1 g, 1 mm
  constexpr double kLeast = 1e-3, kMost = 1e-2, kComputed = 1e-2;
  constexpr double kGravity = 0.015;
  switch (quantity) {
    case RigQuantity::kMass:
    case RigQuantity::kLength: return std::clamp(kOfTool, kLeast * value, kMost * value);
    case RigQuantity::kAcceleration: return kGravity;
    case RigQuantity::kTorque:
    case RigQuantity::kStiffness:
    case RigQuantity::kInertia: return kComputed * value;
  }
  return 0;
}

Result<Rig> ParseRig(std::string_view text, const std::string& name) {
  ASSIGN_OR_RETURN(Json source, ParseJsonObject(text, name, "rig", kFormsText));
  ASSIGN_OR_RETURN(const Form form, FindForm(source, name));
  RigValues values;
  for (const RigKey& key : kRigKeys) {
    if (!source.contains(key.name)) continue;
    ASSIGN_OR_RETURN(const RigValue value, ReadValue(source, key, name));
    values[key.name] = value;
  }
  Rig rig = RigOf(form, values);
  const bool are_usable = std::ranges::all_of(
      std::array{std::optional(rig.gravity_torque), rig.inertia, rig.known_inertia, rig.gravity, rig.length, rig.mass},
      [](const std::optional<RigValue>& value) { return !value || IsUsable(*value); });
  if (!are_usable) {
    return Fault(name,
                 "these values give a torque or inertia outside 1e-30 to 1e30 (SI), which is impossible for a "
                 "pendulum; correct them");
  }
  rig.name = name;
  rig.errors = ErrorsOf(source, form, values);
  rig.source = std::move(source);
  return rig;
}

Result<Rig> ReadRig(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const std::string text, ReadFile(path, "rig", kMaxJsonBytes));
  return ParseRig(text, path.string());
}

}  // namespace pendulum
