// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/joint/joint_errors.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "pendulum/fitting/fit/intervals.h"
#include "pendulum/fitting/joint/joint_parabolas.h"

namespace pendulum {
namespace {

using Eigen::Index;

bool IsFromPosterior(const FitReport& fit) { return fit.interval_method == kPosteriorIntervals; }

/// A source of errors, and the number of recordings that share it.
struct CommonSource {
  SystematicSource source;  // of all P parameters
  std::size_t count = 0;
};

/// Adds a recording's powers to the powers of the common source. If recordings disagree on a power, or if the estimates
/// of one are no powers, the powers are removed and only the pulls are used.
void MergePowers(const JointProblem& joint, const JointMember& member, const SystematicSource& own,
                 CommonSource& common) {
  Eigen::VectorXd& powers = common.source.powers;
  if (own.powers.size() == 0) powers.resize(0);
  if (powers.size() == 0) return;
  const bool first = common.count == 1;
  for (std::size_t i = 0; i < member.at.size(); ++i) {
    const double power = own.powers[static_cast<Index>(i)];
    if (!first && joint.IsShared(member.at[i]) && powers[member.at[i]] != power) {
      powers.resize(0);
      return;
    }
    powers[member.at[i]] = power;
  }
}

/// The sources of all recordings, by identity.
std::map<std::string, CommonSource> SourcesOf(const JointProblem& joint) {
  std::map<std::string, CommonSource> sources;
  const auto size = static_cast<Index>(joint.solve.fixed.size());
  for (const JointMember& member : joint.members) {
    for (const SystematicSource& own : SystematicSources(*member.recording, member.options, *member.problem,
                                                         *member.cost, member.solution, member.alone->effects)) {
      CommonSource& common = sources[own.identity];
      if (common.count++ == 0) {
        common.source = {own.kind, own.identity, Eigen::VectorXd::Zero(own.powers.size() > 0 ? size : 0),
                         Eigen::MatrixXd::Zero(size, own.pull.cols()), own.covariance};
      }
      MergePowers(joint, member, own, common);
      common.source.pull(member.at, Eigen::all) += own.pull;
    }
  }
  return sources;
}

}  // namespace

std::vector<SystematicCovariance> JointSystematicCovariances(const JointProblem& joint, const Solution& solution,
                                                             const Optimum& optimum) {
  const SourceContext context{solution.parameters, joint.solve.fixed, joint.cost->priors(), optimum};
  std::vector<SystematicCovariance> covariances;
  if (!optimum.inverse.identifiable) return covariances;
  for (const auto& [identity, common] : SourcesOf(joint)) {
    const bool of_all = common.count == joint.members.size();
    AddOfKind(CovarianceOfSource(common.source, of_all, context), covariances);
  }
  return covariances;
}

bool HasPosteriors(const JointProblem& joint) {
  const auto& members = joint.members;
  return std::ranges::any_of(members, [](const JointMember& m) { return IsFromPosterior(*m.alone); }) &&
         std::ranges::all_of(members, [](const JointMember& m) { return !m.alone->covariance_names.empty(); });
}

bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known) {
  Optimum optimum = known;
  optimum.free.insert(optimum.free.end(), optimum.at_bound.begin(), optimum.at_bound.end());
  std::ranges::sort(optimum.free);
  optimum.at_bound.clear();
  CombinedParabolas combined = CombineParabolas(joint);
  optimum.inverse = InvertInformation(combined.information, optimum.free);
  double sum = 0;
  if (!optimum.inverse.identifiable || !joint.cost->SumOfSquares(combined.parameters, &sum)) return false;
  optimum.information = std::move(combined.information);
  optimum.gradient.setZero();
  known = std::move(optimum);
  solution.parameters = std::move(combined.parameters);
  joint.Distribute(solution.parameters);
  for (JointMember& member : joint.members) {
    member.solution.noise.sigma = member.alone->noise.sigma;
    member.cost->Readings(member.solution.parameters, &member.solution.readings,
                          nullptr);  // computed before, so it fails only after a stop
  }
  return true;
}

}  // namespace pendulum
