// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/optimum.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace pendulum {
namespace {

using Eigen::Index;

/// Information of the priors over the free parameters.
Eigen::MatrixXd PriorInformation(const TrajectoryCost& cost, const std::vector<int>& free) {
  const auto size = static_cast<Index>(free.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (const PriorTerm& prior : cost.priors()) {
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
  for (Eigen::VectorXd* column : {&terms.score, &terms.information, &terms.mixed}) column->resize(values.size());
  for (Index i = 0; i < values.size(); ++i) {
    const NoiseLikelihood l = solution.noise.LikelihoodAt(values[i], solution.readings[i]);
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
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return InvertInformation(matrix, all).matrix;
}

/// The likelihood's own covariance, σ estimated beside the parameters.
void SetLikelihoodErrors(const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum,
                         const SampleTerms& terms, const Eigen::MatrixXd& jacobian, Errors& errors) {
  const Index size = jacobian.cols();
  Eigen::MatrixXd joint(size + 1, size + 1);
  joint.topLeftCorner(size, size) =
      jacobian.transpose() * terms.information.asDiagonal() * jacobian + PriorInformation(cost, optimum.free);
  joint.col(size).head(size) = jacobian.transpose() * terms.mixed;
  joint.row(size).head(size) = joint.col(size).head(size).transpose();
  joint(size, size) = terms.sigma_information;
  const Eigen::MatrixXd inverse = Inverse(joint);
  if (inverse.size() == 0) return;
  errors.covariance = inverse.topLeftCorner(size, size);
  errors.sigma = solution.noise.sigma * std::sqrt(inverse(size, size));
}

/// The covariance of the scores, Σ_ij ∇m_i cov(s_i, s_j) ∇m_j'. Of different samples it is that of their quantile
/// residuals over σ²: what randomizes these within a level is independent. Of one sample it is its information.
Eigen::MatrixXd MeatOf(const FitProblem& problem, const NoiseModel& noise, const SampleTerms& terms,
                       const Eigen::MatrixXd& jacobian, const Autocorrelation& correlation) {
  if (noise.IsRobust() && problem.censored > 0) {
    return CorrelatedSum(correlation, problem.data.times(), terms.score.cwiseAbs().asDiagonal() * jacobian);
  }
  const Eigen::MatrixXd correlated = CorrelatedSum(correlation, problem.data.times(), jacobian);
  if (noise.IsRobust()) return terms.score.squaredNorm() / static_cast<double>(jacobian.rows()) * correlated;
  const double variance = noise.sigma * noise.sigma;
  const Eigen::VectorXd lost = 1 - variance * terms.information.array();
  return (correlated - jacobian.transpose() * lost.asDiagonal() * jacobian) / variance;
}

/// A^-1 B A^-1, and what it says of the residuals.
struct Sandwich {
  Eigen::MatrixXd covariance;
  double lost = 0;  // tr(A^-1 B): how much of N variances the parameters took from the residuals
};

/// A robust family's A is that of the mean information, for its B is that of the mean square score (P. J. Huber, Robust
/// Statistics, Wiley 1981, section 7.6).
Sandwich MakeSandwich(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution,
                      const Optimum& optimum, const SampleTerms& terms, const Eigen::MatrixXd& jacobian,
                      const Autocorrelation& correlation) {
  const Eigen::MatrixXd prior = PriorInformation(cost, optimum.free);
  Eigen::MatrixXd bread = optimum.inverse.matrix;
  if (solution.noise.IsRobust()) {
    // Readings at an end of the range say less than the mean.
    const bool alike = problem.censored == 0;
    const Eigen::VectorXd weight =
        alike ? Eigen::VectorXd::Constant(jacobian.rows(), terms.information.mean()) : terms.information;
    const Eigen::MatrixXd mean = Inverse(jacobian.transpose() * weight.asDiagonal() * jacobian + prior);
    if (mean.size() > 0) bread = mean;
  }
  const Eigen::MatrixXd meat = MeatOf(problem, solution.noise, terms, jacobian, correlation);
  return {bread * (meat + prior) * bread, (bread * meat).trace()};
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

}  // namespace

std::optional<Optimum> Linearize(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution) {
  Optimum optimum;
  Eigen::MatrixXd sums;
  if (!solution.usable || !cost.Sums(solution.parameters, &sums)) return std::nullopt;
  const Index size = sums.rows() - 1;
  optimum.information = sums.topLeftCorner(size, size);
  optimum.gradient = sums.col(size).head(size);
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (problem.solve.fixed[i]) continue;
    const int side = BoundSide(problem.solve, static_cast<std::size_t>(i), solution.parameters[i]);
    const bool pushes_out = side != 0 && side * optimum.gradient[i] <= 0;
    (pushes_out ? optimum.at_bound : optimum.free).push_back(i);
  }
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  return optimum;
}

Eigen::MatrixXd FreeJacobian(const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  if (!cost.Readings(solution.parameters, &readings, &jacobian)) return {};
  return jacobian(Eigen::all, optimum.free);
}

double RemainingShift(const Optimum& optimum) {
  const Eigen::VectorXd gradient = optimum.gradient(optimum.free);
  return std::sqrt(gradient.dot(optimum.inverse.matrix * gradient));
}

namespace {

/// A parameter's own number of effective samples: memory that inflates a mean may leave a swing's phase alone.
Eigen::VectorXd StudentT95(const Eigen::MatrixXd& covariance, const Optimum& optimum, double samples, bool white) {
  const auto free = static_cast<double>(optimum.free.size());
  Eigen::VectorXd t95(covariance.rows());
  for (Index i = 0; i < t95.size(); ++i) {
    const double share = white ? 1.0 : std::min(optimum.inverse.matrix(i, i) / covariance(i, i), 1.0);
    const double freedom = std::isfinite(share) ? std::max(share * samples - free, 1.0) : 1.0;
    t95[i] = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  }
  return t95;
}

/// The inverse information, or a sandwich where the family is robust or the residuals remember.
Errors CovarianceErrors(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                        const Optimum& optimum, const Autocorrelation& correlation) {
  const auto samples = static_cast<double>(problem.data.time.size());
  const auto free = static_cast<double>(optimum.free.size());
  const bool white = correlation.kind == Autocorrelation::Kind::kWhite;
  Errors errors;
  errors.effective_samples = std::max(samples / std::max(correlation.VarianceInflation(), 1.0), 1.0);
  errors.method = MethodOf(solution.noise, correlation);
  errors.covariance = optimum.inverse.matrix;
  if (solution.noise.IsPlain()) errors.sigma = solution.noise.sigma / std::sqrt(2 * std::max(samples - free, 1.0));
  if ((solution.noise.IsPlain() && white) || optimum.free.empty()) return errors;
  const SampleTerms terms = TermsOf(problem, solution);
  const Eigen::MatrixXd jacobian = FreeJacobian(cost, solution, optimum);
  if (!solution.noise.IsPlain()) SetLikelihoodErrors(cost, solution, optimum, terms, jacobian, errors);
  if (solution.noise.IsRobust()) {
    errors.sigma = RobustSigmaError(solution.noise, problem.data.values(), solution.readings);
  }
  if (errors.sigma) *errors.sigma *= std::sqrt(correlation.SquaredInflation());
  const double counted = solution.noise.IsPlain() ? free : 0;  // of the parameters, in σ
  if (!white || solution.noise.IsRobust()) {
    const Sandwich sandwich = MakeSandwich(cost, problem, solution, optimum, terms, jacobian, correlation);
    errors.covariance = sandwich.covariance * (samples - counted) / std::max(samples - sandwich.lost, 1.0);
  } else {
    errors.covariance *= samples / std::max(samples - free, 1.0);
  }
  return errors;
}

}  // namespace

Errors ComputeErrors(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                     const Optimum& optimum, const Autocorrelation& correlation) {
  Errors errors = CovarianceErrors(problem, cost, solution, optimum, correlation);
  const bool sound =
      errors.covariance.allFinite() && (errors.covariance.size() == 0 || errors.covariance.diagonal().minCoeff() > 0);
  if (!sound) {  // a memory that alternates may leave less than nothing of a direction
    errors.covariance = optimum.inverse.matrix;
    errors.method = "inverse information, residuals taken as independent: with their memory it has no inverse";
  }
  const bool white = correlation.kind == Autocorrelation::Kind::kWhite;
  errors.t95 = StudentT95(errors.covariance, optimum, static_cast<double>(problem.data.time.size()), white);
  return errors;
}

}  // namespace pendulum
