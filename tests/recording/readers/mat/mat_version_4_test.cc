// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_version_4.h"

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/mat_files.h"
#include "tests/recording/rows.h"

namespace pendulum::mat_version_4_test {
namespace {

using namespace std::string_view_literals;
using testing::HasSubstr;

std::string Bytes(std::uint64_t number, std::size_t size, bool is_big) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * (is_big ? size - 1 - i : i));
  return bytes;
}

/// A column built as "MAT-File Format" (The MathWorks) describes it: type, rows, columns, imaginary part, length of the
/// name with its zero, the name, the numbers. Type 10 P means doubles for P = 0 and 16-bit integers for P = 3; adding
/// 1000 means big-endian.
std::string Column(const std::string& name, const std::vector<double>& values, bool is_big, bool is_short = false) {
  std::string bytes;
  for (const std::uint64_t word : {std::uint64_t{is_big ? 1000U : 0U} + (is_short ? 30 : 0), values.size(),
                                   std::uint64_t{1}, std::uint64_t{0}, name.size() + 1}) {
    bytes += Bytes(word, 4, is_big);
  }
  bytes += name + '\0';
  for (const double value : values) {
    bytes += is_short ? Bytes(static_cast<std::uint64_t>(value), 2, is_big)
                      : Bytes(std::bit_cast<std::uint64_t>(value), 8, is_big);
  }
  return bytes;
}

// The times and values that ExpectTheRows expects.
std::vector<double> Times() { return {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07}; }
std::vector<double> Values() { return {100, 101, 102, 103, 104, 105, 106, 107}; }

TEST(ReadMat, ReadsVersion4) {
  for (const bool is_big : {false, true}) {
    for (const bool is_short : {false, true}) {
      ExpectTheRows(RecordingOf(Column("t_s", Times(), is_big) + Column("angle_deg", Values(), is_big, is_short)),
                    kDegree);
    }
  }
  ExpectTheRows(RecordingOf(MatOf({Matrix("t_s", 8, Times()), Matrix("angle_deg", 8, Values())}, MAT_FT_MAT4, false)),
                kDegree);
}

TEST(ReadMat, RejectsATruncatedVersion4File) {
  const std::string whole = Column("t_s", Times(), false) + Column("angle_deg", Values(), false);
  const std::size_t first = Column("t_s", Times(), false).size();
  for (std::size_t size = 30; size < whole.size(); ++size) {
    if (size == first) continue;
    const std::string fault = FaultOf(whole.substr(0, size));
    EXPECT_THAT(fault, testing::StartsWith("run.csv: the file is "));
  }
  EXPECT_THAT(FaultOf(whole + "more"), HasSubstr("at byte 182 no variable begins"));
}

TEST(SizeOfVersion4, IsMissingForOtherBytes) {
  const std::string whole = Column("t_s", Times(), false);
  EXPECT_EQ(SizeOfVersion4(whole), whole.size());
  EXPECT_EQ(SizeOfVersion4(whole.substr(0, 30)), whole.size());
  for (const auto& [at, byte] : {std::pair{0, '\x3C'},
                                 {0, '\4'},
                                 {3, '\1'},
                                 {12, '\2'},
                                 {16, '\1'},
                                 {20, '1'},
                                 {21, ' '},
                                 {23, 'x'},
                                 {7, '\xFF'}}) {
    std::string bytes = whole;
    bytes[static_cast<std::size_t>(at)] = byte;
    const auto size = SizeOfVersion4(bytes);
    EXPECT_TRUE(!size || *size > whole.size()) << at;
  }
  EXPECT_FALSE(SizeOfVersion4(""));
  EXPECT_FALSE(SizeOfVersion4("time_s,angle_deg\n0,1\n1,2\n"));
  EXPECT_FALSE(SizeOfVersion4(std::string(1000, '\0')));
}

}  // namespace
}  // namespace pendulum::mat_version_4_test
