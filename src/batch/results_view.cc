// SPDX-License-Identifier: Apache-2.0
#include "batch/results_view.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "batch/run_kinds.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {
namespace {

/// The parameters of all laws, then the start and what people derive from them.
std::vector<std::string_view> ViewedQuantities() {
  std::vector<std::string_view> names;
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const MotionModel& model : MotionModels()) {
    for (const ParameterInfo& parameter : PhysicalParameters(model)) add(parameter.name);
  }
  for (const std::string_view name :
       {"release_angle", "initial_angle", "small_angle_period", "decay_time", "quality_factor"}) {
    add(name);
  }
  return names;
}

/// The columns of one quantity. SQLite computes only those that a query uses.
std::string ColumnsOf(std::string_view name) {
  std::string columns;
  const auto add = [&](const char* member, const std::string& column) {
    columns += std::string(",\n    (SELECT ") + member +
               " FROM quantities AS q WHERE q.run = main.run AND q.model = main.law AND q.name = '" +
               std::string(name) + "') AS " + column;
  };
  const std::string column(name);
  add("estimate", column);
  add("std_error", column + "_std_error");
  add("total_std_error", column + "_total_std_error");
  add("unit", column + "_unit");
  return columns;
}

}  // namespace

std::string ResultsView() {
  std::string sql = R"sql(CREATE VIEW results AS  -- one row for each refitted run: its recommended law, or its only one
  SELECT main.id, main.position, main.path AS file, main.rig, main.law,
    coalesce(fits.status, iif(main.reason IS NULL, 'no_law_recommended', main.refusal)) AS status,
    coalesce(main.reason, fits.verdict, iif(main.law IS NULL, 'no law is recommended', nullif(fits.reason, ''))) AS verdict,
    main.stale, fits.used_samples, fits.rms_residual, fits.residual_unit)sql";
  for (const std::string_view name : ViewedQuantities()) sql += ColumnsOf(name);
  return sql + R"sql(
  FROM (SELECT run, id, position, path, rig, reason,
          )sql" +
         kWhyStale + R"sql( AS stale, iif()sql" + kIsMissing +
         R"sql(, 'missing', 'refused') AS refusal, coalesce(recommended,
          (SELECT min(model) FROM fits WHERE fits.run = runs.run AND fits.stale IS NULL HAVING count(*) = 1)) AS law
        FROM runs WHERE exit_code IS NOT NULL) AS main
  LEFT JOIN fits ON fits.run = main.run AND fits.model = main.law)sql";
}

}  // namespace pendulum
