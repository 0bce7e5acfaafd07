// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/joint_errors.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "pendulum/fitting/intervals.h"
#include "pendulum/fitting/systematic.h"

namespace pendulum {
namespace {

using Eigen::Index;

bool IsFromPosterior(const FitReport& fit) { return fit.interval_method == kPosteriorIntervals; }

}  // namespace

Eigen::MatrixXd SystematicErrors(const JointProblem& joint, const Solution& solution, const Optimum& optimum) {
  const auto size = static_cast<Index>(joint.solve.fixed.size());
  std::map<std::string, std::pair<SystematicSource, std::size_t>> sources;  // and of how many recordings
  for (const JointMember& member : joint.members) {
    for (const SystematicSource& source :
         SystematicSources(*member.recording, member.options, *member.problem, *member.cost, member.solution)) {
      auto& [all, count] = sources[source.identity];
      if (count++ == 0) {
        all = {source.identity, Eigen::VectorXd::Zero(source.powers.size() > 0 ? size : 0),
               Eigen::MatrixXd::Zero(size, source.pull.cols()), source.covariance};
      }
      // An angle's friction follows the clock otherwise than a rate's: then no one factor says it, and the pulls do.
      if (all.powers.size() > 0 && source.powers.size() > 0) {
        const bool first = count == 1;
        for (std::size_t i = 0; i < member.at.size() && all.powers.size() > 0; ++i) {
          const bool shared = member.at[i] < static_cast<int>(joint.shared.size());
          const double power = source.powers[static_cast<Index>(i)];
          if (shared && !first && all.powers[member.at[i]] != power) {
            all.powers.resize(0);
          } else {
            all.powers[member.at[i]] = power;
          }
        }
      }
      all.pull(member.at, Eigen::all) += source.pull;
    }
  }
  const SourceContext context{solution.parameters, joint.solve.fixed, joint.cost->priors(), optimum};
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [identity, source] : sources) {
    covariance += SourceCovariance(source.first, source.second == joint.members.size(), context);
  }
  return covariance;
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
    member.cost->Readings(member.solution.parameters, &member.solution.readings, nullptr);  // known to be traced
  }
  return true;
}

}  // namespace pendulum
