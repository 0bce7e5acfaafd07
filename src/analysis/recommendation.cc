// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/recommendation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

/// Smaller differences of log-likelihood or BIC count as 0: the estimates of the added terms are then 0.
constexpr double kSame = 1e-3;

/// The rows of one comparison, addressed by index.
class RankedRows {
 public:
  RankedRows(const std::vector<FitReport>& fits, const Comparison& comparison) : fits_(fits), rows_(comparison.rows) {}

  /// Whether a law leaves more than noise in its residuals, predicts worse than it fits, and does not predict better
  /// than every law with fewer terms. Its smaller BIC is then no reason to recommend it.
  bool IsRefuted(std::size_t i) const {
    constexpr double kAsWell = 1.25, kBetter = 0.95;
    const ComparisonRow& row = rows_[i];
    const bool predicts = row.forward.samples > 0;
    if (!row.lack_of_fit || (predicts && row.forward.rms < kAsWell * row.rms)) return false;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (!rows_[k].bic || Terms(k) >= Terms(i) || rows_[k].forward.samples == 0) continue;
      if (!predicts || row.forward.rms > kBetter * rows_[k].forward.rms) return true;
    }
    return false;
  }

  double SmallestBic() const {
    double smallest = kUnbounded;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].bic && !IsRefuted(i)) smallest = std::min(smallest, *rows_[i].bic);
    }
    return smallest;
  }

  bool IsNear(std::size_t i) const {
    return rows_[i].bic && !IsRefuted(i) && *rows_[i].bic <= SmallestBic() + kWithinBic;
  }

  /// The model with the smallest AICc among those not refuted, if its BIC is not near the smallest; otherwise empty.
  std::string ByAicc() const {
    std::size_t best = rows_.size();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].aicc || IsRefuted(i)) continue;
      if (best == rows_.size() || *rows_[i].aicc < *rows_[best].aicc) best = i;
    }
    return best == rows_.size() || IsNear(best) ? "" : rows_[best].model;
  }

  /// Refuted models that have a smaller BIC than the chosen one.
  std::vector<std::string> RefutedModels(std::size_t chosen) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].bic || !IsRefuted(i) || *rows_[i].bic > *rows_[chosen].bic - kSame) continue;
      names.push_back(rows_[i].model);
    }
    return names;
  }

  std::size_t Terms(std::size_t i) const { return PhysicalParameters(fits_[i].model).size(); }

  /// Laws in the order in which they are preferred: fewer terms first, then the more common law, which the registry
  /// names first.
  std::pair<std::size_t, std::ptrdiff_t> Order(std::size_t i) const {
    const MotionModel& model = fits_[i].model;
    const auto place = std::ranges::find(FrictionModels::kNames, model.friction) - FrictionModels::kNames.begin();
    return {Terms(i), place};
  }

  /// Index of the recommended row; the number of rows if there is none.
  std::size_t Simplest() const {
    std::size_t chosen = rows_.size();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!IsNear(i)) continue;
      if (chosen == rows_.size() || Order(i) < Order(chosen)) chosen = i;
    }
    return chosen;
  }

  /// Index of the simplest law whose residuals are rounding: no larger than the error of its computed trajectory. The
  /// number of rows if there is none.
  std::size_t SimplestWithoutNoise() const {
    std::size_t chosen = rows_.size();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].judged || !rows_[i].is_rounding) continue;
      if (chosen == rows_.size() || Order(i) < Order(chosen)) chosen = i;
    }
    return chosen;
  }

  /// Index of the row with the smallest BIC among the rows that are not near the smallest one; the number of rows if
  /// there is none.
  std::size_t RunnerUp() const {
    std::size_t next = rows_.size();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].bic || IsNear(i) || IsRefuted(i)) continue;
      if (next == rows_.size() || *rows_[i].bic < *rows_[next].bic) next = i;
    }
    return next;
  }

  bool IsSame(std::size_t i, std::size_t k) const {
    return std::abs(rows_[i].log_likelihood.value_or(0) - rows_[k].log_likelihood.value_or(kUnbounded)) < kSame;
  }

  /// The other models whose BIC is also near the smallest one.
  std::vector<std::string> UndecidedModels(std::size_t chosen) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      // A law whose added terms are estimated as 0 is the same as the chosen one.
      if (i == chosen || !IsNear(i) || IsSame(i, chosen)) continue;
      names.push_back(rows_[i].model);
    }
    return names;
  }

  /// The other models whose added terms are estimated as 0.
  std::vector<std::string> SameModels(std::size_t chosen) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (i != chosen && rows_[i].bic && IsSame(i, chosen)) names.push_back(rows_[i].model);
    }
    return names;
  }

 private:
  const std::vector<FitReport>& fits_;
  const std::vector<ComparisonRow>& rows_;
};

std::string BicText(double difference) {
  return difference < 100 ? NumberText(difference, 2) : std::to_string(std::lround(difference));
}

/// ", and predicts the last 40 % 2 times as well", or "equally well" within a factor of 1.1; empty unless both laws
/// have predictions.
std::string PredictionText(const ComparisonRow& chosen, const ComparisonRow& other) {
  constexpr double kDiffers = 1.1;
  if (chosen.forward.samples == 0 || other.forward.samples == 0) return "";
  const double ratio = other.forward.rms / chosen.forward.rms;
  if (ratio < kDiffers && ratio > 1 / kDiffers) return ", and predicts the last 40 % equally well";
  const std::string times = NumberText(ratio > 1 ? ratio : 1 / ratio, 2);
  return ratio > 1 ? ", and predicts the last 40 % " + times + " times as well"
                   : ", although it predicts the last 40 % " + times + " times worse";
}

/// Says whether the residuals show a lack of fit or are autocorrelated.
std::string DescribeDoubts(const ComparisonRow& row, const FitReport& fit) {
  if (row.lack_of_fit) {
    return "; its residuals are still more than noise (lag-1 correlation " + NumberText(row.lag1_correlation, 2) +
           "), so the model lacks something";
  }
  if (fit.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite) return "";
  return "; its residuals are autocorrelated (" + fit.noise.autocorrelation.Name() +
         "), which the criterion takes into account";
}

}  // namespace

void Recommend(const std::vector<FitReport>& fits, Comparison& comparison) {
  const RankedRows ranked(fits, comparison);
  if (const std::size_t exact = ranked.SimplestWithoutNoise();
      comparison.likelihood == Likelihood::kNone && exact != comparison.rows.size()) {
    comparison.recommended = comparison.rows[exact].model;
    comparison.reason =
        "the simplest law whose residuals are no larger than the error of its computed trajectory, so that no noise is "
        "left by which laws could be compared";
    return;
  }
  const std::size_t chosen = ranked.Simplest();
  if (chosen == comparison.rows.size()) {
    comparison.reason = "no law is recommended: no likelihood of the residuals could be computed";
    return;
  }
  const ComparisonRow& row = comparison.rows[chosen];
  comparison.recommended = row.model;
  comparison.reason.clear();
  const std::size_t next = ranked.RunnerUp();
  const std::vector<std::string> undecided = ranked.UndecidedModels(chosen);
  if (!undecided.empty()) {
    comparison.reason += "the simplest of the laws that the readings do not distinguish; the others are " +
                         NameList(undecided) + " (their BIC differs by less than " + NumberText(kWithinBic) + ")";
  }
  // Of laws that are not near the smallest BIC some may be near that of the chosen one; of these nothing is said.
  if (next != comparison.rows.size() && *comparison.rows[next].bic > *row.bic + kWithinBic) {
    const ComparisonRow& other = comparison.rows[next];
    comparison.reason += (undecided.empty() ? "BIC lower by " : "; BIC lower by ") + BicText(*other.bic - *row.bic) +
                         " than with " + other.model + PredictionText(row, other);
  } else if (undecided.empty()) {
    const auto judged = std::ranges::count_if(comparison.rows, &ComparisonRow::judged);
    comparison.reason += judged == 1 ? "the only one that converged" : "no other is better";
  }
  if (const std::vector<std::string> same = ranked.SameModels(chosen); !same.empty()) {
    comparison.reason += "; " + NameList(same) +
                         (same.size() == 1 ? " gives the same fit: its added terms are 0"
                                           : " give the same fit: their added terms are 0");
  }
  if (const std::vector<std::string> refuted = ranked.RefutedModels(chosen); !refuted.empty()) {
    comparison.reason += "; " + NameList(refuted) + (refuted.size() == 1 ? " has" : " have") +
                         " a smaller BIC, but residuals that are more than noise, and a prediction of the last 40 % "
                         "that is missing or not better";
  }
  if (const std::string other = ranked.ByAicc(); !other.empty())
    comparison.reason += "; by the criterion AICc, which counts parameters less, " + other + " is better";
  comparison.reason += DescribeDoubts(row, fits[chosen]);
}

}  // namespace pendulum
