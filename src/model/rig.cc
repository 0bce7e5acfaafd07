// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
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

/// Values in the order of the keys of their description.
using RigValues = std::span<const RigValue>;

/// MODEL.md eqs. (1.2) and (1.3).
void SetFromRodAndBob(RigValues values, Rig& rig) {
  const RigValue bob = values[0], rod = values[1], length = values[2], gravity = values[3];
  const double reduced_mass = bob.value + rod.value / 2;
  const double lever = gravity.value * length.value;
  rig.gravity_torque = Propagate(reduced_mass * lever, {{lever, bob.std_dev},
                                                        {lever / 2, rod.std_dev},
                                                        {reduced_mass * gravity.value, length.std_dev},
                                                        {reduced_mass * length.value, gravity.std_dev}});
  const double square = length.value * length.value;
  const double first_moment = (rod.value / 3 + bob.value) * length.value;
  rig.inertia = Propagate(first_moment * length.value,
                          {{square, bob.std_dev}, {square / 3, rod.std_dev}, {2 * first_moment, length.std_dev}});
}

void SetFromTorque(RigValues values, Rig& rig) { rig.gravity_torque = values[0]; }

/// MODEL.md eq. (1.2) in its first form: G = mass · center_of_mass · gravity.
void SetFromBody(RigValues values, Rig& rig) {
  const RigValue mass = values[0], distance = values[1], gravity = values[2];
  rig.gravity_torque =
      Propagate(mass.value * distance.value * gravity.value, {{distance.value * gravity.value, mass.std_dev},
                                                              {mass.value * gravity.value, distance.std_dev},
                                                              {mass.value * distance.value, gravity.std_dev}});
}

/// One way to describe a rig: the required keys, and a function that computes the rig from their values.
struct Form {
  std::span<const std::string_view> keys;
  void (*set)(RigValues values, Rig& rig);
};

constexpr std::array kRodAndBobKeys = {"bob_mass"sv, "rod_mass"sv, "rod_length"sv, "gravity"sv};
constexpr std::array kTorqueKeys = {"gravity_torque"sv};
constexpr std::array kBodyKeys = {"mass"sv, "center_of_mass"sv, "gravity"sv};
constexpr std::array kForms = {Form{kRodAndBobKeys, SetFromRodAndBob}, Form{kTorqueKeys, SetFromTorque},
                               Form{kBodyKeys, SetFromBody}};

constexpr std::string_view kFormsText =
    R"({"bob_mass", "rod_mass", "rod_length", "gravity"} or {"gravity_torque"} or {"mass", "center_of_mass", "gravity"})";

bool Has(const Form& form, std::string_view key) { return std::ranges::find(form.keys, key) != form.keys.end(); }

// ---- From the object to numbers ----------------------------------------------------------------------------------

/// The kind of description that `rig` is. All keys of that kind are present, and no other key except `inertia`.
Result<Form> FindForm(const Json& rig, const std::string& name) {
  std::optional<Form> form;
  std::string identifying_key;
  for (const auto& item : rig.items()) {
    const std::string& key = item.key();
    const auto* const found = std::ranges::find_if(kForms, [&](const Form& each) { return Has(each, key); });
    if (found == kForms.end() && key != kInertia.name) {
      return Fault(name, Quoted(key) + " is not a key of a rig; a rig is " + std::string(kFormsText) +
                             ", each with optional \"inertia\"");
    }
    // Two kinds of description have "gravity", so this key does not identify the kind.
    if (form || found == kForms.end() || key == "gravity") continue;
    form = *found;
    identifying_key = key;
  }
  if (!form) return Fault(name, "the rig has no complete description; it must be " + std::string(kFormsText));
  for (const auto& item : rig.items()) {
    if (item.key() == kInertia.name || Has(*form, item.key())) continue;
    return Fault(name, Quoted(identifying_key) + " and " + Quoted(item.key()) +
                           " belong to different descriptions of a rig, which cannot be mixed; a rig is " +
                           std::string(kFormsText));
  }
  for (const std::string_view key : form->keys) {
    if (!rig.contains(key))
      return Fault(name, Quoted(key) + " is missing beside " + Quoted(identifying_key) + "; add it");
  }
  return *form;
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
Result<RigValue> ReadValue(const Json& rig, std::string_view key, const std::string& name) {
  const Json& json = *rig.find(key);
  const bool may_be_zero = key == "rod_mass";
  if (!json.is_object()) {
    return ReadNumber(json, Quoted(key), may_be_zero, name).map([](double number) { return RigValue{number, 0}; });
  }
  RigValue value;
  for (const auto& item : json.items()) {
    const std::string& part = item.key();
    const bool is_value = part == "value";
    if (!is_value && part != "std_dev") {
      return Fault(name, Quoted(part) + " is not a key of " + Quoted(key) + R"(; its keys are "value" and "std_dev")");
    }
    const Result<double> read =
        ReadNumber(item.value(), Quoted(part) + " of " + Quoted(key), may_be_zero || !is_value, name);
    if (!read) return tl::unexpected(read.error());
    (is_value ? value.value : value.std_dev) = *read;
  }
  if (!json.contains("value")) return Fault(name, Quoted(key) + R"( has no "value"; add it)");
  return value;
}

/// Whether products and squares of the value stay finite and nonzero.
bool IsUsable(const RigValue& value) {
  constexpr double kSmallest = 1e-30;
  constexpr double kLargest = 1e30;
  return value.value > kSmallest && value.value < kLargest && std::isfinite(value.std_dev);
}

}  // namespace

std::span<const RigKey> RigKeys() { return kRigKeys; }

Result<Rig> ParseRig(std::string_view text, const std::string& name) {
  Result<Json> source = ParseJsonObject(text, name, "rig", kFormsText);
  if (!source) return tl::unexpected(std::move(source).error());
  const Result<Form> form = FindForm(*source, name);
  if (!form) return tl::unexpected(form.error());
  std::vector<RigValue> values;
  for (const std::string_view key : form->keys) {
    const Result<RigValue> value = ReadValue(*source, key, name);
    if (!value) return tl::unexpected(value.error());
    values.push_back(*value);
  }
  Rig rig;
  form->set(values, rig);
  if (source->contains(kInertia.name)) {
    const Result<RigValue> inertia = ReadValue(*source, kInertia.name, name);
    if (!inertia) return tl::unexpected(inertia.error());
    rig.inertia = *inertia;
  }
  if (!IsUsable(rig.gravity_torque) || (rig.inertia && !IsUsable(*rig.inertia))) {
    return Fault(name,
                 "these values give a torque or inertia outside 1e-30 to 1e30 (SI), which is impossible for a "
                 "pendulum; correct them");
  }
  rig.source = std::move(*source);
  return rig;
}

Result<Rig> ReadRig(const std::filesystem::path& path) {
  const Result<std::string> text = ReadFile(path, "rig", kMaxJsonBytes);
  if (!text) return tl::unexpected(text.error());
  return ParseRig(*text, path.string());
}

}  // namespace pendulum
