// SPDX-License-Identifier: Apache-2.0
// The output of the process that reads a MAT-file, and the choice among its columns.
#include <cstddef>
#include <cstdint>

#include "recording/readers/mat/mat_columns.h"
#include "recording/readers/mat/mat_recording.h"
#include "tests/fuzz/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = pendulum::TextOf(data, size);
  const pendulum::MatTable table = pendulum::UnpackMatTable(text.substr(0, size - 1));
  const std::string packed = pendulum::Pack(table);
  pendulum::Require(pendulum::Pack(pendulum::UnpackMatTable(packed)) == packed);
  pendulum::CheckResult(pendulum::FromMatTable(table, text, "a.csv", pendulum::Options(text.back())));
  return 0;
}
