// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/service_page.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::service_page_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ServicePage, LoadsItsScriptAndItsStyle) {
  const std::string page(ServicePage());
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("src=\"/app.js\""));
  EXPECT_THAT(page, HasSubstr("href=\"/app.css\""));
  EXPECT_THAT(page, HasSubstr(R"(id="names">@NAMES@<)"));
  EXPECT_THAT(page, HasSubstr(R"(id="flags">@FLAGS@<)"));
  EXPECT_THAT(page, Not(HasSubstr("<style")));
}

TEST(ServicePage, HasItsScriptAndItsStyleInTwoFurtherFiles) {
  EXPECT_THAT(std::string(ServiceScript()), HasSubstr("/v1/fits"));
  EXPECT_THAT(std::string(ServiceStyle()), HasSubstr("--paper"));
}

}  // namespace
}  // namespace pendulum::service_page_test
