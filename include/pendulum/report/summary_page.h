// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace pendulum {

/// The summary of a batch of refitted runs as one HTML file without external resources: the page of src/report/page
/// with the JSON (summary.schema.json) embedded.
std::string SummaryHtml(const nlohmann::ordered_json& summary);

}  // namespace pendulum
