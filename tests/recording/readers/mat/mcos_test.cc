// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mcos.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/readers/mat/mat_subsystem.h"
#include "tests/recording/mat_objects.h"

namespace pendulum::mcos_test {
namespace {

using testing::ElementsAre;

// Files written by MATLAB 2009a, with which SciPy tests its reader. Each function handle in them is an object that
// stores the variables it uses. The file also contains those of `parabola = @(x) a*x.^2 + b*x + c` as plain variables.
std::string FileOfMatlab(const std::string& name) {
  const std::string path = "/usr/lib/python3/dist-packages/scipy/io/matlab/tests/data/" + name;
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.good()) << path << " is not there: scripts/install_dependencies installs it";
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Mcos, ListsObjectsAndPropertiesOfMatlabsFiles) {
  for (const auto& [name, handles] : {std::pair{"sqr.mat", 1}, {"parabola.mat", 1}, {"some_functions.mat", 2}}) {
    const MatSubsystem subsystem = SubsystemOf(FileOfMatlab(name));
    ASSERT_TRUE(subsystem.objects) << name;
    const Mcos& objects = *subsystem.objects;
    EXPECT_EQ(objects.classes(), 2);
    EXPECT_EQ(objects.objects(), 1 + handles) << name;
    EXPECT_EQ(objects.ClassName(1), "function_handle_workspace");
    EXPECT_EQ(subsystem.cells, 3 + handles);  // the table, an empty cell, defaults
    for (int object = 1; object <= handles; ++object) {
      EXPECT_EQ(objects.ClassOf(object), 1);
      const McosProperty* const any = objects.Find(object, "any");
      ASSERT_NE(any, nullptr);
      EXPECT_EQ(any->kind, McosProperty::Kind::kCell);
      EXPECT_EQ(any->value, 1 + object);
      EXPECT_EQ(objects.Find(object, "none"), nullptr);
    }
  }
}

TEST(Mcos, ReadsPropertyValuesOfMatlabsFiles) {
  const MatSubsystem subsystem = SubsystemOf(FileOfMatlab("some_functions.mat"));
  ASSERT_TRUE(subsystem.objects);
  const MatValue value = subsystem.cell(subsystem.objects->Find(2, "any")->value);
  ASSERT_EQ(value.parts.size(), 2);
  // The file also contains the variables a, b, c; SciPy's loadmat reads -3.9, 52 and 0.
  const MatValue& variables = value.parts[1];
  EXPECT_THAT(variables.names, ElementsAre("a", "b", "c"));
  EXPECT_THAT(variables.Field("a")->numbers, ElementsAre(-3.9));
  EXPECT_THAT(variables.Field("b")->numbers, ElementsAre(52));
  EXPECT_THAT(variables.Field("c")->numbers, ElementsAre(0));
  EXPECT_EQ(ObjectsOf(value.parts[0])->class_id, 1);
}

// ---- Damage ------------------------------------------------------------------------------------------------------

/// A table with an object of each kind.
objects::File Several() {
  objects::File file;
  const std::size_t inner = file.AddClass("tsdata", "timemetadata"), outer = file.AddClass("", "timeseries");
  const std::size_t one = file.AddObject(inner, {{"Units", objects::Letters("seconds")}}, true);
  file.AddObject(outer, {{"TimeInfo", file.Reference({one})}}, false, {{"BeingBuilt", 1}});
  return file;
}

std::string TableOf(const objects::File& file, bool is_big) {
  const std::vector<objects::Array> cells = file.AllCells(is_big);
  std::string bytes;
  for (const double byte : cells.front().numbers) bytes += static_cast<char>(static_cast<unsigned char>(byte));
  return bytes;
}

// Cells of Several: table, empty cell, two values, two additional cells of version 4, defaults.
constexpr std::size_t kCells = 7;

TEST(Mcos, IsReadInBothByteOrders) {
  for (const bool is_big : {false, true}) {
    const auto objects = Mcos::Read(TableOf(Several(), is_big), kCells);
    ASSERT_TRUE(objects);
    EXPECT_EQ(objects->ClassName(1), "tsdata.timemetadata");
    EXPECT_EQ(objects->ClassOf(2), 2);
    EXPECT_EQ(objects->Find(1, "Units")->value, 2);
    EXPECT_EQ(objects->Find(2, "TimeInfo")->value, 3);
    const McosProperty* const flag = objects->Find(2, "BeingBuilt");
    EXPECT_EQ(flag->kind, McosProperty::Kind::kNumber);
    EXPECT_EQ(flag->value, 1);
    EXPECT_EQ(objects->ClassOf(3), 0);
    EXPECT_EQ(objects->Find(3, "Units"), nullptr);
    EXPECT_EQ(objects->ClassName(9), "");
  }
}

TEST(Mcos, IsRejectedIfInconsistent) {
  const std::string whole = TableOf(Several(), false);
  EXPECT_FALSE(Mcos::Read(whole, kCells - 1));  // one value has no cell
  EXPECT_FALSE(Mcos::Read("", kCells));
  const auto changed = [&](std::size_t word, std::uint32_t number) {
    return Mcos::Read(std::string(whole).replace(4 * word, 4, objects::Bytes(number, 4, false)), kCells);
  };
  EXPECT_TRUE(changed(0, 3));
  EXPECT_FALSE(changed(0, 1));
  EXPECT_FALSE(changed(0, 5));
  EXPECT_FALSE(changed(1, 4));  // there are more names
  EXPECT_FALSE(changed(1, 4000));
  for (std::size_t offset = 2; offset < 7; ++offset) {
    EXPECT_FALSE(changed(offset, 36)) << offset;
    EXPECT_FALSE(changed(offset, 0xFFFFFFF0)) << offset;
    EXPECT_FALSE(changed(offset, static_cast<std::uint32_t>(whole.size() + 8))) << offset;
  }
}

TEST(Mcos, AcceptsAnyBytesWithoutACrash) {
  const std::string whole = TableOf(Several(), false);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xFF}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      const auto objects = Mcos::Read(bytes, kCells);
      for (std::size_t object = 0; objects && object < objects->objects(); ++object) {
        EXPECT_LT(objects->ClassOf(object), objects->classes());
        const McosProperty* const property = objects->Find(object, "Units");
        const bool is_cell = property != nullptr && property->kind == McosProperty::Kind::kCell;
        EXPECT_LT(is_cell ? property->value : 0, kCells - 3);
      }
    }
    EXPECT_FALSE(Mcos::Read(whole.substr(0, at), kCells) && at < 200) << at;
  }
}

}  // namespace
}  // namespace pendulum::mcos_test
