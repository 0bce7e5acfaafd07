// SPDX-License-Identifier: Apache-2.0
// Recordings made by other people, compared with fits of the same windows by an independent program (Runge-Kutta, tanh
// for the sign of the rate, SciPy least squares). They are not part of the project: PENDULUM_RECORDINGS names their
// folder.
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/window.h"

namespace pendulum::recordings_test {
namespace {

constexpr double kEnd = std::numeric_limits<double>::quiet_NaN();

struct ReferenceFit {
  std::string recording;
  double from;  // s
  double to;    // s
  std::string model;
  double gravity_over_inertia;  // 1/s^2
  double rms;                   // rad
};

void PrintTo(const ReferenceFit& reference, std::ostream* out) { *out << reference.recording; }

class Recordings : public testing::TestWithParam<ReferenceFit> {
 protected:
  void SetUp() override {
    if (std::getenv("PENDULUM_RECORDINGS") == nullptr) GTEST_SKIP() << "PENDULUM_RECORDINGS is not set";
  }

  static FitReport Fit(const ReferenceFit& reference) { return Fit(reference, reference.model); }

  static FitReport Fit(const ReferenceFit& reference, const std::string& model) {
    const std::filesystem::path folder = std::getenv("PENDULUM_RECORDINGS");
    const Result<Recording> recording = ReadRecording(folder / (reference.recording + ".csv"));
    const Result<Recording> window = SelectWindow(recording.value(), reference.from, reference.to);
    FitOptions options;
    options.model = model;
    return FitRecording(window.value(), options).value();
  }
};

TEST_P(Recordings, AreFittedAsWellAsByAnotherProgram) {
  const FitReport report = Fit(GetParam());
  EXPECT_EQ(report.termination, Termination::kConverged) << report.reason;
  const double gravity_over_inertia = 1 / report.Find("inertia")->estimate;
  EXPECT_THAT(gravity_over_inertia / GetParam().gravity_over_inertia, testing::DoubleNear(1, 0.005));
  EXPECT_LE(report.statistics.rms_residual, 1.05 * GetParam().rms);
}

TEST_P(Recordings, AreFittedNoWorseByARicherLaw) {
  double simpler = kUnbounded;
  for (const std::string model : {"viscous", "coulomb", "drag"}) {
    const double rms = Fit(GetParam(), model).statistics.rms_residual;
    EXPECT_LE(rms, simpler * (1 + 1e-6)) << model;
    simpler = rms;
  }
}

INSTANTIATE_TEST_SUITE_P(ReferenceFits, Recordings,
                         testing::Values(ReferenceFit{"stienen_Ef_R01", 1.5, 14.5, "coulomb", 10.884, 0.00335},
                                         ReferenceFit{"stienen_Ea45", 1.75, 28.5, "coulomb", 10.716, 0.00476},
                                         ReferenceFit{"jensen_03", 0.4, kEnd, "coulomb", 120.41, 0.00379},
                                         ReferenceFit{"multiarm_freeswing1", 0.4, 5.6, "coulomb", 65.302, 0.00107},
                                         ReferenceFit{"yfysiks_data2_25", 10, kEnd, "coulomb", 43.635, 0.00643},
                                         ReferenceFit{"pendulepi_A", 0, kEnd, "drag", 21.771, 0.00358},
                                         ReferenceFit{"nielsskov_pend1", 3, 68, "drag", 30.858, 0.00259},
                                         ReferenceFit{"bookip_adip", 4, 115, "drag", 40.291, 0.00235},
                                         ReferenceFit{"davidw_wood", 0.3, kEnd, "drag", 29.524, 0.011},
                                         ReferenceFit{"ferrucci_1525", 0.3, kEnd, "drag", 21.468, 0.0023},
                                         ReferenceFit{"hasi_newpend", 3, 150, "coulomb", 14.001, 0.01},
                                         ReferenceFit{"jensen_01", 1, kEnd, "coulomb", 120.26, 0.00595},
                                         ReferenceFit{"jiarui_8047", 0.3, kEnd, "drag", 6.773, 0.000952},
                                         ReferenceFit{"jiarui_8053", 0.3, kEnd, "drag", 13.059, 0.00104},
                                         ReferenceFit{"macstepien_osc", 1, 28, "coulomb", 87.209, 0.0043},
                                         ReferenceFit{"sonyneto_0312", 1, kEnd, "viscous", 53.413, 0.0289},
                                         ReferenceFit{"tylertian_lab1", 0.3, kEnd, "drag", 14.787, 0.00804},
                                         ReferenceFit{"yfysiks_data32", 11.5, kEnd, "drag", 37.222, 0.00592}),
                         testing::PrintToStringParamName());

using HeldRecording = Recordings;

TEST_P(HeldRecording, HasItsReleaseFound) {
  const FitReport report = Fit(GetParam());
  ASSERT_EQ(report.start, StartKind::kRelease);
  // The hold lasts 0.70 s, and samples are 0.05 s apart.
  EXPECT_THAT(report.Find("release_time")->estimate, testing::AllOf(testing::Ge(0.65), testing::Le(0.75)));
}

INSTANTIATE_TEST_SUITE_P(FromTheStart, HeldRecording,
                         testing::Values(ReferenceFit{"stienen_Ea45", 0, 28.5, "coulomb", 10.716, 0.00476}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace pendulum::recordings_test
