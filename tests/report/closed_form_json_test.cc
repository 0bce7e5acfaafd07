// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_json.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/identify/example_identification.h"

namespace pendulum::closed_form_json_test {
namespace {

using Json = nlohmann::ordered_json;

Json FormsOf(const Identification& report) { return ClosedFormsJson(report.recordings.front(), report.si_rig()); }

TEST(ClosedFormsJson, UsesSiWithARigAndUnitsOfGravityWithout) {
  Identification report = ExampleIdentification();
  report.rig->gravity_torque.value = 2;
  const Json si = FormsOf(report);
  EXPECT_EQ(si["linear"]["inertia"].dump(), R"({"estimate":0.089,"std_error":0.00025,"unit":"kg m^2"})");
  EXPECT_EQ(si["linear"]["damping_ratio"].dump(), R"({"estimate":0.00425,"std_error":0.0004,"unit":"1"})");
  EXPECT_EQ(si["decrement"]["parameters"]["coulomb"].dump(), R"({"estimate":0.01,"std_error":0.001,"unit":"N m"})");
  report.rig.reset();
  const Json relative = FormsOf(report);
  EXPECT_EQ(relative["linear"]["inertia"].dump(), R"({"estimate":0.0445,"std_error":0.000125,"unit":"s^2"})");
  EXPECT_EQ(relative["decrement"]["parameters"]["coulomb"].dump(),
            R"({"estimate":0.005,"std_error":0.0005,"unit":"1"})");
}

TEST(ClosedFormsJson, AlsoNamesTheModelIfThereIsNoFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  report.recordings.front().closed_forms->decrement.reset();
  EXPECT_EQ(FormsOf(report)["model"], "coulomb");
}

TEST(ClosedFormsJson, ExplainsAMissingPart) {
  Identification report = ExampleIdentification();
  report.recordings.front().closed_forms->linear.reset();
  report.recordings.front().closed_forms->decrement.reset();
  report.recordings.front().closed_forms->no_decrement = "too few turning points for 4 unknowns";
  report.recordings.front().closed_forms->envelope.clear();
  const Json json = FormsOf(report);
  EXPECT_TRUE(json["linear"].is_null());
  EXPECT_TRUE(json["decrement"].is_null());
  EXPECT_TRUE(json["envelope"].is_null());
  EXPECT_EQ(json["reason"],
            "linear: no two successive turning points are a whole period apart; decrement: too few turning points "
            "for 4 unknowns");
}

TEST(ClosedFormsJson, IsNullWithoutClosedForms) { EXPECT_TRUE(FormsOf(ExampleRateIdentification()).is_null()); }

TEST(ClosedFormsJson, NamesTheUnitOfTheNoise) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.unit = "rad/s";
  EXPECT_EQ(FormsOf(report)["noise_rad_s"], 0.0035);
  report.recordings.front().data.unit = "counts";
  EXPECT_EQ(FormsOf(report)["noise_counts"], 0.0035);
}

TEST(CheckJson, HasARowForEachQuantity) {
  const ClosedFormCheck check = ExampleCheck();
  const Json rows = CheckJson(&check);
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[1].dump(),
            R"({"quantity":"viscous_log_decrement","method":"2 ζ / ω_n","closed_form":0.00306,"std_error":0.0005,)"
            R"("fit":0.003,"fit_std_error":4e-05,"unit":"N m s/rad","z":-0.04,"agrees":true,"reason":null})");
  EXPECT_EQ(rows[0]["agrees"], false);
  EXPECT_EQ(rows[0]["reason"], check.rows[0].why);
}

TEST(CheckJson, ExplainsAMissingZ) {
  ClosedFormCheck check = ExampleCheck();
  Json row = CheckJson(&check)[2];
  for (const char* key : {"std_error", "z", "agrees"}) EXPECT_TRUE(row[key].is_null()) << key;
  EXPECT_EQ(row["reason"], "the rig file gives no errors");
  check.rows[2].why.clear();
  row = CheckJson(&check)[2];
  EXPECT_EQ(row["reason"], "there is no error to compare with");
  check.rows[1].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(CheckJson(&check)[1]["reason"], "z is not a finite number");
}

TEST(CheckJson, IsEmptyWithoutACheck) { EXPECT_EQ(CheckJson(nullptr), Json::array()); }

TEST(SamplingJson, WritesUnknownValuesAsNull) {
  Sampling sampling;
  sampling.rate_hz = 12.5;
  const Json json = SamplingJson(sampling);
  EXPECT_EQ(json["rate_hz"], 12.5);
  EXPECT_EQ(json["gaps"], 0);
  for (const char* key : {"frequency_hz", "apparent_frequency_hz", "expected_frequency_hz", "samples_per_period",
                          "nyquist_margin", "start_counts", "end_counts"}) {
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_EQ(
      json["reason"],
      "neither turning points nor a rig determine the frequency of the swing; the readings show no discrete levels");
  EXPECT_TRUE(SamplingJson(std::nullopt).is_null());
}

}  // namespace
}  // namespace pendulum::closed_form_json_test
