// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/http.h"

#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::http_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Field, IsFoundInAnyCase) {
  const HttpRequest request = {"GET", "/", {{"Host", "a"}, {"cOnTent-TYPE", "text/csv"}}, ""};
  EXPECT_EQ(request.Field("Content-Type"), "text/csv");
  EXPECT_EQ(request.Field("content-type"), "text/csv");
  EXPECT_EQ(request.Field("HOST"), "a");
}

TEST(Field, IsMissingIfAbsent) {
  const HttpRequest request = {"GET", "/", {{"Host", ""}}, ""};
  EXPECT_EQ(request.Field("Accept"), std::nullopt);
  EXPECT_EQ(request.Field("Hos"), std::nullopt);
  EXPECT_EQ(request.Field("Hosts"), std::nullopt);
  EXPECT_EQ(request.Field(""), std::nullopt);
  EXPECT_EQ(request.Field("Host"), "") << "an empty field is not missing";
}

TEST(Field, IsTheFirstIfRepeated) {
  const HttpRequest request = {"GET", "/", {{"X", "1"}, {"x", "2"}}, ""};
  EXPECT_EQ(request.Field("x"), "1");
}

TEST(Field, IgnoresCaseForAsciiLettersOnly) {  // RFC 9110, section 5.1; '@' and '`' differ by 0x20 like 'A' and 'a'
  const HttpRequest request = {"GET", "/", {{"^", "1"}}, ""};
  EXPECT_EQ(request.Field("~"), std::nullopt);
}

TEST(Fields, AreAllFieldsOfThatNameInOrder) {
  const HttpRequest request = {"GET", "/", {{"X", "1"}, {"Host", "a"}, {"x", "2"}}, ""};
  EXPECT_THAT(request.Fields("x"), ElementsAre("1", "2"));
  EXPECT_THAT(request.Fields("Accept"), IsEmpty());
}

}  // namespace
}  // namespace pendulum::http_test
