// SPDX-License-Identifier: Apache-2.0
#include "service/fitter.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/version.h"
#include "pendulum/batch/provenance.h"
#include "pendulum/report/json.h"

namespace pendulum {
namespace {

std::string HashOf(const std::string& bytes) { return Sha256(bytes).value_or(""); }

std::string HashOf(const SharedFile& file) { return file ? HashOf(file->bytes) : ""; }

Provenance ProvenanceOf(const IdentifyOptions& options, const RunFiles& files) {
  return {HashOf(files.data.bytes),     HashOf(files.rig),     HashOf(files.calibration),
          HashOf(OptionsJson(options)), std::string(kVersion), CpuType()};
}

Status TookTooLong(std::chrono::milliseconds limit) {
  return {StatusCode::kTryAgain,
          "the fit was not done after " + NumberText(std::chrono::duration<double>(limit).count()) +
              " s, the time limit of this service; choose fewer models, a shorter window (from, to) or intervals by "
              "covariance, or use fit_pendulum"};
}

Status Cancelled() { return {StatusCode::kTryAgain, "the fit was cancelled; send it again if it is still wanted"}; }

}  // namespace

/// An exception is a bug or lack of memory and fails only this run.
FinishedRun Fitter::Fit(const IdentifyOptions& asked, RunFiles files, const std::stop_token& unwanted) {
  FinishedRun fitted;
  try {
    fitted.outcome.provenance = ProvenanceOf(asked, files);
    fitted.outcome.models = asked.models;
    FitInto(asked, std::move(files), unwanted, fitted);
  } catch (const std::exception& error) {
    fitted.error = {StatusCode::kInternal, std::string("internal error: ") + error.what()};
  }
  if (!fitted.error) return fitted;
  fitted.run = nullptr;
  fitted.outcome.result = nullptr;
  fitted.outcome.exit_code = ExitCode(fitted.error->code);
  fitted.outcome.reason = ReasonOf(*fitted.error);
  return fitted;
}

void Fitter::FitInto(const IdentifyOptions& asked, RunFiles files, const std::stop_token& unwanted,
                     FinishedRun& fitted) {
  const TimeLimit::Watch watch(limit_, unwanted);
  IdentifyOptions options = asked;
  options.fit.stop = watch.token();
  Result<Identification> run = IdentifyBytes(options, std::move(files));
  fitted.is_stopped = watch.token().stop_requested() && !run;
  if (!run) {
    if (!fitted.is_stopped) {
      fitted.error = run.error();
    } else {
      fitted.error = unwanted.stop_requested() ? Cancelled() : TookTooLong(limit());
    }
    return;
  }
  run->recordings.front().data.path.clear();
  fitted.outcome.exit_code = ExitCode(*run);
  fitted.outcome.result = ToJson(*run);
  fitted.run = std::make_shared<const Identification>(*std::move(run));
}

Result<std::shared_ptr<const Identification>> Fitter::FitOf(const std::string& id, const IdentifyOptions& options,
                                                            RunFiles files, const std::stop_token& unwanted) {
  if (auto run = Find(id)) return run;
  FinishedRun fitted = Fit(options, std::move(files), unwanted);
  if (fitted.error) return tl::unexpected(*fitted.error);
  Remember(id, fitted.run);
  return fitted.run;
}

void Fitter::Remember(const std::string& id, std::shared_ptr<const Identification> run) {
  const std::int64_t samples = run->recordings.front().used.size();
  if (samples > max_remembered_) return;
  const std::scoped_lock lock(mutex_);
  std::erase_if(remembered_, [&](const Remembered& other) { return other.id == id; });
  remembered_.push_front({id, std::move(run), samples});
  std::int64_t total = 0;
  const auto too_many = std::ranges::find_if(
      remembered_, [&](const Remembered& one) { return (total += one.samples) > max_remembered_; });
  remembered_.erase(too_many, remembered_.end());
}

std::shared_ptr<const Identification> Fitter::Find(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  const auto found = std::ranges::find(remembered_, id, &Remembered::id);
  if (found == remembered_.end()) return nullptr;
  remembered_.splice(remembered_.begin(), remembered_, found);
  return remembered_.front().run;
}

}  // namespace pendulum
