// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/temporary_folder.h"
#include "tools/simulate_pendulum_files.h"

namespace pendulum::simulate_pendulum_manifest_test {
namespace {

namespace fs = std::filesystem;
using testing::StartsWith;

/// Folders runs and lists side by side.
class ManifestTest : public testing::Test {
 protected:
  ManifestTest() {
    fs::create_directory(folder_.Path("runs"));
    fs::create_directory(folder_.Path("lists"));
    flags_.set = "inertia=0.04,release_angle=0.25,release_time=0.5";
    flags_.model = "viscous";
    flags_.count = 10;
    flags_.seed = 7;
    flags_.out = folder_.Path("runs/run.csv");
    flags_.manifest = folder_.Path("lists/runs.csv");
  }

  SimulateOptions Options() const {
    const auto options = MakeSimulateOptions(flags_, {});
    EXPECT_TRUE(options) << options.error().message();
    return *options;
  }

  std::string Row(int index) const {
    const SimulateOptions options = Options();
    return *Manifest(options).Row(index);
  }

  std::string Header() const {
    const SimulateOptions options = Options();
    return Manifest(options).Header();
  }

  TemporaryFolder folder_;
  SimulateFlags flags_;
};

TEST_F(ManifestTest, HasARowPerRecordingWithSeedAndTruth) {
  EXPECT_EQ(Header(), "path,id,seed,true_inertia,true_viscous,true_release_angle,true_release_time,true_zero_angle\n");
  EXPECT_EQ(Row(2), "../runs/run_003.csv,run_003,9,0.04,0,0.25,0.5,0\n");
}

TEST_F(ManifestTest, NamesTheRigIfGiven) {
  flags_.rig = folder_.Path("rig, the first.json");
  EXPECT_THAT(Header(), StartsWith("path,id,rig,seed,true_inertia,"));
  EXPECT_THAT(Row(9), StartsWith("../runs/run_010.csv,run_010,\"../rig, the first.json\",16,0.04,"));
}

TEST_F(ManifestTest, GivesPathsRelativeToItsFolder) {
  flags_.manifest = folder_.Path("runs/runs.csv");
  EXPECT_THAT(Row(0), StartsWith("run_001.csv,run_001,"));
  flags_.manifest = folder_.Path("runs.csv");
  EXPECT_THAT(Row(0), StartsWith("runs/run_001.csv,run_001,"));
  flags_.count = 1;
  EXPECT_THAT(Row(0), StartsWith("runs/run.csv,run,"));
}

TEST_F(ManifestTest, FollowsALinkToAFolder) {
  fs::create_directories(folder_.Path("deep/deeper"));
  fs::create_directory_symlink("deep/deeper", folder_.Path("link"));
  flags_.manifest = folder_.Path("link/runs.csv");
  const std::string row = Row(0);
  const std::string path = row.substr(0, row.find(','));
  EXPECT_EQ(path, "../../runs/run_001.csv");
  EXPECT_TRUE(fs::equivalent((fs::path(folder_.Path("link")) / path).parent_path(), folder_.Path("runs")));
}

TEST_F(ManifestTest, GivesTheTruthOfEachRecording) {
  flags_.spread = "inertia=0.001";
  const SimulateOptions options = Options();
  const Manifest manifest(options);
  EXPECT_NE(manifest.Row(0)->substr(0, 40), manifest.Row(1)->substr(0, 40));
  const auto second = SimulationOfRecording(options, 1);
  ASSERT_TRUE(second);
  // Parsing the field gives exactly the same number.
  const std::string row = *manifest.Row(1);
  EXPECT_EQ(std::stod(row.substr(row.find(",8,") + 3)), second->truth.front().second);
}

}  // namespace
}  // namespace pendulum::simulate_pendulum_manifest_test
