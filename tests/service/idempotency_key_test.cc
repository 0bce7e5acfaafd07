// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/idempotency_key.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::idempotency_key_test {
namespace {

using testing::HasSubstr;

HttpRequest Post(std::vector<HttpField> fields) { return {"POST", "/v1/fits", std::move(fields), ""}; }

std::string KeyOf(const std::string& value) {
  const auto key = IdempotencyKey(Post({{"Host", "localhost"}, {"Idempotency-Key", value}}));
  return key ? *key : "refused: " + key.error().message();
}

TEST(IdempotencyKey, IsTheHeaderValueWithoutSurroundingBlanks) {
  // The example of draft-ietf-httpapi-idempotency-key-header, section 2.1, with its quotes, and without quotes.
  EXPECT_EQ(KeyOf("\"8e03978e-40d5-43e8-bc93-6894a57f9324\""), "\"8e03978e-40d5-43e8-bc93-6894a57f9324\"");
  EXPECT_EQ(KeyOf("8e03978e-40d5-43e8-bc93-6894a57f9324"), "8e03978e-40d5-43e8-bc93-6894a57f9324");
  EXPECT_EQ(KeyOf(" \tk\t "), "k");  // RFC 9110, section 5.5: surrounding blanks are not part of the value
  std::string visible;
  for (char c = '!'; c <= '~'; ++c) visible += c;
  EXPECT_EQ(KeyOf(visible), visible);
  const auto lower_case = IdempotencyKey(Post({{"idempotency-KEY", "k"}}));
  ASSERT_TRUE(lower_case);
  EXPECT_EQ(*lower_case, "k");
}

TEST(IdempotencyKey, MayBeAbsent) {
  const auto none = IdempotencyKey(Post({{"X-Idempotency-Key", "k"}}));
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, "");
}

TEST(IdempotencyKey, IsLimitedTo255Bytes) {
  EXPECT_EQ(KeyOf(std::string(255, 'k')), std::string(255, 'k'));
  EXPECT_EQ(KeyOf(std::string(256, 'k')), "refused: the Idempotency-Key has 256 bytes; it may have at most 255");
}

TEST(IdempotencyKey, IsRefusedIfInvalid) {
  EXPECT_EQ(KeyOf(""), "refused: the Idempotency-Key is empty; give each request its own key, or none");
  EXPECT_THAT(KeyOf(" \t "), HasSubstr("is empty"));
  for (const std::string& key : {std::string("a b"), std::string("a\tb"), std::string("a\x7F"), std::string("\xC3\xA9"),
                                 std::string("a\0b", 3), std::string("a\nb"), std::string("\xFF")}) {
    EXPECT_THAT(KeyOf(key), HasSubstr("has characters other than visible ASCII")) << key;
  }
  const auto twice = IdempotencyKey(Post({{"Idempotency-Key", "a"}, {"idempotency-key", "a"}}));
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(twice.error().message(), "the Idempotency-Key is given more than once; keep one of them");
}

}  // namespace
}  // namespace pendulum::idempotency_key_test
