// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/npy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/format.h"
#include "tests/recording/rows.h"
#include "tests/recording/zip_files.h"

namespace pendulum::npy_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A file of NumPy, as NEP 1 describes it: the header ends at a multiple of 64 bytes.
std::string NpyOf(const std::string& type, const std::string& shape, const std::string& data,
                  const std::string& is_fortran = "False", int version = 1) {
  std::string header = "{'descr': " + type + ", 'fortran_order': " + is_fortran + ", 'shape': " + shape + ", }";
  const std::size_t begin = version == 1 ? 10 : 12;
  header += std::string(64 - (begin + header.size() + 1) % 64, ' ') + "\n";
  std::string bytes = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + '\0';
  for (std::size_t i = 0; i < begin - 8; ++i) bytes += static_cast<char>(header.size() >> (8 * i));
  return bytes + header + data;
}

template <typename T>
std::string Raw(const std::vector<T>& numbers, bool is_swapped = false) {
  std::string bytes;
  for (const T number : numbers) {
    std::string each(sizeof(T), '\0');
    std::memcpy(each.data(), &number, sizeof(T));
    if (is_swapped) std::reverse(each.begin(), each.end());
    bytes += each;
  }
  return bytes;
}

std::string TextOf(const std::string& bytes) {
  const Workbook workbook = ReadNpy(bytes, 100'000);
  EXPECT_EQ(workbook.complaint, "");
  return workbook.sheets.empty() ? "" : workbook.sheets.front().text;
}

const std::vector<double> kTimes = {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07};
const std::vector<double> kAngles = {100, 101, 102, 103, 104, 105, 106, 107};

TEST(ReadNpy, ReadsEveryTypeOfNumber) {
  EXPECT_EQ(TextOf(NpyOf("'<f8'", "(2,)", Raw<double>({0.1 + 0.2, NAN}))), "0.30000000000000004\n");
  EXPECT_EQ(TextOf(NpyOf("'>f8'", "(2,)", Raw<double>({1.5, -2}, true))), "1.5\n-2\n");
  EXPECT_EQ(TextOf(NpyOf("'<f4'", "(1,)", Raw<float>({0.5F}))), "0.5\n");
  EXPECT_EQ(TextOf(NpyOf("'>f4'", "(1,)", Raw<float>({0.1F}, true))), "0.10000000149011612\n");
  EXPECT_EQ(TextOf(NpyOf("'|i1'", "(2,)", Raw<std::int8_t>({-128, 127}))), "-128\n127\n");
  EXPECT_EQ(TextOf(NpyOf("'>i2'", "(1,)", Raw<std::int16_t>({-300}, true))), "-300\n");
  EXPECT_EQ(TextOf(NpyOf("'<u2'", "(1,)", Raw<std::uint16_t>({65535}))), "65535\n");
  EXPECT_EQ(TextOf(NpyOf("'<i8'", "(1,)", Raw<std::int64_t>({1709302471273000001}))), "1709302471273000001\n");
  EXPECT_EQ(TextOf(NpyOf("'|b1'", "(2,)", std::string("\1\0", 2))), "1\n0\n");
  EXPECT_EQ(TextOf(NpyOf("'<f8'", "(1,)", Raw<double>({3}), "False", 2)), "3\n");
}

/// IEEE 754: 0x3C00 is 1, 0xC000 is -2, 0x3555 is about 1/3, 0x0001 is 2^-24, 0x7BFF is 65504.
TEST(ReadNpy, ReadsHalfPrecision) {
  EXPECT_EQ(TextOf(NpyOf("'<f2'", "(6,)", Raw<std::uint16_t>({0x3C00, 0xC000, 0x3555, 0x0001, 0x7BFF, 0x7C00}))),
            "1\n-2\n0.333251953125\n5.960464477539063e-08\n65504\n");
}

TEST(ReadNpy, ReadsDatesAndDurations) {
  const std::int64_t moment = 1709309071;  // 2024-03-01 16:04:31 UTC: date -u -d 2024-03-01T16:04:31 +%s
  EXPECT_EQ(TextOf(NpyOf("'<M8[ms]'", "(1,)", Raw<std::int64_t>({moment * 1000 + 273}))), "2024-03-01T16:04:31.273\n");
  EXPECT_EQ(TextOf(NpyOf("'<M8[ns]'", "(1,)", Raw<std::int64_t>({moment * 1000000000 + 5}))),
            "2024-03-01T16:04:31.000000005\n");
  EXPECT_EQ(TextOf(NpyOf("'<M8[D]'", "(1,)", Raw<std::int64_t>({-1}))), "1969-12-31T00:00:00\n");
  EXPECT_EQ(TextOf(NpyOf("'<m8[us]'", "(2,)", Raw<std::int64_t>({1500000, INT64_MIN}))), "1.5\n");
}

TEST(ReadNpy, ReadsMatricesInBothOrders) {
  std::vector<double> rows, columns;
  for (std::size_t i = 0; i < 8; ++i) rows.insert(rows.end(), {kTimes[i], kAngles[i]});
  columns = kTimes;
  columns.insert(columns.end(), kAngles.begin(), kAngles.end());
  for (const std::string& bytes :
       {NpyOf("'<f8'", "(8, 2)", Raw(rows)), NpyOf("'<f8'", "(8, 2)", Raw(columns), "True"),
        NpyOf("'<f8'", "(2, 8)", Raw(columns)), NpyOf("'<f8'", "(2, 8)", Raw(rows), "True")}) {
    ExpectTheRows(RecordingOf(bytes, TimeAndValue("1", "2", "rad")));
  }
}

TEST(ReadNpy, ReadsRecordsWithNames) {
  std::string records;
  for (std::size_t i = 0; i < 8; ++i) {
    records += Raw<double>({kTimes[i]}) + std::string(4, 'x') + Raw<float>({static_cast<float>(kAngles[i])});
  }
  ExpectTheRows(
      RecordingOf(NpyOf("[('time_s', '<f8'), ('', '|V4'), (('the angle', 'angle_rad'), '<f4')]", "(8,)", records)));
  EXPECT_EQ(TextOf(NpyOf("[('acc', '<i2', (2,)), ('tag', '|S3'), ('name', '<U2')]", "(1,)",
                         Raw<std::int16_t>({1, 2}) + std::string("ab\0", 3) + Raw<std::uint32_t>({'x', 0x3B8}))),
            "acc.0;acc.1;tag;name\n1;2;ab;xθ\n");
}

TEST(ReadNpz, ReadsVectorsAsColumns) {
  const std::string angle = NpyOf("'<f8'", "(8,)", Raw(kAngles)), time = NpyOf("'<f8'", "(8,)", Raw(kTimes));
  ExpectTheRows(RecordingOf(ZipOf({{"time_s.npy", time}, {"angle_rad.npy", angle}})));
  const std::string rate = NpyOf("'<i8'", "()", Raw<std::int64_t>({100}));
  ExpectTheRows(RecordingOf(ZipOf({{"angle_rad.npy", angle}, {"sample_rate_hz.npy", rate}})));
  std::vector<double> both = kTimes;
  both.insert(both.end(), kAngles.begin(), kAngles.end());
  const std::string matrix = NpyOf("'<f8'", "(2, 8)", Raw(both));
  ExpectTheRows(RecordingOf(ZipOf({{"arr_0.npy", matrix}}), TimeAndValue("1", "2", "rad")));
  ExpectTheRows(
      RecordingOf(ZipOf({{"arr_0.npy", matrix}, {"arr_1.npy", matrix}}), TimeAndValue("1", "arr_1/2", "rad")));
}

TEST(ReadNpz, WritesATextAsMetadataWithoutQuotes) {
  const std::string rig = NpyOf("'|S16'", "()", "{\"inertia\": 0.1}"), angle = NpyOf("'<f8'", "(8,)", Raw(kAngles));
  const std::string bytes = ZipOf({{"rig.npy", rig}, {"angle_rad.npy", angle}});
  const Workbook workbook = ReadNpz(ZipMembers::Open(bytes, "run.npz").value(), 100'000);
  ASSERT_EQ(workbook.sheets.size(), 1);
  EXPECT_THAT(workbook.sheets[0].text, StartsWith("# rig: {\"inertia\": 0.1}\nangle_rad\n100\n"));
}

/// All arrays together have at most as many bytes as are allowed.
TEST(ReadNpz, LimitsTheBytesOfAllSheets) {
  std::vector<double> numbers(400, 0.1);
  const std::string matrix = NpyOf("'<f8'", "(200, 2)", Raw(numbers));  // 1600 bytes of text
  const std::string two = ZipOf({{"a.npy", matrix}, {"b.npy", matrix}});
  EXPECT_FALSE(ReadNpz(ZipMembers::Open(two, "run.npz").value(), 8'000).is_too_large);
  const std::string text = NpyOf("'<i8'", "(200, 2)", Raw(std::vector<std::int64_t>(400, 1'000'000'000'000'000'000)));
  const std::string long_texts = ZipOf({{"a.npy", text}, {"b.npy", text}});  // twice 8000 bytes of text
  EXPECT_TRUE(ReadNpz(ZipMembers::Open(long_texts, "run.npz").value(), 12'000).is_too_large);
}

TEST(ReadNpz, ReadsTheArraysThatItCan) {
  const std::string angle = NpyOf("'<f8'", "(8,)", Raw(kAngles)), time = NpyOf("'<f8'", "(8,)", Raw(kTimes));
  const std::string objects = NpyOf("'|O'", "(1,)", "\x80\x04x");
  ExpectTheRows(RecordingOf(ZipOf({{"info.npy", objects}, {"time_s.npy", time}, {"angle_rad.npy", angle}})));
  EXPECT_THAT(FaultOf(ZipOf({{"info.npy", objects}})), HasSubstr("contains Python objects (pickle)"));
}

TEST(ReadNpy, ExplainsWhatItRefuses) {
  const std::string save = "; save numbers: np.save('run.npy', np.column_stack([t, angle]).astype(float))";
  EXPECT_EQ(FaultOf(NpyOf("'|O'", "(1,)", "\x80\x04x")),
            "run.csv: this array of NumPy contains Python objects (pickle), which are not read" + save);
  EXPECT_EQ(FaultOf(NpyOf("'<c16'", "(1,)", std::string(16, '\0'))),
            "run.csv: this array of NumPy has elements of type \"<c16\", which are not read" + save);
  EXPECT_EQ(FaultOf(NpyOf("[('t', [('s', '<f8')])]", "(1,)", std::string(8, '\0'))),
            "run.csv: this array of NumPy has elements of type \"records in records\", which are not read" + save);
  EXPECT_EQ(FaultOf(NpyOf("'<f8'", "(1, 2, 3)", std::string(48, '\0'))),
            "run.csv: this array of NumPy has 3 dimensions; save the times and the angles as two columns: "
            "np.column_stack([t, angle])");
  EXPECT_EQ(FaultOf(NpyOf("'<f8'", "(9,)", Raw(kTimes))),
            "run.csv: this array of NumPy is damaged or cut off; save or copy it again");
  for (const char* const shape : {"(4611686018427387905, 4)", "(-1,)", "(99999999999999999999,)"}) {
    EXPECT_THAT(FaultOf(NpyOf("'<f8'", shape, Raw(kTimes))), HasSubstr("damaged or cut off")) << shape;
  }
}

TEST(ReadNpy, SurvivesDamagedHeaders) {
  const std::string whole = NpyOf("[('time_s', '<f8'), ('angle_rad', '<f8')]", "(4,)", Raw(kTimes));
  for (std::size_t at = 6; at < 140; ++at) {
    for (const char byte : {'\0', '\'', '(', ')', ',', '9', 'O', '\xFF'}) {
      std::string damaged = whole;
      damaged[at] = byte;
      ReadNpy(damaged, 100'000);
      ReadNpy(damaged.substr(0, at), 100'000);
    }
  }
}

}  // namespace
}  // namespace pendulum::npy_test
