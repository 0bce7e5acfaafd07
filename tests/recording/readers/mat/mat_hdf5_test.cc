// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_hdf5.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/recording/mat_objects_73.h"
#include "tests/recording/rows.h"
#include "tests/recording/timeseries_files.h"

namespace pendulum::mat_hdf5_test {
namespace {

/// Stores bytes in a file that exists as long as this object.
class Written {
 public:
  explicit Written(const std::string& bytes)
      : path_((std::filesystem::temp_directory_path() / ("mat_hdf5_" + std::to_string(::getpid()))).string()) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  Written(const Written&) = delete;
  Written(Written&&) = delete;
  Written& operator=(const Written&) = delete;
  Written& operator=(Written&&) = delete;
  ~Written() { std::filesystem::remove(path_); }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(OpenHdf5, FindsTheObjectsOfAFileAndTheirPlaces) {
  objects::File file;
  const std::size_t own = file.AddClass("my", "class");
  const std::size_t one =
      file.AddObject(own, {{"Units", objects::Letters("rad")}, {"Data", objects::Numbers({1, 3}, {1, 2, 3})}});
  file.AddVariable("a", file.Reference({one}, true));
  file.AddVariable("s", objects::Struct({{"b", file.Reference({one}, true)}, {"c", objects::Number(1)}}));
  const Written written(objects::Version73(file));
  const MatSubsystem subsystem = OpenHdf5(written.path())();
  ASSERT_TRUE(subsystem.objects);
  ASSERT_EQ(subsystem.references.size(), 2);
  EXPECT_EQ(subsystem.references[0].place, "a");
  EXPECT_EQ(subsystem.references[1].place, "s.b");
  EXPECT_EQ(subsystem.references[1].class_name, "my.class");
  EXPECT_EQ(subsystem.references[1].object, 1);
  EXPECT_EQ(subsystem.cell(subsystem.objects->Find(1, "Units")->value).text, "rad");
  const MatValue data = subsystem.cell(subsystem.objects->Find(1, "Data")->value);
  EXPECT_THAT(data.sizes, testing::ElementsAre(1, 3));
  EXPECT_THAT(data.numbers, testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(subsystem.cell(99).kind, MatValue::Kind::kOther);
}

TEST(OpenHdf5, IsEmptyIfTheFileIsMissingOrNotHdf5) {
  const Written written("no HDF5");
  EXPECT_FALSE(OpenHdf5(written.path())().objects);
  EXPECT_FALSE(OpenHdf5("/nowhere/at/all")().objects);
}

TEST(OpenHdf5, GivesTheSameNumbersOrAnErrorAfterAChangedByte) {
  objects::Series series;
  series.data_unit = "rad";
  const std::string whole = objects::Version73(objects::FileOf(series));
  std::size_t numbers = 0;
  const std::size_t first = whole.find(objects::Bytes(0x4059000000000000, 8, false));  // 100, the first value
  ASSERT_NE(first, std::string::npos);
  for (std::size_t at = 512; at < whole.size(); at += 1 + whole.size() / 70) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0xFF);
    const Result<Recording> recording = ParseRecording(bytes, "run.csv");
    if (!recording) {
      EXPECT_THAT(recording.error().message(), testing::StartsWith("run.csv:"));
      continue;
    }
    ++numbers;
    if (at >= first && at < first + 64) continue;
    EXPECT_DOUBLE_EQ(recording->value[7], 107) << at;
  }
  EXPECT_GT(numbers, 0);
}

}  // namespace
}  // namespace pendulum::mat_hdf5_test
