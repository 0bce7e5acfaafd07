// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/model_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "pendulum/analysis/comparison_parts.h"
#include "pendulum/analysis/nested_tests.h"
#include "pendulum/analysis/recommendation.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/fitting/residuals/bounded_least_squares.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The compared fits: joint fits, or separate fits if the recordings do not share their parameters.
struct ComparedFits {
  const FittedRecordings& fitted;
  bool is_separate = false;
  std::vector<FitReport> combined = {};  // M, of several recordings, without samples
  std::vector<int> parameters = {};      // M

  std::size_t count() const { return fitted.recordings.size(); }
  /// The fits to all recordings, M.
  const std::vector<FitReport>& whole() const { return count() == 1 ? fitted.recordings.front().fits : combined; }
  const Recording& Used(std::size_t k) const { return fitted.recordings[k].used; }
  const FitReport& Fit(std::size_t k, std::size_t m) const {
    return is_separate ? fitted.recordings[k].fits[m] : fitted.FitOf(k, m);
  }
  std::vector<std::string> SharedBy(std::size_t m) const {
    if (is_separate) return {};
    return count() == 1 ? PhysicalNames({fitted.models[m]}) : fitted.joint[m].shared;
  }
};

/// Combines the separate fits to all recordings into one report.
FitReport CombineSeparateFits(const FittedRecordings& fitted, std::size_t m, int& parameters) {
  FitReport whole;
  whole.model = fitted.joint[m].whole.model;
  whole.termination = Termination::kConverged;
  std::vector<const FitReport*> fits;
  for (const FittedRecording& recording : fitted.recordings) {
    const FitReport& fit = recording.fits[m];
    if (fit.termination != Termination::kConverged && whole.termination == Termination::kConverged) {
      whole.termination = fit.termination;
      whole.reason = recording.label + ": " + fit.reason;
    }
    fits.push_back(&fit);
    parameters += DescribeFit(fit).parameters;
    if (whole.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite)
      whole.noise.autocorrelation = fit.noise.autocorrelation;
  }
  whole.statistics = SumStatistics(fits, parameters);
  return whole;
}

ComparedFits SeparateFits(const FittedRecordings& fitted) {
  ComparedFits compared{fitted, true};
  for (std::size_t m = 0; m < fitted.models.size(); ++m) {
    compared.parameters.push_back(0);
    compared.combined.push_back(CombineSeparateFits(fitted, m, compared.parameters.back()));
  }
  return compared;
}

/// The fits to all recordings; of several, separate fits if the recordings disagree under the law that describes each
/// of them best, because then no law makes the joint fit right.
ComparedFits ChooseFitsToCompare(const FittedRecordings& fitted) {
  ComparedFits compared{fitted};
  if (fitted.recordings.size() == 1) {
    for (const FitReport& fit : fitted.recordings.front().fits)
      compared.parameters.push_back(DescribeFit(fit).parameters);
    return compared;
  }
  ComparedFits alone = SeparateFits(fitted);
  const FitReport* const best = BestFit(alone.combined);
  if (best != nullptr && !fitted.homogeneity[static_cast<std::size_t>(best - alone.combined.data())].agrees())
    return alone;
  for (const JointFit& fit : fitted.joint) {
    compared.combined.push_back(fit.whole);
    compared.parameters.push_back(fit.parameters);
  }
  return compared;
}

/// Divisor of recording k's residuals that gives all recordings the same unit. It is 1 if they have one unit; otherwise
/// the least σ of any model, the same for all models.
double UnitOf(const FittedRecordings& fitted, std::size_t k) {
  if (fitted.HaveOneUnit()) return 1;
  double least = kUnbounded;
  for (const FitReport& fit : fitted.recordings[k].fits) {
    if (fit.noise.sigma > 0) least = std::min(least, fit.noise.sigma);
  }
  return least;
}

ComparisonRow DescribeRow(const ComparedFits& compared, std::size_t m) {
  const FitReport& whole = compared.whole()[m];
  ComparisonRow row = DescribeFit(whole);
  row.parameters = compared.parameters[m];
  row.is_rounding = true;
  for (std::size_t k = 0; k < compared.count() && whole.termination != Termination::kFailed; ++k) {
    const FitReport& run = compared.Fit(k, m);
    row.lack_of_fit = row.lack_of_fit || run.HasWarning("lack_of_fit");
    row.is_rounding = row.is_rounding && IsRounding(run);
    if (std::abs(run.noise.lag1_correlation) > std::abs(row.lag1_correlation))
      row.lag1_correlation = run.noise.lag1_correlation;
    row.ljung_box_p = std::min(row.ljung_box_p, run.statistics.ljung_box_p);
  }
  return row;
}

/// The strictest likelihood that any recording requires.
Likelihood StrictestLikelihood(const ComparedFits& compared, std::size_t best) {
  Likelihood chosen = Likelihood::kIndependent;
  for (std::size_t k = 0; k < compared.count(); ++k) {
    chosen = std::max(chosen, ChooseLikelihood(compared.Fit(k, best), compared.Used(k).resolution));
  }
  return chosen;
}

/// The fit to a recording whose residuals require `likelihood`; DescribeLikelihood describes it.
const FitReport& RepresentativeRecording(const ComparedFits& compared, std::size_t best, Likelihood likelihood) {
  for (std::size_t k = 0; k < compared.count(); ++k) {
    const FitReport& fit = compared.Fit(k, best);
    if (ChooseLikelihood(fit, compared.Used(k).resolution) == likelihood) return fit;
  }
  return compared.Fit(0, best);
}

// ---- Likelihood of autocorrelated residuals -------------------------------------------------------------------------

/// Log-likelihoods of recordings about the joint estimates, as parabolas over all free parameters.
class SharedShift {
 public:
  /// Adds a run's parabola in the shift of its F free parameters: information (F x F), the maximum at `shift`, and the
  /// range [lowest, highest] of the shift.
  void Add(const std::vector<std::string>& names, const Eigen::MatrixXd& information, const Eigen::VectorXd& shift,
           const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest, const std::vector<std::string>& shared) {
    std::vector<Index> at;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool is_shared = std::ranges::find(shared, names[i]) != shared.end();
      const auto known = std::ranges::find(shared_names_, names[i]);
      const auto row = static_cast<Index>(i);
      if (is_shared && known != shared_names_.end()) {
        at.push_back(places_[static_cast<std::size_t>(known - shared_names_.begin())]);
        continue;
      }
      at.push_back(static_cast<Index>(lowest_.size()));
      lowest_.push_back(lowest[row]);
      highest_.push_back(highest[row]);
      if (!is_shared) continue;
      shared_names_.push_back(names[i]);
      places_.push_back(at.back());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
    const Eigen::MatrixXd root =
        eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
    roots_.push_back({std::move(at), root, root * shift});
  }

  /// Difference between the sum of separate maxima of the log-likelihoods and the maximum of their sum.
  double Loss() const {
    const auto columns = static_cast<Index>(lowest_.size());
    Index rows = 0;
    for (const Root& root : roots_) rows += root.wanted.size();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::VectorXd wanted(rows);
    Index first = 0;
    for (const Root& root : roots_) {
      const Index count = root.wanted.size();
      matrix(Eigen::seqN(first, count), root.at) = root.matrix;
      wanted.segment(first, count) = root.wanted;
      first += count;
    }
    const Eigen::VectorXd shift =
        BoundedLeastSquares(matrix, wanted, Eigen::Map<const Eigen::VectorXd>(lowest_.data(), columns),
                            Eigen::Map<const Eigen::VectorXd>(highest_.data(), columns));
    return 0.5 * (wanted - matrix * shift).squaredNorm();
  }

 private:
  struct Root {
    std::vector<Index> at;
    Eigen::MatrixXd matrix;
    Eigen::VectorXd wanted;
  };
  std::vector<Root> roots_;
  std::vector<std::string> shared_names_;
  std::vector<Index> places_;  // column of each shared name
  std::vector<double> lowest_, highest_;
};

/// The likelihood of a recording, linearized about its estimates. The autocorrelation has the kind and order of the
/// residuals of the best model. The information about the parameters is added to `together`.
std::optional<CorrelatedLikelihood> AddLikelihood(const ComparedFits& compared, std::size_t k, std::size_t m,
                                                  std::size_t best, const FitOptions& options, SharedShift& together) {
  const FitReport& fit = compared.Fit(k, m);
  std::optional<CorrelatedResiduals> data = ResidualsOf(compared.Used(k), fit, options, false);
  if (!data) return std::nullopt;
  const Eigen::VectorXd lowest = data->lowest, highest = data->highest;
  data->lowest.setConstant(-kUnbounded);
  data->highest.setConstant(kUnbounded);
  auto likelihood = MaximizeCorrelatedLikelihood(*data, SharedAutocorrelation(compared.Fit(k, best)), options.stop);
  if (!likelihood) return std::nullopt;
  std::vector<std::string> names;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (!parameter.fixed && !parameter.at_bound) names.emplace_back(parameter.info.name);
  }
  together.Add(names, likelihood->information, likelihood->shift, lowest, highest, compared.SharedBy(m));
  return likelihood;
}

/// The maximum of the likelihood of the only recording, within the bounds.
std::optional<double> OnlyLikelihood(const ComparedFits& compared, std::size_t m, std::size_t best,
                                     const FitOptions& options, int& parameters) {
  const std::optional<CorrelatedResiduals> data = ResidualsOf(compared.Used(0), compared.Fit(0, m), options, true);
  const auto likelihood =
      data ? MaximizeCorrelatedLikelihood(*data, SharedAutocorrelation(compared.Fit(0, best)), options.stop)
           : std::nullopt;
  if (!likelihood) return std::nullopt;
  parameters += likelihood->parameters - 1;
  return likelihood->log_likelihood + SumOfLogLevelWidths(compared.Used(0));
}

/// The maximum of the sum of several recordings' likelihoods, which are parabolas. unknown: the recording whose
/// likelihood cannot be computed.
std::optional<double> SumOfLikelihoods(const ComparedFits& compared, std::size_t m, std::size_t best,
                                       const FitOptions& options, int& parameters, std::string& unknown) {
  SharedShift together;
  double sum = 0;
  for (std::size_t k = 0; k < compared.count(); ++k) {
    const auto likelihood = AddLikelihood(compared, k, m, best, options, together);
    if (!likelihood) {
      unknown = " of " + compared.fitted.recordings[k].label;
      return std::nullopt;
    }
    sum += likelihood->log_likelihood + SumOfLogLevelWidths(compared.Used(k));
    parameters += likelihood->parameters - 1;
  }
  return sum - together.Loss();
}

void SetCorrelatedLikelihood(const ComparedFits& compared, std::size_t m, std::size_t best, const FitOptions& options,
                             ComparisonRow& row) {
  const bool is_one = compared.count() == 1;
  std::string unknown;
  row.log_likelihood = is_one ? OnlyLikelihood(compared, m, best, options, row.parameters)
                              : SumOfLikelihoods(compared, m, best, options, row.parameters, unknown);
  if (row.log_likelihood) return;
  row.judged = false;
  row.reason = "the likelihood of " + std::string(is_one ? "its residuals" : "the residuals" + unknown) +
               " cannot be computed with the autocorrelation of the best model's residuals";
}

/// Each recording counts with its own effective samples.
double SumOfScaledLikelihoods(const ComparedFits& compared, std::size_t m, std::size_t best) {
  double sum = 0;
  for (std::size_t k = 0; k < compared.count(); ++k) {
    const auto samples = static_cast<double>(compared.Used(k).size());
    sum += ScaledLikelihood(compared.Fit(k, m), compared.Fit(k, best), samples);
  }
  return sum;
}

void SetLikelihoods(const ComparedFits& compared, std::size_t best, const FitOptions& options, Comparison& comparison) {
  const std::vector<std::string>& models = compared.fitted.models;
  double samples = 0;
  for (std::size_t k = 0; k < compared.count(); ++k) samples += static_cast<double>(compared.Used(k).size());
  for (std::size_t m = 0; m < comparison.rows.size(); ++m) {
    ComparisonRow& row = comparison.rows[m];
    if (!row.judged || comparison.likelihood == Likelihood::kNone) continue;
    double counted = samples;
    if (comparison.likelihood == Likelihood::kIndependent) {
      row.log_likelihood = compared.whole()[m].statistics.log_likelihood;
    } else if (comparison.likelihood == Likelihood::kScaled) {
      row.log_likelihood = SumOfScaledLikelihoods(compared, m, best);
      counted = comparison.effective_samples;
    } else {
      SetCorrelatedLikelihood(compared, m, best, ForModel(options, models[m], models).options, row);
    }
    SetCriteria(counted, comparison.effective_samples, row);
  }
  SetDifferences(comparison.rows);
}

// ---- Prediction -----------------------------------------------------------------------------------------------------

/// Combines the predictions of recordings, whose residuals are divided by their units.
Prediction Pool(const std::vector<Prediction>& predictions, const FittedRecordings& fitted) {
  if (predictions.size() == 1) return predictions.front();
  Prediction pooled;
  double squares = 0, standardized = 0;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const Prediction& one = predictions[k];
    if (one.samples == 0) {  // then there is none of all
      pooled = {};
      pooled.reason = fitted.recordings[k].label + ": " + one.reason;
      return pooled;
    }
    const auto samples = static_cast<double>(one.samples);
    const double unit = UnitOf(fitted, k);
    squares += samples * one.rms * one.rms / (unit * unit);
    standardized += samples * one.standardized * one.standardized;
    pooled.samples += one.samples;
  }
  const auto samples = static_cast<double>(pooled.samples);
  pooled.rms = std::sqrt(squares / samples);
  pooled.standardized = std::sqrt(standardized / samples);
  return pooled;
}

/// Each recording is predicted from parts of itself.
void SetPredictions(const ComparedFits& compared, const FitOptions& options, Comparison& comparison) {
  const FittedRecordings& fitted = compared.fitted;
  for (std::size_t m = 0; m < fitted.models.size(); ++m) {
    if (compared.whole()[m].termination != Termination::kConverged) continue;
    const FitOptions own = ForModel(options, fitted.models[m], fitted.models).options;
    std::vector<Prediction> blocks, forward;
    for (const FittedRecording& recording : fitted.recordings) {
      blocks.push_back(CrossValidate(recording.used, recording.fits[m], own));
      forward.push_back(PredictForward(recording.used, recording.fits[m], own));
    }
    comparison.rows[m].cross_validation = Pool(blocks, fitted);
    comparison.rows[m].forward = Pool(forward, fitted);
  }
}

/// Sets the rms of residuals over their σ if units differ.
void SetUnitlessRms(const ComparedFits& compared, Comparison& comparison) {
  for (std::size_t m = 0; m < comparison.rows.size(); ++m) {
    double squares = 0, samples = 0;
    for (std::size_t k = 0; k < compared.count(); ++k) {
      const FitReport& fit = compared.Fit(k, m);
      const double own = CountedSamples(fit);
      squares += own * std::pow(fit.statistics.rms_residual / UnitOf(compared.fitted, k), 2);
      samples += own;
    }
    comparison.rows[m].rms = std::sqrt(squares / std::max(samples, 1.0));
  }
}

ComparedRuns RunsOf(const ComparedFits& compared) {
  ComparedRuns runs;
  const std::size_t models = compared.fitted.models.size();
  for (std::size_t k = 0; k < compared.count(); ++k) {
    ComparedRun run{compared.Used(k), {}};
    for (std::size_t m = 0; m < models; ++m) run.fits.push_back(&compared.Fit(k, m));
    runs.runs.push_back(std::move(run));
  }
  for (std::size_t m = 0; m < models; ++m) {
    for (const std::string& name : compared.SharedBy(m)) {
      if (std::ranges::find(runs.shared, name) == runs.shared.end()) runs.shared.push_back(name);
    }
  }
  return runs;
}

/// Says of several recordings which fits are compared.
std::string OfSeveral(const ComparedFits& compared) {
  if (compared.count() == 1) return "";
  return compared.is_separate ? ", of the fits to each recording alone, because the recordings do not agree"
                              : ", of all recordings";
}

}  // namespace

Comparison CompareModels(const FittedRecordings& fitted, const FitOptions& options, const CompareOptions& how) {
  Comparison comparison;
  const ComparedFits compared = ChooseFitsToCompare(fitted);
  for (std::size_t m = 0; m < fitted.models.size(); ++m) comparison.rows.push_back(DescribeRow(compared, m));
  if (!fitted.HaveOneUnit()) SetUnitlessRms(compared, comparison);
  const FitReport* const best = BestFit(compared.whole());
  if (best == nullptr) {
    comparison.likelihood = Likelihood::kNone;
    comparison.criterion = "none: no fit converged";
    comparison.reason = "no model converged, so none is recommended";
    return comparison;
  }
  const auto index = static_cast<std::size_t>(best - compared.whole().data());
  comparison.likelihood = StrictestLikelihood(compared, index);
  // With ln n >= 2 the penalty is never weaker than that of AIC.
  comparison.effective_samples = std::max(best->statistics.effective_samples, std::exp(2.0));
  comparison.criterion =
      DescribeLikelihood(comparison.likelihood, RepresentativeRecording(compared, index, comparison.likelihood)) +
      OfSeveral(compared);
  SetLikelihoods(compared, index, options, comparison);
  if (how.predict) SetPredictions(compared, options, comparison);
  comparison.tests = TestNested(RunsOf(compared), comparison.rows, options, comparison.likelihood);
  Recommend(compared.whole(), comparison);
  if (compared.is_separate)
    comparison.reason += "; compared are the fits to each recording alone, because the recordings do not agree";
  return comparison;
}

}  // namespace pendulum
