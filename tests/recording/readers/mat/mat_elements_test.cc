// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_elements.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/recording/mat_files.h"

// Bytes written by hand follow "MAT-File Format" (The MathWorks), chapter 1: a tag with type and size, data aligned to
// eight bytes. matio is an independent writer.
namespace pendulum::mat_elements_test {
namespace {

using namespace std::string_view_literals;
using testing::ElementsAre;
using Kind = MatValue::Kind;

/// The first matrix of a file written by matio without compression.
MatValue ValueOfMatio(matvar_t* variable) {
  const std::string bytes = MatOf({variable}, MAT_FT_MAT5, false);
  const auto matrix = MatElements(std::string_view(bytes).substr(128), false).Next(kMatrixElement);
  EXPECT_TRUE(matrix);
  auto open = OpenMatrix(matrix.value_or(""), false);
  EXPECT_TRUE(open);
  return open ? ValueOf(*std::move(open), true) : MatValue{};
}

TEST(MatElements, AreReadOneByOne) {
  const std::string_view bytes =
      "\1\0\0\0\3\0\0\0abc\0\0\0\0\0"  // three bytes and five of padding
      "\1\0\2\0xy\0\0"                 // two bytes in one word with their size
      "\2\0\0\0\0\0\0\0"sv;            // no bytes
  MatElements elements(bytes, false);
  EXPECT_EQ(elements.Next()->bytes, "abc");
  EXPECT_EQ(elements.at(), 16);
  EXPECT_EQ(elements.Next()->bytes, "xy");
  const auto last = elements.Next();
  EXPECT_EQ(last->type, 2);
  EXPECT_EQ(last->bytes, "");
  EXPECT_TRUE(elements.IsAtEnd());
  EXPECT_FALSE(elements.Next());
}

TEST(MatElements, AreReadInTheOtherByteOrder) {
  MatElements elements("\0\0\0\1\0\0\0\3abc\0\0\0\0\0\0\2\0\1xy\0\0"sv, true);
  EXPECT_EQ(elements.Next(1), "abc");
  EXPECT_EQ(elements.Next(1), "xy");
}

TEST(MatElements, EndAtAnElementThatExceedsTheBytes) {
  EXPECT_FALSE(MatElements("\1\0\0\0\3\0\0"sv, false).Next());
  EXPECT_FALSE(MatElements("\1\0\0\0\3\0\0\0ab"sv, false).Next());
  EXPECT_FALSE(MatElements("\1\0\0\0\xFF\xFF\xFF\xFF"
                           "ab"sv,
                           false)
                   .Next());
  EXPECT_FALSE(MatElements("\1\0\5\0abcd"sv, false).Next());  // five bytes announced, four present
  EXPECT_FALSE(MatElements("\1\0\2\0xy\0\0"sv, false).Next(2));
}

TEST(ValueOf, ReadsNumbersAndSizesOfAMatrix) {
  const MatValue value = ValueOfMatio(Matrix("m", 2, {1, 2, 3, 4, 5, 6.5}));
  EXPECT_EQ(value.kind, Kind::kNumbers);
  EXPECT_THAT(value.sizes, ElementsAre(2, 3));
  EXPECT_THAT(value.numbers, ElementsAre(1, 2, 3, 4, 5, 6.5));
  EXPECT_THAT(ValueOfMatio(Vector<std::int16_t>("i", MAT_C_INT16, MAT_T_INT16, {-1, 2})).numbers, ElementsAre(-1, 2));
  EXPECT_THAT(ValueOfMatio(Vector<float>("f", MAT_C_SINGLE, MAT_T_SINGLE, {0.5})).numbers, ElementsAre(0.5));
  EXPECT_THAT(ValueOfMatio(Vector<std::uint64_t>("u", MAT_C_UINT64, MAT_T_UINT64, {7})).numbers, ElementsAre(7));
}

TEST(ValueOf, ReadsFieldsOfAStructureAndLettersOfAText) {
  const MatValue value = ValueOfMatio(Structure("s", {{"a", Matrix("a", 1, {3})}, {"text", Text("text", "rad/s")}}));
  EXPECT_THAT(value.names, ElementsAre("a", "text"));
  EXPECT_THAT(value.Field("a")->numbers, ElementsAre(3));
  EXPECT_EQ(value.Field("text")->text, "rad/s");
  EXPECT_EQ(value.Field("none"), nullptr);
}

TEST(ValueOf, RejectsComplexAndTruncatedValues) {
  std::vector<double> values(2);
  mat_complex_split_t complex{values.data(), values.data()};
  std::size_t sizes[] = {2, 1};
  EXPECT_EQ(ValueOfMatio(Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, sizes, &complex, MAT_F_COMPLEX)).kind,
            Kind::kOther);
  const std::string bytes = MatOf({Matrix("m", 2, {1, 2, 3, 4})}, MAT_FT_MAT5, false).substr(136);
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    auto open = OpenMatrix(std::string_view(bytes).substr(0, size), false);
    EXPECT_TRUE(!open || ValueOf(*std::move(open), true).kind == Kind::kOther) << size;
  }
}

TEST(OpenMatrix, IsEmptyForNoBytes) {
  auto open = OpenMatrix("", false);
  ASSERT_TRUE(open);
  EXPECT_TRUE(ValueOf(*std::move(open), true).IsEmpty());
}

std::string Packed(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return packed.substr(0, size);
}

TEST(Unpacked, RestoresThePackedBytesOrTheirBeginning) {
  const std::string bytes = std::string(200'000, 'a') + "end";
  const std::string packed = Packed(bytes);
  EXPECT_EQ(Unpacked(packed, 1'000'000), bytes);
  EXPECT_EQ(Unpacked(packed, 100), bytes.substr(0, 100));
  EXPECT_EQ(Unpacked(packed, bytes.size()), bytes);
}

TEST(Unpacked, IsMissingForDamagedBytes) {
  const std::string packed = Packed("some letters");
  for (std::size_t size = 0; size < packed.size(); ++size) EXPECT_FALSE(Unpacked(packed.substr(0, size), 1000)) << size;
  std::string changed = packed;
  changed.back() ^= 1;  // part of its checksum
  EXPECT_FALSE(Unpacked(changed, 1000));
}

}  // namespace
}  // namespace pendulum::mat_elements_test
