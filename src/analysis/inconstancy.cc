// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/inconstancy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Estimates of one parameter from K parts of a recording.
struct Estimates {
  std::string_view name;
  VectorXd value, std_error;  // K
  bool differs = false;       // A test says that they differ.
  double least_change = 0;    // The change that this test has seen, as a standard deviation.
  std::string_view parts;
};

/// Standard deviation of a quantity that is evenly distributed over this range.
double DeviationOverRange(double range) { return std::abs(range) / std::sqrt(12.0); }

Estimates OfWindows(const AmplitudeTrend& trend, const std::vector<AmplitudeRow>& windows) {
  const auto count = static_cast<Index>(windows.size());
  Estimates estimates{trend.name, VectorXd(count), VectorXd(count), false, 0, "windows"};
  VectorXd square(count);
  const bool is_inertia = trend.name == kInertia.name;
  for (Index w = 0; w < count; ++w) {
    const AmplitudeRow& row = windows[static_cast<std::size_t>(w)];
    estimates.value[w] = is_inertia ? row.inertia : row.friction;
    estimates.std_error[w] = is_inertia ? row.inertia_std_error : row.friction_std_error;
    square[w] = row.amplitude * row.amplitude;
  }
  estimates.differs = trend.has_trend() || trend.scatters();
  if (trend.has_trend())
    estimates.least_change = DeviationOverRange(trend.slope * (square.maxCoeff() - square.minCoeff()));
  return estimates;
}

/// The two halves. If only all parameters together differ, the one that differs most has changed. A jump between them
/// has half its size as standard deviation.
Estimates OfHalves(const HalvesRow& row, const Constancy& constancy) {
  const auto size = [](const HalvesRow& one) { return std::abs(one.z); };
  const bool is_joint = constancy.halves_p.value_or(1) < kNotConstant;
  const bool is_most = is_joint && &*std::ranges::max_element(constancy.halves, {}, size) == &row;
  Estimates estimates{row.name,
                      Eigen::Vector2d(row.first, row.second),
                      Eigen::Vector2d(row.first_std_error, row.second_std_error),
                      false,
                      0,
                      "halves"};
  const bool has_jump = is_most || row.differs();
  estimates.differs = is_joint || has_jump;
  if (has_jump) estimates.least_change = 0.5 * std::abs(row.second - row.first);
  return estimates;
}

/// The estimates of each parameter from windows and from halves. A change in the middle of a recording can be seen in
/// its halves alone, one with amplitude in its windows alone.
std::vector<Estimates> EstimatesOfParts(const Constancy& constancy) {
  std::vector<Estimates> all;
  for (const AmplitudeTrend& trend : constancy.trends) all.push_back(OfWindows(trend, constancy.windows));
  for (const HalvesRow& row : constancy.halves) all.push_back(OfHalves(row, constancy));
  return all;
}

std::string_view NameOf(const ParameterEstimate& parameter) { return parameter.info.name; }

/// Adds this error to what is derived from the parameter. The ratios of the parameters to G determine them.
void AddToDerived(const ParameterEstimate& changing, ErrorSource source, double std_dev, FitReport& fit) {
  const auto ratio = std::ranges::find(fit.derived, "gravity_over_inertia", &DerivedQuantity::name);
  if (ratio == fit.derived.end()) return;
  const double gravity = ratio->estimate * fit.Find(kInertia.name)->estimate;
  const double error = std_dev / (changing.info.scales_with_gravity() ? gravity : 1);
  const auto count = static_cast<Index>(fit.parameters.size());
  const Index i = &changing - fit.parameters.data();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  covariance(i, i) = error * error;
  AddSystematicErrors(source, covariance, fit.derived);
}

/// Adds a systematic error of this parameter that is independent of all other errors.
void AddSystematic(ParameterEstimate& parameter, ErrorSource source, double std_dev, FitReport& fit) {
  parameter.systematic.Add(source, std_dev);
  const auto place = std::ranges::find(fit.systematic_names, parameter.info.name);
  const Index row = place - fit.systematic_names.begin();
  if (place == fit.systematic_names.end()) {
    fit.systematic_names.emplace_back(parameter.info.name);
    fit.systematic_covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(row + 1, row + 1));
  }
  fit.systematic_covariance(row, row) += std_dev * std_dev;
  AddToDerived(parameter, source, std_dev, fit);
}

/// How much a parameter changes during a recording, or between recordings.
struct Change {
  std::string_view name;
  double std_dev = 0;  // of its parts about the estimate, beyond their errors
  std::string_view parts;
};

/// Standard deviation of the parts' estimates about the whole fit's, beyond their errors. Friction below 0 in a part is
/// an error of that part.
double ChangeAbout(const ParameterEstimate& parameter, const Estimates& estimates) {
  const VectorXd possible = estimates.value.cwiseMax(parameter.info.lower).cwiseMin(parameter.info.upper);
  return ScatterAbout(parameter.estimate, possible, estimates.std_error);
}

/// The parameters of `fit` that change by more than their errors. Windows measure a change better than halves, which
/// count if they have seen a larger one.
std::vector<Change> Changes(const Constancy& constancy, const FitReport& fit) {
  std::vector<Change> changes;
  for (const Estimates& estimates : EstimatesOfParts(constancy)) {
    const ParameterEstimate* const parameter = fit.Find(estimates.name);
    if (!estimates.differs || parameter == nullptr) continue;
    const auto known = std::ranges::find(changes, parameter->info.name, &Change::name);
    const double scatter = known == changes.end() ? ChangeAbout(*parameter, estimates) : 0;
    const double about = std::max(scatter, estimates.least_change);
    if (!(about > 0) || !std::isfinite(about)) continue;
    const Change change{parameter->info.name, about, estimates.parts};
    if (known == changes.end()) {
      changes.push_back(change);
    } else if (about > known->std_dev) {
      *known = change;
    }
  }
  return changes;
}

/// "coulomb by 0.0012 N m between windows".
std::string ChangeText(const ParameterEstimate& parameter, const Change& change) {
  return std::string(parameter.info.name) + " by " + NumberText(change.std_dev, 2) +
         (parameter.unit == "1" ? "" : " " + parameter.unit) + " between " + std::string(change.parts);
}

/// Root mean square of a parameter's standard deviations in K recordings, of those where they are known, weighted with
/// 1 / std_error², or equally if no recording determines the parameter.
double CommonStdDev(std::string_view name, const std::vector<RunAlone>& runs,
                    const std::vector<std::optional<double>>& std_devs) {
  std::vector<double> known, weights;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const ParameterEstimate* const parameter = runs[k].fit.Find(name);
    if (parameter == nullptr || !std_devs[k]) continue;
    const double error = parameter->std_error.value_or(0);
    known.push_back(*std_devs[k]);
    weights.push_back(error > 0 ? 1 / (error * error) : 0);
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double equal = 1 / static_cast<double>(weights.size());
  double square = 0;
  for (std::size_t k = 0; k < known.size(); ++k) square += (sum > 0 ? weights[k] / sum : equal) * known[k] * known[k];
  return std::sqrt(square);
}

/// The changes in one recording; std::nullopt if it was not tested.
using TestedChanges = std::optional<std::vector<Change>>;

TestedChanges ChangesOf(const RunAlone& run) {
  const Constancy* const constancy = run.constancy;
  if (constancy == nullptr || (constancy->windows.empty() && constancy->halves.empty())) return std::nullopt;
  return Changes(*constancy, run.fit);
}

/// How much a parameter changes within all recordings that were tested. `parts` are those of the largest change.
Change CommonChange(std::string_view name, const std::vector<RunAlone>& runs, const std::vector<TestedChanges>& all) {
  Change largest{name, 0, ""};
  std::vector<std::optional<double>> std_devs;
  for (const TestedChanges& changes : all) {
    if (!changes) {
      std_devs.emplace_back();
      continue;
    }
    const auto change = std::ranges::find(*changes, name, &Change::name);
    std_devs.emplace_back(change == changes->end() ? 0 : change->std_dev);
    if (*std_devs.back() > largest.std_dev) largest = *change;
  }
  return {name, CommonStdDev(name, runs, std_devs), largest.parts};
}

/// Standard deviation of a parameter between recordings beyond their errors, if that is significant. Short recordings
/// cannot show a change within them, but their differences can.
double ChangeBetweenRuns(std::string_view name, const std::vector<SharedParameter>& between) {
  const auto shared = std::ranges::find(between, name, &SharedParameter::name);
  if (shared == between.end() || shared->agrees()) return 0;
  return std::isfinite(shared->scatter.between) ? shared->scatter.between : 0;
}

/// How far an estimate is off by friction that the law does not have: what was named, and in a short recording also
/// terms that the readings suggest too weakly to be named, if they move it more.
double FrictionLawError(const Constancy& constancy, const ParameterEstimate& parameter) {
  return std::max(parameter.named_friction, constancy.is_too_short_for_windows() ? parameter.hidden_friction : 0.0);
}

/// The part of this error that is not among the changes during the recording, which are a consequence of it.
double BeyondChange(double law_error, const ParameterEstimate& parameter) {
  const double change = parameter.systematic.Of(ErrorSource::kInconstancy);
  return law_error > change ? std::sqrt(law_error * law_error - change * change) : 0;
}

double CommonFrictionLawError(std::string_view name, const std::vector<RunAlone>& runs) {
  std::vector<std::optional<double>> errors;
  for (const RunAlone& run : runs) {
    const ParameterEstimate* const own = run.fit.Find(name);
    const bool is_known = own != nullptr && run.constancy != nullptr;
    errors.push_back(is_known ? std::optional(FrictionLawError(*run.constancy, *own)) : std::nullopt);
  }
  return CommonStdDev(name, runs, errors);
}

/// Adds a systematic error to a parameter of the fit to all recordings and of the parts of several recordings.
void AddToAll(std::string_view name, ErrorSource source, double std_dev, FitReport& whole, std::span<FitReport> parts) {
  AddSystematic(*std::ranges::find(whole.parameters, name, NameOf), source, std_dev, whole);
  for (FitReport& part : parts) AddSystematic(*std::ranges::find(part.parameters, name, NameOf), source, std_dev, part);
}

}  // namespace

void AddInconstancyError(const std::vector<RunAlone>& runs, const std::vector<SharedParameter>& between,
                         FitReport& whole, std::span<FitReport> parts) {
  std::vector<TestedChanges> changes;
  for (const RunAlone& run : runs) changes.push_back(ChangesOf(run));
  std::string text;
  for (const ParameterEstimate& parameter : whole.parameters) {
    if (runs.size() > 1 && !parameter.std_error) continue;
    Change change = CommonChange(parameter.info.name, runs, changes);
    const double between_runs = ChangeBetweenRuns(parameter.info.name, between);
    if (between_runs > change.std_dev) change = {parameter.info.name, between_runs, "recordings"};
    if (!(change.std_dev > 0)) continue;
    AddToAll(change.name, ErrorSource::kInconstancy, change.std_dev, whole, parts);
    text += (text.empty() ? "" : ", ") + ChangeText(parameter, change);
  }
  if (text.empty()) return;
  whole.warnings.push_back({.code = "not_constant",
                            .finding = "parameters change by more than their errors: " + text,
                            .explanation = "another run may differ by about as much; the systematic errors include "
                                           "this, standard errors and intervals do not"});
}

void AddFrictionLawError(const std::vector<RunAlone>& runs, FitReport& whole, std::span<FitReport> parts) {
  for (const ParameterEstimate& parameter : whole.parameters) {
    if (!parameter.std_error) continue;
    const double error = BeyondChange(CommonFrictionLawError(parameter.info.name, runs), parameter);
    if (error > 0) AddToAll(parameter.info.name, ErrorSource::kFrictionLaw, error, whole, parts);
  }
}

}  // namespace pendulum
