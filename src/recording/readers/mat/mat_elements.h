// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/mat/mat_value.h"

/// The elements of MAT-files of version 5 ("MAT-File Format", The MathWorks). The bytes are not trusted.
namespace pendulum {

inline constexpr std::uint32_t kMatrixElement = 14, kPackedElement = 15;  ///< Types of elements.
inline constexpr std::uint32_t kCellClass = 1, kStructureClass = 2, kTextClass = 4, kUint8Class = 9,
                               kOpaqueClass = 17;  ///< Classes of matrices.

/// Bytes and the type of their numbers.
struct MatElement {
  std::uint32_t type = 0;
  std::string_view bytes;
};

/// A sequence of elements.
class MatElements {
 public:
  /// `is_swapped`: the byte order of numbers differs from this machine's.
  MatElements(std::string_view bytes, bool is_swapped) : bytes_(bytes), is_swapped_(is_swapped) {}

  /// std::nullopt at the end, or if the bytes end within an element.
  std::optional<MatElement> Next();
  /// The bytes of the next element, which must have this type; std::nullopt otherwise.
  std::optional<std::string_view> Next(std::uint32_t type);

  std::size_t at() const { return at_; }  // Position of the next element.
  bool IsAtEnd() const { return at_ >= bytes_.size(); }
  bool is_swapped() const { return is_swapped_; }

 private:
  std::string_view bytes_;
  bool is_swapped_;
  std::size_t at_ = 0;
};

/// The header of a matrix; `contents` are its further elements, not yet read.
struct MatMatrix {
  std::uint32_t kind = 0;  // Class of the matrix; 0: an empty element, which represents an empty matrix.
  bool is_complex = false;
  std::vector<std::size_t> sizes;
  std::string name;        // For a variable.
  std::string class_name;  // For an opaque matrix, which has no sizes.
  MatElements contents{{}, false};
};

/// Interprets the bytes as a matrix; std::nullopt if they are not one.
std::optional<MatMatrix> OpenMatrix(std::string_view bytes, bool is_swapped);

/// The 32-bit whole numbers in these bytes; std::nullopt if the number of bytes is not a multiple of 4.
std::optional<std::vector<std::uint32_t>> WordsOf(std::string_view bytes, bool is_swapped);

/// Reads the field names of a structure and leaves `contents` at the first field; std::nullopt if they are invalid.
std::optional<std::vector<std::string>> ReadFieldNames(MatElements& contents);

/// The contents of a matrix; kOther if it is damaged. Without `with_numbers` only parts that lead to objects are read.
MatValue ValueOf(MatMatrix matrix, bool with_numbers);

/// Unpacks zlib data, up to `max_bytes` bytes; std::nullopt if the data are damaged.
std::optional<std::string> Unpacked(std::string_view packed, std::size_t max_bytes);

}  // namespace pendulum
