// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/report_page.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "tests/identify/example_joint_identification.h"
#include "tests/web/embedded_json.h"

namespace pendulum::report_page_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Recording ExampleSamples() {
  Recording used;
  used.time = Eigen::VectorXd::LinSpaced(8, 0, 0.7);
  used.value = Eigen::VectorXd::LinSpaced(8, 0.1, -0.123456789012);
  return used;
}

Identification SampledReport() {
  Identification report = ExampleIdentification();
  report.recordings.front().used = ExampleSamples();
  return report;
}

TEST(ToHtml, ContainsResultSeriesAndCommand) {
  const Identification report = SampledReport();
  const std::string html = ToHtml(report, "fit_pendulum --data run.csv");
  EXPECT_THAT(html, StartsWith("<!doctype html>"));
  EXPECT_EQ(Embedded(html, "result"), ToJson(report));
  EXPECT_EQ(Embedded(html, "series").at(0).at("time_s").size(), 8);
  EXPECT_EQ(Embedded(html, "command").at("command"), "fit_pendulum --data run.csv");
  EXPECT_THAT(html, Not(HasSubstr("@RESULT@")));
}

TEST(ToHtml, ContainsEachRecordingOfAJointFit) {
  Identification report = ExampleJointIdentification();
  for (IdentifiedRecording& recording : report.recordings) recording.used = ExampleSamples();
  report.recordings[1].used.value[0] = 0.5;
  const std::string html = ToHtml(report, "");
  EXPECT_EQ(Embedded(html, "result"), ToJson(report));
  const Json series = Embedded(html, "series");
  ASSERT_EQ(series.size(), 2);
  EXPECT_EQ(series[1].at("measured").at(0), 0.5);
}

TEST(ToHtml, EscapesScriptEndsInNames) {
  Identification report = SampledReport();
  report.recordings.front().data.path = "</script><script>alert(1)</script>@SERIES@.csv";
  const std::string html = ToHtml(report, "<!--");
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_EQ(Embedded(html, "result").at("recordings").at(0).at("path"), report.recordings.front().data.path);
  EXPECT_EQ(Embedded(html, "command").at("command"), "<!--");
}

// The page has no address of a server, and its policy forbids loading.
TEST(ToHtml, LoadsNoResources) {
  const std::string html = ToHtml(SampledReport(), "");
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr(" src=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  EXPECT_TRUE(Embedded(html, "command").is_null());
}

}  // namespace
}  // namespace pendulum::report_page_test
