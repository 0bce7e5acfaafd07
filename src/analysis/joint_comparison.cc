// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/joint_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "pendulum/analysis/comparison_parts.h"
#include "pendulum/analysis/nested_tests.h"
#include "pendulum/analysis/recommendation.h"
#include "pendulum/fitting/joint/fit_jointly.h"
#include "pendulum/fitting/residuals/bounded_least_squares.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The compared fits: joint fits, or separate fits if the recordings do not share their parameters.
struct ComparedFits {
  const JointModels& joint;
  bool is_separate = false;
  std::vector<FitReport> combined = {};  // M, without samples
  std::vector<int> parameters = {};      // M

  const FitReport& Fit(std::size_t k, std::size_t m) const {
    return is_separate ? joint.runs[k].alone.fits[m] : joint.FitOf(k, m);
  }
  std::vector<std::string> SharedBy(std::size_t m) const {
    return is_separate ? std::vector<std::string>{} : joint.joint[m].shared;
  }
};

/// Combines the separate fits to all recordings into one report.
FitReport CombineSeparateFits(const JointModels& joint, std::size_t m, int& parameters) {
  FitReport whole;
  whole.model = joint.joint[m].whole.model;
  whole.termination = Termination::kConverged;
  std::vector<const FitReport*> fits;
  for (const RunModels& run : joint.runs) {
    const FitReport& fit = run.alone.fits[m];
    if (fit.termination != Termination::kConverged && whole.termination == Termination::kConverged) {
      whole.termination = fit.termination;
      whole.reason = run.label + ": " + fit.reason;
    }
    fits.push_back(&fit);
    parameters += DescribeFit(fit).parameters;
    if (whole.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite)
      whole.noise.autocorrelation = fit.noise.autocorrelation;
  }
  whole.statistics = SumStatistics(fits, parameters);
  return whole;
}

ComparedFits SeparateFits(const JointModels& joint) {
  ComparedFits compared{joint, true};
  for (std::size_t m = 0; m < joint.models.size(); ++m) {
    compared.parameters.push_back(0);
    compared.combined.push_back(CombineSeparateFits(joint, m, compared.parameters.back()));
  }
  return compared;
}

ComparedFits JointFits(const JointModels& joint) {
  ComparedFits compared{joint, false};
  for (const JointFit& fit : joint.joint) {
    compared.combined.push_back(fit.whole);
    compared.parameters.push_back(fit.parameters);
  }
  return compared;
}

/// Chooses separate fits if the recordings disagree under the law that describes each of them best. Then no law makes
/// the joint fit right.
ComparedFits ChooseFitsToCompare(const JointModels& joint) {
  ComparedFits alone = SeparateFits(joint);
  const FitReport* const best = BestFit(alone.combined);
  const bool disagree =
      best != nullptr && !joint.homogeneity[static_cast<std::size_t>(best - alone.combined.data())].agrees();
  return disagree ? alone : JointFits(joint);
}

/// Divisor of recording k's residuals that gives all recordings the same unit. It is 1 if they have one unit; otherwise
/// the least σ of any model, the same for all models.
double UnitOf(const JointModels& joint, std::size_t k) {
  if (joint.HaveOneUnit()) return 1;
  double least = kUnbounded;
  for (const FitReport& fit : joint.runs[k].alone.fits) {
    if (fit.noise.sigma > 0) least = std::min(least, fit.noise.sigma);
  }
  return least;
}

ComparisonRow DescribeRow(const ComparedFits& compared, std::size_t m) {
  const FitReport& whole = compared.combined[m];
  ComparisonRow row = DescribeFit(whole);
  row.parameters = compared.parameters[m];
  row.is_rounding = true;
  for (std::size_t k = 0; k < compared.joint.runs.size() && whole.termination != Termination::kFailed; ++k) {
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
Likelihood ChooseJointLikelihood(const ComparedFits& compared, std::size_t best) {
  Likelihood chosen = Likelihood::kIndependent;
  for (std::size_t k = 0; k < compared.joint.runs.size(); ++k) {
    chosen = std::max(chosen, ChooseLikelihood(compared.Fit(k, best), compared.joint.runs[k].alone.used.resolution));
  }
  return chosen;
}

/// The fit to a recording whose residuals require `likelihood`; DescribeLikelihood describes it.
const FitReport& RepresentativeRecording(const ComparedFits& compared, std::size_t best, Likelihood likelihood) {
  for (std::size_t k = 0; k < compared.joint.runs.size(); ++k) {
    const FitReport& fit = compared.Fit(k, best);
    if (ChooseLikelihood(fit, compared.joint.runs[k].alone.used.resolution) == likelihood) return fit;
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
  std::optional<CorrelatedResiduals> data = ResidualsOf(compared.joint.runs[k].alone.used, fit, options, false);
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

void SetCorrelatedLikelihood(const ComparedFits& compared, std::size_t m, std::size_t best, const FitOptions& options,
                             ComparisonRow& row) {
  SharedShift together;
  double sum = 0;
  for (std::size_t k = 0; k < compared.joint.runs.size(); ++k) {
    const RunModels& run = compared.joint.runs[k];
    const auto likelihood = AddLikelihood(compared, k, m, best, options, together);
    if (!likelihood) {
      row.judged = false;
      row.reason = "the likelihood of the residuals of " + run.label +
                   " cannot be computed with the autocorrelation of the best model's residuals";
      return;
    }
    sum += likelihood->log_likelihood + SumOfLogLevelWidths(run.alone.used);
    row.parameters += likelihood->parameters - 1;
  }
  row.log_likelihood = sum - together.Loss();
}

/// Each recording counts with its own effective samples.
double SumOfScaledLikelihoods(const ComparedFits& compared, std::size_t m, std::size_t best) {
  double sum = 0;
  for (std::size_t k = 0; k < compared.joint.runs.size(); ++k) {
    const auto samples = static_cast<double>(compared.joint.runs[k].alone.used.size());
    sum += ScaledLikelihood(compared.Fit(k, m), compared.Fit(k, best), samples);
  }
  return sum;
}

void SetLikelihoods(const ComparedFits& compared, std::size_t best, const FitOptions& options, Comparison& comparison) {
  const JointModels& joint = compared.joint;
  double samples = 0;
  for (const RunModels& run : joint.runs) samples += static_cast<double>(run.alone.used.size());
  for (std::size_t m = 0; m < comparison.rows.size(); ++m) {
    ComparisonRow& row = comparison.rows[m];
    if (!row.judged || comparison.likelihood == Likelihood::kNone) continue;
    double counted = samples;
    if (comparison.likelihood == Likelihood::kIndependent) {
      row.log_likelihood = compared.combined[m].statistics.log_likelihood;
    } else if (comparison.likelihood == Likelihood::kScaled) {
      row.log_likelihood = SumOfScaledLikelihoods(compared, m, best);
      counted = comparison.effective_samples;
    } else {
      SetCorrelatedLikelihood(compared, m, best, ForModel(options, joint.models[m], joint.models).options, row);
    }
    SetCriteria(counted, comparison.effective_samples, row);
  }
  SetDifferences(comparison.rows);
}

// ---- Prediction -----------------------------------------------------------------------------------------------------

/// Combines predictions of several recordings.
class PooledPrediction {
 public:
  void Add(const Prediction& one, double unit, const std::string& label) {
    if (one.samples == 0) {
      if (pooled_.reason.empty()) pooled_.reason = label + ": " + one.reason;
      return;
    }
    const auto samples = static_cast<double>(one.samples);
    squares_ += samples * one.rms * one.rms / (unit * unit);
    standardized_ += samples * one.standardized * one.standardized;
    pooled_.samples += one.samples;
  }

  Prediction Take() {
    if (!pooled_.reason.empty()) pooled_.samples = 0;  // a recording has no prediction
    if (pooled_.samples == 0) return pooled_;
    const auto samples = static_cast<double>(pooled_.samples);
    pooled_.rms = std::sqrt(squares_ / samples);
    pooled_.standardized = std::sqrt(standardized_ / samples);
    return pooled_;
  }

 private:
  Prediction pooled_;
  double squares_ = 0, standardized_ = 0;
};

void SetPredictions(const ComparedFits& compared, const FitOptions& options, Comparison& comparison) {
  const JointModels& joint = compared.joint;
  for (std::size_t m = 0; m < joint.models.size(); ++m) {
    if (compared.combined[m].termination != Termination::kConverged) continue;
    const FitOptions own = ForModel(options, joint.models[m], joint.models).options;
    PooledPrediction blocks, forward;
    for (std::size_t k = 0; k < joint.runs.size(); ++k) {
      const RunModels& run = joint.runs[k];
      const FitReport& alone = run.alone.fits[m];
      const double unit = UnitOf(joint, k);
      blocks.Add(CrossValidate(run.alone.used, alone, own), unit, run.label);
      forward.Add(PredictForward(run.alone.used, alone, own), unit, run.label);
    }
    comparison.rows[m].cross_validation = blocks.Take();
    comparison.rows[m].forward = forward.Take();
  }
}

/// Sets the rms of residuals over their σ if units differ.
void SetUnitlessRms(const ComparedFits& compared, Comparison& comparison) {
  const JointModels& joint = compared.joint;
  for (std::size_t m = 0; m < joint.models.size(); ++m) {
    double squares = 0, samples = 0;
    for (std::size_t k = 0; k < joint.runs.size(); ++k) {
      const FitReport& fit = compared.Fit(k, m);
      const double own = CountedSamples(fit);
      squares += own * std::pow(fit.statistics.rms_residual / UnitOf(joint, k), 2);
      samples += own;
    }
    comparison.rows[m].rms = std::sqrt(squares / std::max(samples, 1.0));
  }
}

ComparedRuns RunsOf(const ComparedFits& compared) {
  ComparedRuns runs;
  for (std::size_t k = 0; k < compared.joint.runs.size(); ++k) {
    ComparedRun run{compared.joint.runs[k].alone.used, {}};
    for (std::size_t m = 0; m < compared.combined.size(); ++m) run.fits.push_back(&compared.Fit(k, m));
    runs.runs.push_back(std::move(run));
  }
  for (std::size_t m = 0; m < compared.combined.size(); ++m) {
    for (const std::string& name : compared.SharedBy(m)) {
      if (std::ranges::find(runs.shared, name) == runs.shared.end()) runs.shared.push_back(name);
    }
  }
  return runs;
}

}  // namespace

Comparison CompareJointModels(const JointModels& joint, const FitOptions& options, const CompareOptions& how) {
  Comparison comparison;
  const ComparedFits compared = ChooseFitsToCompare(joint);
  for (std::size_t m = 0; m < joint.models.size(); ++m) comparison.rows.push_back(DescribeRow(compared, m));
  if (!joint.HaveOneUnit()) SetUnitlessRms(compared, comparison);
  const FitReport* const best = BestFit(compared.combined);
  if (best == nullptr) {
    comparison.likelihood = Likelihood::kNone;
    comparison.criterion = "none: no fit converged";
    comparison.reason = "no model converged, so none is recommended";
    return comparison;
  }
  const auto index = static_cast<std::size_t>(best - compared.combined.data());
  comparison.likelihood = ChooseJointLikelihood(compared, index);
  comparison.effective_samples = std::max(best->statistics.effective_samples, std::exp(2.0));
  comparison.criterion =
      DescribeLikelihood(comparison.likelihood, RepresentativeRecording(compared, index, comparison.likelihood)) +
      (compared.is_separate ? ", each recording with its own parameters, because they are not shared"
                            : ", of all recordings");
  SetLikelihoods(compared, index, options, comparison);
  if (how.predict) SetPredictions(compared, options, comparison);
  comparison.tests = TestNested(RunsOf(compared), comparison.rows, options, comparison.likelihood);
  Recommend(compared.combined, comparison);
  return comparison;
}

}  // namespace pendulum
