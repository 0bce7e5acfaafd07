// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/calibration/calibration_source.h"

#include <algorithm>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/recording/calibration/calibration_table.h"
#include "recording/readers/content.h"

namespace pendulum {
namespace {

/// Whether the text is meant as JSON. A table begins with a name of a column or a comment.
bool IsJson(std::string_view text) {
  text = WithoutByteOrderMark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos || text[first] == '{' || text[first] == '[';
}

std::string NoteOn(const CalibrationTable& table, const CalibrationFit& fit) {
  std::string note = "the calibration is a straight line through the " + std::to_string(table.size()) + " points of " +
                     table.path + ": slope " + NumberText(fit.calibration.coefficients[1], 4) + " " + table.angle_unit +
                     " per " + (table.input == "counts" ? "count" : "volt");
  if (fit.calibration.residual_std_dev) {
    note +=
        ", residual standard deviation " + NumberText(*fit.calibration.residual_std_dev, 2) + " " + table.angle_unit;
  }
  return note;
}

std::string DoubtOn(const CalibrationTable& table, const CalibrationFit& fit) {
  constexpr double kSmallP = 0.001;
  if (!fit.higher_order || !(fit.higher_order->p < kSmallP)) return "";
  return "a parabola fits the points of " + table.path + " better than the straight line that is used (p " +
         ProbabilityText(fit.higher_order->p) + ")";
}

}  // namespace

Result<Calibration> CalibrationFromText(std::string_view text, const std::string& name) {
  const Content content = ContentOf(text.substr(0, kContentBytes));
  if (content != Content::kText && content != Content::kReturns && content != Content::kJson) {
    return Fault(name, "this is neither CSV nor JSON in UTF-8; save the table of the calibration as CSV");
  }
  if (IsJson(text)) return ParseCalibration(text, name);
  std::string lines(text);
  if (content == Content::kReturns) std::ranges::replace(lines, '\r', '\n');
  Result<CalibrationTable> table = ParseCalibrationTable(lines, name);
  if (!table) {
    table.error().sentence +=
        ". A calibration is JSON, or a table with a column of counts or volts and a column of angles, such as "
        "adc_counts,angle_deg";
    return tl::unexpected(std::move(table).error());
  }
  ASSIGN_OR_RETURN(CalibrationFit fit, CalibrateSensor(*table, 1));
  fit.calibration.note = NoteOn(*table, fit);
  fit.calibration.doubt = DoubtOn(*table, fit);
  return std::move(fit.calibration);
}

Result<Calibration> CalibrationFromFile(const std::filesystem::path& path) {
  ASSIGN_OR_RETURN(const std::string text, ReadFile(path, "calibration", kMaxJsonBytes));
  return CalibrationFromText(text, path.string());
}

}  // namespace pendulum
