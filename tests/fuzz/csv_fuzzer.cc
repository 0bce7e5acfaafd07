// SPDX-License-Identifier: Apache-2.0
// Rows of text in our format and in the formats that other programs export.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::CheckRecording(pendulum::TextOf(data, size));
  return 0;
}
