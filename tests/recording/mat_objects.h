// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Objects for tests in MATLAB's file format. They follow what is known of MATLAB's files, independently of the reader.
/// This file contains the parts common to all versions.
namespace pendulum::objects {

/// A MATLAB array: "double", "uint32", "char", "cell", "struct", or "object" with the class in `text`.
struct Array {
  std::string kind = "double";
  std::vector<std::size_t> sizes;
  std::vector<double> numbers;
  std::string text;
  std::vector<std::string> names;  // Names of a structure's fields.
  std::vector<Array> parts;        // Fields of a structure, or cells of an array.
};

using Fields = std::vector<std::pair<std::string, Array>>;

inline Array Numbers(std::vector<std::size_t> sizes, std::vector<double> numbers, const std::string& kind = "double") {
  return {kind, std::move(sizes), std::move(numbers), {}, {}, {}};
}
inline Array Number(double number) { return Numbers({1, 1}, {number}); }
inline Array Nothing() { return Numbers({0, 0}, {}); }
inline Array Letters(const std::string& text) {
  return {"char", {text.empty() ? std::size_t{0} : 1, text.size()}, {}, text, {}, {}};
}
inline Array Cells(std::vector<Array> cells) { return {"cell", {cells.size(), 1}, {}, {}, {}, std::move(cells)}; }
inline Array Struct(const Fields& fields) {
  Array array{"struct", {1, 1}, {}, {}, {}, {}};
  for (const auto& [name, field] : fields) {
    array.names.push_back(name);
    array.parts.push_back(field);
  }
  return array;
}

/// A number in `size` bytes of either order.
inline std::string Bytes(std::uint64_t number, std::size_t size, bool is_big) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i);
  if (is_big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Variables and the objects to which they refer.
class File {
 public:
  /// `version` of the table: 2, 3 or 4. After the values of properties, version - 2 additional cells follow.
  explicit File(int version = 4) : version_(version) {}

  std::size_t AddClass(const std::string& package, const std::string& name, const Fields& defaults = {}) {
    classes_.push_back({package.empty() ? 0 : NameOf(package), NameOf(name)});
    full_names_.push_back(package.empty() ? name : package + "." + name);
    defaults_.push_back(Struct(defaults));
    return classes_.size();
  }

  /// `is_saved`: the object's class has a function saveobj. Flags and enumerations are in the table, not in a cell.
  std::size_t AddObject(std::size_t class_id, const Fields& properties, bool is_saved = false,
                        const std::vector<std::pair<std::string, std::uint32_t>>& flags = {}) {
    std::vector<std::uint32_t> block;
    block.push_back(static_cast<std::uint32_t>(properties.size() + flags.size()));
    for (const auto& [name, value] : properties) {
      const auto cell = static_cast<std::uint32_t>(values_.size());
      block.insert(block.end(), {NameOf(name), 1, cell});
      values_.push_back(value);
    }
    for (const auto& [name, value] : flags) block.insert(block.end(), {NameOf(name), 2, value});
    if (block.size() % 2 != 0) block.push_back(0);
    std::vector<std::vector<std::uint32_t>>& blocks = is_saved ? saved_ : normal_;
    blocks.push_back(block);
    const auto id = static_cast<std::uint32_t>(blocks.size());
    objects_.push_back({static_cast<std::uint32_t>(class_id), is_saved ? id : 0, is_saved ? 0 : id});
    return objects_.size();
  }

  /// The value that refers to objects, for a property or a variable.
  Array Reference(const std::vector<std::size_t>& objects, bool is_variable = false) const {
    const std::uint32_t class_id = objects_[objects.front() - 1].class_id;
    std::vector<double> numbers = {3707764736.0, 2, 1, static_cast<double>(objects.size())};  // 0xDD000000
    for (const std::size_t object : objects) numbers.push_back(static_cast<double>(object));
    numbers.push_back(class_id);
    const std::size_t count = numbers.size();
    Array array = Numbers({count, 1}, std::move(numbers), is_variable ? "object" : "uint32");
    if (is_variable) array.text = full_names_[class_id - 1];
    return array;
  }

  void AddVariable(const std::string& name, const Array& array) { variables_.emplace_back(name, array); }
  const Fields& variables() const { return variables_; }

  /// The cells of the subsystem: the table, an empty cell, values of properties, additions of each version, defaults.
  std::vector<Array> AllCells(bool is_big) const {
    const std::string table = Table(is_big);
    std::vector<Array> cells = {Numbers({table.size(), 1}, {}, "uint8"), Nothing()};
    for (const char byte : table) cells.front().numbers.push_back(static_cast<unsigned char>(byte));
    cells.insert(cells.end(), values_.begin(), values_.end());
    for (int i = 2; i < version_; ++i) cells.push_back(Cells({}));
    std::vector<Array> defaults = {Struct({})};
    defaults.insert(defaults.end(), defaults_.begin(), defaults_.end());
    cells.push_back(Cells(defaults));
    return cells;
  }

 private:
  using Block = std::vector<std::uint32_t>;
  struct Object {
    std::uint32_t class_id, saved, normal;
  };
  struct Class {
    std::uint32_t package, name;
  };

  std::uint32_t NameOf(const std::string& name) {
    auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) found = names_.insert(found, name);
    return static_cast<std::uint32_t>(found - names_.begin() + 1);
  }

  std::string Table(bool is_big) const {
    std::string names;
    for (const std::string& name : names_) names += name + '\0';
    names.resize((names.size() + 7) / 8 * 8);
    std::vector<Block> regions = {{0, 0, 0, 0}, {0, 0}, {0, 0, 0, 0, 0, 0}, {0, 0}, Block(2 * objects_.size() + 2)};
    for (const Class& one : classes_) regions[0].insert(regions[0].end(), {one.package, one.name, 0, 0});
    for (const Block& block : saved_) regions[1].insert(regions[1].end(), block.begin(), block.end());
    std::uint32_t order = 0;
    for (const auto& [class_id, saved, normal] : objects_) {
      regions[2].insert(regions[2].end(), {class_id, 0, 0, saved, normal, ++order});
    }
    for (const Block& block : normal_) regions[3].insert(regions[3].end(), block.begin(), block.end());
    std::string offsets, rest;
    const auto words = [&](const Block& block) {
      for (const std::uint32_t word : block) rest += Bytes(word, 4, is_big);
    };
    for (const Block& region : regions) {
      offsets += Bytes(40 + names.size() + rest.size(), 4, is_big);
      words(region);
    }
    const std::size_t end = 40 + names.size() + rest.size();
    offsets += Bytes(end, 4, is_big);
    offsets += Bytes(version_ > 2 ? end : 0, 4, is_big) + Bytes(version_ > 3 ? end : 0, 4, is_big);
    return Bytes(static_cast<std::uint64_t>(version_), 4, is_big) + Bytes(names_.size(), 4, is_big) + offsets + names +
           rest;
  }

  int version_;
  std::vector<std::string> names_, full_names_;
  std::vector<Class> classes_;
  std::vector<Object> objects_;
  std::vector<Block> saved_, normal_;
  std::vector<Array> values_, defaults_;
  Fields variables_;
};

}  // namespace pendulum::objects
