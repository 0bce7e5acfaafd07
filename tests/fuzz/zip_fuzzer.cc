// SPDX-License-Identifier: Apache-2.0
// Zip files; what is in them is text more often than not.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pendulum::CheckRecording(pendulum::TextOf(data, size));
  return 0;
}
