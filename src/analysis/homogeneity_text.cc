// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/homogeneity_text.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

std::string PercentText(double share) {
  const double percent = 100 * std::abs(share);
  return (percent < 100 ? NumberText(percent, 2) : std::to_string(std::lround(percent))) + " %";
}

bool IsAnyParameter(const SharedParameter& /*parameter*/) { return true; }

bool Differs(const SharedParameter& parameter) { return !parameter.agrees(); }

std::string NamesOf(const Homogeneity& result, bool (*is_included)(const SharedParameter&)) {
  std::vector<std::string> names;
  for (const SharedParameter& parameter : result.parameters) {
    if (is_included(parameter)) names.push_back(parameter.name);
  }
  return NameList(names);
}

/// The parameters whose own test shows disagreement; all of them if only the joint test shows it.
std::string DifferingNames(const Homogeneity& result) {
  return NamesOf(result, std::ranges::any_of(result.parameters, Differs) ? Differs : IsAnyParameter);
}

/// Parameters that differ although the joint test shows agreement.
std::string DescribeExceptions(const Homogeneity& result) {
  std::string text;
  for (const SharedParameter& parameter : result.parameters) {
    if (Differs(parameter))
      text += "; on its own, " + parameter.name + " does not agree (p " + ProbabilityText(parameter.p) + ")";
  }
  return text;
}

/// Weighted mean and variance of a parameter over the recordings that do not disagree.
struct OtherRecordings {
  double mean = 0, variance = 0;
};

OtherRecordings SummarizeOthers(const Homogeneity& result, const SharedParameter& parameter) {
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < parameter.runs.size(); ++k) {
    const RunEstimate& run = parameter.runs[k];
    const bool out = std::ranges::find(result.disagreeing, static_cast<int>(k)) != result.disagreeing.end();
    if (!run.value || out) continue;
    const double weight = 1 / (*run.std_error * *run.std_error);
    sum += weight * *run.value;
    weights += weight;
  }
  return {sum / weights, 1 / weights};
}

/// The parameter in which a recording is farthest from the recordings that agree.
const SharedParameter* Farthest(const Homogeneity& result, std::size_t run) {
  const SharedParameter* farthest = nullptr;
  double most = 0;
  for (const SharedParameter& parameter : result.parameters) {
    const RunEstimate& own = parameter.runs[run];
    if (!own.value) continue;
    const OtherRecordings others = SummarizeOthers(result, parameter);
    const double z = std::abs(*own.value - others.mean) / std::hypot(*own.std_error, std::sqrt(others.variance));
    if (farthest != nullptr && !(z > most)) continue;
    farthest = &parameter;
    most = z;
  }
  return farthest;
}

/// "recording 3 (c.csv) disagrees with the others: its inertia is 3.0 % larger".
std::string DescribeOutlier(const Homogeneity& result, const std::vector<RunAlone>& runs, std::size_t run) {
  std::string text = runs[run].label + " disagrees with the others";
  const SharedParameter* const farthest = Farthest(result, run);
  if (farthest == nullptr) return text;
  const double mean = SummarizeOthers(result, *farthest).mean;
  const double change = *farthest->runs[run].value / mean - 1;
  text += ": its " + farthest->name + " is ";
  if (mean == 0 || !std::isfinite(change)) return text + NumberText(*farthest->runs[run].value, 3);
  return text + PercentText(change) + (change > 0 ? " larger" : " smaller");
}

/// Gives no advice if the law may be the cause.
std::string DescribeOutliers(const Homogeneity& result, const std::vector<RunAlone>& runs, bool lacks_fit) {
  std::string text;
  for (const int run : result.disagreeing) {
    text += (text.empty() ? "" : "; ") + DescribeOutlier(result, runs, static_cast<std::size_t>(run));
  }
  if (lacks_fit) return text;
  return text + "; fit the others without " + (result.disagreeing.size() == 1 ? "it" : "them");
}

/// Describes the differences that amplitude explains, if any.
std::string DescribeAmplitude(const Homogeneity& result) {
  std::string text;
  for (const AmplitudeDependence& dependence : result.amplitude_dependence) {
    if (!(dependence.p < Homogeneity::kDisagree)) continue;
    text +=
        (text.empty() ? "" : "; ") + dependence.name + (dependence.span > 0 ? " rises by " : " falls by ") +
        PercentText(dependence.span) +
        " from the recording with the smallest swings to that with the largest, as a linear dependence on amplitude "
        "squared within and between recordings predicts (p " +
        ProbabilityText(dependence.p) + ")" +
        (dependence.rest_p < Homogeneity::kDisagree ? ", but other differences remain" : ", and nothing else differs");
  }
  return text.empty() ? text : text + "; another law may explain that (--models all)";
}

/// Names the parameter with the largest scatter relative to its errors. Adds advice unless another law was already
/// recommended.
std::string DescribeScatter(const Homogeneity& result, bool recommends_law) {
  const auto most = std::ranges::max_element(result.parameters, {}, &SharedParameter::statistic);
  const RandomEffects& scatter = most->scatter;
  const std::string unit = most->unit == "1" ? "" : " " + most->unit;
  return "between recordings " + most->name + " scatters by " +
         (scatter.mean != 0 ? PercentText(scatter.between / scatter.mean) : NumberText(scatter.between, 2) + unit) +
         ", beyond its errors" +
         (recommends_law ? ""
                         : "; another law may explain that (--models all); if not, the random-effects means and their "
                           "errors are the rig's constants");
}

bool LacksFit(const std::vector<RunAlone>& runs) {
  return std::ranges::any_of(runs, [](const RunAlone& run) { return run.fit.HasWarning("lack_of_fit"); });
}

}  // namespace

std::string DescribeHomogeneity(const Homogeneity& result, const std::vector<RunAlone>& runs) {
  const std::string test = " (chi-square " + NumberText(result.statistic, 3) + ", " + DegreesOfFreedomText(result.dof) +
                           ", p " + ProbabilityText(result.p.value_or(0)) + ")";
  const std::string misfit = "; the model does not describe each recording completely";
  const bool lacks_fit = LacksFit(runs);
  if (result.agrees()) {
    return "the recordings agree on " + NamesOf(result, IsAnyParameter) + test + DescribeExceptions(result) +
           (lacks_fit ? misfit + ", which makes the errors larger" : "");
  }
  const std::string text = "the recordings do not agree on " + DifferingNames(result) + test + "; ";
  const std::string end = lacks_fit ? misfit +
                                          ", so the errors compared here may be too small, and another law may explain "
                                          "the differences (--models all)"
                                    : "";
  if (!result.disagreeing.empty()) return text + DescribeOutliers(result, runs, lacks_fit) + end;
  if (const double share = result.ScatterOfRigs(); share > 0) {
    return text + "inertia differs by " + PercentText(share) +
           " (standard deviation): the recordings are of different rigs, or of one rig at different lengths";
  }
  const std::string amplitude = DescribeAmplitude(result);
  if (result.is_amplitude()) return text + amplitude + end;
  return text + amplitude + (amplitude.empty() ? "" : "; ") + DescribeScatter(result, lacks_fit || !amplitude.empty()) +
         end;
}

}  // namespace pendulum
