// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pendulum {

// The page of the fitting service is three files, built from src/web/service: its content security policy forbids
// inline scripts and styles.

/// The bytes of src/web/dist/service.html, which loads /app.js and /app.css; @FLAGS@ stands for the flags of its forms.
std::string_view ServicePage();

/// The bytes of src/web/dist/app.js.
std::string_view ServiceScript();

/// The bytes of src/web/dist/app.css.
std::string_view ServiceStyle();

}  // namespace pendulum
