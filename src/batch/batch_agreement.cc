// SPDX-License-Identifier: Apache-2.0
#include "batch/batch_agreement.h"

#include <map>
#include <string>
#include <utility>

#include "batch/disagreement_text.h"
#include "batch/run_agreement.h"
#include "batch/run_groups.h"
#include "batch/summary_verdict.h"
#include "pendulum/analysis/agreement.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// The names of the runs of a batch by their ids: those that their sender gave, or those of the files.
std::map<std::string, std::string> NamesOf(SQLite::Database& database, std::int64_t batch) {
  SQLite::Statement rows(database,
                         "SELECT runs.id, coalesce(nullif(requests.name, ''), path) FROM requests JOIN runs USING(run) "
                         "WHERE batch = ?");
  sqlite::Bind(rows, batch);
  std::map<std::string, std::string> names;
  while (rows.executeStep()) names.emplace(sqlite::Text(rows, 0), sqlite::Text(rows, 1));
  return names;
}

/// "Recording d.csv disagrees with the others: ...".
std::string OutliersText(const GroupAgreement& tested, const std::map<std::string, std::string>& names) {
  StoreSummary named;
  named.agreement.rows = {tested};
  for (DisagreeingRun& run : named.agreement.rows.front().outliers) run.id = names.at(run.id);
  return DisagreementText(named) +
         (tested.outliers.size() == 1 ? " The means leave it out." : " The means leave them out.");
}

std::string TestedText(const GroupAgreement& tested, const std::string& law,
                       const std::map<std::string, std::string>& names) {
  const std::string runs = std::to_string(tested.runs) + " recordings", p = " (p " + ProbabilityText(tested.p) + ")";
  if (!tested.outliers.empty()) return OutliersText(tested, names);
  if (tested.p < Agreement::kDisagree) {
    return "The " + runs + " differ by more than their errors under the law " + law + p +
           "; the errors of the means contain that.";
  }
  return "The " + runs + " agree under the law " + law + p + ".";
}

BatchAgreement NotCompared(std::string why) { return {"", "caution", std::move(why), {}, {}}; }

}  // namespace

BatchAgreement AgreementOfBatch(SQLite::Database& database, std::int64_t batch) {
  RunGroups groups = GroupBatch(database, batch);
  const std::string law = MainLaw(database, {}, groups);
  if (groups.runs < 2 || law.empty())
    return NotCompared("Fewer than two recordings were fitted: there is nothing to compare.");
  FindUnlikeGroups(database, law, groups);
  if (!groups.unlike.empty()) return NotCompared(GroupsText(groups));
  RunAgreement agreement = TestRunAgreement(database, law, groups);
  if (agreement.rows.empty()) {
    return NotCompared(
        "The recordings are not compared: fewer than two, or more than 500, have errors of the same parameters under "
        "the law " +
        law + ".");
  }
  GroupAgreement& tested = agreement.rows.front();
  return {.law = law,
          .level = tested.p < Agreement::kDisagree ? "caution" : "good",
          .text = TestedText(tested, law, NamesOf(database, batch)),
          .means = std::move(tested.means),
          .outliers = std::move(tested.outliers)};
}

}  // namespace pendulum
