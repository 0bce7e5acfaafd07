// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <tl/expected.hpp>

/// The two ways to pass an error on, named as in Abseil and Arrow. Both return it from the calling function, whose
/// return value is a Result too. They are statements: an `if` needs braces around them. No public header includes this
/// one, so the macros stay out of programs that use the library (tests/check_floors.py).

// NOLINTBEGIN(cppcoreguidelines-macro-usage, bugprone-macro-parentheses): only a macro can return from its caller

/// Passes on the error of a Result whose value is not needed: RETURN_IF_ERROR(CheckOutputs(files));
#define RETURN_IF_ERROR(...)                                                                             \
  do {                                                                                                   \
    if (auto returned_ = (__VA_ARGS__); !returned_) return tl::unexpected(std::move(returned_).error()); \
  } while (false)

/// Declares a variable with the value of a Result, or passes on its error:
/// ASSIGN_OR_RETURN(const std::string text, ReadFile(path, "rig", kMaxJsonBytes));
#define ASSIGN_OR_RETURN(declaration, ...) \
  PENDULUM_ASSIGN_OR_RETURN(PENDULUM_NAME_OF_LINE(__LINE__), declaration, __VA_ARGS__)

#define PENDULUM_ASSIGN_OR_RETURN(result, declaration, ...)      \
  auto result = (__VA_ARGS__);                                   \
  if (!result) return tl::unexpected(std::move(result).error()); \
  declaration = *std::move(result)
#define PENDULUM_NAME_OF_LINE(line) PENDULUM_NAME_OF_LINE_NUMBER(line)
#define PENDULUM_NAME_OF_LINE_NUMBER(number) result_of_line_##number

// NOLINTEND(cppcoreguidelines-macro-usage, bugprone-macro-parentheses)
