// SPDX-License-Identifier: Apache-2.0
// Tests of POST /v1/previews without a socket.
#include "service/preview_answers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/asked_service.h"

namespace pendulum::preview_answers_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FormOf;
using asked_service::Json;
using asked_service::kForm;
using asked_service::PartOf;
using asked_service::Recording;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kDegPerRad = 57.29577951308232;

/// The recording with other names for its columns.
std::string Renamed(const std::string& names) { return names + Recording().substr(Recording().find('\n')); }

/// The recording in degrees.
std::string InDegrees(const std::string& names) {
  std::string text = names + "\n";
  const std::string rows = Recording().substr(Recording().find('\n') + 1);
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t comma = rows.find(',', at), end = rows.find('\n', at);
    const double value = std::stod(rows.substr(comma + 1, end - comma - 1));
    text += rows.substr(at, comma + 1 - at) + std::to_string(kDegPerRad * value) + "\n";
    at = end + 1;
  }
  return text;
}

class PreviewTest : public asked_service::ServiceTest {
 protected:
  Json PreviewOf(const std::string& body, const std::string& query = "", const std::string& type = "text/csv") {
    const HttpResponse response = Post("/v1/previews" + query, type, body);
    EXPECT_EQ(response.status, 200) << response.body;
    return Json::parse(response.body);
  }
};

TEST_F(PreviewTest, ShowsTheTableAndTheWindowOfAFit) {
  const Json preview = PreviewOf(Recording(), "?name=run.csv");
  EXPECT_EQ(preview["name"], "run.csv");
  EXPECT_EQ(preview["format"], "text with columns separated by commas");
  EXPECT_EQ(preview["columns"][1], (Json{{"name", "angle_rad"}, {"value_column", "angle_rad"}}));
  EXPECT_EQ(preview["rows"].size(), 8U);
  EXPECT_EQ(preview["time"], (Json{{"column", 0}, {"unit", "s"}}));
  EXPECT_EQ(preview["value"], (Json{{"column", 1}, {"unit", "rad"}}));
  EXPECT_EQ(preview["missing"], Json::array());
  EXPECT_EQ(preview["problem"], nullptr);
  EXPECT_LE(preview["samples"]["time_s"].size(), 1000U);
  const HttpResponse fit = Post("/v1/fits?model=viscous", "text/csv", Recording());
  const Json data = Json::parse(fit.body)["recordings"][0];
  EXPECT_EQ(preview["samples"]["samples"], data["samples"]);
  EXPECT_EQ(preview["window"]["window_s"], data["window_s"]);
  EXPECT_EQ(preview["window"]["release"], 1);
}

TEST_F(PreviewTest, FitsAndStoresNothing) {
  PreviewOf(Recording());
  EXPECT_TRUE(IdsAt("/v1/fits").empty());
}

TEST_F(PreviewTest, TellsWhatWasAssumedAndWhichOptionSaysOtherwise) {
  const Json preview = PreviewOf(InDegrees("time_s,reading"));
  ASSERT_EQ(preview["assumptions"].size(), 1U);
  EXPECT_EQ(preview["assumptions"][0]["code"], "value_unit_assumed");
  EXPECT_EQ(preview["assumptions"][0]["options"], Json::array({"unit"}));
  EXPECT_EQ(PreviewOf(InDegrees("time_s,reading"), "?unit=deg")["assumptions"], Json::array());
}

TEST_F(PreviewTest, HasReadingsInDegreesIfTheFileIs) {
  const Json own = PreviewOf(InDegrees("time_s,angle_deg"))["samples"];
  const Json rad = PreviewOf(Recording())["samples"];
  EXPECT_EQ(own["unit"], "deg");
  EXPECT_EQ(rad["unit"], "rad");
  EXPECT_NEAR(own["measured"][0].get<double>(), kDegPerRad * rad["measured"][0].get<double>(), 1e-5);
}

TEST_F(PreviewTest, AsksForAllThatIsMissingAtOnce) {
  std::string text = "n,encoder\n";
  for (int i = 1; i < 600; ++i)
    text += std::to_string(i) + "," + std::to_string(std::lround(40 * std::exp(-0.003 * i) * std::cos(0.1 * i))) + "\n";
  const Json preview = PreviewOf(text, "?bob_mass=380g");
  const Json& missing = preview["missing"];
  ASSERT_EQ(missing.size(), 3U);
  EXPECT_EQ(missing[0]["options"], Json::array({"sample_rate_hz", "time_column"}));
  EXPECT_TRUE(missing[0]["try"].empty());  // No example of a rate is right.
  EXPECT_EQ(missing[1]["options"], Json::array({"unit"}));
  const Json& units = missing[1]["values"];
  EXPECT_NE(std::ranges::find(units, "counts"), units.end());
  EXPECT_EQ(missing[2]["options"], Json::array({"rod_mass", "rod_length"}));
  EXPECT_THAT(missing[2]["question"].get<std::string>(), StartsWith("--rod_mass, --rod_length are missing"));
  EXPECT_EQ(preview["samples"], nullptr);
  EXPECT_EQ(preview["columns"].size(), 2U);
  // A fit refuses the same request with the questions of the reader.
  const std::string refusal = AnswerOf(Post("/v1/fits?bob_mass=380g", "text/csv", text));
  for (const int i : {0, 1}) EXPECT_THAT(refusal, HasSubstr(missing[i]["question"].get<std::string>()));
  const Json answered = PreviewOf(text, "?bob_mass=380g&rod_mass=0g&rod_length=43cm&unit=deg&sample_rate_hz=100");
  EXPECT_EQ(answered["missing"], Json::array());
  EXPECT_NE(answered["window"], nullptr);
}

TEST_F(PreviewTest, ShowsTheWindowAlthoughTheRigIsIncomplete) {
  const Json preview = PreviewOf(Recording(), "?bob_mass=380g");
  EXPECT_EQ(preview["missing"].size(), 1U);
  EXPECT_NE(preview["window"], nullptr);
}

TEST_F(PreviewTest, HasTheProblemOfARigThatIsWrong) {
  const std::string query = "?bob_mass=380g&rod_mass=-1g&rod_length=43cm";
  const Json preview = PreviewOf(Recording(), query);
  EXPECT_EQ(preview["missing"], Json::array());
  EXPECT_EQ(preview["problem"], Json::parse(Post("/v1/fits" + query, "text/csv", Recording()).body));
}

TEST_F(PreviewTest, HasTheProblemOfARecordingWithoutASwing) {
  std::string held = "time_s,angle_deg\n";
  for (int i = 0; i < 200; ++i) held += std::to_string(0.01 * i) + "," + std::to_string(20 + i % 2) + "\n";
  const Json preview = PreviewOf(held);
  ASSERT_TRUE(preview["problem"].is_object());
  EXPECT_EQ(preview["problem"], Json::parse(Post("/v1/fits", "text/csv", held).body));
  EXPECT_EQ(preview["problem"]["code"], "no_swing");
  EXPECT_EQ(preview["window"], nullptr);
  EXPECT_EQ(preview["samples"]["samples"], 200);
}

TEST_F(PreviewTest, HasTheProblemOfReadingsThatAreNoAngles) {
  const std::string text = Renamed("time_s,pot_volts");
  const Json problem = PreviewOf(text)["problem"];
  ASSERT_TRUE(problem.is_object());
  EXPECT_EQ(problem, Json::parse(Post("/v1/fits", "text/csv", text).body));
  EXPECT_THAT(problem["detail"].get<std::string>(), HasSubstr("the readings are in volts"));
  EXPECT_EQ(PreviewOf(text, "?model=linear")["problem"], nullptr);
}

TEST_F(PreviewTest, HasTheProblemOfAPeriodThatNoPendulumHas) {
  const std::string query = "?time_column=time_s:min";
  const Json preview = PreviewOf(Recording(), query);
  ASSERT_TRUE(preview["problem"].is_object());
  EXPECT_EQ(preview["problem"], Json::parse(Post("/v1/fits" + query, "text/csv", Recording()).body));
  EXPECT_THAT(preview["problem"]["detail"].get<std::string>(), StartsWith("the period is "));
  EXPECT_NE(preview["window"], nullptr);
}

TEST_F(PreviewTest, NumbersAColumnWhoseNameIsNotUtf8) {
  const std::string text = Renamed("t [s],\xA4ngle");  // JSON cannot return the name
  const Json preview = PreviewOf(text, "?value_column=2&unit=rad");
  EXPECT_EQ(preview["columns"][1], (Json{{"name", "2"}, {"value_column", "2"}}));
  EXPECT_EQ(preview["problem"], nullptr);
}

TEST_F(PreviewTest, RefusesAnUnreadableRecordingAsAFitDoes) {
  for (const std::string& text : {Recording() + "1e9,x\n9e9,1\n", std::string("%PDF-1.4"), std::string()}) {
    const HttpResponse preview = Post("/v1/previews", "text/csv", text);
    const HttpResponse fit = Post("/v1/fits", "text/csv", text);
    EXPECT_GE(preview.status, 400);
    EXPECT_EQ(AnswerOf(preview), AnswerOf(fit));
  }
  EXPECT_EQ(AnswerOf(Post("/v1/previews?unit=furlong", "text/csv", Recording())),
            AnswerOf(Post("/v1/fits?unit=furlong", "text/csv", Recording())));
}

TEST_F(PreviewTest, UsesACalibrationTable) {
  const std::string text = Renamed("time_s,reading_volts");
  EXPECT_EQ(PreviewOf(text)["calibration"], nullptr);
  const std::string table = "volts,angle_deg\n-2,-120\n-1,-60\n0,0\n1,60\n2,120\n";
  const std::string form = FormOf(PartOf("data", text, "run.csv") + PartOf("calibration", table, "table.csv"));
  const Json preview = PreviewOf(form, "", kForm);
  EXPECT_NE(preview["calibration"], nullptr);
  EXPECT_EQ(preview["samples"]["unit"], "rad");
}

}  // namespace
}  // namespace pendulum::preview_answers_test
