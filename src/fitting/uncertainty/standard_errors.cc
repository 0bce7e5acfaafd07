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
Eigen::MatrixXd PriorInformation(std::span<const PriorTerm> priors, const std::vector<int>& free) {
  const auto size = static_cast<Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (const PriorTerm& prior : priors) {
    const Index i = std::ranges::find(free, prior.parameter) - free.begin();
    if (i < size) information(i, i) += prior.weight * prior.weight;
  }
  return information;
}

/// What the samples say, one by one: derivatives of their log-likelihood.
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

/// The inverse of a symmetric matrix scaled to unit diagonal; empty when it has none.
Eigen::MatrixXd Inverse(const Eigen::MatrixXd& matrix) {
  std::vector<int> all(static_cast<std::size_t>(matrix.rows()));
  std::iota(all.begin(), all.end(), 0);
  return InvertInformation(matrix, all).matrix;
}

/// The covariance of the scores, Σ_ij ∇m_i cov(s_i, s_j) ∇m_j'. Of different samples it is that of their quantile
/// residuals over σ²: what randomizes these within a level is independent. Of one sample it is its information.
Eigen::MatrixXd MeatOf(const FitProblem& problem, const NoiseModel& noise, const SampleTerms& terms,
                       const Eigen::MatrixXd& jacobian, const Autocorrelation& correlation) {
  if (noise.IsRobust() && problem.censored > 0) {
    return CorrelatedSum(correlation, problem.data.times(), terms.score.cwiseAbs().asDiagonal() * jacobian);
  }
  if (noise.family == NoiseFamily::kEdges) {
    const Eigen::VectorXd deviation = terms.information.cwiseSqrt();  // of the scores: each edge its own
    return CorrelatedSum(correlation, problem.data.times(), deviation.asDiagonal() * jacobian);
  }
  const Eigen::MatrixXd correlated = CorrelatedSum(correlation, problem.data.times(), jacobian);
  if (noise.IsRobust()) return terms.score.squaredNorm() / static_cast<double>(jacobian.rows()) * correlated;
  const double variance = noise.sigma * noise.sigma;
  const Eigen::VectorXd lost = 1 - variance * terms.information.array();
  return (correlated - jacobian.transpose() * lost.asDiagonal() * jacobian) / variance;
}

/// Jᵀ W J. A robust family's information is that of the mean, for its meat is that of the mean square score (P. J.
/// Huber, Robust Statistics, Wiley 1981, section 7.6); readings at an end of the range say less than the mean.
Eigen::MatrixXd InformationOf(const FitProblem& problem, const NoiseModel& noise, const SampleTerms& terms,
                              const Eigen::MatrixXd& jacobian) {
  const bool by_mean = noise.IsRobust() && problem.censored == 0;
  const Eigen::VectorXd weight =
      by_mean ? Eigen::VectorXd::Constant(jacobian.rows(), terms.information.mean()) : terms.information;
  return jacobian.transpose() * weight.asDiagonal() * jacobian;
}

bool IsWhite(const FittedRun& run) { return run.correlation.kind == Autocorrelation::Kind::kWhite; }

/// Whether least squares say everything: normal noise without memory.
bool IsSimple(const FittedRun& run) { return run.solution.noise.IsPlain() && IsWhite(run); }

/// What one recording says of those F of its parameters that are free.
struct Part {
  std::vector<Index> rows;       // F: where they stand among all free ones
  Eigen::MatrixXd bread, meat;   // F x F: information, and the covariance of the scores
  Eigen::VectorXd mixed;         // F: information of a parameter and log σ
  double sigma_information = 0;  // of log σ
  bool beside_sigma = false;     // the bread is what is left of the information beside log σ
  double samples = 0;            // N
};

/// A recording's parameters that are free, and where those stand among all free ones.
std::vector<Index> FreeColumns(const FittedRun& run, const Optimum& optimum, std::vector<Index>& rows) {
  std::vector<Index> columns;
  for (std::size_t j = 0; j < run.at.size(); ++j) {
    const auto place = std::ranges::find(optimum.free, run.at[j]);
    if (place == optimum.free.end()) continue;
    rows.push_back(place - optimum.free.begin());
    columns.push_back(static_cast<Index>(j));
  }
  return columns;
}

/// The optimum was traced: unless the fit was stopped since, this can be, too. Then the part has no information.
void SetNothing(const std::vector<Index>& columns, Part& part) {
  const auto size = static_cast<Index>(columns.size());
  part.bread = part.meat = Eigen::MatrixXd::Zero(size, size);
  part.mixed = Eigen::VectorXd::Zero(size);
}

/// The sums say it all, and the cost has them ready.
void SetSimple(const FittedRun& run, const std::vector<Index>& columns, Part& part) {
  Eigen::MatrixXd sums, priors;
  if (!run.cost.Sums(run.solution.parameters, &sums)) {
    SetNothing(columns, part);
    return;
  }
  priors.setZero(sums.rows(), sums.cols());
  AddPriors(run.cost.priors(), run.solution.parameters, &priors);
  part.bread = part.meat = (sums - priors)(columns, columns);
}

/// The meat, in no direction less than the bread. A slow misfit taken for continuous noise has next to nothing at the
/// swing's frequency: by its sandwich alone readings would tell more than independent ones of the same scatter.
Eigen::MatrixXd NoLessThan(const Eigen::MatrixXd& bread, const Eigen::MatrixXd& meat) {
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
  part.samples = static_cast<double>(run.problem.data.time.size());
  const std::vector<Index> columns = FreeColumns(run, optimum, part.rows);
  if (IsSimple(run)) {
    SetSimple(run, columns, part);
    return part;
  }
  const NoiseModel& noise = run.solution.noise;
  Eigen::VectorXd readings;
  Eigen::MatrixXd all;
  if (!run.cost.Readings(run.solution.parameters, &readings, &all)) {
    SetNothing(columns, part);
    return part;
  }
  const Eigen::MatrixXd jacobian = all(Eigen::all, columns);
  const SampleTerms terms = TermsOf(run.problem, run.solution);
  part.bread = InformationOf(run.problem, noise, terms, jacobian);
  part.mixed = jacobian.transpose() * terms.mixed;
  part.sigma_information = terms.sigma_information;
  if (!IsWhite(run) || noise.IsRobust()) {
    part.meat = MeatOf(run.problem, noise, terms, jacobian, run.correlation);
    if (run.correlation.kind == Autocorrelation::Kind::kContinuous) part.meat = NoLessThan(part.bread, part.meat);
  } else {
    // σ is estimated beside the parameters.
    part.beside_sigma = !noise.IsPlain();
    if (part.beside_sigma) part.bread -= part.mixed * part.mixed.transpose() / part.sigma_information;
    part.meat = part.bread;
  }
  return part;
}

std::string MethodOf(const NoiseModel& noise, const Autocorrelation& correlation) {
  if (correlation.kind != Autocorrelation::Kind::kWhite) {
    return "sandwich: the residuals follow each other as " + correlation.Name() +
           " noise does, and its autocovariance stands between two inverses of the information";
  }
  if (noise.IsRobust()) return "sandwich of the robust score, residuals taken as independent";
  if (noise.IsPlain()) return "covariance sigma^2 (J'J)^-1, residuals taken as independent";
  return "inverse observed information of the parameters and sigma, readings taken as independent";
}

/// A parameter's own number of effective samples: memory that inflates a mean may leave a swing's phase alone.
Eigen::VectorXd StudentT95(const Eigen::MatrixXd& covariance, const Optimum& optimum, const Eigen::VectorXd& samples,
                           bool white) {
  const auto free = static_cast<double>(optimum.free.size());
  Eigen::VectorXd t95(covariance.rows());
  for (Index i = 0; i < t95.size(); ++i) {
    const double share = white ? 1.0 : std::min(optimum.inverse.matrix(i, i) / covariance(i, i), 1.0);
    const double freedom = std::isfinite(share) ? std::max(share * samples[i] - free, 1.0) : 1.0;
    t95[i] = StudentQuantile(0.975, freedom);
  }
  return t95;
}

/// σ's standard error beside parameters of inverse information C, by the blocks of the inverse of the information of
/// both.
std::optional<double> SigmaError(const FittedRun& run, const Part& part, const Eigen::MatrixXd& inverse) {
  const NoiseModel& noise = run.solution.noise;
  if (noise.IsRobust()) return RobustSigmaError(noise, run.problem.data.values(), run.solution.readings);
  const double traded = part.mixed.dot(inverse(part.rows, part.rows) * part.mixed);
  const double s = part.sigma_information;
  return noise.sigma * std::sqrt(part.beside_sigma ? 1 / s + traded / (s * s) : 1 / (s - traded));
}

NoiseErrors NoiseErrorsOf(const FittedRun& run) {
  const auto samples = static_cast<double>(run.problem.data.time.size());
  return {std::nullopt, std::max(samples / std::max(run.correlation.VarianceInflation(), 1.0), 1.0),
          MethodOf(run.solution.noise, run.correlation)};
}

/// The sandwich of all recordings' information and covariance of scores; each recording's share of the parameters is
/// what its σ and its residuals' memory are short of.
void SetCovariance(std::span<const FittedRun> runs, const std::vector<Part>& parts, const Eigen::MatrixXd& prior,
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
    const double counted = runs[k].solution.noise.IsPlain() ? (own * part.bread).trace() : 0;
    meat(part.rows, part.rows) += (part.samples - counted) / std::max(part.samples - lost, 1.0) * part.meat;
    if (!runs[k].solution.noise.IsPlain()) errors.runs[k].sigma = SigmaError(runs[k], part, inverse);
  }
  errors.covariance = inverse * meat * inverse;
}

}  // namespace

Errors ComputeErrors(std::span<const FittedRun> runs, std::span<const PriorTerm> priors, const Optimum& optimum) {
  Errors errors;
  Eigen::VectorXd samples = Eigen::VectorXd::Zero(static_cast<Index>(optimum.free.size()));  // that tell the parameter
  for (const FittedRun& run : runs) {
    std::vector<Index> rows;
    FreeColumns(run, optimum, rows);
    samples(rows).array() += static_cast<double>(run.problem.data.time.size());
    errors.runs.push_back(NoiseErrorsOf(run));
  }
  errors.covariance = optimum.inverse.matrix;
  const bool simple = std::ranges::all_of(runs, IsSimple) || optimum.free.empty();
  if (!simple) {
    std::vector<Part> parts;
    parts.reserve(runs.size());
    for (const FittedRun& run : runs) parts.push_back(PartOf(run, optimum));
    SetCovariance(runs, parts, PriorInformation(priors, optimum.free), errors);
  }
  const bool sound =
      errors.covariance.allFinite() && (errors.covariance.size() == 0 || errors.covariance.diagonal().minCoeff() > 0);
  if (!sound) errors.covariance = optimum.inverse.matrix;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    NoiseErrors& own = errors.runs[k];
    const auto count = static_cast<double>(runs[k].problem.data.time.size());
    const double free = static_cast<double>(optimum.free.size()) / static_cast<double>(runs.size());
    const NoiseModel& noise = runs[k].solution.noise;
    if (noise.IsPlain()) own.sigma = noise.sigma / std::sqrt(2 * std::max(count - free, 1.0));
    if (own.sigma) *own.sigma *= std::sqrt(runs[k].correlation.SquaredInflation());
    // A memory that alternates may leave less than nothing of a direction.
    if (!sound) own.method = "inverse information, residuals taken as independent: with their memory it has no inverse";
  }
  errors.t95 = StudentT95(errors.covariance, optimum, samples, std::ranges::all_of(runs, IsWhite));
  return errors;
}

Errors ComputeErrors(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                     const Optimum& optimum, const Autocorrelation& correlation) {
  FittedRun run{problem, cost, solution, correlation, {}};
  run.at.resize(problem.infos.size());
  std::iota(run.at.begin(), run.at.end(), 0);
  return ComputeErrors({&run, 1}, cost.priors(), optimum);
}

}  // namespace pendulum
