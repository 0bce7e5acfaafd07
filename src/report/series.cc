// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/series.h"

#include <cmath>
#include <cstddef>

#include "pendulum/base/format.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

void AppendNumber(double value, std::string& text) {
  if (std::isfinite(value)) text += NumberText(value);
}

}  // namespace

std::string ToResidualCsv(const Recording& used, const FitReport& fit) {
  constexpr std::size_t kTypicalLine = 80;  // bytes
  const std::string suffix = "_" + KeySuffix(used.value_unit());
  std::string text = "time_s,measured" + suffix + ",fitted" + suffix + ",residual" + suffix + "\n";
  text.reserve(kTypicalLine * static_cast<std::size_t>(used.size() + 1));
  const bool fitted = fit.fitted.size() == used.size() && fit.residual.size() == used.size();
  for (Eigen::Index i = 0; i < used.size(); ++i) {
    AppendNumber(used.time[i], text);
    text += ',';
    AppendNumber(used.value[i], text);
    text += ',';
    if (fitted) AppendNumber(fit.fitted[i], text);
    text += ',';
    if (fitted) AppendNumber(fit.residual[i], text);
    text += '\n';
  }
  return text;
}

}  // namespace pendulum
