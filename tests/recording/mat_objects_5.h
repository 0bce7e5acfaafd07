// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <zlib.h>

#include "tests/recording/mat_objects.h"

/// Files of version 5 with objects.
namespace pendulum::objects {

/// Byte order and compression of a file of version 5.
struct Form {
  bool is_big = false, is_packed = false;
};

class Writer5 {
 public:
  explicit Writer5(Form form) : form_(form) {}

  std::string File5(const File& file) const {
    std::string bytes = "MATLAB 5.0 MAT-file, Platform: GLNXA64, Created on: Mon Mar  2 10:00:00 2026";
    bytes.resize(116, ' ');
    std::string body;
    for (const auto& [name, array] : file.variables()) body += TopLevel(Matrix(array, name));
    const std::size_t place = 128 + body.size();
    bytes += Bytes(place, 8, form_.is_big) + Bytes(0x0100, 2, form_.is_big) + (form_.is_big ? "MI" : "IM");
    return bytes + body + TopLevel(Matrix(Subsystem(file), ""));
  }

 private:
  static constexpr std::uint32_t kInt8 = 1, kUint8 = 2, kUint16 = 4, kInt32 = 5, kUint32 = 6, kDouble = 9, kMatrix = 14,
                                 kPacked = 15;

  std::string Word(std::uint64_t number) const { return Bytes(number, 4, form_.is_big); }

  std::string Element(std::uint32_t type, const std::string& bytes) const {
    if (!bytes.empty() && bytes.size() <= 4 && type != kMatrix) {  // size and type share a word
      return Word(bytes.size() << 16 | type) + bytes + std::string(4 - bytes.size(), '\0');
    }
    return Word(type) + Word(bytes.size()) + bytes + std::string((8 - bytes.size() % 8) % 8, '\0');
  }

  std::string TopLevel(const std::string& element) const {
    if (!form_.is_packed) return element;
    uLongf size = compressBound(element.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(element.data()),
             element.size());
    return Word(kPacked) + Word(size) + packed.substr(0, size);
  }

  static std::uint32_t ClassOf(const std::string& kind) {
    const std::vector<std::string> kinds = {"cell", "struct", "",      "char",   "",      "double", "single",
                                            "int8", "uint8",  "int16", "uint16", "int32", "uint32"};
    return static_cast<std::uint32_t>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin() + 1);
  }

  std::string Data(const Array& array) const {
    std::string bytes;
    if (array.kind == "char") {
      for (const char letter : array.text) bytes += Bytes(static_cast<unsigned char>(letter), 2, form_.is_big);
      return Element(kUint16, bytes);
    }
    const bool is_byte = array.kind == "uint8", is_double = array.kind == "double";
    for (const double number : array.numbers) {
      bytes += is_double ? Bytes(std::bit_cast<std::uint64_t>(number), 8, form_.is_big)
                         : Bytes(static_cast<std::uint32_t>(number), is_byte ? 1 : 4, form_.is_big);
    }
    return Element(is_double ? kDouble : is_byte ? kUint8 : kUint32, bytes);
  }

  std::string Opaque(const std::string& name, const std::string& class_name, const Array& contents) const {
    return Element(kMatrix, Element(kUint32, Word(17) + Word(0)) + Element(kInt8, name) + Element(kInt8, "MCOS") +
                                Element(kInt8, class_name) + Matrix(contents, ""));
  }

  std::string Matrix(const Array& array, const std::string& name) const {
    constexpr std::size_t kNameBytes = 32;
    if (array.kind == "object") {
      return Opaque(name, array.text, Numbers(array.sizes, array.numbers, "uint32"));
    }
    std::string sizes;
    for (const std::size_t size : array.sizes) sizes += Word(size);
    std::string bytes =
        Element(kUint32, Word(ClassOf(array.kind)) + Word(0)) + Element(kInt32, sizes) + Element(kInt8, name);
    if (array.kind == "wrapper") return Opaque(name, "FileWrapper__", Cells(array.parts));
    if (array.kind == "struct") {
      std::string names;
      for (const std::string& field : array.names) {
        names += field;
        names.resize((names.size() + kNameBytes - 1) / kNameBytes * kNameBytes);
      }
      bytes += Element(kInt32, Word(kNameBytes)) + Element(kInt8, names);
    }
    for (const Array& part : array.parts) bytes += Matrix(part, "");
    return Element(kMatrix, array.kind == "struct" || array.kind == "cell" ? bytes : bytes + Data(array));
  }

  Array Subsystem(const File& file) const {
    Array wrapper;
    wrapper.kind = "wrapper";
    wrapper.parts = file.AllCells(form_.is_big);
    const std::string bytes = Bytes(0x0100, 2, form_.is_big) + (form_.is_big ? "MI" : "IM") + std::string(4, '\0') +
                              Matrix(Struct({{"MCOS", wrapper}}), "");
    Array array = Numbers({1, bytes.size()}, {}, "uint8");
    for (const char byte : bytes) array.numbers.push_back(static_cast<unsigned char>(byte));
    return array;
  }

  Form form_;
};

inline std::string Version5(const File& file, Form form = {}) { return Writer5(form).File5(file); }

}  // namespace pendulum::objects
