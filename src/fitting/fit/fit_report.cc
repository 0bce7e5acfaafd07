// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pendulum {

std::string_view TerminationName(Termination termination) {
  switch (termination) {
    case Termination::kConverged: return "converged";
    case Termination::kNotConverged: return "not_converged";
    case Termination::kNotIdentifiable: return "not_identifiable";
    case Termination::kFailed: return "failed";
  }
  return "failed";
}

int ExitCode(Termination termination) { return termination == Termination::kConverged ? 0 : 1; }

const ParameterEstimate* FitReport::Find(std::string_view name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.info.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

bool FitReport::HasWarning(WarningCode code) const { return pendulum::HasWarning(warnings, code); }

const Warning* FitReport::ReasonWarning() const { return reason_code ? FindWarning(warnings, *reason_code) : nullptr; }

void Reject(Termination termination, std::string reason, std::string_view without_errors, FitReport& fit) {
  fit.termination = termination;
  fit.reason = std::move(reason);
  fit.reason_code.reset();
  WithdrawErrors(without_errors, fit);
}

void RejectFor(Termination termination, Warning why, std::string_view without_errors, FitReport& fit) {
  Reject(termination, MessageText(why), without_errors, fit);
  fit.reason_code = why.code;
  fit.warnings.push_back(std::move(why));
}

void WithdrawErrors(std::string_view why, FitReport& fit) {
  for (ParameterEstimate& parameter : fit.parameters) {
    parameter.std_error = parameter.lower95 = parameter.upper95 = std::nullopt;
    parameter.systematic = {};
    if (!parameter.fixed) parameter.reason = why;
  }
  for (DerivedQuantity& quantity : fit.derived) {
    quantity.std_error = std::nullopt;
    quantity.systematic = {};
  }
  fit.profiles.clear();
  fit.covariance_names.clear();
  fit.covariance.resize(0, 0);
}

double Correlation(const FitReport& fit, Eigen::Index row, Eigen::Index column) {
  if (row == column) return 1;
  return fit.covariance(row, column) / std::sqrt(fit.covariance(row, row) * fit.covariance(column, column));
}

FitOptions OptionsLike(const FitReport& fit, FitOptions options) {
  options.start = fit.start;
  options.noise = fit.noise.family;
  options.search.may_correct = false;
  options.with_losses = false;
  return options;
}

}  // namespace pendulum
