// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"
#include "pendulum/identify/identify.h"

namespace pendulum {

/// One run that a service is asked for.
struct FitOrder {
  std::string id;       ///< Unlike that of any other run.
  std::string created;  ///< RFC 3339, UTC.
  std::string flags;    ///< What is asked, a JSON object of texts by the flags' names.
  RunFiles files;
};

/// What a client may ask again without its being done again: its key, and the SHA-256 of what it sent.
struct RequestKey {
  std::string key, request_sha256;
};

/// What a key stands for.
struct KnownAnswer {
  std::string request_sha256;
  std::string location;  ///< "/v1/fits/ID"
};

/// One parameter of a fit in a list.
struct ListedParameter {
  std::string name, unit;
  std::optional<double> estimate, std_error;
};

/// One model of a run in a list.
struct ListedModel {
  std::string model, status, reason, residual_unit;
  std::optional<double> rms_residual;
  std::vector<ListedParameter> parameters;
};

/// One run as a list shows it.
struct ListedFit {
  std::int64_t run = 0;  ///< Its number; later ones have greater numbers.
  std::string id, name, created;
  std::optional<std::string> batch;  ///< The id of its batch.
  std::optional<int> exit_code;      ///< None: it waits.
  std::string reason;                ///< Why it could not be fitted.
  std::optional<std::string> recommended;
  std::vector<ListedModel> models;
};

/// Which runs a list is of; empty: any.
struct FitFilter {
  int limit = 50;
  std::optional<std::int64_t> before;  ///< Those with lesser numbers only.
  std::string model, status, name, batch, since;
};

/// A run with all that it was made from.
struct KeptFit {
  ListedFit fit;  ///< Without models.
  FitOrder order;
  nlohmann::ordered_json result;  ///< Null where there is none.
};

/// A batch of runs, counted.
struct ListedBatch {
  std::int64_t batch = 0;  ///< Its number; later ones have greater numbers.
  std::string id, created;
  std::int64_t runs = 0, done = 0, failed = 0;
};

/// The store of a service: that of refit_pendulums, with what the runs were made from, for many threads at a time. What
/// a function that changes it has returned from is on the disk; several of them share one wait for it. While it is
/// open no other process may write, and readers of other processes hinder nobody (write-ahead log). Errors of all
/// functions: as Store's; kNotFound where an id is unknown.
class FitStore {
  struct State;

 public:
  /// Makes one that is not there. kTryAgain: another process writes to it.
  static Result<std::unique_ptr<FitStore>> Open(const std::filesystem::path& path);

  explicit FitStore(std::unique_ptr<State> state);
  FitStore(FitStore&&) = delete;
  FitStore(const FitStore&) = delete;
  FitStore& operator=(FitStore&&) = delete;
  FitStore& operator=(const FitStore&) = delete;
  ~FitStore();

  /// Keeps a run that is done.
  Result<void> Add(const FitOrder& order, const RunOutcome& outcome, const std::optional<RequestKey>& key);

  /// Keeps runs that are to be done.
  Result<void> AddBatch(const std::string& id, const std::string& created, const std::vector<FitOrder>& orders,
                        const std::optional<RequestKey>& key);

  /// Keeps what came of a run that was to be done. kNotFound: it was deleted meanwhile.
  Result<void> Put(const std::string& id, const RunOutcome& outcome);

  /// A run and its files go; so does a batch with all of its runs.
  Result<void> DeleteFit(const std::string& id);
  Result<void> DeleteBatch(const std::string& id);

  Result<KeptFit> Find(const std::string& id);
  Result<std::vector<ListedFit>> List(const FitFilter& filter);
  Result<ListedBatch> FindBatch(const std::string& id);
  Result<std::vector<ListedBatch>> ListBatches(int limit, const std::optional<std::int64_t>& before);

  /// The runs of a batch in the order they were sent, without models.
  Result<std::vector<ListedFit>> RunsOf(const std::string& batch);

  /// The runs that are to be done, from the first on: their ids, and that of their batch.
  struct Waiting {
    std::string id, batch;
  };
  Result<std::vector<Waiting>> WaitingRuns();

  Result<std::optional<KnownAnswer>> FindAnswer(const std::string& key);

 private:
  std::unique_ptr<State> state_;
};

}  // namespace pendulum
