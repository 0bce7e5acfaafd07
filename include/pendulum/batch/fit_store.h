// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"
#include "pendulum/batch/store_summary.h"
#include "pendulum/identify/identify.h"

namespace pendulum {

/// One run requested from a service.
struct FitOrder {
  std::string id;       ///< Unique among all runs.
  std::string created;  ///< RFC 3339, UTC.
  std::string flags;    ///< The options: a JSON object with the names and values of flags, all as texts.
  RunFiles files;
  std::string name = {};  ///< Given by the client; may be empty.
};

/// The key of a request and the SHA-256 of its content. They identify a repetition, which is not processed again.
struct RequestKey {
  std::string key, request_sha256;
};

/// The stored answer for a key.
struct KnownAnswer {
  std::string request_sha256;
  std::string location;  ///< "/v1/fits/ID"
};

/// One parameter of a fit, as a list shows it.
struct ListedParameter {
  std::string name, unit;
  std::optional<double> estimate, std_error;
  std::optional<double> total_std_error;  ///< Statistical and systematic, in squares.
};

/// The fit of one model to a run, as a list shows it.
struct ListedModel {
  std::string model, status, reason, residual_unit;
  std::optional<double> rms_residual;
  std::vector<ListedParameter> parameters;
};

/// One run, as a list shows it.
struct ListedFit {
  std::int64_t run = 0;  ///< Its number; later runs have larger numbers.
  std::string id;
  std::string name;  ///< Given by the client; may be empty.
  std::string file;  ///< Name of the recording.
  std::string created;
  std::optional<std::string> batch;  ///< The id of its batch.
  std::optional<int> exit_code;      ///< std::nullopt: the run waits.
  std::string reason;                ///< Why it could not be fitted.
  std::optional<std::string> recommended;
  std::optional<std::array<double, 2>> window;  ///< Begin and end of the fitted samples, s.
  std::vector<ListedModel> models;

  /// The given name, or that of the recording.
  const std::string& ShownName() const { return name.empty() ? file : name; }
};

/// Selects the runs of a list; an empty field matches any run. `name`: a part of the given name or of the file's.
struct FitFilter {
  int limit = 50;
  std::optional<std::int64_t> before;  ///< Only smaller run numbers.
  std::string model, status, name, batch, since;
};

/// A run with all its inputs.
struct KeptFit {
  ListedFit fit;  ///< Without models and window.
  FitOrder order;
  nlohmann::ordered_json result;  ///< Null if there is none.
};

/// A batch with counts of its runs.
struct ListedBatch {
  std::int64_t batch = 0;  ///< Its number; later batches have larger numbers.
  std::string id, created;
  std::int64_t runs = 0, done = 0, failed = 0;
};

/// Whether the recordings of a batch agree, by the rules for repeats in a store of refit_pendulums (Summarize).
struct BatchAgreement {
  std::string law;    ///< Compared under this law, the one recommended most often; empty: nothing is compared.
  std::string level;  ///< good or caution.
  std::string text;   ///< In sentences, which name recordings as the list does.
  std::vector<RunsMean> means;
  std::vector<DisagreeingRun> outliers;  ///< By the ids of runs.
};

/// The store of a service: a store of refit_pendulums that also contains the inputs of the runs. For many threads at a
/// time. When a function that changes the store returns, the change is on the disk; simultaneous changes share one
/// commit. While the store is open, no other process may write to it. Readers in other processes block nobody
/// (write-ahead log). Errors of all functions: as for Store; kNotFound for an unknown id.
class FitStore {
  struct State;

 public:
  /// Creates the file if it does not exist. kTryAgain: another process writes to it.
  static Result<std::unique_ptr<FitStore>> Open(const std::filesystem::path& path);

  explicit FitStore(std::unique_ptr<State> state);
  FitStore(FitStore&&) = delete;
  FitStore(const FitStore&) = delete;
  FitStore& operator=(FitStore&&) = delete;
  FitStore& operator=(const FitStore&) = delete;
  ~FitStore();

  /// Stores a finished run.
  Result<void> Add(const FitOrder& order, const RunOutcome& outcome, const std::optional<RequestKey>& key);

  /// Stores waiting runs.
  Result<void> AddBatch(const std::string& id, const std::string& created, const std::vector<FitOrder>& orders,
                        const std::optional<RequestKey>& key);

  /// Stores the outcome of a waiting run. kNotFound: it was deleted meanwhile.
  Result<void> Put(const std::string& id, const RunOutcome& outcome);

  /// Gives a run another name; an empty one removes it.
  Result<void> Rename(const std::string& id, const std::string& name);

  /// Deletes a run with its files, a batch with all of its runs, or the runs of a batch that wait.
  Result<void> DeleteFit(const std::string& id);
  Result<void> DeleteBatch(const std::string& id);
  Result<void> DeleteWaiting(const std::string& batch);

  /// Errors only: kNotFound if there is no run with this id.
  Result<void> CheckFit(const std::string& id);

  Result<KeptFit> Find(const std::string& id);
  Result<std::vector<ListedFit>> List(const FitFilter& filter);
  Result<ListedBatch> FindBatch(const std::string& id);
  Result<std::vector<ListedBatch>> ListBatches(int limit, const std::optional<std::int64_t>& before);

  /// The runs of a batch in the order in which they were sent, without models and windows.
  Result<std::vector<ListedFit>> RunsOf(const std::string& batch);

  /// The finished runs of a batch, taken for repeats of one pendulum.
  Result<BatchAgreement> AgreementOf(const std::string& batch);

  /// A waiting run: its id and the id of its batch.
  struct Waiting {
    std::string id, batch;
  };

  /// All waiting runs, in the order in which they were sent.
  Result<std::vector<Waiting>> WaitingRuns();

  Result<std::optional<KnownAnswer>> FindAnswer(const std::string& key);

 private:
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
