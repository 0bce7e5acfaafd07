// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/standard_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "fitting/likelihood/level_likelihoods.h"
#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Information of the priors over the free parameters.
Eigen::MatrixXd PriorInformation(const std::vector<PriorTerm>& priors, const std::vector<int>& free) {
  const auto size = static_cast<Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (const PriorTerm& prior : priors) {
    const Index i = std::ranges::find(free, prior.parameter) - free.begin();
    if (i < size) information(i, i) += prior.weight * prior.weight;
  }
  return information;
}

/// Derivatives of the log-likelihood of each sample.
struct SampleTerms {
  Eigen::VectorXd score;        // N
  Eigen::VectorXd information;  // N
  Eigen::VectorXd mixed;        // N, with λ = log σ
  double sigma_information = 0;
};

SampleTerms TermsOf(const FitProblem& problem, const Solution& solution) {
  const auto values = problem.data.values();
  SampleTerms terms;
  const LevelLikelihoods likelihoods(solution.noise, values.size());
  for (Eigen::VectorXd* column : {&terms.score, &terms.information, &terms.mixed}) column->resize(values.size());
  for (Index i = 0; i < values.size(); ++i) {
    const NoiseLikelihood l = likelihoods.At(values[i], solution.readings[i], i);
    terms.score[i] = l.score;
    terms.information[i] = l.information;
    terms.mixed[i] = l.mixed;
    terms.sigma_information += l.sigma_information;
  }
  return terms;
}

/// The inverse of a symmetric matrix, computed after scaling to unit diagonal; empty if it is singular.
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& matrix) {
  std::vector<int> all(static_cast<std::size_t>(matrix.rows()));
  std::iota(all.begin(), all.end(), 0);
  return InvertInformation(matrix, all).matrix;
}

/// The covariance of the scores, Σ_ij ∇m_i cov(s_i, s_j) ∇m_j'. For two different samples, cov is the covariance of
/// their quantile residuals divided by σ², because the randomization within a level is independent. For one sample it
/// is the information.
Eigen::MatrixXd MeatOf(const FitProblem& problem, const NoiseModel& noise, const SampleTerms& terms,
                       const Eigen::MatrixXd& jacobian, const Autocorrelation& correlation) {
  if (noise.IsRobust() && problem.censored > 0) {
    return CorrelatedSum(correlation, problem.data.times(), terms.score.cwiseAbs().asDiagonal() * jacobian);
  }
  if (noise.family == NoiseFamily::kEdges || noise.family == NoiseFamily::kAveraged) {
    const Eigen::VectorXd deviation =
        terms.information.cwiseMax(0).cwiseSqrt();  // of the scores: it differs between samples
    return CorrelatedSum(correlation, problem.data.times(), deviation.asDiagonal() * jacobian);
  }
  const Eigen::MatrixXd correlated = CorrelatedSum(correlation, problem.data.times(), jacobian);
  if (noise.IsRobust()) return terms.score.squaredNorm() / static_cast<double>(jacobian.rows()) * correlated;
  const double variance = noise.sigma * noise.sigma;
  const Eigen::VectorXd lost = 1 - variance * terms.information.array();
  return (correlated - jacobian.transpose() * lost.asDiagonal() * jacobian) / variance;
}

/// Jᵀ W J. For a robust family W is the mean information, because its meat uses the mean square score (P. J. Huber,
/// Robust Statistics, Wiley 1981, section 7.6). With censored readings W is per sample, because censored readings carry
/// less information.
Eigen::MatrixXd InformationOf(const FitProblem& problem, const NoiseModel& noise, const SampleTerms& terms,
                              const Eigen::MatrixXd& jacobian) {
  const bool by_mean = noise.IsRobust() && problem.censored == 0;
  const Eigen::VectorXd weight =
      by_mean ? Eigen::VectorXd::Constant(jacobian.rows(), terms.information.mean()) : terms.information;
  return jacobian.transpose() * weight.asDiagonal() * jacobian;
}

bool IsWhite(const FittedRun& run) { return run.correlation.kind == Autocorrelation::Kind::kWhite; }

/// Whether least squares is the exact likelihood: normal noise without autocorrelation.
bool IsWhiteGaussian(const FittedRun& run) { return run.solution.noise.IsUncensoredGaussian() && IsWhite(run); }

/// The contribution of one recording to the information about its F free parameters.
struct Part {
  std::vector<Index> rows;           // F: indices among all free parameters
  Eigen::MatrixXd bread, meat;       // F x F, of the sandwich: information, and covariance of the scores
  Eigen::VectorXd mixed;             // F: information of a parameter and log σ
  double sigma_information = 0;      // of log σ
  bool is_sigma_eliminated = false;  // whether the bread is the information after log σ is eliminated
  double samples = 0;                // N
};

/// Sets a part without information. The trajectory at the optimum was computed before, so this happens only after a
/// stop.
void SetNoInformation(const std::vector<int>& columns, Part& part) {
  const auto size = static_cast<Index>(columns.size());
  part.bread = part.meat = Eigen::MatrixXd::Zero(size, size);
  part.mixed = Eigen::VectorXd::Zero(size);
}

/// Takes the information from the sums, which the cost has cached.
void SetFromSums(const FittedRun& run, const std::vector<int>& columns, Part& part) {
  Eigen::MatrixXd sums, priors;
  if (!run.cost.Sums(run.solution.parameters, &sums)) {
    SetNoInformation(columns, part);
    return;
  }
  priors.setZero(sums.rows(), sums.cols());
  AddPriors(run.cost.priors(), run.solution.parameters, &priors);
  part.bread = part.meat = (sums - priors)(columns, columns);
}

/// The meat, enlarged so that it is not below the bread in any direction. A slow misfit that is taken for continuous
/// noise has almost no power at the swing's frequency. Without the limit, such readings would carry more information
/// than independent readings with the same scatter.
Eigen::MatrixXd AtLeast(const Eigen::MatrixXd& bread, const Eigen::MatrixXd& meat) {
  const Eigen::VectorXd scale = bread.diagonal().cwiseSqrt();
  if (!(scale.array() > 0).all()) return meat;
  const Eigen::VectorXd unit = scale.cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(unit.asDiagonal() * bread * unit.asDiagonal());
  if (factor.info() != Eigen::Success) return meat;
  const auto lower = factor.matrixL();
  const Eigen::MatrixXd half = lower.solve(unit.asDiagonal() * meat * unit.asDiagonal());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> over(lower.solve(half.transpose()));
  const Eigen::MatrixXd root = scale.asDiagonal() * Eigen::MatrixXd(lower) * over.eigenvectors();
  return root * over.eigenvalues().cwiseMax(1).asDiagonal() * root.transpose();
}

Part PartOf(const FittedRun& run, const Optimum& optimum) {
  Part part;
  part.samples = run.samples();
  const std::vector<int> columns = OwnIndices(run.at, optimum.free);
  part.rows = RowsAmong(run.at, optimum.free, columns);
  if (IsWhiteGaussian(run)) {
    SetFromSums(run, columns, part);
    return part;
  }
  const NoiseModel& noise = run.solution.noise;
  Eigen::VectorXd readings;
  Eigen::MatrixXd all;
  if (!run.cost.Readings(run.solution.parameters, &readings, &all)) {
    SetNoInformation(columns, part);
    return part;
  }
  const Eigen::MatrixXd jacobian = all(Eigen::all, columns);
  const SampleTerms terms = TermsOf(run.problem, run.solution);
  part.bread = InformationOf(run.problem, noise, terms, jacobian);
  part.mixed = jacobian.transpose() * terms.mixed;
  part.sigma_information = terms.sigma_information;
  if (!IsWhite(run) || noise.IsRobust()) {
    part.meat = MeatOf(run.problem, noise, terms, jacobian, run.correlation);
    if (run.correlation.kind == Autocorrelation::Kind::kContinuous) part.meat = AtLeast(part.bread, part.meat);
  } else {
    // σ is estimated together with the parameters.
    part.is_sigma_eliminated = !noise.IsUncensoredGaussian();
    if (part.is_sigma_eliminated) part.bread -= part.mixed * part.mixed.transpose() / part.sigma_information;
    part.meat = part.bread;
  }
  return part;
}

std::string MethodOf(const NoiseModel& noise, const Autocorrelation& correlation) {
  if (correlation.kind != Autocorrelation::Kind::kWhite) {
    return "sandwich: the autocovariance of the residuals (" + correlation.Name() +
           ") between two inverses of the information";
  }
  if (noise.IsRobust()) return "sandwich of the robust score, residuals assumed independent";
  if (noise.IsUncensoredGaussian()) return "covariance sigma^2 (J'J)^-1, residuals assumed independent";
  return "inverse observed information of the parameters and sigma, readings assumed independent";
}

/// samples: F, the effective samples of the recordings on which each parameter depends; all: those of all recordings.
/// Each recording loses its share of the F degrees of freedom.
Eigen::VectorXd StudentT95(const Eigen::VectorXd& samples, double all) {
  const double kept = 1 - static_cast<double>(samples.size()) / all;
  return samples.unaryExpr([&](double count) { return StudentQuantile(0.975, std::max(kept * count, 1.0)); });
}

/// Standard error of σ, which is estimated together with the parameters, from the blocks of the inverse of the joint
/// information. inverse: of the information of all free parameters.
std::optional<double> SigmaError(const FittedRun& run, const Part& part, const Eigen::MatrixXd& inverse) {
  const NoiseModel& noise = run.solution.noise;
  if (noise.IsRobust()) return RobustSigmaError(noise, run.problem.data.values(), run.solution.readings);
  const double traded = part.mixed.dot(inverse(part.rows, part.rows) * part.mixed);
  const double s = part.sigma_information;
  return noise.sigma * std::sqrt(part.is_sigma_eliminated ? 1 / s + traded / (s * s) : 1 / (s - traded));
}

NoiseErrors NoiseErrorsOf(const FittedRun& run) {
  return {std::nullopt, std::max(run.samples() / std::max(run.correlation.VarianceInflation(), 1.0), 1.0),
          MethodOf(run.solution.noise, run.correlation)};
}

/// The sandwich of the information and the scores' covariance of all recordings. Each recording's scores are scaled up
/// for the degrees of freedom that its share of the parameters takes from σ and from the autocorrelation.
void SetCovariance(const std::vector<FittedRun>& runs, const std::vector<Part>& parts, const Eigen::MatrixXd& prior,
                   Errors& errors) {
  Eigen::MatrixXd information = prior;
  for (const Part& part : parts) information(part.rows, part.rows) += part.bread;
  Eigen::MatrixXd inverse = Inverse(information);
  if (inverse.size() == 0) inverse = errors.covariance;
  Eigen::MatrixXd meat = prior;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Part& part = parts[k];
    const Eigen::MatrixXd own = inverse(part.rows, part.rows);
    const double lost = (own * part.meat).trace();
    const double counted = runs[k].solution.noise.IsUncensoredGaussian() ? (own * part.bread).trace() : 0;
    meat(part.rows, part.rows) += (part.samples - counted) / std::max(part.samples - lost, 1.0) * part.meat;
    if (!runs[k].solution.noise.IsUncensoredGaussian()) errors.runs[k].sigma = SigmaError(runs[k], part, inverse);
  }
  errors.covariance = inverse * meat * inverse;
}

}  // namespace

Errors ComputeErrors(const SolvedFit& fit, const Optimum& optimum) {
  const std::vector<FittedRun>& runs = fit.runs;
  Errors errors;
  Eigen::VectorXd samples = Eigen::VectorXd::Zero(static_cast<Index>(optimum.free.size()));  // per parameter
  for (const FittedRun& run : runs) {
    const std::vector<Index> rows = RowsAmong(run.at, optimum.free, OwnIndices(run.at, optimum.free));
    errors.runs.push_back(NoiseErrorsOf(run));
    samples(rows).array() += errors.runs.back().effective_samples;
  }
  errors.covariance = optimum.inverse.matrix;
  const bool simple = std::ranges::all_of(runs, IsWhiteGaussian) || optimum.free.empty();
  if (!simple) {
    std::vector<Part> parts;
    parts.reserve(runs.size());
    for (const FittedRun& run : runs) parts.push_back(PartOf(run, optimum));
    SetCovariance(runs, parts, PriorInformation(fit.priors, optimum.free), errors);
  }
  const bool sound =
      errors.covariance.allFinite() && (errors.covariance.size() == 0 || errors.covariance.diagonal().minCoeff() > 0);
  if (!sound) errors.covariance = optimum.inverse.matrix;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    NoiseErrors& own = errors.runs[k];
    const double free = static_cast<double>(optimum.free.size()) / static_cast<double>(runs.size());
    const NoiseModel& noise = runs[k].solution.noise;
    if (noise.IsUncensoredGaussian()) own.sigma = noise.sigma / std::sqrt(2 * std::max(runs[k].samples() - free, 1.0));
    if (own.sigma) *own.sigma *= std::sqrt(runs[k].correlation.SquaredInflation());
    // Alternating autocorrelation can make the variance in a direction negative.
    if (!sound)
      own.method =
          "inverse information, residuals assumed independent, because their autocorrelation gives no valid covariance";
  }
  double all = 0;
  for (const NoiseErrors& run : errors.runs) all += run.effective_samples;
  errors.t95 = StudentT95(samples, all);
  return errors;
}

Errors OwnErrors(const SolvedFit& fit, std::size_t k, const Optimum& own, const Optimum& optimum,
                 const Errors& errors) {
  const std::vector<Index> rows = RowsAmong(fit.runs[k].at, optimum.free, own.free);
  return {errors.covariance(rows, rows), errors.t95(rows), {errors.runs[k]}};
}

}  // namespace pendulum
