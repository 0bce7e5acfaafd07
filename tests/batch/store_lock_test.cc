// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/store_lock.h"

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pendulum::store_lock_test {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;
using testing::StartsWith;

class StoreLockTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  bool IsFree() const { return StoreLock::Take(store_).has_value(); }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("store_lock_test_" + std::to_string(getpid()));
  const fs::path store_ = folder_ / "results.sqlite";
  const fs::path file_ = folder_ / "results.sqlite.lock";
};

/// Another process that holds the lock until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& store) {
    std::array<int, 2> ready{};
    EXPECT_EQ(::pipe(ready.data()), 0);
    process_ = ::fork();
    if (process_ == 0) {
      const auto lock = StoreLock::Take(store);
      const char answer = lock ? 'y' : 'n';
      if (::write(ready[1], &answer, 1) != 1) ::_exit(1);
      while (true) ::pause();
    }
    char answer = '?';
    EXPECT_EQ(::read(ready[0], &answer, 1), 1);
    EXPECT_EQ(answer, 'y');
    ::close(ready[0]);
    ::close(ready[1]);
  }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;
  ~Holder() { Kill(); }

  void Kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(std::exchange(process_, 0), nullptr, 0);
  }

 private:
  pid_t process_ = 0;
};

TEST_F(StoreLockTest, HasOneOwnerAtATime) {
  std::optional<Result<StoreLock>> lock = StoreLock::Take(store_);
  ASSERT_TRUE(*lock) << lock->error().message();
  EXPECT_TRUE(fs::exists(file_));
  const auto other = StoreLock::Take(store_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, StatusCode::kTryAgain);
  EXPECT_EQ(other.error().message(),
            store_.string() + ": another process writes to this file; try again when it is done");
  lock.reset();
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_TRUE(IsFree());
}

TEST_F(StoreLockTest, ExcludesOtherProcessesUntilItsOwnerIsKilled) {
  Holder holder(store_);
  const auto other = StoreLock::Take(store_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, StatusCode::kTryAgain);
  holder.Kill();
  EXPECT_TRUE(fs::exists(file_));  // the killed process could not remove it
  EXPECT_TRUE(IsFree());
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(StoreLockTest, StaysLockedWhenMoved) {
  auto lock = StoreLock::Take(store_);
  ASSERT_TRUE(lock);
  {
    const StoreLock moved = *std::move(lock);
    EXPECT_FALSE(IsFree());
  }
  EXPECT_TRUE(IsFree());
}

TEST_F(StoreLockTest, LocksEachStoreSeparately) {
  const auto lock = StoreLock::Take(store_);
  ASSERT_TRUE(lock);
  EXPECT_TRUE(StoreLock::Take(folder_ / "other.sqlite"));
}

TEST_F(StoreLockTest, LocksTheSameStoreThroughALink) {
  std::ofstream(store_) << "x";
  fs::create_symlink("results.sqlite", folder_ / "link.sqlite");
  const auto lock = StoreLock::Take(folder_ / "link.sqlite");
  ASSERT_TRUE(lock);
  EXPECT_TRUE(fs::exists(file_));
  EXPECT_FALSE(IsFree());
}

TEST_F(StoreLockTest, ReusesALeftoverLockFile) {
  std::ofstream(file_) << "x";
  EXPECT_TRUE(IsFree());
}

TEST_F(StoreLockTest, ReportsAPathThatCannotBeCreated) {
  const fs::path store = folder_ / "nowhere" / "results.sqlite";
  const auto lock = StoreLock::Take(store);
  ASSERT_FALSE(lock);
  EXPECT_EQ(lock.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(lock.error().message(), StartsWith("cannot write " + store.string() + ": No such file or directory"));
  EXPECT_THAT(lock.error().message(), HasSubstr(store.string() + ".lock"));
}

}  // namespace
}  // namespace pendulum::store_lock_test
