// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/text/sample_rate_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>

#include "recording/readers/columns/column.h"
#include "recording/readers/columns/csv.h"

namespace pendulum::csv {
namespace {

constexpr std::array<std::string_view, 14> kRates = {"fs",
                                                     "fps",
                                                     "sample rate",
                                                     "samplerate",
                                                     "sampling rate",
                                                     "sampling frequency",
                                                     "sample freq",
                                                     "samples per s",
                                                     "abtastrate",
                                                     "abtastfrequenz",
                                                     "frame rate",
                                                     "framerate",
                                                     "bildrate",
                                                     "sample frequency"};
constexpr std::array<std::string_view, 7> kSteps = {
    "dt", "interval", "sample interval", "sampling interval", "sample time", "sample step", "abtastintervall"};

/// A name and the unit at its end: `Sample Rate (Hz)`, `interval_ms`.
struct Key {
  std::string name, unit;
};

Key SplitKey(std::string_view text) {
  std::string plain = PlainName(Trim(Unquote(text)));
  std::ranges::replace_if(
      plain, [](char c) { return c == '_' || c == '(' || c == '['; }, ' ');
  std::erase_if(plain, [](char c) { return c == ')' || c == ']'; });
  const std::string_view name = Trim(plain);
  const std::size_t blank = name.rfind(' ');
  const std::string_view last = blank == std::string_view::npos ? "" : name.substr(blank + 1);
  const bool is_unit = last == "hz" || last == "khz" || last == "s" || last == "ms" || last == "us" || last == "sec";
  if (!is_unit) return {std::string(name), ""};
  return {std::string(Trim(name.substr(0, blank))), std::string(last)};
}

template <std::size_t N>
bool Has(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

double SampleRateIn(std::string_view line) {
  const std::size_t mark = line.find_first_of(":=,;\t");
  if (mark == std::string_view::npos) return 0;
  const Key key = SplitKey(line.substr(0, mark));
  const bool is_rate = Has(kRates, key.name);
  if (!is_rate && !Has(kSteps, key.name)) return 0;
  const std::string_view value = Unquote(line.substr(mark + 1));
  double number = 0;
  const auto [end, error] = Numbers(true).From(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || !(number > 0) || !std::isfinite(number)) return 0;
  std::string unit = PlainName(Trim(value.substr(static_cast<std::size_t>(end - value.data()))));
  if (unit.empty()) unit = key.unit;
  if (is_rate) return unit.empty() || unit == "hz" || unit == "fps" ? number : unit == "khz" ? 1000 * number : 0;
  const Unit* time = UnitOfText(unit.empty() ? "s" : unit);
  return time != nullptr && time->kind == Kind::kTime ? 1 / time->ToSi(number) : 0;
}

}  // namespace pendulum::csv
