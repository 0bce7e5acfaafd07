// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/containers/utf16.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/sha256.h"
#include "tests/recording/rows.h"

namespace pendulum::utf16_test {
namespace {

using std::string_literals::operator""s;

/// A text of ASCII and Latin-1 in two bytes per character.
std::string Wide(const std::string& text, bool is_big) {
  std::string wide;
  for (const char c : text) wide += is_big ? std::string(1, '\0') + c : c + std::string(1, '\0');
  return wide;
}

/// The examples of the Unicode Standard, table 3-4: U+004D, U+0430, U+4E8C, U+10302.
TEST(Utf8OfUtf16, ConvertsAllLengths) {
  EXPECT_EQ(Utf8OfUtf16("\x00\x4D\x04\x30\x4E\x8C\xD8\x00\xDF\x02"s, ByteOrder::kBig),
            "M\xD0\xB0\xE4\xBA\x8C\xF0\x90\x8C\x82");
  EXPECT_EQ(Utf8OfUtf16("\x4D\x00\x30\x04"s, ByteOrder::kLittle), "M\xD0\xB0");
}

TEST(Utf8OfUtf16, ReplacesInvalidCharacters) {
  const std::string replacement = "\xEF\xBF\xBD";
  EXPECT_EQ(Utf8OfUtf16("\xD8\x00\x00\x41"s, ByteOrder::kBig), replacement + "A");
  EXPECT_EQ(Utf8OfUtf16("\xDF\x02"s, ByteOrder::kBig), replacement);
  EXPECT_EQ(Utf8OfUtf16("\x00\x41\x00"s, ByteOrder::kBig), "A" + replacement);
}

TEST(Utf16Text, IsReadWithAndWithoutAMark) {
  const std::string text = "time_s\tangle_rad\r\n" + Rows("0.0{t}\t{v}");
  for (const bool is_big : {false, true}) {
    const std::string mark = is_big ? "\xFE\xFF" : "\xFF\xFE";
    for (const std::string& bytes : {Wide(text, is_big), mark + Wide(text, is_big)}) {
      const Recording recording = RecordingOf(bytes);
      ExpectTheRows(recording);
      EXPECT_TRUE(recording.warnings.empty());
      EXPECT_EQ(recording.sha256, Sha256(bytes).value());
    }
  }
}

TEST(Utf16Text, MayBeJson) {
  ExpectTheRows(
      RecordingOf(Wide("{\"time_s\": [0,0.01,0.02,0.03,0.04,0.05,0.06,0.07], \"angle_rad\": "
                       "[100,101,102,103,104,105,106,107]}",
                       false)));
}

}  // namespace
}  // namespace pendulum::utf16_test
