// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Values of MATLAB's as objects are made of them, whichever way the file keeps them.
namespace pendulum {

/// One array.
struct MatValue {
  enum class Kind {
    kNumbers,    // Real and full.
    kText,       // In ASCII, with ? for other letters.
    kCells,      // `parts` are the cells.
    kStructure,  // `parts` are the fields of each element after those of the one before.
    kObject,     // `text` is the class, `numbers` tell which (ObjectsOf).
    kOther,      // What is not needed, or damaged.
  };
  Kind kind = Kind::kOther;
  std::vector<std::size_t> sizes;  // In MATLAB's order.
  std::vector<double> numbers;     // In MATLAB's order.
  std::string text;
  std::vector<std::string> names;  // Of fields.
  std::vector<MatValue> parts;

  /// That there is nothing in it, as far as one can tell.
  bool IsEmpty() const;
  /// The field of a structure of one element, else nullptr.
  const MatValue* Field(std::string_view name) const;
};

/// How deep values may be within each other.
inline constexpr int kDeepestValue = 16;

/// A letter as MATLAB numbers it, in ASCII, with ? for others.
char AsciiLetter(double letter);

/// Elements of an array of these sizes; none where there cannot be so many.
std::optional<std::size_t> CountIn(const std::vector<std::size_t>& sizes);

/// The objects, numbered from 1 on in their file, that stand in the place of a value, and their class.
struct MatObjects {
  std::vector<std::size_t> objects;
  std::size_t class_id = 0;
};

/// What a column 0xDD000000, number of sizes, sizes, objects, class refers to; none where it is not one.
std::optional<MatObjects> ObjectsOf(const MatValue& value);

/// A place in a file's variables where an object stands.
struct MatReference {
  std::string place;  // As MATLAB writes it: `run.angle`, `runs(2)`, `logs{1}`.
  std::string class_name;
  std::size_t object = 0;  // 0: not to be told.
};

/// Adds the objects in a variable of this name, at most a hundred thousand.
void AddReferences(const MatValue& value, const std::string& name, std::vector<MatReference>& references);

}  // namespace pendulum
