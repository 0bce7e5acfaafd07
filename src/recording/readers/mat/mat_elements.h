// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/mat/mat_value.h"

/// The elements that MAT-files of version 5 are made of ("MAT-File Format", The MathWorks), where the bytes are
/// anybody's.
namespace pendulum {

inline constexpr std::uint32_t kMatrixElement = 14, kPackedElement = 15;  ///< Types of elements.
inline constexpr std::uint32_t kCellClass = 1, kStructureClass = 2, kTextClass = 4, kUint8Class = 9,
                               kOpaqueClass = 17;  ///< Classes of matrices.

/// Bytes, and the type of the numbers that they are.
struct MatElement {
  std::uint32_t type = 0;
  std::string_view bytes;
};

/// Elements that follow each other.
class MatElements {
 public:
  /// `is_swapped`: the order of the bytes of a number is not this machine's.
  MatElements(std::string_view bytes, bool is_swapped) : bytes_(bytes), is_swapped_(is_swapped) {}

  /// None at the end, and where the bytes end within one.
  std::optional<MatElement> Next();
  /// That of the type that has to come; none where another one comes.
  std::optional<std::string_view> Next(std::uint32_t type);

  std::size_t at() const { return at_; }  // Where the next begins.
  bool IsAtEnd() const { return at_ >= bytes_.size(); }
  bool is_swapped() const { return is_swapped_; }

 private:
  std::string_view bytes_;
  bool is_swapped_;
  std::size_t at_ = 0;
};

/// A matrix without its contents.
struct MatMatrix {
  std::uint32_t kind = 0;  // Its class; 0: an empty element, which stands for an empty matrix.
  bool is_complex = false;
  std::vector<std::size_t> sizes;
  std::string name;        // Of a variable.
  std::string class_name;  // Of an opaque one, which has no sizes.
  MatElements contents{{}, false};
};

/// The bytes of a matrix as one; none where they are not.
std::optional<MatMatrix> OpenMatrix(std::string_view bytes, bool is_swapped);

/// The whole numbers of an element; none where it holds others.
std::optional<std::vector<std::uint32_t>> WordsOf(std::string_view bytes, bool is_swapped);

/// Names of fields, from the contents of a structure up to its fields; none where they are none.
std::optional<std::vector<std::string>> TakeFieldNames(MatElements& contents);

/// What a matrix holds; kOther where it is damaged. Without `with_numbers` only what leads to objects is looked at.
MatValue ValueOf(MatMatrix matrix, bool with_numbers);

/// What zlib has packed, or the first `most` bytes of it; none where it is damaged.
std::optional<std::string> Unpacked(std::string_view packed, std::size_t most);

}  // namespace pendulum
