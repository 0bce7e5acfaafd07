// SPDX-License-Identifier: Apache-2.0
#include "tools/output.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum::output_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// Each test has a separate directory.
class OutputTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "output_test_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    directory_ = name;
  }

  void TearDown() override {
    std::error_code error;
    fs::remove_all(directory_, error);
  }

  std::string Path(const std::string& name) const { return (directory_ / name).string(); }

  void Create(const std::string& name, const std::string& text) const { std::ofstream(Path(name)) << text; }

  std::string Text(const std::string& name) const {
    std::ifstream file(Path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_)) names.push_back(entry.path().filename());
    return names;
  }

  fs::path directory_;
};

/// The message of CheckOutputs for outputs --a, --b, ... and inputs --in; "" if there is no error.
std::string Check(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs, StatusCode code) {
  std::vector<NamedFile> out(outputs.size());
  std::vector<NamedFile> in(inputs.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {"--out" + std::to_string(i), outputs[i]};
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = {"--in", inputs[i]};
  const auto checked = CheckOutputs(out, in);
  if (checked) return "";
  EXPECT_EQ(checked.error().code, code) << checked.error().message();
  return checked.error().message();
}

std::string Unwritable(const std::string& path) { return Check({path}, {}, StatusCode::kCannotWrite); }

std::string Write(const std::vector<Output>& outputs) {
  const auto written = WriteOutputs(outputs);
  if (written) return "";
  EXPECT_EQ(written.error().code, StatusCode::kCannotWrite);
  return written.error().message();
}

TEST_F(OutputTest, CheckCreatesNothing) {
  Create("old", "kept");
  EXPECT_EQ(Check({Path("new"), Path("old"), "-", "/dev/null"}, {Path("data")}, StatusCode::kCannotWrite), "");
  EXPECT_THAT(Names(), UnorderedElementsAre("old"));
  EXPECT_EQ(Text("old"), "kept");
}

TEST_F(OutputTest, CheckRefusesUnwritablePaths) {
  EXPECT_EQ(Unwritable(directory_), "cannot write " + directory_.string() + ": it is a directory");
  EXPECT_EQ(Unwritable(Path("no/x")), "cannot write " + Path("no/x") + ": No such file or directory");
  EXPECT_EQ(Unwritable(Path("new/")), "cannot write " + Path("new/") + ": No such file or directory");
  EXPECT_THAT(Unwritable(Path(std::string(300, 'x'))), HasSubstr("File name too long"));
  Create("file", "");
  EXPECT_THAT(Unwritable(Path("file/x")), HasSubstr("Not a directory"));
}

TEST_F(OutputTest, CheckRefusesAReadOnlyFileAndDirectory) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  Create("file", "");
  fs::permissions(Path("file"), fs::perms::owner_read);
  EXPECT_THAT(Unwritable(Path("file")), HasSubstr("Permission denied"));
  fs::permissions(directory_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(Unwritable(Path("new")), HasSubstr("Permission denied"));
  fs::permissions(directory_, fs::perms::owner_all);
}

TEST_F(OutputTest, CheckRefusesTwoNamesOfOneFile) {
  Create("data", "x");
  fs::create_symlink("data", Path("link"));
  fs::create_hard_link(Path("data"), Path("hard"));
  const auto same = [&](const std::string& a, const std::string& b) {
    return Check({a, b}, {}, StatusCode::kInvalidArgument);
  };
  EXPECT_EQ(same(Path("new"), Path("./new")), "--out0 " + Path("new") + " is the output of --out1 too");
  EXPECT_NE(same(Path("link"), Path("data")), "");
  EXPECT_NE(same("-", "/dev/stdout"), "");
  EXPECT_EQ(same("/dev/null", "/dev/null"), "");
  EXPECT_EQ(Check({Path("hard")}, {Path("data")}, StatusCode::kInvalidArgument),
            "--out0 " + Path("hard") + " would overwrite the input of --in");
}

TEST_F(OutputTest, CheckComparesEachOutputWithAllOtherOutputsAndAllInputs) {
  std::vector<std::string> outputs;
  std::vector<std::string> inputs;
  for (int i = 0; i < 150; ++i) {
    outputs.push_back(Path("out" + std::to_string(i)));
    inputs.push_back(Path("in" + std::to_string(i)));
  }
  EXPECT_EQ(Check(outputs, inputs, StatusCode::kInvalidArgument), "");
  inputs.back() = outputs.front();
  EXPECT_EQ(Check(outputs, inputs, StatusCode::kInvalidArgument),
            "--out0 " + Path("out0") + " would overwrite the input of --in");
  outputs.back() = outputs.front();
  EXPECT_EQ(Check(outputs, {}, StatusCode::kInvalidArgument),
            "--out0 " + Path("out0") + " is the output of --out149 too");
}

TEST_F(OutputTest, CheckFollowsALinkToAMissingFile) {
  fs::create_symlink("new", Path("link"));
  EXPECT_NE(Check({Path("link"), Path("new")}, {}, StatusCode::kInvalidArgument), "");
}

TEST_F(OutputTest, WritesAndReplacesWholeFiles) {
  Create("old", "a much longer text than the new one");
  EXPECT_EQ(Write({{Path("old"), "new"}, {Path("b"), std::string(1 << 20, 'b')}}), "");
  EXPECT_EQ(Text("old"), "new");
  EXPECT_EQ(Text("b").size(), 1 << 20);
  EXPECT_THAT(Names(), UnorderedElementsAre("old", "b"));
}

TEST_F(OutputTest, WritesNothingIfOneFileIsUnwritable) {
  EXPECT_EQ(Write({{Path("a"), "a"}, {Path("no/b"), "b"}}),
            "cannot write " + Path("no/b") + ": No such file or directory");
  EXPECT_TRUE(Names().empty());
}

TEST_F(OutputTest, WritesMoreThanAHundredFiles) {
  std::vector<Output> outputs;
  for (int i = 0; i < 150; ++i) outputs.push_back({Path(std::to_string(i)), "text " + std::to_string(i)});
  EXPECT_EQ(Write(outputs), "");
  EXPECT_EQ(Names().size(), 150);
  EXPECT_EQ(Text("0"), "text 0");
  EXPECT_EQ(Text("149"), "text 149");
}

TEST_F(OutputTest, IgnoresFilesOfAKilledProcess) {
  const auto left = [](int i) { return ".pendulum." + std::to_string(::getpid()) + "." + std::to_string(i) + ".tmp"; };
  for (int i = 0; i < 1000; ++i) Create(left(i), "left");
  EXPECT_EQ(Write({{Path("a"), "a"}}), "");
  EXPECT_EQ(Text("a"), "a");
  EXPECT_EQ(Names().size(), 1001);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(Text(left(i)), "left");
}

TEST_F(OutputTest, KeepsPermissionsOrFollowsTheUmask) {
  Create("old", "");
  fs::permissions(Path("old"), fs::perms(0640));
  const mode_t mask = ::umask(027);
  EXPECT_EQ(Write({{Path("old"), "x"}, {Path("new"), "x"}}), "");
  ::umask(mask);
  EXPECT_EQ(fs::status(Path("old")).permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(Path("new")).permissions(), fs::perms(0640));
}

TEST_F(OutputTest, ReplacesTheTargetOfALinkAndKeepsTheLink) {
  fs::create_directory(Path("deep"));
  Create("deep/file", "old");
  fs::create_symlink("deep/file", Path("link"));
  EXPECT_EQ(Write({{Path("link"), "new"}}), "");
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Text("deep/file"), "new");
}

TEST_F(OutputTest, WritesIntoANamedPipe) {
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = Text("pipe"); });
  EXPECT_EQ(Check({Path("pipe")}, {}, StatusCode::kCannotWrite), "");
  EXPECT_EQ(Write({{Path("pipe"), "through"}}), "");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(Path("pipe")));
}

TEST_F(OutputTest, WritesToDevicesAndReportsWhenTheyAreFull) {
  EXPECT_EQ(Write({{"/dev/null", "gone"}}), "");
  EXPECT_EQ(Write({{"/dev/full", "x"}}), "cannot write /dev/full: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

Result<std::string> Letter(int i) { return std::string(1, static_cast<char>('a' + i)); }

TEST_F(OutputTest, WritesPiecesOneAfterTheOther) {
  Create("old", "a longer text");
  EXPECT_TRUE(WritePieces(Path("old"), 3, Letter));
  EXPECT_EQ(Text("old"), "abc");
  EXPECT_THAT(Names(), UnorderedElementsAre("old"));
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = Text("pipe"); });
  EXPECT_TRUE(WritePieces(Path("pipe"), 3, Letter));
  reader.join();
  EXPECT_EQ(read, "abc");
}

TEST_F(OutputTest, KeepsTheOldFileIfAPieceFails) {
  Create("old", "kept");
  const auto written = WritePieces(Path("old"), 3, [](int i) -> Result<std::string> {
    if (i == 2) return Error(StatusCode::kInternal, "no third piece");
    return Letter(i);
  });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message(), "no third piece");
  EXPECT_EQ(Text("old"), "kept");
  EXPECT_THAT(Names(), UnorderedElementsAre("old"));
  EXPECT_EQ(WritePieces(Path("no/x"), 1, Letter).error().message(),
            "cannot write " + Path("no/x") + ": No such file or directory");
}

TEST_F(OutputTest, WritesTheSameWithDeferredSynchronisation) {
  Create("old", "a longer text");
  const std::vector<Output> outputs = {{Path("old"), "new"}, {Path("b"), "b"}};
  EXPECT_TRUE(WriteOutputs(outputs, Durability::kDeferred));
  EXPECT_TRUE(SynchroniseFileSystem(Path("old")));
  EXPECT_EQ(Text("old"), "new");
  EXPECT_EQ(Text("b"), "b");
  EXPECT_THAT(Names(), UnorderedElementsAre("old", "b"));
}

TEST(IsStandardOutput, HasThreeNames) {
  EXPECT_TRUE(IsStandardOutput("-"));
  EXPECT_TRUE(IsStandardOutput("/dev/stdout"));
  EXPECT_TRUE(IsStandardOutput("/dev/fd/1"));
  EXPECT_FALSE(IsStandardOutput("./-"));
}

TEST(NumberedPath, IsUnchangedForOneRecording) { EXPECT_EQ(NumberedPath("a/run.csv", 0, 1), "a/run.csv"); }

TEST(NumberedPath, StartsAtOneWithThreeDigitsOrMore) {
  EXPECT_EQ(NumberedPath("a.b/run.csv", 0, 2), "a.b/run_001.csv");
  EXPECT_EQ(NumberedPath("run", 11, 12), "run_012");
  EXPECT_EQ(NumberedPath("run.x.csv", 999, 1000), "run.x_1000.csv");
  EXPECT_EQ(NumberedPath("run.csv", 0, 1000), "run_0001.csv");
}

TEST(NumberedPath, KeepsStandardOutput) {
  for (const std::string path : {"-", "/dev/stdout", "/dev/fd/1"}) EXPECT_EQ(NumberedPath(path, 1, 3), path);
}

}  // namespace
}  // namespace pendulum::output_test
