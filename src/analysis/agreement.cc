// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>

#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double Tail(double statistic, double dof) {
  if (!(dof > 0)) return 1;
  return ChiSquareTail(std::max(statistic, 0.0), dof);
}

/// Estimates of one recording, scaled by typical errors.
struct Scaled {
  VectorXd value;      // S
  MatrixXd precision;  // S x S
};

/// Divides each parameter by its mean standard error.
std::vector<Scaled> Scale(const std::vector<SeparateEstimates>& estimates) {
  const Index size = estimates.front().value.size();
  VectorXd scale = VectorXd::Zero(size);
  for (const SeparateEstimates& one : estimates)
    scale += one.covariance.diagonal().cwiseSqrt() / static_cast<double>(estimates.size());
  const VectorXd inverse = scale.cwiseInverse();
  std::vector<Scaled> scaled;
  for (const SeparateEstimates& one : estimates) {
    const MatrixXd covariance = inverse.asDiagonal() * one.covariance * inverse.asDiagonal();
    scaled.push_back(
        {one.value.cwiseProduct(inverse), MatrixXd(covariance.ldlt().solve(MatrixXd::Identity(size, size)))});
  }
  return scaled;
}

/// Weighted mean of several recordings.
struct Pool {
  MatrixXd precision;  // S x S
  VectorXd mean;       // S
  double statistic = 0;
};

Pool PoolOf(const std::vector<Scaled>& estimates, const std::vector<std::size_t>& members) {
  const Index size = estimates.front().value.size();
  Pool pool{MatrixXd::Zero(size, size), VectorXd::Zero(size), 0};
  VectorXd sum = VectorXd::Zero(size);
  for (const std::size_t k : members) {
    pool.precision += estimates[k].precision;
    sum += estimates[k].precision * estimates[k].value;
  }
  pool.mean = pool.precision.ldlt().solve(sum);
  for (const std::size_t k : members) {
    const VectorXd distance = estimates[k].value - pool.mean;
    pool.statistic += distance.dot(estimates[k].precision * distance);
  }
  return pool;
}

/// The statistic of a pool without one of its members.
double StatisticWithout(const Scaled& member, const Pool& pool) {
  const VectorXd distance = member.value - pool.mean;
  const VectorXd pull = member.precision * distance;
  return pool.statistic - distance.dot(pull) - pull.dot((pool.precision - member.precision).ldlt().solve(pull));
}

std::vector<std::size_t> AllOf(std::size_t count) {
  std::vector<std::size_t> members(count);
  std::iota(members.begin(), members.end(), 0);
  return members;
}

/// Removes recordings one by one until the remaining recordings agree; each time it removes the recording whose removal
/// leaves the smallest statistic. A majority must remain; without a majority no recording can be called wrong.
std::vector<std::size_t> FindDeviatingRecordings(const std::vector<Scaled>& estimates) {
  std::vector<std::size_t> members = AllOf(estimates.size());
  std::vector<std::size_t> out;
  const auto size = static_cast<double>(estimates.front().value.size());
  Pool pool = PoolOf(estimates, members);
  while (2 * (out.size() + 1) < estimates.size()) {
    auto best = members.begin();
    double least = std::numeric_limits<double>::infinity();
    for (auto member = members.begin(); member != members.end(); ++member) {
      const double statistic = StatisticWithout(estimates[*member], pool);
      if (statistic >= least) continue;
      least = statistic;
      best = member;
    }
    out.push_back(*best);
    members.erase(best);
    pool = PoolOf(estimates, members);
    const double dof = size * static_cast<double>(members.size() - 1);
    if (members.size() > 1 && Tail(pool.statistic, dof) >= Agreement::kDisagree) return out;
  }
  return {};
}

/// p of the distance between parameter j of recording k and the other recordings, judged by the scatter of the other
/// recordings.
double DistanceFromScatter(const std::vector<SeparateEstimates>& estimates, std::size_t k, Index j) {
  VectorXd value(static_cast<Index>(estimates.size()) - 1), error(value.size());
  for (Index i = 0; i < value.size(); ++i) {
    const SeparateEstimates& other =
        estimates[static_cast<std::size_t>(i) + (static_cast<std::size_t>(i) >= k ? 1 : 0)];
    value[i] = other.value[j];
    error[i] = std::sqrt(other.covariance(j, j));
  }
  const RandomEffects others = SummarizeScatter(value, error);
  const double variance =
      estimates[k].covariance(j, j) + others.between * others.between + others.std_error * others.std_error;
  const double t = std::abs(estimates[k].value[j] - others.mean) / std::sqrt(variance);
  return 2 * StudentTail(t, static_cast<double>(value.size() - 1));
}

/// If no majority agrees: recordings whose distance from the others is large compared with the scatter of the others.
/// Needs at least kMinRecordings.
std::vector<std::size_t> FarFromScatter(const std::vector<SeparateEstimates>& estimates) {
  constexpr std::size_t kMinRecordings = 4;
  std::vector<std::size_t> far;
  if (estimates.size() < kMinRecordings) return far;
  const Index size = estimates.front().value.size();
  const double trials = static_cast<double>(estimates.size()) * static_cast<double>(size);
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    for (Index j = 0; j < size; ++j) {
      if (DistanceFromScatter(estimates, k, j) * trials >= Agreement::kDisagree) continue;
      far.push_back(k);
      break;
    }
  }
  return far;
}

}  // namespace

Agreement TestAgreement(const std::vector<SeparateEstimates>& estimates) {
  Agreement agreement;
  agreement.statistic = PoolOf(Scale(estimates), AllOf(estimates.size())).statistic;
  agreement.dof = static_cast<int>(estimates.front().value.size()) * static_cast<int>(estimates.size() - 1);
  if (std::isfinite(agreement.statistic)) agreement.p = Tail(agreement.statistic, agreement.dof);
  return agreement;
}

std::vector<std::size_t> FindDisagreeing(const std::vector<SeparateEstimates>& estimates) {
  std::vector<std::size_t> out = FindDeviatingRecordings(Scale(estimates));
  if (out.empty()) out = FarFromScatter(estimates);
  std::ranges::sort(out);
  return out;
}

}  // namespace pendulum
