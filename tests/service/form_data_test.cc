// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/form_data.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::form_data_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kType = "multipart/form-data; boundary=X";

/// Parts in the form "name|filename|content type|content".
std::vector<std::string> PartsOf(const std::string& content_type, const std::string& body) {
  const auto parts = ParseFormData(content_type, body);
  if (!parts) return {"refused: " + parts.error().message()};
  std::vector<std::string> shown;
  for (const FormPart& part : *parts) {
    shown.push_back(part.name + "|" + part.filename + "|" + part.content_type + "|" + std::string(part.content));
  }
  return shown;
}

/// A form with one part of this head and content.
std::string Form(const std::string& head, const std::string& content = "x") {
  return "--X\r\n" + head + "\r\n\r\n" + content + "\r\n--X--\r\n";
}

std::string Named(const std::string& parameters) { return "Content-Disposition: form-data; " + parameters; }

/// "name|filename" of one part with these parameters.
std::string NamesOf(const std::string& parameters) {
  const std::vector<std::string> parts = PartsOf(kType, Form(Named(parameters)));
  return parts.size() == 1 ? parts.front().substr(0, parts.front().find("||x")) : "not one part";
}

/// The error message for a refused form.
std::string FaultOf(const std::string& content_type, const std::string& body) {
  const auto parts = ParseFormData(content_type, body);
  if (parts) return "not refused";
  EXPECT_EQ(parts.error().code, StatusCode::kInvalidArgument);
  EXPECT_LT(parts.error().message().size(), 400);
  return parts.error().message();
}

std::string FaultOf(const std::string& body) { return FaultOf(kType, body); }

// ---- Bodies recorded from clients ----------------------------------------------------------------------------------

// curl 7.88.1 -F 'data=@run ä.csv;type=text/csv' -F 'data=@"q\"b\\c.csv"'
//   -F 'rig=@rig.json;type=application/json;filename="x.json"' -F 'options={"model":"drag"}'
TEST(ParseFormData, ReadsWhatCurlSends) {
  const std::string body =
      "--------------------------411ed7379ce11781\r\nContent-Disposition: form-data; name=\"data\"; filename=\"run "
      "\xc3\xa4.csv\"\r\nContent-Type: text/csv\r\n\r\nt,a\n0,1\n\r\n--------------------------411ed7379ce11781\r\n"
      "Content-Disposition: form-data; name=\"data\"; filename=\"q%22b\\c.csv\"\r\nContent-Type: "
      "application/octet-stream\r\n\r\nt,a\n0,2\n\r\n--------------------------411ed7379ce11781\r\n"
      "Content-Disposition: form-data; name=\"rig\"; filename=\"x.json\"\r\nContent-Type: application/json\r\n\r\n"
      "{\"a\":1}\r\n--------------------------411ed7379ce11781\r\nContent-Disposition: form-data; name=\"options\"\r\n"
      "\r\n{\"model\":\"drag\"}\r\n--------------------------411ed7379ce11781--\r\n";
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=------------------------411ed7379ce11781", body),
              ElementsAre("data|run ä.csv|text/csv|t,a\n0,1\n", "data|q\"b\\c.csv|application/octet-stream|t,a\n0,2\n",
                          "rig|x.json|application/json|{\"a\":1}", "options|||{\"model\":\"drag\"}"));
}

// curl 7.88.1 --form-escape -F 'name=x;type=text/plain' -F 'e=' -F 'data=@"q\"b\\c.csv"'
TEST(ParseFormData, ReadsWhatCurlSendsWithBackslashes) {
  const std::string body =
      "--------------------------e0961e86aab4e6d8\r\nContent-Disposition: form-data; name=\"name\"\r\nContent-Type: "
      "text/plain\r\n\r\nx\r\n--------------------------e0961e86aab4e6d8\r\nContent-Disposition: form-data; name=\"e\""
      "\r\n\r\n\r\n--------------------------e0961e86aab4e6d8\r\nContent-Disposition: form-data; name=\"data\"; "
      "filename=\"q\\\"b\\\\c.csv\"\r\nContent-Type: application/octet-stream\r\n\r\nt,a\n0,2\n\r\n"
      "--------------------------e0961e86aab4e6d8--\r\n";
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=------------------------e0961e86aab4e6d8", body),
              ElementsAre("name||text/plain|x", "e|||", "data|q\"b\\c.csv|application/octet-stream|t,a\n0,2\n"));
}

// Python's requests 2.34.2 with urllib3 2.7.0: files data 'läuf "1".csv' and 'b\\c\r\n.csv', fields options and ö.
TEST(ParseFormData, ReadsAFormOfRequests) {
  const std::string body =
      "--d813902922a28381460adff4595def90\r\nContent-Disposition: form-data; name=\"options\"\r\n\r\n"
      "{\"model\":\"drag\"}\r\n--d813902922a28381460adff4595def90\r\nContent-Disposition: form-data; name=\"\xc3\xb6\""
      "\r\n\r\n\xc3\xbc\r\n--d813902922a28381460adff4595def90\r\nContent-Disposition: form-data; name=\"data\"; "
      "filename=\"l\xc3\xa4uf %221%22.csv\"\r\nContent-Type: text/csv\r\n\r\nt,a\n0,1\n\r\n"
      "--d813902922a28381460adff4595def90\r\nContent-Disposition: form-data; name=\"data\"; filename=\"b\\c%0D%0A"
      ".csv\"\r\n\r\n\r\n--d813902922a28381460adff4595def90--\r\n";
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=d813902922a28381460adff4595def90", body),
              ElementsAre("options|||{\"model\":\"drag\"}", "ö|||ü", "data|läuf \"1\".csv|text/csv|t,a\n0,1\n",
                          "data|b\\c\r\n.csv||"));
}

// Chromium 156: append("data", csv, 'a "b"\\c\r\n%22 äπ.csv'), append("options", '{"model": "drag"}\r\nx\ny'),
// append('na"me\n', ""), append("plain", a Blob without a type). A literal %22 in the name is decoded too.
TEST(ParseFormData, ReadsABrowsersForm) {
  const std::string body =
      "------WebKitFormBoundaryepWWNMvwjaQ52KHP\r\nContent-Disposition: form-data; name=\"data\"; filename=\"a "
      "%22b%22\\c%0D%0A%22 \xc3\xa4\xcf\x80.csv\"\r\nContent-Type: text/csv\r\n\r\nt,a\n0,1\n\r\n"
      "------WebKitFormBoundaryepWWNMvwjaQ52KHP\r\nContent-Disposition: form-data; name=\"options\"\r\n\r\n"
      "{\"model\": \"drag\"}\r\nx\r\ny\r\n------WebKitFormBoundaryepWWNMvwjaQ52KHP\r\nContent-Disposition: form-data; "
      "name=\"na%22me%0D%0A\"\r\n\r\n\r\n------WebKitFormBoundaryepWWNMvwjaQ52KHP\r\nContent-Disposition: form-data; "
      "name=\"plain\"; filename=\"blob\"\r\nContent-Type: application/octet-stream\r\n\r\n\r\n"
      "------WebKitFormBoundaryepWWNMvwjaQ52KHP--\r\n";
  EXPECT_THAT(
      PartsOf("multipart/form-data; boundary=----WebKitFormBoundaryepWWNMvwjaQ52KHP", body),
      ElementsAre("data|a \"b\"\\c\r\n\" äπ.csv|text/csv|t,a\n0,1\n", "options|||{\"model\": \"drag\"}\r\nx\r\ny",
                  "na\"me\r\n|||", "plain|blob|application/octet-stream|"));
  // The same browser, and Node's fetch, send this for a form without fields.
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=----WebKitFormBoundaryq7wAslCctbBtKqqZ",
                      "------WebKitFormBoundaryq7wAslCctbBtKqqZ--\r\n"),
              IsEmpty());
}

// Python's email package, as_bytes(policy=email.policy.HTTP) and SMTP, which folds long lines.
TEST(ParseFormData, ReadsAFormOfPythonsEmail) {
  const std::string type = "multipart/form-data;\t boundary=\"===============8676321469719812468==\"";
  const std::string begin =
      "--===============8676321469719812468==\r\nContent-Type: text/csv; charset=\"us-ascii\"\r\n"
      "MIME-Version: 1.0\r\nContent-Transfer-Encoding: 7bit\r\n";
  const std::string end = "\r\n\r\nt,a\r\n0,1\r\n\r\n--===============8676321469719812468==--\r\n";
  EXPECT_THAT(PartsOf(type, begin +
                                "Content-Disposition: form-data; name=\"data\"; "
                                "filename*=utf-8'en'l%C3%A4uf%20xxxx.csv" +
                                end),
              ElementsAre("data|läuf xxxx.csv|text/csv; charset=\"us-ascii\"|t,a\r\n0,1\r\n"));
  EXPECT_THAT(
      PartsOf(type, begin + "Content-Disposition: form-data; name=\"data\";\r\n filename=\"a\r\n\tb.csv\"" + end),
      ElementsAre("data|a\tb.csv|text/csv; charset=\"us-ascii\"|t,a\r\n0,1\r\n"));
}

// ---- Examples from the standards -----------------------------------------------------------------------------------

// RFC 2046, section 5.1.1, the boundaries of its example. Preamble and epilogue are ignored. The last line end before a
// boundary belongs to the boundary; a line end before that one belongs to the part.
TEST(ParseFormData, SkipsPreambleAndEpilogue) {
  const std::string body =
      "This is the preamble.  It is to be ignored, though it\r\nis a handy place for composers to include an\r\n"
      "explanatory note.\r\n\r\n--simple boundary\r\nContent-Disposition: form-data; name=a\r\n\r\nThis does NOT end "
      "with a linebreak.\r\n--simple boundary\r\nContent-Disposition: form-data; name=b\r\nContent-type: text/plain; "
      "charset=us-ascii\r\n\r\nThis DOES end with a linebreak.\r\n\r\n--simple boundary--\r\n\r\nThis is the epilogue. "
      " It is also to be ignored.\r\n--simple boundary\r\n";
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=\"simple boundary\"", body),
              ElementsAre("a|||This does NOT end with a linebreak.",
                          "b||text/plain; charset=us-ascii|This DOES end with a linebreak.\r\n"));
}

// The form of RFC 7578, sections 4.2 and 5.1, with names of RFC 6266, section 5, and RFC 8187, section 3.2.3.
TEST(ParseFormData, ReadsFileNames) {
  EXPECT_EQ(NamesOf("name=\"data\"; filename=\"example.csv\""), "data|example.csv");
  EXPECT_EQ(NamesOf("name=data; filename=example.csv"), "data|example.csv");
  EXPECT_EQ(NamesOf("NAME=data; FileName=\"an example.csv\""), "data|an example.csv");
  EXPECT_EQ(NamesOf("name=data; filename*=UTF-8''%e2%82%ac%20rates"), "data|€ rates");
  EXPECT_EQ(NamesOf("name=data; filename=\"EURO rates\"; filename*=utf-8''%e2%82%ac%20rates"), "data|€ rates");
  EXPECT_EQ(NamesOf("name=data; filename*=utf-8''%e2%82%ac%20rates; filename=\"EURO rates\""), "data|€ rates");
  EXPECT_EQ(NamesOf("name=data; filename*=utf-8'en'%C2%A3%20rates"), "data|£ rates");
  EXPECT_EQ(NamesOf("name=data"), "data|");
  EXPECT_EQ(NamesOf("name=data; filename=\"\""), "data|");
  EXPECT_EQ(NamesOf("name=data; filename=\"../../etc/passwd\""), "data|../../etc/passwd");  // never used as a path
}

// WHATWG HTML, section 4.10.21.8: only a quote and line breaks are escaped.
TEST(ParseFormData, DecodesOnlyTheEscapesOfBrowsers) {
  EXPECT_EQ(NamesOf("name=\"%22%0d%0A\"; filename=\"100%25 %41 %2 %\""), "\"\r\n|100%25 %41 %2 %");
  EXPECT_EQ(NamesOf("name=\"%2522\"; filename=\"%%22\""), "%2522|%\"");
}

TEST(ParseFormData, ReadsNamesThatContainBackslashesAndSemicolons) {
  EXPECT_EQ(NamesOf(R"(name="a;b"; filename="c:\runs\\x; name=\"y\".csv")"), "a;b|c:\\runs\\x; name=\"y\".csv");
}

TEST(ParseFormData, ReadsFieldsInAnyCaseAndOrder) {
  EXPECT_THAT(PartsOf(kType, Form("content-TYPE:text/csv\r\nX-Other: y\r\ncontent-disposition:FORM-DATA ;name=a")),
              ElementsAre("a||text/csv|x"));
  for (const char* encoding : {"7bit", "8BIT", "binary"}) {
    EXPECT_THAT(PartsOf(kType, Form(Named("name=a") + "\r\nContent-Transfer-Encoding: " + encoding)),
                ElementsAre("a|||x"));
  }
}

// ---- Boundaries ----------------------------------------------------------------------------------------------------

TEST(ParseFormData, AcceptsABoundaryOnlyOnItsOwnLine) {
  const std::string content = "--X\r\n--X\n\r\n--XY\r\n --X\r\nx--X\r\n--X-\r\n--X--y\r\n--x\r\n\n--X--\r\r\n- -X--";
  // At the start of the content the first of these lines would end the part; "-" prevents that.
  EXPECT_THAT(PartsOf(kType, Form(Named("name=a"), "-" + content)), ElementsAre("a|||-" + content));
}

// RFC 2046, section 5.1.1: transport-padding, which a receiver must handle.
TEST(ParseFormData, SkipsBlanksAfterABoundary) {
  const std::string head = Named("name=a") + "\r\n\r\n";
  EXPECT_THAT(PartsOf(kType, "--X \t \r\n" + head + "1\r\n--X\t\r\n" + head + "2\r\n--X-- \t"),
              ElementsAre("a|||1", "a|||2"));
  EXPECT_THAT(PartsOf(kType, "\r\n--X\r\n" + head + "1\r\n--X--  \r\nepilogue"), ElementsAre("a|||1"));
}

TEST(ParseFormData, ReadsContentOfAnyBytes) {
  std::string content;
  for (int i = 0; i < 256; ++i) content += static_cast<char>(i);
  EXPECT_THAT(PartsOf(kType, Form(Named("name=a"), content)), ElementsAre("a|||" + content));
  EXPECT_THAT(PartsOf(kType, Form(Named("name=a"), "\r\n\r\n")), ElementsAre("a|||\r\n\r\n"));
  EXPECT_THAT(PartsOf(kType, Form(Named("name=a"), "")), ElementsAre("a|||"));
}

// RFC 2046, section 5.1.1: body-part := MIME-part-headers [CRLF *OCTET], so the blank line may belong to the boundary.
TEST(ParseFormData, ReadsAPartWithoutContent) {
  EXPECT_THAT(PartsOf(kType, "--X\r\n" + Named("name=a") + "\r\n\r\n--X--"), ElementsAre("a|||"));
}

TEST(ParseFormData, AcceptsBoundariesOfAllCharacters) {
  const std::string letters = "0'()+_,-./:=? z";  // RFC 2046: bchars
  EXPECT_THAT(PartsOf("multipart/form-data; boundary=\"" + letters + "\"",
                      "--" + letters + "\r\n" + Named("name=a") + "\r\n\r\nx\r\n--" + letters + "--"),
              ElementsAre("a|||x"));
  const std::string longest(70, 'b');
  EXPECT_THAT(PartsOf("Multipart/Form-Data; charset=utf-8; Boundary=" + longest, "--" + longest + "--"), IsEmpty());
}

TEST(ParseFormData, RefusesAFormWithoutABoundary) {
  EXPECT_EQ(FaultOf("multipart/form-data", Form(Named("name=a"))),
            "the form has no boundary; write it as multipart/form-data; boundary=...");
  EXPECT_THAT(FaultOf("multipart/form-data; boundary=\"\"", ""), HasSubstr("it must have 1 to 70 bytes"));
  EXPECT_THAT(FaultOf("multipart/form-data; boundary=" + std::string(71, 'b'), ""),
              HasSubstr("it must have 1 to 70 bytes"));
  EXPECT_THAT(FaultOf("multipart/form-data; boundary=\"b \"", ""), HasSubstr("end in a blank"));
  EXPECT_EQ(FaultOf("multipart/mixed; boundary=X", Form(Named("name=a"))),
            "the content type is \"multipart/mixed\"; it must be multipart/form-data");
  EXPECT_THAT(FaultOf("multipart/form-data; boundary=X; boundary=Y", ""), HasSubstr("given twice"));
  EXPECT_THAT(FaultOf("", ""), HasSubstr("is not a media type"));
}

TEST(ParseFormData, RefusesABodyWithoutItsBoundary) {
  const std::string fault =
      "the form has no line \"--X\", the boundary of its content type; begin each part with one, and end it in CR LF";
  for (const char* body : {"", "--", "--X", "--X-", "X--", "--Y--\r\n", "x --X--", "\n--X--", "--X\n", "--X \t"}) {
    EXPECT_EQ(FaultOf(body), fault) << body;
  }
}

TEST(ParseFormData, RefusesATruncatedForm) {
  const std::string whole =
      "--X\r\n" + Named("name=a") + "\r\n\r\none\r\n--X\r\n" + Named("name=b") + "\r\n\r\ntwo\r\n--X--";
  ASSERT_EQ(PartsOf(kType, whole).size(), 2);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(FaultOf(whole.substr(0, size)), "not refused") << size;
  }
  EXPECT_EQ(FaultOf(whole.substr(0, whole.size() - 2)),
            "part 2 of the form has no boundary after it; end the form with \"--X--\"");
  EXPECT_THAT(FaultOf(whole.substr(0, 20)), StartsWith("part 1 of the form has no boundary after it"));
}

// ---- Heads ---------------------------------------------------------------------------------------------------------

TEST(ParseFormData, RefusesAPartWithoutAName) {
  const std::string fault = "part 1 of the form has no name; write Content-Disposition: form-data; name=\"data\"";
  EXPECT_EQ(FaultOf("--X\r\n\r\nx\r\n--X--"), fault);
  EXPECT_EQ(FaultOf(Form("Content-Type: text/csv")), fault);
  EXPECT_EQ(FaultOf(Form("Content-Disposition: form-data")), fault);
  EXPECT_EQ(FaultOf(Form(Named("filename=a.csv"))), fault);
  EXPECT_EQ(FaultOf(Form(Named("name=\"\""))), fault);
  EXPECT_EQ(FaultOf(Form(Named("name*=utf-8''a"))), fault);
}

TEST(ParseFormData, NamesTheFaultyPart) {
  EXPECT_THAT(FaultOf("--X\r\n" + Named("name=a") + "\r\n\r\n1\r\n--X\r\nA: b\r\n\r\n2\r\n--X--"),
              StartsWith("part 2 of the form has no name"));
}

TEST(ParseFormData, RefusesAnotherDisposition) {
  EXPECT_EQ(FaultOf(Form("Content-Disposition: attachment; name=a")),
            "part 1 of the form has the Content-Disposition \"attachment; name=a\"; it must be form-data");
  EXPECT_THAT(FaultOf(Form("Content-Disposition: name=a")), HasSubstr("it must be form-data"));
  EXPECT_THAT(FaultOf(Form(Named("name=a; name=b"))), HasSubstr("\"name\", which is given twice"));
  EXPECT_THAT(FaultOf(Form(Named("name=\"a"))), HasSubstr("whose quotes do not close"));
  EXPECT_THAT(FaultOf(Form(Named("name=a b"))),
              HasSubstr("the parameters of part 1 of the form have \"b\", where a semicolon must be"));
  EXPECT_THAT(FaultOf(Form(Named("name=a") + "\r\n" + Named("name=b"))),
              HasSubstr("has the field content-disposition twice"));
}

TEST(ParseFormData, RefusesEncodedContent) {
  for (const char* encoding : {"base64", "quoted-printable", "x-gzip", ""}) {
    EXPECT_EQ(FaultOf(Form(Named("name=a") + "\r\nContent-Transfer-Encoding: " + encoding)),
              "part 1 of the form has the Content-Transfer-Encoding \"" + std::string(encoding) +
                  "\"; send its bytes as they are, in binary");
  }
}

TEST(ParseFormData, RefusesNamesInOtherEncodings) {
  const auto fault = [](const std::string& value) { return FaultOf(Form(Named("name=a; filename*=" + value))); };
  EXPECT_EQ(fault("iso-8859-1'en'%A3%20rates"),  // RFC 5987's example, which is not in RFC 8187
            "part 1 of the form has the filename* \"iso-8859-1'en'%A3%20rates\"; write UTF-8''name, or "
            "filename=\"name\"");
  EXPECT_THAT(fault("a.csv"), HasSubstr("write UTF-8''name"));
  EXPECT_THAT(fault("utf-8'a.csv"), HasSubstr("write UTF-8''name"));
  EXPECT_THAT(fault("''a.csv"), HasSubstr("write UTF-8''name"));
  for (const char* value : {"utf-8''%A3", "utf-8''%C0%AF", "utf-8''%", "utf-8''%4", "utf-8''%ED%A0%80", "utf-8''%G0"}) {
    EXPECT_THAT(fault(value), HasSubstr("whose escapes are not UTF-8")) << value;
  }
}

TEST(ParseFormData, RefusesInvalidHeads) {
  EXPECT_EQ(FaultOf(Form("no colon")), "part 1 of the form has the line \"no colon\" in its head; write Name: value");
  EXPECT_THAT(FaultOf(Form("Content Type: a/b")), HasSubstr("write Name: value"));
  EXPECT_THAT(FaultOf(Form(": a/b")), HasSubstr("write Name: value"));
  EXPECT_THAT(FaultOf(Form(" " + Named("name=a"))), HasSubstr("write Name: value"));
  EXPECT_THAT(FaultOf(Form(Named("name=a") + "\nX: y")), HasSubstr("has a control character in its head"));
  EXPECT_THAT(FaultOf(Form(Named("name=a") + "\rX: y")), HasSubstr("has a control character in its head"));
  EXPECT_THAT(FaultOf(Form(Named("name=\"a") + std::string(1, '\0') + "\"")), HasSubstr("has a control character"));
  EXPECT_THAT(FaultOf(Form(Named("name=\"\x1b[2J\""))), HasSubstr("has a control character"));
  const std::string no_blank_line =
      "part 1 of the form has no blank line below its head; write one, with lines that end in CR LF";
  EXPECT_EQ(FaultOf("--X\r\n" + Named("name=a") + "\r\n--X--"), no_blank_line);
  EXPECT_EQ(FaultOf("--X\r\n" + Named("name=a") + "\n\nx\r\n--X--"), no_blank_line);
  EXPECT_EQ(FaultOf("--X\r\n--X--"), no_blank_line);
}

// ---- Limits --------------------------------------------------------------------------------------------------------

TEST(ParseFormData, LimitsTheHeadOfAPart) {
  const std::string rest = "Content-Disposition: form-data; name=\"\"";
  const auto head = [&](std::size_t bytes) { return Named("name=\"" + std::string(bytes - rest.size(), 'n') + "\""); };
  EXPECT_EQ(PartsOf(kType, Form(head(kMaxPartHeadBytes))).front().size(), kMaxPartHeadBytes - rest.size() + 4);
  EXPECT_EQ(FaultOf(Form(head(kMaxPartHeadBytes + 1))),
            "part 1 of the form has a head of more than 8192 bytes, or no blank line below it; shorten its names");
  EXPECT_THAT(FaultOf(Form("X: " + std::string(1 << 20, 'n'))), HasSubstr("more than 8192 bytes"));
}

TEST(ParseFormData, LimitsTheNumberOfParts) {
  const std::string part = "--X\r\n" + Named("name=data") + "\r\n\r\nx\r\n";
  std::string body;
  for (std::size_t i = 0; i < kMaxFormParts; ++i) body += part;
  EXPECT_EQ(PartsOf(kType, body + "--X--").size(), kMaxFormParts);
  EXPECT_EQ(FaultOf(body + part + "--X--"), "the form has more than 20000 parts; send several forms");
}

// A parser that restarts at every line, or at every byte of a line, would need quadratic time.
TEST(ParseFormData, ReadsLongBodiesWithTextLikeABoundary) {
  constexpr std::size_t kBytes = std::size_t{1} << 21;
  const std::string head = "--X\r\n" + Named("name=a") + "\r\n\r\n";
  for (const std::string piece :
       {"\r", "\r\n", "\r\n-", "\r\n--", "\r\n--XX", "\r\n--X-", "\r\n--X\tx", "\r\n--X--x", " ", "\r\n--X \t \t"}) {
    std::string content;
    while (content.size() < kBytes)
      content += piece + (piece.ends_with("\t \t") ? std::string(100'000, ' ') + "-" : "");
    const auto parts = ParseFormData(kType, head + content + "!\r\n--X--");
    ASSERT_TRUE(parts) << piece << parts.error().message();
    EXPECT_EQ(parts->front().content.size(), content.size() + 1) << piece;
    EXPECT_NE(FaultOf(head + content), "not refused") << piece;
    EXPECT_NE(FaultOf("--X" + content), "not refused") << piece;
  }
}

}  // namespace
}  // namespace pendulum::form_data_test
