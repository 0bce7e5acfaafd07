// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_subsystem.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/mat_files.h"
#include "tests/recording/mat_objects_5.h"

namespace pendulum::mat_subsystem_test {
namespace {

objects::File Example() {
  objects::File file;
  const std::size_t own = file.AddClass("my", "class");
  const std::size_t one = file.AddObject(own, {{"Units", objects::Letters("rad")}});
  file.AddVariable("numbers", objects::Numbers({1, 2}, {1, 2}));
  file.AddVariable("a", file.Reference({one}, true));
  file.AddVariable("s", objects::Struct({{"first", objects::Number(1)}, {"b", file.Reference({one}, true)}}));
  return file;
}

TEST(SubsystemOf, FindsTheObjectsOfAFileAndTheirPlaces) {
  for (const bool is_big : {false, true}) {
    for (const bool is_packed : {false, true}) {
      const MatSubsystem subsystem = SubsystemOf(objects::Version5(Example(), {is_big, is_packed}));
      ASSERT_TRUE(subsystem.objects);
      ASSERT_EQ(subsystem.references.size(), 2);
      EXPECT_EQ(subsystem.references[0].place, "a");
      EXPECT_EQ(subsystem.references[1].place, "s.b");
      EXPECT_EQ(subsystem.references[1].class_name, "my.class");
      EXPECT_EQ(subsystem.references[1].object, 1);
      EXPECT_EQ(subsystem.cell(subsystem.objects->Find(1, "Units")->value).text, "rad");
      EXPECT_EQ(subsystem.cell(99).kind, MatValue::Kind::kOther);
    }
  }
}

TEST(SubsystemOf, IsEmptyForAFileWithoutObjects) {
  for (const bool is_packed : {false, true}) {
    const MatSubsystem subsystem = SubsystemOf(MatOf({Matrix("t", 2, {1, 2})}, MAT_FT_MAT5, is_packed));
    EXPECT_FALSE(subsystem.objects);
    EXPECT_TRUE(subsystem.references.empty());
  }
  EXPECT_FALSE(SubsystemOf("").objects);
  EXPECT_FALSE(SubsystemOf(std::string(200, ' ')).objects);
}

TEST(SubsystemOf, IsEmptyIfThePositionInTheHeaderIsWrong) {
  const std::string whole = objects::Version5(Example());
  for (const std::string& place : {std::string(8, ' '), std::string(8, '\0'), objects::Bytes(128, 8, false),
                                   objects::Bytes(129, 8, false), std::string(8, '\xFF')}) {
    const MatSubsystem subsystem = SubsystemOf(std::string(whole).replace(116, 8, place));
    EXPECT_FALSE(subsystem.objects);
    EXPECT_LE(subsystem.references.size(), 2);
  }
}

}  // namespace
}  // namespace pendulum::mat_subsystem_test
