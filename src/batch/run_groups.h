// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "batch/sqlite.h"
#include "pendulum/batch/run_statistics.h"

namespace pendulum {

/// Which fitted runs of a store are taken for repeats of one pendulum, and why.
struct RunGroups {
  enum class By {
    kColumn,      ///< A column of the manifest that the user chose, or whose name says what it is.
    kTrueValues,  ///< The true values of simulated recordings.
    kRig,         ///< The rig file.
    kFolder,      ///< The folder of the recording.
    kAll,         ///< All runs are of one pendulum.
  };
  By by = By::kAll;
  std::string name = {};           ///< "rig", "bench", "folder", "true values"; empty: all runs are one group.
  std::string sql = "''";          ///< The group of a row of table runs, a text.
  std::string condition = "true";  ///< The rows of table runs that are grouped.
  bool is_stated = false;          ///< A flag, the manifest or the true values say so; otherwise it is an assumption.
  std::string one_rig = {};        ///< The rig file of all runs, for kAll; empty if there is none.
  std::int64_t runs = 0;           ///< Fitted runs (kIsFitted); only these are counted here.
  std::int64_t groups = 0;
  std::int64_t smallest = 0, largest = 0;  ///< Runs of a group.
  std::int64_t without_rig = 0;            ///< Runs without a rig, if others have one.
  std::vector<std::string> unlike = {};    ///< Groups whose runs differ too much for repeats; they are not compared.
  std::string difference = {};  ///< If `unlike` is not empty: "inertia scatters by 49 % between its recordings, ...".
  std::set<std::string> own_sources = {};  ///< Groups whose runs have different clocks or calibrations.

  /// Whether some runs are compared as repeats of one pendulum.
  bool compares() const { return largest > 1 && static_cast<std::int64_t>(unlike.size()) < groups; }
};

/// Groups runs by `group_by`: a column of the manifest, or folder, or all. If it is empty, by what the manifest says:
/// its columns pendulum, group and rig_id, the true values of simulated recordings, several rig files; if it names no
/// rig, by folders, if some have several recordings. Otherwise all runs are of one pendulum. `group_by` must exist.
RunGroups GroupRuns(SQLite::Database& database, const std::string& group_by);

/// All runs of a batch of a FitStore as one group. batch: its number.
RunGroups GroupBatch(SQLite::Database& database, std::int64_t batch);

/// Whether a name is not a column, but a way to group runs: all, folder.
bool IsWayToGroup(const std::string& group_by);

/// SQL for a run's value in a column of the manifest, a text or a number.
std::string ColumnSql(const std::string& column);

/// Whether values of a parameter scatter so much that the runs cannot be repeats of one pendulum. A change of the
/// pendulum's length by 2 % changes its period by 1 %; temperature, air pressure and remounting change it less.
/// Friction may change by some tens of percent. So the limits of the robust relative standard deviation (1.4826 times
/// the median distance from the median) are 1 % for the period, 2 % for the inertia and 50 % for viscous and dry
/// friction. The scatter must also be ten times the median standard error, so that imprecise estimates do not count.
bool DifferGrossly(const std::string& parameter, const RunValues& values);

/// Finds groups that are assumptions and whose runs differ grossly under a model; sets `unlike`.
void FindUnlikeGroups(SQLite::Database& database, const std::string& model, RunGroups& groups);

/// What was taken for one pendulum, in one or two sentences.
std::string GroupsText(const RunGroups& groups);

/// How to say otherwise, in a sentence.
std::string OtherGroupsText(const RunGroups& groups);

}  // namespace pendulum
