// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "tests/tools/with_variable.h"
#include "tools/output.h"

namespace pendulum::terminal_test {
namespace {

/// Closes a descriptor at the end.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(value_); }
  int value() const { return value_; }

 private:
  int value_;
};

/// The terminal's end of a pair of pseudo-terminals; the other end stays open during the lifetime of `controller`.
int OpenTerminal(const Descriptor& controller) {
  EXPECT_EQ(::grantpt(controller.value()), 0);
  EXPECT_EQ(::unlockpt(controller.value()), 0);
  return ::open(::ptsname(controller.value()), O_RDWR | O_NOCTTY);
}

class TerminalTest : public testing::Test {
 protected:
  WithVariable terminal_{"TERM", "xterm"};
  WithVariable no_color_{"NO_COLOR", nullptr};
  Descriptor controller_{::posix_openpt(O_RDWR | O_NOCTTY)};
  Descriptor end_{OpenTerminal(controller_)};
};

TEST_F(TerminalTest, HasColour) {
  ASSERT_GE(end_.value(), 0);
  EXPECT_TRUE(WantsColour(end_.value()));
}

TEST_F(TerminalTest, HasNoColourWithNonEmptyNoColor) {
  const WithVariable zero("NO_COLOR", "0");  // any value disables colours
  EXPECT_FALSE(WantsColour(end_.value()));
  const WithVariable empty("NO_COLOR", "");
  EXPECT_TRUE(WantsColour(end_.value()));
}

TEST_F(TerminalTest, HasNoColourIfUnsupported) {
  for (const char* kind : {"dumb", "", static_cast<const char*>(nullptr)}) {
    const WithVariable terminal("TERM", kind);
    EXPECT_FALSE(WantsColour(end_.value()));
  }
}

TEST_F(TerminalTest, HasNoColourWithoutATerminal) {
  const Descriptor null(::open("/dev/null", O_WRONLY));
  EXPECT_FALSE(WantsColour(null.value()));
  EXPECT_FALSE(WantsColour(-1));
}

TEST_F(TerminalTest, GivesItsWidthToTexts) {
  for (const auto& [columns, width] : {std::pair(132, 100), std::pair(60, 60), std::pair(20, 40)}) {
    const winsize size{.ws_row = 24, .ws_col = static_cast<unsigned short>(columns), .ws_xpixel = 0, .ws_ypixel = 0};
    ASSERT_EQ(::ioctl(end_.value(), TIOCSWINSZ, &size), 0);
    EXPECT_EQ(TextStyleFor(end_.value()).width, width);
  }
  const Descriptor null(::open("/dev/null", O_WRONLY));
  EXPECT_EQ(TextStyleFor(null.value()).width, 80);
}

}  // namespace
}  // namespace pendulum::terminal_test
