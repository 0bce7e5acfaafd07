// SPDX-License-Identifier: Apache-2.0
#include "batch/run_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "batch/kept_result.h"
#include "batch/run_kinds.h"
#include "pendulum/analysis/agreement.h"
#include "pendulum/analysis/random_effects.h"
#include "pendulum/analysis/separate_estimates.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Index;

constexpr std::size_t kMaxRuns = 500;      // of a group
constexpr std::int64_t kMaxBatch = 20000;  // runs
constexpr std::size_t kMaxRows = 50;

/// A run of a group.
struct Member {
  std::string id;
  FitAloneResult fit;                    ///< No names if the run cannot be compared.
  std::vector<std::string> units = {};   ///< Of the parameters of `fit`.
  Eigen::VectorXd total_std_error = {};  ///< Of the parameters of `fit`, from all sources.
};

/// The free parameters of the pendulum in a fit, in the order of the model.
std::vector<std::string> FreeNames(const Json& fit) {
  std::vector<std::string> names;
  const auto model = FindMotionModel(fit["model"].get<std::string>());
  if (!model) return names;
  for (const ParameterInfo& parameter : PhysicalParameters(*model)) {
    const auto found = fit["parameters"].find(parameter.name);
    if (found != fit["parameters"].end() && !(*found)["fixed"].get<bool>()) names.emplace_back(parameter.name);
  }
  return names;
}

/// The rows and columns of a matrix of the result JSON for these names; 0 where it has none.
std::optional<Eigen::MatrixXd> MatrixOf(const Json& json, const std::vector<std::string>& names) {
  const auto size = static_cast<Index>(names.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  if (!json.is_object()) return std::nullopt;
  const auto known = json["names"].get<std::vector<std::string>>();
  std::vector<std::ptrdiff_t> rows;
  for (const std::string& name : names) rows.push_back(std::ranges::find(known, name) - known.begin());
  const auto count = static_cast<std::ptrdiff_t>(known.size());
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j < size; ++j) {
      const auto row = rows[static_cast<std::size_t>(i)], column = rows[static_cast<std::size_t>(j)];
      if (row == count || column == count) continue;
      const Json& value = json["matrix"][static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      if (!value.is_number()) return std::nullopt;
      matrix(i, j) = value.get<double>();
    }
  }
  return matrix;
}

/// Half the 95 % interval over the standard error; absent if the interval is open.
std::optional<double> HalfInterval(const Json& parameter) {
  const Json& interval = parameter["interval95"];
  if (!interval.is_array() || !interval[0].is_number() || !interval[1].is_number()) return std::nullopt;
  return 0.5 * (interval[1].get<double>() - interval[0].get<double>()) / parameter["std_error"].get<double>();
}

/// own: the part of the fit for its recording.
bool IsComparable(const Json& result, const Json& fit, const Json& own, const std::vector<std::string>& names) {
  const auto is_free = [](const Json& parameter) { return !parameter["at_bound"].get<bool>(); };
  if (!std::ranges::all_of(fit["parameters"], is_free) || !std::ranges::all_of(own["parameters"], is_free))
    return false;
  for (const std::string& name : names) {
    if (!fit["parameters"][name]["std_error"].is_number()) return false;
  }
  const auto is_another_minimum = [](const Json& warning) { return warning["code"] == "another_minimum"; };
  return !result.contains("warnings") || std::ranges::none_of(result["warnings"], is_another_minimum);
}

SystematicParts SystematicOf(const Json& fit, const std::vector<std::string>& names) {
  const auto size = static_cast<Index>(names.size());
  SystematicParts parts{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  if (const auto found = fit.find("systematic_covariance"); found != fit.end()) {
    parts.covariance = MatrixOf(*found, names).value_or(parts.covariance);
  }
  for (Index i = 0; i < size; ++i) {
    const Json& parameter = fit["parameters"][names[static_cast<std::size_t>(i)]];
    const auto budget = parameter.find("error_budget");
    if (budget == parameter.end() || !budget->is_object()) continue;
    parts.rig[i] = budget->value("rig", 0.0);
    parts.inconstancy[i] = std::hypot(budget->value("inconstancy", 0.0), budget->value("friction_law", 0.0));
  }
  return parts;
}

Member MemberOf(std::string id, const std::string& text, const std::string& model) {
  Member member{std::move(id), {}};
  const Json result = Json::parse(text);
  const auto fit = std::ranges::find_if(result["fits"], [&](const Json& one) { return one["model"] == model; });
  if (fit == result["fits"].end() || !fit->contains("covariance")) return member;
  const std::vector<std::string> names = FreeNames(*fit);
  const Json* const recording = RecordingOf(result);
  const auto index = static_cast<std::size_t>(fit - result["fits"].begin());
  if (names.empty() || recording == nullptr || index >= recording->at("fits").size() ||
      !IsComparable(result, *fit, recording->at("fits").at(index), names))
    return member;
  const auto covariance = MatrixOf((*fit)["covariance"], names);
  if (!covariance || !(covariance->diagonal().minCoeff() > 0)) return member;
  FitAloneResult alone{
      names, Eigen::VectorXd(static_cast<Index>(names.size())), *covariance, {}, SystematicOf(*fit, names)};
  member.total_std_error = covariance->diagonal().cwiseSqrt();
  for (Index i = 0; i < alone.value.size(); ++i) {
    const Json& parameter = (*fit)["parameters"][names[static_cast<std::size_t>(i)]];
    alone.value[i] = parameter["estimate"].get<double>();
    member.units.push_back(parameter["unit"].get<std::string>());
    const auto total = parameter.find("total_std_error");
    if (total != parameter.end() && total->is_number()) member.total_std_error[i] = total->get<double>();
    alone.t95.push_back(HalfInterval(parameter));
  }
  member.fit = std::move(alone);
  return member;
}

/// A disagreeing run, and the parameter in which it differs most.
DisagreeingRun DisagreementOf(const std::vector<SeparateEstimates>& estimates, std::size_t run,
                              const std::vector<std::size_t>& outliers, const std::string& id) {
  const SeparateEstimates& own = estimates[run];
  DisagreeingRun described;
  double largest = -1;
  for (Index j = 0; j < own.value.size(); ++j) {
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < estimates.size(); ++k) {
      if (std::ranges::find(outliers, k) != outliers.end()) continue;
      const double weight = 1 / estimates[k].covariance(j, j);
      sum += weight * estimates[k].value[j];
      weights += weight;
    }
    const double others = sum / weights;
    const double errors = std::abs(own.value[j] - others) / std::sqrt(own.covariance(j, j) + 1 / weights);
    if (!(errors > largest)) continue;
    largest = errors;
    described = {id, own.names[static_cast<std::size_t>(j)], own.value[j], others};
  }
  return described;
}

/// The mean of parameter j over the runs that are no outliers. Its error contains their scatter, and of each source
/// that all of them share the mean square.
RunsMean MeanOf(const std::vector<const Member*>& members, const std::vector<SeparateEstimates>& estimates,
                const std::vector<std::size_t>& outliers, Index j) {
  std::vector<double> values, errors;
  double shared = 0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (std::ranges::find(outliers, k) != outliers.end()) continue;
    const double variance = estimates[k].covariance(j, j), total = members[k]->total_std_error[j];
    values.push_back(estimates[k].value[j]);
    errors.push_back(std::sqrt(variance));
    shared += std::max(total * total - variance, 0.0);
  }
  const auto count = static_cast<Index>(values.size());
  const auto row = static_cast<std::size_t>(j);
  RunsMean mean{estimates.front().names[row], members.front()->units[row], values.front(), errors.front(),
                values.size()};
  if (count > 1) {
    const RandomEffects scatter =
        SummarizeScatter(Eigen::VectorXd::Map(values.data(), count), Eigen::VectorXd::Map(errors.data(), count));
    mean.mean = scatter.mean;
    mean.total_std_error = scatter.std_error;
  }
  mean.total_std_error = std::hypot(mean.total_std_error, std::sqrt(shared / static_cast<double>(count)));
  return mean;
}

/// One pendulum: its runs, and the test.
class Group {
 public:
  Group(std::string name, bool own_sources) : name_(std::move(name)), own_sources_(own_sources) {}

  const std::string& name() const { return name_; }

  void Add(std::string id, const std::string& result, const std::string& model) {
    if (++runs_ <= kMaxRuns) members_.push_back(MemberOf(std::move(id), result, model));
  }

  /// std::nullopt if the group cannot be tested. Adds the ids of the outliers if they are few.
  std::optional<GroupAgreement> Test(std::set<std::string>& named) const {
    std::vector<const Member*> members;
    std::vector<SeparateEstimates> estimates;
    for (const Member* member : Comparable()) {
      std::optional<SeparateEstimates> one = EstimatesToCompare(member->fit, own_sources_);
      if (!one) continue;
      one->run = members.size();
      members.push_back(member);
      estimates.push_back(*std::move(one));
    }
    if (members.size() < 2 || runs_ > kMaxRuns) return std::nullopt;
    const Agreement agreement = TestAgreement(estimates);
    if (!agreement.p) return std::nullopt;
    std::vector<std::size_t> outliers;
    if (*agreement.p < Agreement::kDisagree) outliers = FindDisagreeing(estimates);
    GroupAgreement tested{name_, members.size(), agreement.statistic, agreement.dof, *agreement.p, {}, {}};
    for (const std::size_t k : outliers) {
      tested.outliers.push_back(DisagreementOf(estimates, k, outliers, members[k]->id));
      constexpr std::size_t kShare = 10;  // more than one in ten are no exceptions
      if (outliers.size() == 1 || kShare * outliers.size() <= members.size()) named.insert(members[k]->id);
    }
    for (Index j = 0; j < estimates.front().value.size(); ++j)
      tested.means.push_back(MeanOf(members, estimates, outliers, j));
    return tested;
  }

 private:
  /// The runs whose parameters and units are those of most runs. Runs with and without a rig have different units.
  std::vector<const Member*> Comparable() const {
    std::map<std::pair<std::vector<std::string>, std::vector<std::string>>, std::vector<const Member*>> kinds;
    for (const Member& member : members_) {
      if (!member.fit.names.empty()) kinds[{member.fit.names, member.units}].push_back(&member);
    }
    std::vector<const Member*> most;
    for (const auto& [kind, members] : kinds) {
      if (members.size() > most.size()) most = members;
    }
    return most;
  }

  std::string name_;
  bool own_sources_;
  std::size_t runs_ = 0;
  std::vector<Member> members_;
};

}  // namespace

RunAgreement TestRunAgreement(SQLite::Database& database, const std::string& model, const RunGroups& groups) {
  RunAgreement agreement;
  agreement.law = model;
  if (!groups.compares() || groups.runs > kMaxBatch) return agreement;
  SQLite::Statement rows(database, "SELECT " + groups.sql +
                                       R"sql( AS pendulum, id, result FROM runs JOIN fits USING(run)
  WHERE model = ? AND status = 'converged' AND result IS NOT NULL AND )sql" +
                                       kIsLiveFit + " AND " + groups.condition + " ORDER BY pendulum, position, id");
  sqlite::Bind(rows, model);
  std::vector<GroupAgreement>& tested = agreement.rows;
  std::optional<Group> group;
  const auto test = [&] {
    if (!group || std::ranges::find(groups.unlike, group->name()) != groups.unlike.end()) return;
    if (auto row = group->Test(agreement.outliers)) tested.push_back(*std::move(row));
  };
  while (rows.executeStep()) {
    const std::string name = sqlite::Text(rows, 0);
    if (!group || group->name() != name) {
      test();
      group.emplace(name, groups.own_sources.contains(name));
    }
    group->Add(sqlite::Text(rows, 1), sqlite::Text(rows, 2), model);
  }
  test();
  std::ranges::stable_sort(tested, {}, &GroupAgreement::p);
  for (GroupAgreement& row : tested) {
    if (groups.name.empty()) row.group.reset();
    if (row.p < Agreement::kDisagree) ++agreement.disagreeing;
  }
  agreement.groups = tested.size();
  if (tested.size() > kMaxRows) tested.resize(kMaxRows);
  return agreement;
}

}  // namespace pendulum
