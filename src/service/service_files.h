// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pendulum {

/// A recording for trying the service.
struct Example {
  std::string_view name;   ///< Used in paths.
  std::string_view title;  ///< "A run to rest"
  std::string_view about;
  std::string_view models;     ///< In the form of --model.
  std::string_view recording;  ///< CSV
  std::string_view rig;        ///< JSON; empty: none.
};

/// Recordings from datasets/ whose true values are known.
std::span<const Example> Examples();

/// openapi.json with the schema of results inserted.
std::string OpenApiDocument();

/// The service's page, with the flags of RunFlagTable that have a field in its form.
const std::string& FilledServicePage();

// Bytes of embedded files (embed_file.cmake): openapi.json and the schema it refers to, recordings and rigs of
// datasets/.
std::string_view OpenApiTemplate();
std::string_view ResultSchema();
std::string_view CoulombRecording();
std::string_view TextbookRecording();
std::string_view TextbookRig();
std::string_view RecordedRecording();
std::string_view RecordedRig();

}  // namespace pendulum
