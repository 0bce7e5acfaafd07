// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_elements.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include <zlib.h>

namespace pendulum {
namespace {

constexpr std::uint32_t kInt8 = 1, kUint8 = 2, kInt16 = 3, kUint16 = 4, kInt32 = 5, kUint32 = 6, kSingle = 7,
                        kDouble = 9, kInt64 = 12, kUint64 = 13, kUtf8 = 16, kUtf16 = 17;  // Types of elements.
constexpr std::uint32_t kFirstNumberClass = 6, kLastNumberClass = 15;

template <typename T>
T NumberAt(const char* at, bool is_swapped) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), at, raw.size());
  if (is_swapped) std::ranges::reverse(raw);
  T number{};
  std::memcpy(&number, raw.data(), raw.size());
  return number;
}

template <typename T>
std::vector<double> Doubles(std::string_view bytes, bool is_swapped) {
  std::vector<double> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<double>(NumberAt<T>(bytes.data() + i * sizeof(T), is_swapped));
  }
  return numbers;
}

/// The numbers of an element. A matrix may store them in a smaller type than its class.
std::vector<double> NumbersIn(const MatElement& element, bool is_swapped) {
  switch (element.type) {
    case kInt8: return Doubles<std::int8_t>(element.bytes, is_swapped);
    case kUint8:
    case kUtf8: return Doubles<std::uint8_t>(element.bytes, is_swapped);
    case kInt16: return Doubles<std::int16_t>(element.bytes, is_swapped);
    case kUint16:
    case kUtf16: return Doubles<std::uint16_t>(element.bytes, is_swapped);
    case kInt32: return Doubles<std::int32_t>(element.bytes, is_swapped);
    case kUint32: return Doubles<std::uint32_t>(element.bytes, is_swapped);
    case kSingle: return Doubles<float>(element.bytes, is_swapped);
    case kDouble: return Doubles<double>(element.bytes, is_swapped);
    case kInt64: return Doubles<std::int64_t>(element.bytes, is_swapped);
    case kUint64: return Doubles<std::uint64_t>(element.bytes, is_swapped);
    default: return {};
  }
}

struct EndUnpacking {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

/// Reads the letters of a name. Their type depends on the version of MATLAB.
std::optional<std::string_view> ReadLetters(MatElements& elements) {
  const std::optional<MatElement> element = elements.Next();
  if (!element || (element->type != kInt8 && element->type != kUint8 && element->type != kUtf8)) return std::nullopt;
  return element->bytes;
}

MatValue ValueAt(MatMatrix matrix, bool with_numbers, int depth);

/// Reads the `count` matrices inside another one. Returns false if there are fewer or if data remain.
bool ReadParts(MatElements& contents, std::size_t count, bool with_numbers, int depth, MatValue& value) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<std::string_view> part = contents.Next(kMatrixElement);
    std::optional<MatMatrix> matrix = part ? OpenMatrix(*part, contents.is_swapped()) : std::nullopt;
    if (!matrix) return false;
    value.parts.push_back(ValueAt(*std::move(matrix), with_numbers, depth + 1));
  }
  return contents.IsAtEnd();
}

bool ReadCells(MatMatrix& matrix, bool with_numbers, int depth, MatValue& value) {
  const std::optional<std::size_t> count = CountIn(matrix.sizes);
  return count && ReadParts(matrix.contents, *count, with_numbers, depth, value);
}

bool ReadStructure(MatMatrix& matrix, bool with_numbers, int depth, MatValue& value) {
  std::optional<std::vector<std::string>> names = ReadFieldNames(matrix.contents);
  const std::optional<std::size_t> count = CountIn(matrix.sizes);
  if (!names || !count || (*count > 0 && names->empty())) return names && count;
  const std::optional<std::size_t> parts = CountIn({*count, names->size()});
  value.names = *std::move(names);
  return parts && ReadParts(matrix.contents, *parts, with_numbers, depth, value);
}

bool ReadNumbers(MatMatrix& matrix, MatValue& value) {
  const std::optional<std::size_t> count = CountIn(matrix.sizes);
  const std::optional<MatElement> element = matrix.contents.Next();
  if (!count || !element || matrix.is_complex) return false;
  value.numbers = NumbersIn(*element, matrix.contents.is_swapped());
  return value.numbers.size() == *count;
}

/// MATLAB writes letters in one or two bytes.
bool ReadText(MatMatrix& matrix, MatValue& value) {
  const std::optional<MatElement> element = matrix.contents.Next();
  if (!element) return false;
  for (const double letter : NumbersIn(*element, matrix.contents.is_swapped())) value.text += AsciiLetter(letter);
  return true;
}

/// A separate matrix contains the references of an opaque matrix to its objects.
bool ReadObject(MatMatrix& matrix, MatValue& value) {
  value.text = matrix.class_name;
  const std::optional<std::string_view> part = matrix.contents.Next(kMatrixElement);
  std::optional<MatMatrix> numbers = part ? OpenMatrix(*part, matrix.contents.is_swapped()) : std::nullopt;
  if (numbers && numbers->kind >= kFirstNumberClass && numbers->kind <= kLastNumberClass) ReadNumbers(*numbers, value);
  return true;
}

MatValue ValueAt(MatMatrix matrix, bool with_numbers, int depth) {
  MatValue value;
  value.sizes = matrix.sizes;
  bool is_whole = true;
  if (matrix.kind == kCellClass && depth < kDeepestValue) {
    value.kind = MatValue::Kind::kCells;
    is_whole = ReadCells(matrix, with_numbers, depth, value);
  } else if (matrix.kind == kStructureClass && depth < kDeepestValue) {
    value.kind = MatValue::Kind::kStructure;
    is_whole = ReadStructure(matrix, with_numbers, depth, value);
  } else if (matrix.kind == kOpaqueClass) {
    value.kind = MatValue::Kind::kObject;
    is_whole = ReadObject(matrix, value);
  } else if (matrix.kind == 0) {
    value.kind = MatValue::Kind::kNumbers;
    value.sizes = {0, 0};
  } else if (matrix.kind == kTextClass && with_numbers) {
    value.kind = MatValue::Kind::kText;
    is_whole = ReadText(matrix, value);
  } else if (matrix.kind >= kFirstNumberClass && matrix.kind <= kLastNumberClass && with_numbers) {
    value.kind = MatValue::Kind::kNumbers;
    is_whole = ReadNumbers(matrix, value);
  }
  if (!is_whole) return {};
  return value;
}

}  // namespace

std::optional<MatElement> MatElements::Next() {
  constexpr std::size_t kTag = 8, kWord = 4;
  if (IsAtEnd() || bytes_.size() - at_ < kTag) return std::nullopt;
  const std::string_view rest = bytes_.substr(at_);
  const auto type = NumberAt<std::uint32_t>(rest.data(), is_swapped_);
  if (const std::size_t small = type >> 16; small > 0) {  // Up to four bytes: size and type share a word.
    if (small > kWord) return std::nullopt;
    at_ += kTag;
    return MatElement{type & 0xFFFF, rest.substr(kWord, small)};
  }
  const std::size_t size = NumberAt<std::uint32_t>(rest.data() + kWord, is_swapped_);
  if (size > rest.size() - kTag) return std::nullopt;
  const std::size_t padded = type == kPackedElement ? size : (size + kTag - 1) / kTag * kTag;
  at_ += std::min(kTag + padded, rest.size());
  return MatElement{type, rest.substr(kTag, size)};
}

std::optional<std::string_view> MatElements::Next(std::uint32_t type) {
  const std::optional<MatElement> element = Next();
  if (!element || element->type != type) return std::nullopt;
  return element->bytes;
}

std::optional<std::vector<std::uint32_t>> WordsOf(std::string_view bytes, bool is_swapped) {
  constexpr std::size_t kWord = sizeof(std::uint32_t);
  if (bytes.size() % kWord != 0) return std::nullopt;
  std::vector<std::uint32_t> words(bytes.size() / kWord);
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i] = NumberAt<std::uint32_t>(bytes.data() + i * kWord, is_swapped);
  }
  return words;
}

std::optional<MatMatrix> OpenMatrix(std::string_view bytes, bool is_swapped) {
  constexpr std::uint32_t kClassBits = 0xFF, kComplexBit = 0x800;
  MatMatrix matrix;
  matrix.contents = MatElements(bytes, is_swapped);
  if (bytes.empty()) return matrix;
  const auto flags = matrix.contents.Next(kUint32);
  const auto words = flags ? WordsOf(*flags, is_swapped) : std::nullopt;
  if (!words || words->size() != 2) return std::nullopt;
  matrix.kind = words->front() & kClassBits;
  matrix.is_complex = (words->front() & kComplexBit) != 0;
  if (matrix.kind == 0) return std::nullopt;
  if (matrix.kind != kOpaqueClass) {
    const auto sizes = matrix.contents.Next(kInt32);
    const auto numbers = sizes ? WordsOf(*sizes, is_swapped) : std::nullopt;
    if (!numbers || numbers->size() < 2) return std::nullopt;
    matrix.sizes.assign(numbers->begin(), numbers->end());
  }
  const auto name = ReadLetters(matrix.contents);
  if (!name) return std::nullopt;
  matrix.name = *name;
  if (matrix.kind != kOpaqueClass) return matrix;
  const auto system = ReadLetters(matrix.contents);
  const auto class_name = ReadLetters(matrix.contents);
  if (!system || !class_name) return std::nullopt;
  matrix.class_name = *class_name;
  return matrix;
}

std::optional<std::vector<std::string>> ReadFieldNames(MatElements& contents) {
  const auto length = contents.Next(kInt32);
  const auto words = length ? WordsOf(*length, contents.is_swapped()) : std::nullopt;
  const auto letters = ReadLetters(contents);
  if (!words || words->size() != 1 || words->front() == 0 || !letters) return std::nullopt;
  const std::size_t step = words->front();
  if (letters->size() % step != 0) return std::nullopt;
  std::vector<std::string> names;
  for (std::size_t at = 0; at < letters->size(); at += step) {
    const std::string_view name = letters->substr(at, step);
    names.emplace_back(name.substr(0, name.find('\0')));
  }
  return names;
}

MatValue ValueOf(MatMatrix matrix, bool with_numbers) { return ValueAt(std::move(matrix), with_numbers, 0); }

std::optional<std::string> Unpacked(std::string_view packed, std::size_t max_bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 16, kMaxRoom = std::size_t{1} << 30;
  std::string bytes;
  z_stream stream{};
  if (packed.size() > UINT32_MAX || inflateInit(&stream) != Z_OK) return std::nullopt;
  const std::unique_ptr<z_stream, EndUnpacking> end(&stream);
  // zlib uses unsigned bytes and does not write to its input.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // NOLINT
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  std::size_t used = 0;
  while (state == Z_OK && used < max_bytes) {
    bytes.resize(std::min(max_bytes, std::max(2 * used, kBlock)));
    const std::size_t room = std::min(bytes.size() - used, kMaxRoom);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + used);  // NOLINT
    stream.avail_out = static_cast<uInt>(room);
    state = inflate(&stream, Z_NO_FLUSH);
    used += room - stream.avail_out;
  }
  bytes.resize(used);
  if (state != Z_STREAM_END && used < max_bytes) return std::nullopt;
  return bytes;
}

}  // namespace pendulum
