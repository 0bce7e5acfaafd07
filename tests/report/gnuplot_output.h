// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace pendulum {

/// What gnuplot writes to standard output for a script; uses temporary files and a shell.
inline std::string GnuplotOutput(const std::string& script) {
  const std::string path = testing::TempDir() + "gnuplot_output.gp";
  std::ofstream(path) << script;
  std::FILE* output = ::popen(("gnuplot -d " + path + " 2>" + path + ".err").c_str(), "r");
  EXPECT_NE(output, nullptr);
  std::string picture;
  std::array<char, 4096> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), output)) picture.append(block.data(), got);
  EXPECT_EQ(::pclose(output), 0);
  std::ifstream errors(path + ".err");
  EXPECT_EQ(errors.peek(), std::ifstream::traits_type::eof()) << errors.rdbuf();
  return picture;
}

}  // namespace pendulum
