// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/series.h"

#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/identify/example_joint_identification.h"

namespace pendulum::series_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Recording ThreeSamples() {
  Recording used;
  used.time = Eigen::Vector3d(0, 0.1, 0.2);
  used.value = Eigen::Vector3d(0.5, -1e-7, 1.0 / 3.0);
  return used;
}

FitReport FitOfThreeSamples() {
  FitReport fit;
  fit.model = {"coulomb", "coulomb", Gravity::kSine};
  fit.fitted = Eigen::Vector3d(0.25, 0, 0.5);
  fit.residual = Eigen::Vector3d(0.25, -1e-7, -0.125);
  return fit;
}

TextbookOverlay OverlayOfThreeSamples() {
  TextbookOverlay overlay;
  overlay.linear = Eigen::Vector3d(0.5, 0.25, 0.125);
  overlay.nonlinear = Eigen::Vector3d(1, 2, 3);
  return overlay;
}

/// Three samples, their fit and its overlay, and the turning points of the example.
Identification ReportOfThreeSamples() {
  Identification report = ExampleIdentification();
  report.recordings.front().used = ThreeSamples();
  report.fits = {FitOfThreeSamples()};
  report.recordings.front().checks[0].overlay = OverlayOfThreeSamples();
  report.recordings.front().sampling->gaps = 0;
  return report;
}

std::vector<std::string> Keys(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

TEST(ToResidualCsv, WritesAllDigitsInSi) {
  EXPECT_EQ(ToResidualCsv(ThreeSamples(), FitOfThreeSamples(), OverlayOfThreeSamples()),
            "time_s,measured_rad,fitted_rad,residual_rad,linear_closed_form_rad,nonlinear_closed_form_rad\n"
            "0,0.5,0.25,0.25,0.5,1\n"
            "0.1,-1e-07,0,-1e-07,0.25,2\n"
            "0.2,0.3333333333333333,0.5,-0.125,0.125,3\n");
}

TEST(ToResidualCsv, NamesTheUnitOfARate) {
  Recording used = ThreeSamples();
  used.quantity = Quantity::kRate;
  const std::string csv = ToResidualCsv(used, FitOfThreeSamples());
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time_s,measured_rad_s,fitted_rad_s,residual_rad_s,linear_closed_form_rad_s,nonlinear_closed_form_rad_s");
}

TEST(ToResidualCsv, LeavesMissingFieldsEmpty) {
  EXPECT_EQ(ToResidualCsv(ThreeSamples(), FitReport()),
            "time_s,measured_rad,fitted_rad,residual_rad,linear_closed_form_rad,nonlinear_closed_form_rad\n"
            "0,0.5,,,,\n"
            "0.1,-1e-07,,,,\n"
            "0.2,0.3333333333333333,,,,\n");
  FitReport fit = FitOfThreeSamples();
  fit.fitted[1] = kNan;
  EXPECT_NE(ToResidualCsv(ThreeSamples(), fit).find("\n0.1,-1e-07,,-1e-07,,\n"), std::string::npos);
}

TEST(SeriesJson, HasSamplesAndModelsByName) {
  const Json series = SeriesJson(ReportOfThreeSamples())[0];
  EXPECT_THAT(Keys(series),
              ElementsAre("time_s", "measured", "unit", "extrema", "peaks", "profiles", "models", "motions"));
  EXPECT_EQ(series["time_s"].dump(), "[0.0,0.1,0.2]");
  EXPECT_EQ(series["measured"].dump(), "[0.5,-1e-07,0.3333333333333333]");
  EXPECT_EQ(series["unit"], "rad");
  EXPECT_TRUE(series["profiles"].is_null());
  EXPECT_TRUE(series["motions"].is_null());
  EXPECT_EQ(series["models"].dump(),
            R"({"coulomb":{"fitted":[0.25,0.0,0.5],"fitted_std_error":null,"residual":[0.25,-1e-07,-0.125],)"
            R"("linear_closed_form":[0.5,0.25,0.125],"nonlinear_closed_form":[1.0,2.0,3.0]}})");
}

TEST(SeriesJson, HasProfilesByModelAndParameter) {
  Identification report = ReportOfThreeSamples();
  report.fits[0].profiles = {{"inertia", {0.5, 1, 1.5}, {4, 0, kNan}, 3.875}};
  EXPECT_EQ(SeriesJson(report)[0]["profiles"].dump(),
            R"({"coulomb":{"inertia":{"value":[0.5,1.0,1.5],"statistic":[4.0,0.0,null],"threshold":3.875}}})");
}

// The standard errors are the roots of the variances 1e-6 s² and 4e-6 rad².
TEST(SeriesJson, NumbersTheTurningPointsFromOne) {
  const Json peaks = SeriesJson(ReportOfThreeSamples())[0]["peaks"];
  ASSERT_EQ(peaks.size(), 5);
  EXPECT_EQ(peaks[2].dump(),
            R"({"number":3,"time_s":3.8,"time_std_error":0.001,"angle_rad":0.39,"std_error":0.002,)"
            R"("zeta_pair":0.0042,"zeta_pair_std_error":0.0008,"zeta":0.0041,"zeta_std_error":0.0008,"periods":1})");
  for (const char* key : {"zeta", "zeta_std_error", "periods"}) EXPECT_TRUE(peaks[0][key].is_null()) << key;
  for (const char* key : {"zeta_pair", "zeta_pair_std_error"}) EXPECT_TRUE(peaks[4][key].is_null()) << key;
}

TEST(SeriesJson, NamesTheUnitOfARateOrOfCounts) {
  Identification report = ReportOfThreeSamples();
  report.recordings.front().used.unit = "counts";
  EXPECT_TRUE(SeriesJson(report)[0]["peaks"][0].contains("angle_counts"));
  report.recordings.front().used.unit = "rad/s";
  report.recordings.front().used.quantity = report.recordings.front().closed_forms->table.quantity = Quantity::kRate;
  EXPECT_TRUE(SeriesJson(report)[0]["peaks"][0].contains("rate_rad_s"));
}

TEST(SeriesJson, IsNullForMissingParts) {
  Identification report = ReportOfThreeSamples();
  report.recordings.front().closed_forms.reset();
  report.recordings.front().checks.clear();
  report.fits[0].fitted[1] = kNan;
  report.fits[0].residual.resize(0);
  const Json series = SeriesJson(report)[0];
  EXPECT_EQ(series["extrema"], Json::array());
  EXPECT_EQ(series["peaks"], Json::array());
  EXPECT_EQ(series["models"]["coulomb"].dump(), R"({"fitted":[0.25,null,0.5],"fitted_std_error":null,"residual":null,)"
                                                R"("linear_closed_form":null,"nonlinear_closed_form":null})");
  report.fits.clear();
  EXPECT_EQ(SeriesJson(report)[0]["models"], Json::object());
}

// cos(2π t / 1 s) over 0.2 to 3.8 s has turning points at every half second from 0.5 to 3.5 s, alternately -1 and 1. A
// parabola through samples 0.01 s apart has an error of about (2π 0.01)³.
TEST(SeriesJson, ListsExtremaAsTimesAndReadings) {
  Identification report;
  report.recordings.emplace_back().used.time = Eigen::VectorXd::LinSpaced(361, 0.2, 3.8);
  report.recordings.front().used.value = (2 * kPi * report.recordings.front().used.time.array()).cos();
  const Json extrema = SeriesJson(report)[0]["extrema"];
  ASSERT_EQ(extrema.size(), 7);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(extrema[i][0].get<double>(), 0.5 + 0.5 * static_cast<double>(i), 5e-4);
    EXPECT_NEAR(extrema[i][1].get<double>(), i % 2 == 0 ? -1 : 1, 5e-4);
  }
}

TEST(SeriesJson, HasSevenDigitsAndNoResidualsForThePage) {
  Identification report = ReportOfThreeSamples();
  report.recordings.front().used.value[2] = -0.123456789012;
  const Json all = SeriesJson(report)[0];
  const Json page = SeriesJson(report, SeriesDetail::kPage)[0];
  EXPECT_EQ(all.at("measured").at(2), -0.123456789012);
  EXPECT_EQ(page.at("measured").at(2), -0.1234568);
  for (const auto& [name, model] : page.at("models").items()) EXPECT_TRUE(model.at("residual").is_null()) << name;
}

/// The small-angle pendulum, I_O = 0.04 s² and b = 0.008 s in units of the restoring torque G. Released at 1 s, from
/// 0.3 rad.
FitReport LinearFit() {
  FitReport fit;
  fit.model = {"linear", "viscous", Gravity::kLinear};
  fit.termination = Termination::kConverged;
  fit.start = StartKind::kRelease;
  fit.parameters = {ExampleParameter(kInertia, "s^2", 0.04, 0), ExampleParameter(kViscous, "s", 0.008, 0),
                    ExampleParameter(kReleaseAngle, "rad", 0.3, 0), ExampleParameter(kReleaseTime, "s", 1, 0),
                    ExampleParameter(kZeroAngle, "rad", 0.01, 0)};
  return fit;
}

/// Angle and rate of LinearFit t s after the release: A exp(-δ t) (cos ω t + δ/ω sin ω t), δ = b / (2 I_O), ω² = 1 /
/// I_O - δ².
std::array<double, 2> LinearMotion(double t) {
  const double decay = 0.1, frequency = std::sqrt(25 - decay * decay), amplitude = 0.3 * std::exp(-decay * t);
  return {amplitude * (std::cos(frequency * t) + decay / frequency * std::sin(frequency * t)),
          -amplitude * 25 / frequency * std::sin(frequency * t)};
}

/// 40 samples at 2 Hz from 0 s on, which is 2.5 samples a period, with LinearFit.
Identification TwoSamplesASecond() {
  Identification run;
  run.recordings.emplace_back().used.time = Eigen::VectorXd::LinSpaced(40, 0, 19.5);
  run.recordings.front().used.value = Eigen::VectorXd::Zero(40);
  run.fits = {LinearFit()};
  run.recordings.front().sampling.emplace().samples_per_period = 2.5;
  return run;
}

// 60 points a period of 2π 0.2 s from 1 to 19.5 s: 884 steps.
TEST(SeriesJson, HasTheMotionIfAPeriodHasFewSamples) {
  const Identification run = TwoSamplesASecond();
  const Json motion = SeriesJson(run)[0]["motions"]["linear"];
  EXPECT_THAT(Keys(motion), ElementsAre("start_s", "interval_s", "angle_unit", "angle", "rate", "reading"));
  EXPECT_EQ(motion["start_s"], 1);
  EXPECT_NEAR(motion["interval_s"].get<double>(), 18.5 / 884, 1e-12);
  EXPECT_EQ(motion["angle_unit"], "rad");
  for (const char* key : {"angle", "rate", "reading"}) ASSERT_EQ(motion[key].size(), 885) << key;
  for (std::size_t i = 0; i < 885; ++i) {
    const auto [angle, rate] = LinearMotion(18.5 / 884 * static_cast<double>(i));
    EXPECT_NEAR(motion["angle"][i].get<double>(), angle, 1e-7) << i;
    EXPECT_NEAR(motion["rate"][i].get<double>(), rate, 1e-6) << i;
    EXPECT_NEAR(motion["reading"][i].get<double>(), angle + 0.01, 1e-7) << i;
  }
}

// The clock is 2 % slow: 18.5 s on this clock are 18.87 true seconds of motion.
TEST(SeriesJson, HasTheMotionAtInstantsOfTheFilesClock) {
  Identification run = TwoSamplesASecond();
  run.recordings.front().used.clock_scale = 1.02;
  const Json motion = SeriesJson(run, SeriesDetail::kPage)[0]["motions"]["linear"];
  const double interval = motion["interval_s"];
  EXPECT_NEAR(interval * static_cast<double>(motion["angle"].size() - 1), 18.5, 1e-9);
  for (const std::size_t i : {0, 100, 800}) {
    const auto [angle, rate] = LinearMotion(1.02 * interval * static_cast<double>(i));
    EXPECT_NEAR(motion["angle"][i].get<double>(), angle, 1e-7) << i;
    EXPECT_NEAR(motion["rate"][i].get<double>(), rate, 1e-6) << i;
  }
}

TEST(SeriesJson, HasTheMotionIfReadingsAreMissingOrNotAngles) {
  Identification run = TwoSamplesASecond();
  run.recordings.front().sampling->samples_per_period = 12;
  EXPECT_TRUE(SeriesJson(run)[0]["motions"].is_null());
  run.recordings.front().sampling->gaps = 1;
  EXPECT_FALSE(SeriesJson(run)[0]["motions"].is_null());
  run.recordings.front().sampling.reset();
  EXPECT_TRUE(SeriesJson(run)[0]["motions"].is_null());
  run.recordings.front().used.quantity = run.fits[0].quantity = Quantity::kRate;
  run.fits[0].parameters[4] = ExampleParameter(kRateBias, "rad/s", 0.2, 0);
  const Json motion = SeriesJson(run)[0]["motions"]["linear"];
  EXPECT_NEAR(motion["reading"][200].get<double>(), motion["rate"][200].get<double>() + 0.2, 1e-7);
}

// The reading of a linear pendulum is z + A m(t), m(t) = LinearMotion(t) / 0.3 after the release at 1 s and 1 before
// it. With errors of A and z and their covariance its variance is m² 0.004² + 0.003² + 2 m 0.5 0.004 0.003.
TEST(SeriesJson, HasStandardErrorsOfTheFittedReadings) {
  Identification run = TwoSamplesASecond();
  FitReport& fit = run.fits[0];
  fit.fitted = Eigen::VectorXd::Zero(40);
  fit.covariance_names = {"release_angle", "zero_angle"};
  fit.covariance = Eigen::Matrix2d({{1.6e-5, 6e-6}, {6e-6, 9e-6}});
  const Json errors = SeriesJson(run)[0]["models"]["linear"]["fitted_std_error"];
  ASSERT_EQ(errors.size(), 40);
  for (std::size_t i = 0; i < 40; ++i) {
    const double time = 0.5 * static_cast<double>(i);
    const double share = time < 1 ? 1 : LinearMotion(time - 1)[0] / 0.3;
    EXPECT_NEAR(errors[i].get<double>(), std::sqrt(share * share * 1.6e-5 + 9e-6 + share * 1.2e-5), 1e-8) << i;
  }
}

// Two standard errors of at most 0.004 rad: 0.008 rad is seen beside a swing of 0.6 rad, not beside 60 rad.
TEST(SeriesJson, HasStandardErrorsForThePageOnlyIfTheyAreVisible) {
  Identification run = TwoSamplesASecond();
  run.fits[0].fitted = Eigen::VectorXd::Zero(40);
  run.fits[0].covariance_names = {"release_angle"};
  run.fits[0].covariance = Eigen::MatrixXd::Constant(1, 1, 1.6e-5);
  const auto errors = [&](double range) {
    run.recordings.front().used.value[0] = range;
    return SeriesJson(run, SeriesDetail::kPage)[0]["models"]["linear"]["fitted_std_error"];
  };
  EXPECT_EQ(errors(0.6).size(), 40);
  EXPECT_TRUE(errors(60).is_null());
}

TEST(SeriesJson, IsNullIfThereIsNoMotion) {
  Identification run = TwoSamplesASecond();
  run.fits[0].termination = Termination::kFailed;
  EXPECT_TRUE(SeriesJson(run)[0]["motions"].at("linear").is_null());
  run.fits = {LinearFit()};
  run.fits[0].parameters[0].estimate = 0;  // without inertia no trajectory can be computed
  EXPECT_TRUE(SeriesJson(run)[0]["motions"].at("linear").is_null());
  run.fits = {LinearFit()};
  run.fits[0].parameters[3].estimate = 19.5;  // released at the last sample
  EXPECT_TRUE(SeriesJson(run)[0]["motions"].at("linear").is_null());
}

TEST(ToSeriesJsonText, IsTheSeriesJsonOnOneLine) {
  const Identification report = ReportOfThreeSamples();
  const std::string text = ToSeriesJsonText(report);
  EXPECT_EQ(text.find('\n'), text.size() - 1);
  EXPECT_EQ(Json::parse(text), SeriesJson(report));
}

TEST(SeriesJson, IsAnArrayOfRecordingsForAJointFit) {
  const Identification one = ReportOfThreeSamples();
  Identification report = ExampleJointIdentification();
  report.recordings = {one.recordings.front(), one.recordings.front()};
  for (IdentifiedRecording& recording : report.recordings) recording.own_fits = one.fits;
  report.recordings[1].own_fits[0].fitted[0] = 0.75;
  report.recordings[1].used.time[2] = 0.25;
  const Json series = SeriesJson(report);
  ASSERT_EQ(series.size(), 2);
  EXPECT_EQ(series[0], SeriesJson(one)[0]);
  EXPECT_EQ(series[1]["time_s"].dump(), "[0.0,0.1,0.25]");
  EXPECT_EQ(series[1]["models"]["coulomb"]["fitted"].dump(), "[0.75,0.0,0.5]");
  EXPECT_EQ(Json::parse(ToSeriesJsonText(report)), series);
}

}  // namespace
}  // namespace pendulum::series_test
