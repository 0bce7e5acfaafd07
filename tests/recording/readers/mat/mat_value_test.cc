// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_value.h"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::mat_value_test {
namespace {

using testing::ElementsAre;
using Kind = MatValue::Kind;

constexpr double kMark = 3707764736.0;  // 0xDD000000

MatValue Column(const std::vector<double>& numbers) {
  return {Kind::kNumbers, {numbers.size(), 1}, numbers, {}, {}, {}};
}

TEST(CountIn, IsTheProductUnlessTooLarge) {
  EXPECT_EQ(CountIn({2, 3, 4}), 24);
  EXPECT_EQ(CountIn({std::numeric_limits<std::size_t>::max(), 0, 7}), 0);
  EXPECT_FALSE(CountIn({std::numeric_limits<std::size_t>::max(), 2}));
  EXPECT_FALSE(CountIn({std::size_t{1} << 32, std::size_t{1} << 32, 1}));
}

TEST(ObjectsOf, ListsTheObjectsAfterTheSizes) {
  const auto one = ObjectsOf(Column({kMark, 2, 1, 1, 7, 3}));
  ASSERT_TRUE(one);
  EXPECT_THAT(one->objects, ElementsAre(7));
  EXPECT_EQ(one->class_id, 3);
  EXPECT_THAT(ObjectsOf(Column({kMark, 2, 1, 3, 7, 8, 9, 3}))->objects, ElementsAre(7, 8, 9));
  EXPECT_THAT(ObjectsOf(Column({kMark, 2, 0, 0, 3}))->objects, ElementsAre());
}

TEST(ObjectsOf, IsEmptyIfTheContentDoesNotFit) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& numbers : {std::vector<double>{},
                                             {kMark},
                                             {kMark, 2, 1},
                                             {kMark - 1, 2, 1, 1, 7, 3},
                                             {kMark, 2, 1, 2, 7, 3},
                                             {kMark, 2, 1, 1, 7},
                                             {kMark, 0, 7},
                                             {kMark, 4294967295.0, 1, 1, 7, 3},
                                             {kMark, 2, 4294967295.0, 4294967295.0, 7},
                                             {kMark, 2, 1, 1, nan, 3},
                                             {kMark, 2, 1, 1, 7.5, 3},
                                             {kMark, -2, 1, 1, 7, 3},
                                             {kMark, 2, 1, 1, 1e300, 3}}) {
    EXPECT_FALSE(ObjectsOf(Column(numbers))) << testing::PrintToString(numbers);
  }
  MatValue text;
  text.kind = Kind::kText;
  text.numbers = {kMark, 2, 1, 1, 7, 3};
  EXPECT_FALSE(ObjectsOf(text));
}

TEST(AddReferences, UsesMatlabNotationForTheLocationsOfObjects) {
  const auto object = [](double number) {
    return MatValue{Kind::kObject, {}, {kMark, 2, 1, 1, number, 1}, "A", {}, {}};
  };
  const MatValue two{Kind::kObject, {}, {kMark, 2, 1, 2, 3, 4, 1}, "A", {}, {}};
  const MatValue cells{Kind::kCells, {1, 2}, {}, {}, {}, {object(1), object(2)}};
  const MatValue unknown{Kind::kObject, {}, {}, "B", {}, {}};
  const MatValue structure{Kind::kStructure, {1, 1}, {}, {}, {"c", "t", "u"}, {cells, two, unknown}};
  const MatValue array{Kind::kStructure, {1, 2}, {}, {}, {"x"}, {object(5), object(6)}};
  std::vector<MatReference> references;
  AddReferences(structure, "s", references);
  AddReferences(array, "a", references);
  std::vector<std::string> places;
  for (const MatReference& each : references) places.push_back(each.place + "=" + std::to_string(each.object));
  EXPECT_THAT(places, ElementsAre("s.c{1}=1", "s.c{2}=2", "s.t(1)=3", "s.t(2)=4", "s.u=0", "a(1).x=5", "a(2).x=6"));
  EXPECT_EQ(references[4].class_name, "B");
}

TEST(MatValue, IsEmptyIfASizeIsZero) {
  EXPECT_TRUE((MatValue{Kind::kNumbers, {0, 0}, {}, {}, {}, {}}.IsEmpty()));
  EXPECT_FALSE((MatValue{Kind::kNumbers, {1, 1}, {0}, {}, {}, {}}.IsEmpty()));
  EXPECT_FALSE(MatValue{}.IsEmpty());  // unknown
}

}  // namespace
}  // namespace pendulum::mat_value_test
