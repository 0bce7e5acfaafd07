// SPDX-License-Identifier: Apache-2.0
#include "service/service_metrics.h"

#include <fstream>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include "pendulum/base/version.h"

namespace pendulum {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

/// Bounds of the histograms of answers and fits, s. A short fit takes some ten milliseconds, the longest one that a
/// request may take by default 30 s.
const std::vector<double> kSeconds = {0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60};

double Seconds(std::chrono::duration<double> time) { return time.count(); }

/// Resident memory of the process in bytes.
double ResidentBytes() {
  std::ifstream statm("/proc/self/statm");
  double all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// CPU time of the process in seconds.
double CpuSeconds() {
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Outcome of a fit from its exit code.
std::string_view OutcomeOf(int exit_code) {
  return exit_code == 0 ? "converged" : exit_code == 1 ? "not_converged" : "failed";
}

}  // namespace

struct ServiceMetrics::State {
  Gauge& AddGauge(const std::string& name, const std::string& help) {
    return BuildGauge().Name(name).Help(help).Register(registry).Add({});
  }

  /// A counter without labels. Text copies the values that are counted elsewhere.
  Counter& AddCounter(const std::string& name, const std::string& help) {
    return BuildCounter().Name(name).Help(help).Register(registry).Add({});
  }

  prometheus::Registry registry;
  Family<Counter>& answers =
      BuildCounter().Name("pendulum_http_requests_total").Help("Answered requests.").Register(registry);
  Family<Histogram>& answer_seconds = BuildHistogram()
                                          .Name("pendulum_http_request_duration_seconds")
                                          .Help("Time from a request's first byte to the last byte of its answer.")
                                          .Register(registry);
  Family<Counter>& fits = BuildCounter().Name("pendulum_fits_total").Help("Fits that were made.").Register(registry);
  Family<Histogram>& fit_seconds =
      BuildHistogram().Name("pendulum_fit_duration_seconds").Help("Time that a fit took.").Register(registry);
  Gauge& connections = AddGauge("pendulum_http_open_connections", "Open connections.");
  Gauge& waiting = AddGauge("pendulum_http_requests_waiting", "Requests that wait for a thread.");
  Gauge& running = AddGauge("pendulum_http_requests_running", "Requests in progress.");
  Gauge& streams = AddGauge("pendulum_http_event_streams", "Open streams of events.");
  Gauge& buffered = AddGauge("pendulum_http_buffered_bytes", "Bodies of requests in memory.");
  Gauge& batch_runs = AddGauge("pendulum_batch_runs_waiting", "Runs of batches that wait.");
  Counter& retries = AddCounter("pendulum_batch_retried_runs_total",
                                "How often a run of a batch had to wait because the store was not available.");
  Gauge& resident = AddGauge("process_resident_memory_bytes", "Resident memory of the process.");
  Counter& cpu = AddCounter("process_cpu_seconds_total", "Processor time of the process.");
  Counter& accepted = AddCounter("pendulum_http_connections_total", "Connections that were accepted.");
  Counter& refused =
      AddCounter("pendulum_http_requests_refused_total", "Requests that were dropped before they were processed.");

  std::mutex mutex;  // for `server` and for the counters that Text copies
  std::function<ServerCounts()> server;
};

ServiceMetrics::ServiceMetrics() : state_(std::make_unique<State>()) {
  BuildGauge()
      .Name("pendulum_build_info")
      .Help("The program's version.")
      .Register(state_->registry)
      .Add({{"version", std::string(kVersion)}})
      .Set(1);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  state_->AddGauge("process_start_time_seconds", "When the process began, since the epoch.").Set(Seconds(now));
}

ServiceMetrics::~ServiceMetrics() = default;

void ServiceMetrics::CountAnswer(const std::string& method, const std::string& route, int status,
                                 std::chrono::microseconds time) {
  state_->answers.Add({{"method", method}, {"route", route}, {"status", std::to_string(status)}}).Increment();
  state_->answer_seconds.Add({{"route", route}}, kSeconds).Observe(Seconds(time));
}

void ServiceMetrics::CountFit(const std::string& kind, int exit_code, std::chrono::steady_clock::duration time) {
  state_->fits.Add({{"kind", kind}, {"outcome", std::string(OutcomeOf(exit_code))}}).Increment();
  state_->fit_seconds.Add({{"kind", kind}}, kSeconds).Observe(Seconds(time));
}

void ServiceMetrics::CountRetry() { state_->retries.Increment(); }

void ServiceMetrics::set_server(std::function<ServerCounts()> counts) {
  const std::scoped_lock lock(state_->mutex);
  state_->server = std::move(counts);
}

std::string ServiceMetrics::Text(std::size_t waiting) {
  const std::scoped_lock lock(state_->mutex);
  const ServerCounts counts = state_->server ? state_->server() : ServerCounts{};
  const auto set = [](Gauge& gauge, std::size_t value) { gauge.Set(static_cast<double>(value)); };
  const auto raise = [](Counter& counter, double value) { counter.Increment(value - counter.Value()); };
  set(state_->connections, counts.connections);
  set(state_->waiting, counts.waiting);
  set(state_->running, counts.running);
  set(state_->streams, counts.streams);
  set(state_->buffered, counts.buffered);
  set(state_->batch_runs, waiting);
  state_->resident.Set(ResidentBytes());
  raise(state_->cpu, CpuSeconds());
  raise(state_->accepted, static_cast<double>(counts.accepted));
  raise(state_->refused, static_cast<double>(counts.refused));
  return prometheus::TextSerializer().Serialize(state_->registry.Collect());
}

}  // namespace pendulum
