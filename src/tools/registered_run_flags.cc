// SPDX-License-Identifier: Apache-2.0
#include "tools/registered_run_flags.h"

#include <string>

#include <gflags/gflags.h>

namespace pendulum {
namespace {

// gflags keeps pointers to both.
RunFlags& Values() {
  static RunFlags values;
  return values;
}

RunFlags& Defaults() {
  static RunFlags defaults;
  return defaults;
}

}  // namespace

void RegisterRunFlags() {
  for (const RunFlag& flag : RunFlagTable()) {
    gflags::FlagRegisterer(flag.name.data(), flag.help.c_str(), __FILE__, &(Values().*flag.value),
                           &(Defaults().*flag.value));
  }
}

const RunFlags& RegisteredRunFlags() { return Values(); }

}  // namespace pendulum
