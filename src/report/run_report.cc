// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/run_report.h"

#include <algorithm>
#include <cmath>

namespace pendulum {
namespace {

void AddOnce(const std::vector<Warning>& warnings, std::vector<Warning>& all) {
  for (const Warning& warning : warnings) {
    const bool said = std::any_of(all.begin(), all.end(), [&](const Warning& other) {
      return other.code == warning.code && other.message == warning.message;
    });
    if (!said) all.push_back(warning);
  }
}

}  // namespace

DataSummary SummarizeData(const Recording& recording, const Recording& used) {
  DataSummary data;
  data.path = recording.path;
  data.sha256 = recording.sha256;
  data.unit = used.value_unit();
  data.samples = recording.size();
  data.used_samples = used.size();
  data.from = used.time[0];
  data.to = used.time[used.size() - 1];
  data.resolution = used.resolution;
  data.resolution_source = used.resolution > 0 ? used.resolution_source : "";
  data.clock_scale = used.clock_scale;
  data.clock_scale_std_dev = used.clock_scale_std_dev;
  return data;
}

DataSummary SummarizeData(const SwingFit& fit, const ChosenSwings& swings, int release, Eigen::Index samples) {
  DataSummary data = SummarizeData(fit.used, fit.used);
  data.samples = samples;
  data.begins = fit.swing.begins;
  data.ends = fit.swing.ends;
  if (fit.swing.from_given && fit.swing.to_given) return data;
  for (const FreeSwing& swing : swings.found) data.releases.push_back({swing.from, swing.to});
  data.release = release;
  return data;
}

std::vector<Warning> AllWarnings(const RunReport& report) {
  std::vector<Warning> all;
  AddOnce(report.warnings, all);
  for (const FitReport& fit : report.fits) AddOnce(fit.warnings, all);
  return all;
}

double Correlation(const FitReport& fit, Eigen::Index row, Eigen::Index column) {
  if (row == column) return 1;
  return fit.covariance(row, column) / std::sqrt(fit.covariance(row, row) * fit.covariance(column, column));
}

}  // namespace pendulum
