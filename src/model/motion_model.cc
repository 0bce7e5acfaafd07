// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/motion_model.h"

#include <string>

#include "pendulum/base/format.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {

std::vector<MotionModel> MotionModels() {
  std::vector<MotionModel> models = {{"linear", ViscousFriction::kName, Gravity::kLinear}};
  for (const std::string_view name : FrictionModels::kNames) models.push_back({name, name, Gravity::kSine});
  return models;
}

std::string MotionModelNames() { return NameList(MotionModels()); }

Result<MotionModel> FindMotionModel(std::string_view name) {
  for (const MotionModel& model : MotionModels()) {
    if (model.name == name) return model;
  }
  return Error(StatusCode::kInvalidArgument,
               "there is no model '" + std::string(name) + "'; the models are " + MotionModelNames());
}

std::vector<ParameterInfo> PhysicalParameters(const MotionModel& model) {
  std::vector<ParameterInfo> parameters = {kInertia};
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    parameters.insert(parameters.end(), F::kParameters.begin(), F::kParameters.end());
  });
  return parameters;
}

}  // namespace pendulum
