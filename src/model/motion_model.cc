// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/motion_model.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "pendulum/base/format.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {

namespace {

std::string ModelName(std::string_view gravity, std::string_view friction) {
  if (gravity == Gravity().name()) return std::string(friction);
  if (friction == ViscousFriction::kName) return std::string(gravity);
  return std::string(gravity) + "_" + std::string(friction);
}

/// Whether a fit can determine the parameters of the two laws together. A spring has no weight that loads a bearing.
template <FrictionModel F>
bool IsDeterminable(Gravity gravity) {
  return !((HasConstantTorque<F> || HasLoad<F>)&&gravity.is_linear());
}

/// A model with its own name. The models returned to callers only refer to these names.
struct NamedModel {
  std::string name;
  std::string_view friction;
  Gravity gravity;
};

const std::vector<NamedModel>& NamedModels() {
  static const std::vector<NamedModel> models = [] {
    std::vector<NamedModel> all;
    for (const std::string_view name : GravityModels::kNames) {
      const Gravity gravity = *Gravity::Named(name);
      FrictionModels::ForEach([&]<typename F>() {
        if (IsDeterminable<F>(gravity)) all.push_back({ModelName(name, F::kName), F::kName, gravity});
      });
    }
    return all;
  }();
  return models;
}

/// The model with `gravity`, if it has the default gravity or already this one.
Result<MotionModel> ChangeGravity(const MotionModel& model, Gravity gravity) {
  const std::string name(model.name);
  if (model.gravity != Gravity() && model.gravity != gravity) {
    return Error(StatusCode::kInvalidArgument,
                 "model " + name + " has the restoring torque " + std::string(model.gravity.name()) +
                     ", but --gravity says " + std::string(gravity.name()) + "; leave --gravity out, or give --model " +
                     std::string(model.friction));
  }
  if (const auto changed = WithGravity(model, gravity)) return *changed;
  return Error(StatusCode::kInvalidArgument,
               "model " + name + " cannot be combined with --gravity " + std::string(gravity.name()) +
                   ", where a constant torque would only shift the zero, and no weight loads the bearing; give "
                   "--model coulomb");
}

/// A usual word for a friction law.
struct Synonym {
  std::string_view word, friction;
};

constexpr std::array kSynonyms = {Synonym{"dry", CoulombFriction::kName}, Synonym{"quadratic", DragFriction::kName},
                                  Synonym{"air", DragFriction::kName}, Synonym{"stiction", StribeckFriction::kName}};

}  // namespace

std::vector<MotionModel> MotionModels() {
  std::vector<MotionModel> models;
  for (const auto& [name, friction, gravity] : NamedModels()) models.push_back({name, friction, gravity});
  return models;
}

std::string MotionModelNames() { return NameList(MotionModels()); }

Result<MotionModel> FindMotionModel(std::string_view name) {
  const auto* const synonym = std::ranges::find(kSynonyms, name, &Synonym::word);
  const std::string_view known = synonym == kSynonyms.end() ? name : synonym->friction;
  for (const MotionModel& model : MotionModels()) {
    if (model.name == known) return model;
  }
  return Error(StatusCode::kInvalidArgument,
               "there is no model '" + std::string(name) + "'; the models are " + MotionModelNames());
}

std::optional<MotionModel> WithGravity(const MotionModel& model, Gravity gravity) {
  for (const MotionModel& other : MotionModels()) {
    if (other.gravity == gravity && other.friction == model.friction) return other;
  }
  return std::nullopt;
}

Result<std::vector<MotionModel>> FindMotionModels(std::string_view names, std::optional<Gravity> gravity) {
  std::vector<MotionModel> models;
  if (names == "all") {
    models = MotionModels();
    std::erase_if(models, [&](const MotionModel& model) { return model.gravity != gravity.value_or(Gravity()); });
    return models;
  }
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    const std::string name(names.substr(begin, end - begin));
    begin = end + 1;
    auto found = FindMotionModel(name);
    if (!found)
      return Error(StatusCode::kInvalidArgument,
                   found.error().message() + "; or give 'all' by itself for every friction law");
    if (gravity) found = ChangeGravity(*found, *gravity);
    if (!found) return tl::unexpected(found.error());
    if (std::ranges::find(models, found->name, &MotionModel::name) != models.end()) {
      const std::string model(found->name);
      const std::string other = name == model || gravity ? "" : "; " + name + " is another name of it";
      const std::string twice = "'" + std::string(names) + "' names " + model + " twice";
      return Error(StatusCode::kInvalidArgument, twice + other);
    }
    models.push_back(*found);
  }
  return models;
}

std::vector<ParameterInfo> PhysicalParameters(const MotionModel& model) {
  std::vector<ParameterInfo> parameters = {kInertia};
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    parameters.insert(parameters.end(), F::kParameters.begin(), F::kParameters.end());
  });
  return parameters;
}

std::vector<ParameterInfo> AllParameters() {
  std::vector<ParameterInfo> all;
  const auto add = [&](const auto& parameters) {
    for (const ParameterInfo& parameter : parameters) {
      const bool is_known = std::ranges::find(all, parameter.name, &ParameterInfo::name) != all.end();
      if (!is_known) all.push_back(parameter);
    }
  };
  for (const MotionModel& model : MotionModels()) add(PhysicalParameters(model));
  add(kParametersOfRecordings);
  return all;
}

}  // namespace pendulum
