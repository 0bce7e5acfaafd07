// SPDX-License-Identifier: Apache-2.0
#include "tools/serve_pendulum_options.h"

#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/temporary_folder.h"

namespace pendulum::serve_pendulum_options_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr const char* kToken = "0123456789abcdef";

ServePendulumFlags Flags() {
  ServePendulumFlags flags;
  flags.store = "fits.sqlite";
  return flags;
}

// ---- Options -------------------------------------------------------------------------------------------------------

TEST(MakeServePendulumOptions, ServeOnlyThisMachineByDefault) {
  const auto options = MakeServePendulumOptions(Flags(), "");
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->store, "fits.sqlite");
  EXPECT_EQ(options->server.address, "127.0.0.1");
  EXPECT_EQ(options->server.port, 8080);
  EXPECT_EQ(options->server.max_body, 32U * 1024 * 1024);
  EXPECT_EQ(options->service.limits.max_samples, 200'000U);
  EXPECT_EQ(options->service.limits.max_runs, 10'000U);
  EXPECT_EQ(options->service.fit_time, std::chrono::seconds(30));
  EXPECT_EQ(options->service.access.token, "");
  EXPECT_THAT(options->service.access.allowed_hosts, IsEmpty());
  EXPECT_EQ(options->service.live, "");
  EXPECT_EQ(options->service.docs, "");
}

TEST(InstalledGuide, IsBesideTheFolderOfTheProgram) {
  EXPECT_EQ(InstalledGuide("/usr/bin/serve_pendulum"), "/usr/share/doc/pendulum/html");
  EXPECT_EQ(InstalledGuide("/home/ada/pendulum/bin/serve_pendulum"), "/home/ada/pendulum/share/doc/pendulum/html");
}

TEST(MakeServePendulumOptions, StoreEachFlag) {
  ServePendulumFlags flags = Flags();
  flags.port = 0;
  flags.address = "0.0.0.0";
  flags.threads = 3;
  flags.allowed_hosts = "lab.example,other.example:8443";
  flags.max_body_mb = 200;
  flags.max_samples = 1000;
  flags.fit_seconds = 7;
  flags.max_queue = 5;
  flags.max_batch_runs = 6;
  flags.max_connections = 8;
  flags.request_seconds = 9;
  flags.stop_seconds = 0;
  flags.live = "run.csv";
  flags.docs = "/tmp";
  const auto options = MakeServePendulumOptions(flags, kToken);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->server.port, 0);
  EXPECT_EQ(options->server.address, "0.0.0.0");
  EXPECT_EQ(options->server.fit_threads, 3);
  EXPECT_EQ(options->server.max_queue, 5U);
  EXPECT_EQ(options->server.max_connections, 8U);
  EXPECT_EQ(options->server.max_body, 200U * 1024 * 1024);
  EXPECT_GE(options->server.max_buffered, options->server.max_body);  // room for the largest request
  EXPECT_EQ(options->server.request_time, std::chrono::seconds(9));
  EXPECT_EQ(options->server.stop_time, std::chrono::seconds(5)) << "5 s to answer the clients whose fits are stopped";
  EXPECT_EQ(options->service.threads, 3);
  EXPECT_EQ(options->service.limits.max_samples, 1000U);
  EXPECT_EQ(options->service.limits.max_runs, 6U);
  EXPECT_EQ(options->service.fit_time, std::chrono::seconds(7));
  EXPECT_EQ(options->service.access.token, kToken);
  EXPECT_THAT(options->service.access.allowed_hosts, ElementsAre("lab.example", "other.example:8443"));
  EXPECT_EQ(options->service.live, "run.csv");
  EXPECT_EQ(options->service.docs, "/tmp");
}

struct Refusal {
  std::string message;
  void (*spoil)(ServePendulumFlags&);
};

TEST(MakeServePendulumOptions, RefuseWrongFlagsAndNameThem) {
  const std::vector<Refusal> refusals = {
      {"'stray' does not belong to a flag", [](ServePendulumFlags& f) { f.positional = {"stray"}; }},
      {"--store is missing", [](ServePendulumFlags& f) { f.store.clear(); }},
      {"--docs names '/none'; there is no such folder", [](ServePendulumFlags& f) { f.docs = "/none"; }},
      {"--port is -1; it must be 0 to 65535", [](ServePendulumFlags& f) { f.port = -1; }},
      {"--port is 65536; it must be 0 to 65535", [](ServePendulumFlags& f) { f.port = 65536; }},
      {"--threads is -1; it must be 0 to 256", [](ServePendulumFlags& f) { f.threads = -1; }},
      {"--max_body_mb is 0; it must be 1 to 512", [](ServePendulumFlags& f) { f.max_body_mb = 0; }},
      {"--max_samples is 99; it must be 100 to 10000000", [](ServePendulumFlags& f) { f.max_samples = 99; }},
      {"--fit_seconds is 0; it must be 1 to 86400", [](ServePendulumFlags& f) { f.fit_seconds = 0; }},
      {"--max_queue is 0; it must be 1 to 100000", [](ServePendulumFlags& f) { f.max_queue = 0; }},
      {"--max_batch_runs is 0; it must be 1 to 10000000", [](ServePendulumFlags& f) { f.max_batch_runs = 0; }},
      {"--max_connections is 1; it must be 2 to 100000", [](ServePendulumFlags& f) { f.max_connections = 1; }},
      {"--request_seconds is 0; it must be 1 to 86400", [](ServePendulumFlags& f) { f.request_seconds = 0; }},
      {"--stop_seconds is -1; it must be 0 to 86400", [](ServePendulumFlags& f) { f.stop_seconds = -1; }},
  };
  for (const Refusal& refusal : refusals) {
    ServePendulumFlags flags = Flags();
    refusal.spoil(flags);
    const auto options = MakeServePendulumOptions(flags, "");
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument) << refusal.message;
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

TEST(MakeServePendulumOptions, RequireATokenForOtherMachines) {
  for (const char* address : {"0.0.0.0", "192.168.1.5", "::", "128.0.0.1", "::ffff:127.0.0.1"}) {
    ServePendulumFlags flags = Flags();
    flags.address = address;
    const auto refused = MakeServePendulumOptions(flags, "");
    ASSERT_FALSE(refused) << address;
    EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(refused.error().message(),
                StartsWith(std::string("--address ") + address + " is open to other machines"));
    EXPECT_TRUE(MakeServePendulumOptions(flags, kToken)) << address;
  }
  for (const char* address : {"127.0.0.1", "127.1.2.3", "::1"}) {
    ServePendulumFlags flags = Flags();
    flags.address = address;
    EXPECT_TRUE(MakeServePendulumOptions(flags, "")) << address;
  }
}

// ---- Token ---------------------------------------------------------------------------------------------------------

class ReadTokenTest : public testing::Test {
 protected:
  Result<std::string> Read(const std::string& text) const {
    folder_.Create("token", text);
    return ReadToken(folder_.Path("token"), nullptr);
  }

  const TemporaryFolder folder_;
};

TEST_F(ReadTokenTest, IsTheFirstLineOfTheFile) {
  const std::string token = kToken;
  for (const std::string& text : {token, token + "\n", token + "\r\n", token + "\nand notes\n"}) {
    EXPECT_EQ(Read(text).value(), token) << text;
  }
}

TEST_F(ReadTokenTest, UsesTheEnvironmentWithoutAFile) {
  EXPECT_EQ(ReadToken("", nullptr).value(), "");
  EXPECT_EQ(ReadToken("", "").value(), "");
  EXPECT_EQ(ReadToken("", kToken).value(), kToken);
  folder_.Create("token", "that_of_the_file");
  EXPECT_EQ(ReadToken(folder_.Path("token"), kToken).value(), "that_of_the_file");
}

TEST_F(ReadTokenTest, RequiresSixteenVisibleCharacters) {
  for (const std::string text : {"0123456789abcde", "0123456789abcde f", "0123456789abcdef\t", "0123456789abcdéf"}) {
    const auto refused = Read(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(refused.error().message(),
                StartsWith(folder_.Path("token") + ": the token must have at least 16 visible ASCII characters"));
    EXPECT_EQ(refused.error().message().find(text),
              std::string::npos);  // the text may be the token with a typing error
    EXPECT_THAT(ReadToken("", text.c_str()).error().message(), StartsWith("PENDULUM_TOKEN: the token must have"));
  }
}

TEST_F(ReadTokenTest, RefusesAFileWithoutAToken) {
  for (const char* text : {"", "\n", "\r\n0123456789abcdef\n"}) {
    const auto refused = Read(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
  }
  const auto missing = ReadToken(folder_.Path("none"), kToken);
  ASSERT_FALSE(missing);  // the environment does not replace a missing token file
  EXPECT_EQ(missing.error().code, StatusCode::kNotFound);
  EXPECT_FALSE(Read(std::string(5000, 'x')));
}

}  // namespace
}  // namespace pendulum::serve_pendulum_options_test
