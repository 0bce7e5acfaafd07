// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// MATLAB values that occur in objects, independent of the file version.
namespace pendulum {

/// One array.
struct MatValue {
  enum class Kind {
    kNumbers,    // Real and full.
    kText,       // In ASCII, with ? for other letters.
    kCells,      // `parts` are the cells.
    kStructure,  // `parts` are the fields, element by element.
    kObject,     // `text` is the class, `numbers` identify it (ObjectsOf).
    kOther,      // Not needed, or damaged.
  };
  Kind kind = Kind::kOther;
  std::vector<std::size_t> sizes;  // In MATLAB's order.
  std::vector<double> numbers;     // In MATLAB's order.
  std::string text;
  std::vector<std::string> names;  // Names of fields.
  std::vector<MatValue> parts;

  /// Whether it is known to be empty.
  bool IsEmpty() const;
  /// The field of this name in a structure of one element; otherwise nullptr.
  const MatValue* Field(std::string_view name) const;
};

/// Maximum nesting depth of values.
inline constexpr int kDeepestValue = 16;

/// The ASCII letter for MATLAB's code; ? for others.
char AsciiLetter(double letter);

/// Number of elements of an array with these sizes; std::nullopt if it is impossibly large.
std::optional<std::size_t> CountIn(const std::vector<std::size_t>& sizes);

/// The objects that replace a value, numbered from 1 in their file, and their class.
struct MatObjects {
  std::vector<std::size_t> objects;
  std::size_t class_id = 0;
};

/// Decodes a column of 0xDD000000, number of sizes, sizes, objects and class; std::nullopt for any other value.
std::optional<MatObjects> ObjectsOf(const MatValue& value);

/// A place in a file's variables that refers to an object.
struct MatReference {
  std::string place;  // In MATLAB's notation: `run.angle`, `runs(2)`, `logs{1}`.
  std::string class_name;
  std::size_t object = 0;  // 0: unknown.
};

/// Adds the references to objects in the variable `name`, at most about a hundred thousand in all.
void AddReferences(const MatValue& value, const std::string& name, std::vector<MatReference>& references);

}  // namespace pendulum
