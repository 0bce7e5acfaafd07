// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/summary_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/web/embedded_json.h"

namespace pendulum::summary_page_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(SummaryHtml, ContainsTheSummary) {
  const Json summary = {{"schema_version", 2}, {"store", {{"path", "results.sqlite"}, {"runs", 2000}}}};
  const std::string html = SummaryHtml(summary);
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_EQ(Embedded(html, "summary"), summary);
  EXPECT_THAT(html, Not(HasSubstr("@SUMMARY@")));
}

TEST(SummaryHtml, EscapesScriptEndsInNames) {
  const Json summary = {{"id", "</script><script>alert(1)</script>"}};
  const std::string html = SummaryHtml(summary);
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_EQ(Embedded(html, "summary"), summary);
}

// The page has no address of a server, and its policy forbids loading.
TEST(SummaryHtml, LoadsNoResources) {
  const std::string html = SummaryHtml(nullptr);
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr(" src=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
}

}  // namespace
}  // namespace pendulum::summary_page_test
