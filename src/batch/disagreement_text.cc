// SPDX-License-Identifier: Apache-2.0
#include "batch/disagreement_text.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/batch/quantity_text.h"

namespace pendulum {
namespace {

/// A recording, the parameter in which it differs most, and what it is compared with.
struct Difference {
  std::string id, parameter;
  double estimate = 0;
  std::string whose;
  double others = 0, z = 0;
};

/// Each recording once.
std::vector<Difference> DifferencesOf(const StoreSummary& summary) {
  std::vector<Difference> found;
  std::set<std::string> known;
  for (const GroupAgreement& row : summary.agreement.rows) {
    for (const DisagreeingRun& run : row.outliers) {
      if (known.insert(run.id).second)
        found.push_back({run.id, run.parameter, run.estimate, "the others", run.others, run.z});
    }
  }
  for (const QuantitySummary& quantity : summary.quantities) {
    if (!summary.IsMainParameter(quantity)) continue;
    for (const OutlyingRun& run : quantity.outliers) {
      if (known.insert(run.id).second)
        found.push_back({run.id, quantity.name, run.estimate, "median", quantity.distribution.median, run.z});
    }
  }
  return found;
}

/// "3 % more".
std::string ShareText(double value, double others) {
  constexpr int kDigits = 2;
  const double percent = 100 * std::abs((value - others) / others);
  return NumberText(percent, kDigits) + " % " + (std::abs(value) > std::abs(others) ? "more" : "less");
}

/// "inertia 0.081402, the others 0.078999: 3 % more, z 17.8".
std::string DifferenceText(const Difference& one) {
  constexpr int kDigits = 5;
  std::vector<std::string> how;
  if (one.others != 0 && one.estimate / one.others > 0) how.push_back(ShareText(one.estimate, one.others));
  if (std::isfinite(one.z)) how.push_back("z " + DistanceText(one.z));
  return one.parameter + " " + NumberText(one.estimate, kDigits) + ", " + one.whose + " " +
         NumberText(one.others, kDigits) + (how.empty() ? "" : ": " + NameList(how));
}

}  // namespace

std::string DisagreementText(const StoreSummary& summary) {
  constexpr std::size_t kNamed = 3;
  const std::vector<Difference> found = DifferencesOf(summary);
  if (found.empty()) return "";
  const std::size_t count = found.size();
  std::string text = count == 1 ? "One recording disagrees" : std::to_string(count) + " recordings disagree";
  text += " with the others of the same pendulum: ";
  for (std::size_t i = 0; i < count && i < kNamed; ++i)
    text += (i == 0 ? "" : "; ") + found[i].id + " (" + DifferenceText(found[i]) + ")";
  return text + (count > kNamed ? "; and " + std::to_string(count - kNamed) + " more" : "") + ".";
}

std::map<std::string, std::string> DifferencesById(const StoreSummary& summary) {
  std::map<std::string, std::string> texts;
  for (const Difference& one : DifferencesOf(summary)) texts.emplace(one.id, DifferenceText(one));
  return texts;
}

}  // namespace pendulum
