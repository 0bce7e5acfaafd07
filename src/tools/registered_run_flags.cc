// SPDX-License-Identifier: Apache-2.0
#include "tools/registered_run_flags.h"

#include <variant>

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
    std::visit(
        [&](auto member) {
          gflags::FlagRegisterer(flag.name.data(), flag.help.c_str(), __FILE__, &(Values().*member),
                                 &(Defaults().*member));
        },
        flag.value);
  }
}

const RunFlags& RegisteredRunFlags() { return Values(); }

}  // namespace pendulum
