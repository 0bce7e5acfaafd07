// SPDX-License-Identifier: Apache-2.0
// Prints a Markdown table: how often each friction law is recommended for recordings simulated with a known law.
//   GLOG_minloglevel=3 recommendation_study [COUNT [LAW]]
#include <cstdlib>
#include <iostream>

#include "pendulum/base/format.h"
#include "tests/analysis/recommendation_cases.h"

namespace pendulum {
namespace {

void PrintCase(const TrueLaw& law, double duration, double noise, int count) {
  const Recommendations counts = CountRecommendations(LawRun(law, duration, noise), count, 1);
  std::cout << "| " << law.model << " | " << NumberText(duration) << " | " << NumberText(noise) << " |";
  for (const std::string_view name : FrictionModels::kNames) {
    const auto found = counts.find(std::string(name));
    std::cout << " " << (found == counts.end() ? 0 : found->second) << " |";
  }
  const auto none = counts.find("");
  std::cout << " " << (none == counts.end() ? 0 : none->second) << " |" << std::endl;
}

/// Prints the study of all laws, or of the law `only`.
void PrintStudy(int count, std::string_view only) {
  std::cout << "| law | seconds | noise, counts |";
  for (const std::string_view name : FrictionModels::kNames) std::cout << " " << name << " |";
  std::cout << " none |\n|---|---|---|";
  for (std::size_t i = 0; i <= FrictionModels::kNames.size(); ++i) std::cout << "---|";
  std::cout << "\n";
  for (const TrueLaw& law : kTrueLaws) {
    if (!only.empty() && law.model != only) continue;
    for (const double noise : {0.25, 1.0, 2.5}) PrintCase(law, 20, noise, count);
  }
  if (!only.empty() && only != "stribeck") return;
  // Stribeck friction is identified by the slow end of a swing, so its recordings also last 60 s.
  for (const double noise : {0.25, 1.0, 2.5}) PrintCase(kTrueLaws.back(), 60, noise, count);
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  constexpr int kCount = 200;
  pendulum::PrintStudy(argc > 1 ? std::atoi(argv[1]) : kCount, argc > 2 ? argv[2] : "");
  return 0;
}
