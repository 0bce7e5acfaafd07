// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pendulum {

/// A recording to try the service with.
struct Example {
  std::string_view name;   ///< In paths.
  std::string_view title;  ///< "A run to rest"
  std::string_view about;
  std::string_view models;     ///< As --model.
  std::string_view recording;  ///< CSV
  std::string_view rig;        ///< JSON; empty for none.
};

/// Some of datasets/, each with a truth that a fit should find.
std::span<const Example> Examples();

/// openapi.json with the schema of results in it.
std::string OpenApiDocument();

// Files as they are, embed_file.cmake's: the page of src/report/page/dist, openapi.json and what belongs into it,
// recordings and rigs of datasets/.
std::string_view ServicePage();
std::string_view ServiceScript();
std::string_view ServiceStyle();
std::string_view OpenApiTemplate();
std::string_view ResultSchema();
std::string_view CoulombRecording();
std::string_view TextbookRecording();
std::string_view TextbookRig();
std::string_view RecordedRecording();
std::string_view RecordedRig();

}  // namespace pendulum
