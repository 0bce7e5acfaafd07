// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// SQL of the view `results`: one row for each refitted run, with the parameters of its recommended law, or of its only
/// law. It is not a migration, because it has a column for every parameter that the program knows.
std::string ResultsView();

}  // namespace pendulum
