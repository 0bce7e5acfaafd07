// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The table of objects that MATLAB stores in the subsystem of a MAT-file. The MathWorks do not document it, and the
/// known structure was derived from files. Therefore any inconsistency makes the whole table unreadable.
namespace pendulum {

/// A property that differs from its default.
struct McosProperty {
  enum class Kind { kEnumeration = 0, kCell = 1, kNumber = 2 };
  std::size_t name = 0;
  Kind kind = Kind::kCell;
  std::size_t value = 0;  // kCell: index among all cells; kEnumeration: a name; kNumber: the value itself.
};

/// The table of objects, which is in cell 0. Names, classes and objects are numbered from 1; 0 means none.
class Mcos {
 public:
  /// `cells` is the number of cells including the table. std::nullopt if the table is inconsistent.
  static std::optional<Mcos> Read(std::string_view bytes, std::size_t cells);

  std::size_t classes() const { return classes_.size(); }  // Number of them, plus one.
  std::size_t objects() const { return objects_.size(); }  // Number of them, plus one.
  std::string ClassName(std::size_t class_id) const;       // Including packages: tsdata.timemetadata.
  /// 0 if `object` is not an object.
  std::size_t ClassOf(std::size_t object) const;
  /// Finds a property by its name; nullptr if it has its default.
  const McosProperty* Find(std::size_t object, std::string_view name) const;
  const std::string& Name(std::size_t name) const { return names_[name]; }

 private:
  using Words = std::vector<std::uint32_t>;
  using Properties = std::vector<McosProperty>;
  struct Class {
    std::size_t package = 0, name = 0;
  };
  struct Object {
    std::size_t class_id = 0, saved = 0, normal = 0;
  };

  bool ReadNames(std::string_view bytes, std::size_t count);
  bool ReadClasses(const Words& words);
  bool ReadObjects(const Words& words);
  bool ReadProperties(const Words& words, std::size_t end_of_cells, std::vector<Properties>& blocks) const;

  std::vector<std::string> names_;
  std::vector<Class> classes_;
  std::vector<Object> objects_;
  std::vector<Properties> saved_, normal_;  // Of objects whose classes have a function saveobj; of others.
};

}  // namespace pendulum
