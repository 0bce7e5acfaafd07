// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/equation.h"

#include <string_view>

#include "pendulum/base/rounding.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// The equation with {name} instead of the parameters' values, and {gravity_torque} instead of G.
std::string EquationOf(const MotionModel& model) {
  std::string equation = "{inertia} th'' + ";
  FrictionModels::Visit(model.friction, [&]<typename F>() { equation += F::kFormula; });
  return equation + " + {gravity_torque} " + std::string(model.gravity.formula()) + " = 0";
}

void Replace(std::string_view from, std::string_view to, std::string& text) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

void Fill(std::string_view name, std::string_view value, std::string& equation) {
  Replace("{" + std::string(name) + "}", value, equation);
}

Rounding RoundingOf(const ParameterEstimate& parameter, EquationDigits digits) {
  const auto total = TotalStdError(parameter.std_error, parameter.systematic);
  const double error = (digits == EquationDigits::kOfTotalError ? total : parameter.std_error).value_or(0);
  return error > 0 ? PdgRounding(parameter.estimate, error)
                   : SignificantRounding(parameter.estimate, kDigitsWithoutError);
}

std::string NumberOf(const ParameterEstimate& parameter, EquationDigits digits) {
  return parameter.estimate == 0 ? "0" : RoundedText(parameter.estimate, RoundingOf(parameter, digits));
}

}  // namespace

std::string SymbolicEquation(const MotionModel& model) {
  std::string equation = EquationOf(model);
  for (const ParameterInfo& parameter : PhysicalParameters(model)) Fill(parameter.name, parameter.symbol, equation);
  Fill("gravity_torque", "G", equation);
  return equation;
}

std::string FittedEquation(const FitReport& fit, const std::optional<Rig>& rig, EquationDigits digits) {
  std::string equation = EquationOf(fit.model);
  int of_torque = kDigitsWithoutError;
  for (const ParameterEstimate& parameter : fit.parameters) {
    Fill(parameter.info.name, NumberOf(parameter, digits), equation);
    if (parameter.info.name == kInertia.name)
      of_torque = SignificantDigits(parameter.estimate, RoundingOf(parameter, digits));
  }
  if (rig) {
    const double torque = rig->gravity_torque.value;
    Fill("gravity_torque", RoundedText(torque, SignificantRounding(torque, of_torque)), equation);
  } else {
    Replace("{gravity_torque} ", "", equation);
  }
  Replace("+ -", "- ", equation);
  return equation;
}

std::string WithoutZeroTerms(std::string equation) {
  constexpr std::string_view kZero = " + 0 ";
  for (std::size_t at = equation.find(kZero); at != std::string::npos; at = equation.find(kZero, at)) {
    int depth = 0;  // of brackets: a sum within them belongs to the term
    std::size_t end = at + kZero.size();
    const auto ends = [&] {
      return depth <= 0 && equation[end] == ' ' && std::string_view("+-=").find(equation[end + 1]) < 3;
    };
    for (; end + 1 < equation.size() && !ends(); ++end) {
      depth += equation[end] == '(' || equation[end] == '[' ? 1 : equation[end] == ')' || equation[end] == ']' ? -1 : 0;
    }
    equation.erase(at, end - at);
  }
  return equation;
}

}  // namespace pendulum
