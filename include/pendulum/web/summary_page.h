// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace pendulum {

/// The summary of a batch of refitted runs as one HTML file that needs no network: the page built from src/web/summary,
/// with the JSON embedded. summary: as include/pendulum/report/summary.schema.json describes it.
std::string SummaryHtml(const nlohmann::ordered_json& summary);

}  // namespace pendulum
