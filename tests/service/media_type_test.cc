// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/media_type.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::media_type_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;
using testing::Pair;

MediaType TypeOf(const std::string& text) {
  const auto type = ParseMediaType(text);
  EXPECT_TRUE(type) << text << ": " << type.error().message();
  return type ? *type : MediaType();
}

/// The error message for a refused media type.
std::string FaultOf(const std::string& text) {
  const auto type = ParseMediaType(text);
  if (type) return "not refused";
  EXPECT_EQ(type.error().code, StatusCode::kInvalidArgument);
  return type.error().message();
}

FieldParameters ParametersOf(const std::string& text, Backslash backslash) {
  const auto parameters = ParseFieldParameters(text, "a test", backslash);
  EXPECT_TRUE(parameters) << text << ": " << parameters.error().message();
  return parameters ? *parameters : FieldParameters();
}

// RFC 9110, section 8.3.1: "the following media types are equivalent".
TEST(ParseMediaType, ReadsTheEquivalentExamplesOfTheStandard) {
  EXPECT_EQ(TypeOf("text/html;charset=utf-8").type, "text/html");
  EXPECT_THAT(TypeOf("text/html;charset=utf-8").Parameter("charset"), Optional(std::string_view("utf-8")));
  EXPECT_THAT(TypeOf("Text/HTML;Charset=\"utf-8\"").Parameter("charset"), Optional(std::string_view("utf-8")));
  EXPECT_EQ(TypeOf("Text/HTML;Charset=\"utf-8\"").type, "text/html");
  EXPECT_THAT(TypeOf("text/html; charset=\"utf-8\"").Parameter("charset"), Optional(std::string_view("utf-8")));
  EXPECT_THAT(TypeOf("text/html;charset=UTF-8").Parameter("charset"), Optional(std::string_view("UTF-8")));
}

TEST(ParseMediaType, ReadsATypeWithoutParameters) {
  EXPECT_EQ(TypeOf("application/problem+json").type, "application/problem+json");
  EXPECT_EQ(TypeOf(" \ttext/csv \t").type, "text/csv");
  EXPECT_THAT(TypeOf("text/csv").parameters, IsEmpty());
  EXPECT_FALSE(TypeOf("text/csv").Parameter("charset"));
}

// RFC 9110, section 5.6.6: parameters = *( OWS ";" OWS [ parameter ] ).
TEST(ParseMediaType, AllowsBlanksAndEmptyParameters) {
  EXPECT_THAT(TypeOf("text/csv ; ;; a=1\t;b=\"2\" ;").parameters, ElementsAre(Pair("a", "1"), Pair("b", "2")));
  EXPECT_THAT(TypeOf("text/csv;").parameters, IsEmpty());
}

// RFC 9110, section 5.6.4: a backslash escapes any character.
TEST(ParseMediaType, ReadsQuotedValues) {
  EXPECT_THAT(TypeOf(R"(a/b; c="x; y=\"z\" \\ \q"; d="")").parameters,
              ElementsAre(Pair("c", R"(x; y="z" \ q)"), Pair("d", "")));
  // RFC 2046, section 5.1.1: a colon needs quotes.
  EXPECT_THAT(TypeOf("multipart/mixed; boundary=\"gc0pJq0M:08jU534c0p\"").Parameter("boundary"),
              Optional(std::string_view("gc0pJq0M:08jU534c0p")));
}

TEST(ParseMediaType, RefusesInvalidTypes) {
  EXPECT_EQ(FaultOf(""), "the content type \"\" is not a media type; write one such as text/csv");
  for (const char* text : {"text", "text/", "/csv", "/", "text/csv/x", "text /csv", "text/ csv", "te(xt/csv",
                           "text/csv,a/b", "text/csv x", ";charset=utf-8", "t\xC3\xA9xt/csv", "\"text/csv\""}) {
    EXPECT_THAT(FaultOf(text), EndsWith("is not a media type; write one such as text/csv")) << text;
  }
}

TEST(ParseMediaType, RefusesInvalidParameters) {
  const auto fault = [](const std::string& parameters) { return FaultOf("text/csv;" + parameters); };
  EXPECT_EQ(fault("charset"), "the parameters of the content type have \"charset\", which is not name=value");
  EXPECT_THAT(fault("=utf-8"), HasSubstr("which is not name=value"));
  EXPECT_THAT(fault("charset =utf-8"), HasSubstr("which is not name=value"));  // RFC 9110, 5.6.6: no blanks
  EXPECT_THAT(fault("charset= utf-8"), HasSubstr("whose value must be in quotes"));
  EXPECT_THAT(fault("charset=;a=b"), HasSubstr("whose value must be in quotes"));
  EXPECT_THAT(fault("charset=\xC3\xA9"), HasSubstr("whose value must be in quotes"));
  EXPECT_THAT(fault("a=b c=d"), HasSubstr("\"c=d\", where a semicolon must be"));
  EXPECT_THAT(fault("a=\"b\"c"), HasSubstr("\"c\", where a semicolon must be"));
  for (const char* open :
       {"a=\"", "a=\"b", "a=\"b\\\"", "a=\"b\\", "a=\"\x01\"", "a=\"\r\n\"", "a=\"\x7F\"", "a=\"\\\n\""}) {
    EXPECT_THAT(fault(open), HasSubstr("whose quotes do not close, or contain a control character")) << open;
  }
  EXPECT_EQ(fault("a=1; b=2; A=3"),
            "the parameters of the content type have \"a\", which is given twice; keep one of them");
}

// Browsers encode file names by WHATWG HTML, section 4.10.21.8 (multipart/form-data encoding): quotes and line breaks
// are escaped, a backslash is not.
TEST(ParseFieldParameters, KeepsABackslashThatEscapesNoQuote) {
  EXPECT_THAT(ParametersOf(R"(;filename="C:\runs\a.csv")", Backslash::kEscapesQuotes),
              ElementsAre(Pair("filename", R"(C:\runs\a.csv)")));
  EXPECT_THAT(ParametersOf(R"(;filename="a\"b\\c.csv")", Backslash::kEscapesQuotes),
              ElementsAre(Pair("filename", R"(a"b\c.csv)")));
  EXPECT_THAT(ParametersOf(R"(;filename="C:\runs\a.csv")", Backslash::kEscapesAll),
              ElementsAre(Pair("filename", "C:runsa.csv")));
}

TEST(ParseFieldParameters, KeepsNonAsciiBytesInQuotes) {
  EXPECT_THAT(ParametersOf(";a=\"Öl \xFF\\\xC3\xA9\"", Backslash::kEscapesAll), ElementsAre(Pair("a", "Öl \xFFé")));
}

TEST(ParseFieldParameters, NamesTheirField) {
  const auto wrong = ParseFieldParameters("x", "part 3", Backslash::kEscapesQuotes);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message(), "the parameters of part 3 have \"x\", where a semicolon must be");
}

TEST(ParseFieldParameters, ReadsManyParameters) {
  constexpr int kMany = 100'000;
  std::string text;
  for (int i = 0; i < kMany; ++i) text += ";p" + std::to_string(i) + "=\"" + std::to_string(i) + "\"";
  EXPECT_EQ(ParametersOf(text + std::string(kMany, ';') + std::string(kMany, ' '), Backslash::kEscapesAll).size(),
            kMany);
}

TEST(IsToken, AcceptsTokenCharactersOnly) {
  EXPECT_TRUE(IsToken("!#$%&'*+-.^_`|~09azAZ"));  // all characters of RFC 9110, section 5.6.2
  for (const char c : std::string("\"(),/:;<=>?@[\\]{} \t\x7F\x80\xFF") + '\0') {
    EXPECT_FALSE(IsToken("a" + std::string(1, c))) << static_cast<int>(c);
  }
  EXPECT_FALSE(IsToken(""));
}

TEST(LowerCase, KeepsNonAsciiBytes) { EXPECT_EQ(LowerCase("AZaz[@Ä"), "azaz[@Ä"); }

TEST(WithoutBlanks, KeepsInnerBlanks) {
  EXPECT_EQ(WithoutBlanks(" \ta b\t "), "a b");
  EXPECT_EQ(WithoutBlanks(" \t"), "");
  EXPECT_EQ(WithoutBlanks(""), "");
}

}  // namespace
}  // namespace pendulum::media_type_test
