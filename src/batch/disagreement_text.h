// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// Names the recordings that disagree with the others of their pendulum; empty if there are none. Both the test of all
/// parameters together (RunAgreement) and the outliers of each parameter of the main law count.
std::string DisagreementText(const StoreSummary& summary);

/// How each of these recordings differs, by its id.
std::map<std::string, std::string> DifferencesById(const StoreSummary& summary);

}  // namespace pendulum
