// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_subsystem.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "recording/readers/mat/mat_elements.h"

namespace pendulum {
namespace {

constexpr std::size_t kMatHeaderBytes = 128, kMatOrderBytes = 2;

/// Whether numbers of a file or of its subsystem are byte-swapped, from its two letters; std::nullopt for other
/// letters.
std::optional<bool> IsSwapped(std::string_view order) {
  constexpr bool kIsLittle = std::endian::native == std::endian::little;
  if (order == "IM") return !kIsLittle;
  if (order == "MI") return kIsLittle;
  return std::nullopt;
}

/// The position of the subsystem. 0, or the number that blanks form, means that there is none.
std::size_t PlaceOfSubsystem(std::string_view bytes, bool is_swapped) {
  constexpr std::size_t kPlaceAt = 116, kPlaceBytes = 8;
  const auto words = WordsOf(bytes.substr(kPlaceAt, kPlaceBytes), is_swapped);
  if (!words) return 0;
  const std::uint64_t first = words->front(), second = words->back();
  const bool is_little = (std::endian::native == std::endian::little) != is_swapped;
  return is_little ? second << 32 | first : first << 32 | second;
}

/// The bytes of the matrix in an element at top level, unpacked into `room` if it is compressed. Without `all`,
/// matrices of numbers, which cannot contain objects, are not unpacked.
std::optional<MatMatrix> MatrixIn(const MatElement& element, bool is_swapped, bool all, std::string& room) {
  constexpr std::size_t kHead = 1024, kTag = 8, kMaxUnpacked = std::size_t{1} << 33;
  if (element.type == kMatrixElement) return OpenMatrix(element.bytes, is_swapped);
  if (element.type != kPackedElement) return std::nullopt;
  auto head = Unpacked(element.bytes, kHead);
  if (!head || head->size() <= kTag) return std::nullopt;
  const auto start = OpenMatrix(std::string_view(*head).substr(kTag), is_swapped);
  const std::uint32_t kind = start ? start->kind : 0;
  if (!all && kind != kOpaqueClass && kind != kStructureClass && kind != kCellClass) return std::nullopt;
  auto unpacked = Unpacked(element.bytes, kMaxUnpacked);
  if (!unpacked) return std::nullopt;
  room = *std::move(unpacked);
  const auto matrix = MatElements(room, is_swapped).Next(kMatrixElement);
  return matrix ? OpenMatrix(*matrix, is_swapped) : std::nullopt;
}

/// The bytes of the subsystem, which the file stores in a matrix of bytes, and the cells in them.
struct Cells {
  std::string bytes;
  std::vector<std::string_view> cells;
  bool is_swapped = false;
};

/// Finds the cells: the field MCOS of a structure is an opaque matrix that contains an array of cells.
bool FindCells(Cells& found) {
  constexpr std::size_t kOrderAt = 2, kHead = 8;
  const std::string_view bytes = found.bytes;
  const auto is_swapped = IsSwapped(bytes.substr(std::min(kOrderAt, bytes.size()), kMatOrderBytes));
  if (!is_swapped || bytes.size() < kHead) return false;
  found.is_swapped = *is_swapped;
  const auto first = MatElements(bytes.substr(kHead), *is_swapped).Next(kMatrixElement);
  auto structure = first ? OpenMatrix(*first, *is_swapped) : std::nullopt;
  if (!structure || structure->kind != kStructureClass || CountIn(structure->sizes) != std::size_t{1}) return false;
  const auto names = ReadFieldNames(structure->contents);
  std::optional<std::string_view> field;
  for (std::size_t i = 0; names && i < names->size(); ++i) {
    const auto each = structure->contents.Next(kMatrixElement);
    if (!each) return false;
    if ((*names)[i] == "MCOS") field = each;
  }
  auto wrapper = field ? OpenMatrix(*field, *is_swapped) : std::nullopt;
  if (!wrapper || wrapper->class_name != "FileWrapper__") return false;
  const auto inner = wrapper->contents.Next(kMatrixElement);
  auto array = inner ? OpenMatrix(*inner, *is_swapped) : std::nullopt;
  if (!array || array->kind != kCellClass) return false;
  const auto count = CountIn(array->sizes);
  while (const auto cell = array->contents.Next(kMatrixElement)) found.cells.push_back(*cell);
  return array->contents.IsAtEnd() && count == found.cells.size();
}

std::optional<Mcos> TableIn(const Cells& found) {
  auto matrix = found.cells.empty() ? std::nullopt : OpenMatrix(found.cells.front(), found.is_swapped);
  const auto bytes = matrix && matrix->kind == kUint8Class ? matrix->contents.Next() : std::nullopt;
  if (!bytes || CountIn(matrix->sizes) != bytes->bytes.size()) return std::nullopt;
  return Mcos::Read(bytes->bytes, found.cells.size());
}

void ReadSubsystem(const MatElement& element, bool is_swapped, MatSubsystem& subsystem) {
  std::string room;
  auto matrix = MatrixIn(element, is_swapped, true, room);
  const auto bytes = matrix && matrix->kind == kUint8Class ? matrix->contents.Next() : std::nullopt;
  if (!bytes) return;
  const auto found = std::make_shared<Cells>();  // Shared by copies of subsystem.cell.
  found->bytes = bytes->bytes;
  if (!FindCells(*found)) return;
  subsystem.objects = TableIn(*found);
  subsystem.cells = found->cells.size();
  subsystem.cell = [found](std::size_t i) {
    auto cell = i < found->cells.size() ? OpenMatrix(found->cells[i], found->is_swapped) : std::nullopt;
    return cell ? ValueOf(*std::move(cell), true) : MatValue{};
  };
}

}  // namespace

MatSubsystem SubsystemOf(std::string_view bytes) {
  MatSubsystem subsystem;
  if (bytes.size() < kMatHeaderBytes) return subsystem;
  const auto is_swapped = IsSwapped(bytes.substr(kMatHeaderBytes - kMatOrderBytes, kMatOrderBytes));
  if (!is_swapped) return subsystem;
  const std::size_t place = PlaceOfSubsystem(bytes, *is_swapped);
  MatElements elements(bytes.substr(kMatHeaderBytes), *is_swapped);
  for (std::size_t variables = 0; !elements.IsAtEnd(); ++variables) {
    const bool is_subsystem = elements.at() + kMatHeaderBytes == place;
    const auto element = elements.Next();
    if (!element) break;
    if (is_subsystem) {
      ReadSubsystem(*element, *is_swapped, subsystem);
      if (elements.IsAtEnd()) subsystem.variables = variables;
      continue;
    }
    std::string room;
    auto matrix = MatrixIn(*element, *is_swapped, false, room);
    if (!matrix) continue;
    const std::string name = matrix->name;
    AddReferences(ValueOf(*std::move(matrix), false), name, subsystem.references);
  }
  return subsystem;
}

}  // namespace pendulum
