// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/ambiguity_sections.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::ambiguity_sections_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The example with a rig of 1.8 N m ± 1 % and this inertia; the fitted one is 0.079 ± 0.00025 kg m².
Identification WithInertia(const std::string& inertia) {
  Identification identification = ExampleIdentification();
  identification.rig =
      ParseRig(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.018}, "inertia": )" + inertia + "}", "rig").value();
  return identification;
}

TEST(AmbiguitySections, ListCausesAndTheVerdictOfTheRig) {
  const Sections sections = AmbiguitySections(WithInertia(R"({"value": 0.070, "std_dev": 0.0005})"), 0);
  ASSERT_THAT(sections, SizeIs(1));
  EXPECT_THAT(ToText(sections, {}), AllOf(HasSubstr("[[What one swing cannot tell]]"),
                                          HasSubstr("13 % larger than the rig's"), HasSubstr("A support that yields")));
}

TEST(AmbiguitySections, AreEmptyWithoutAResult) {
  Identification identification = ExampleIdentification();
  identification.fits[0].termination = Termination::kNotConverged;
  EXPECT_THAT(AmbiguitySections(identification, 0), IsEmpty());
}

// The torque's 1 % of 0.079 is 0.00079: z = 0.009 / sqrt(0.00079² + 0.0005² + 0.00025²) = 9.3.
TEST(AddAmbiguities, GivesTheVerdictWithItsNumbers) {
  nlohmann::ordered_json json;
  AddAmbiguities(WithInertia(R"({"value": 0.070, "std_dev": 0.0005})"), 0, json);
  EXPECT_NEAR(json["rig_verdict"]["z"].get<double>(), 9.3, 0.1);
  EXPECT_EQ(json["rig_verdict"]["agrees"], false);
  EXPECT_THAT(json["ambiguities"], SizeIs(4));
  for (const auto& one : json["ambiguities"]) EXPECT_THAT(one, SizeIs(3));
}

TEST(AddAmbiguities, SaysThatNoVerdictIsPossible) {
  Identification identification = WithInertia("0.070");
  identification.fits.front().parameters.front().std_error.reset();
  nlohmann::ordered_json json;
  AddAmbiguities(identification, 0, json);
  EXPECT_TRUE(json["rig_verdict"]["agrees"].is_null());
  EXPECT_THAT(json["rig_verdict"]["reason"].get<std::string>(), HasSubstr("no standard deviation"));
}

}  // namespace
}  // namespace pendulum::ambiguity_sections_test
