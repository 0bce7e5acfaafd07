// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/markdown.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/text.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::markdown_test {
namespace {

using testing::HasSubstr;
using testing::IsSubsetOf;
using testing::StartsWith;

std::string MarkdownOf(Block block) { return ToMarkdown(Sections{{"T", "", {std::move(block)}}}); }

// Active characters of GitHub-flavoured Markdown, version 0.29, sections 4.10, 6.1, 6.4, 6.6 and 6.10.
TEST(MarkdownText, EscapesMarkup) {
  EXPECT_EQ(MarkdownText("a|b*c`d<e&f~g$h\\i"), "a\\|b\\*c\\`d\\<e\\&f\\~g\\$h\\\\i");
  EXPECT_EQ(MarkdownText("[x](javascript:y) ![z][w] [v]: u"), "[x\\](javascript:y) ![z\\][w] [v\\]: u");
  EXPECT_EQ(MarkdownText("_a_ release_angle τ_c _"), "\\_a\\_ release_angle τ_c \\_");
  EXPECT_EQ(MarkdownText("a\nb\x1B[1m"), "a?b?[1m");
}

TEST(MarkdownText, KeepsNumbersAndIntervals) {
  for (const char* text : {"[0.0785, 0.0795]", "-0.5", "N m s^2/rad^2", "0.0790 ± 0.0003", "χ² (p 0.14)"}) {
    EXPECT_EQ(MarkdownText(text), text);
  }
}

TEST(ToMarkdown, EscapesHeadingsAndListsInParagraphs) {
  EXPECT_EQ(MarkdownOf(Words{"# x"}), "## T\n\n\\# x\n");
  EXPECT_EQ(MarkdownOf(Words{"12. x"}), "## T\n\n12\\. x\n");
  EXPECT_EQ(MarkdownOf(Words{"1 of 2 agree"}), "## T\n\n1 of 2 agree\n");
  EXPECT_EQ(MarkdownOf(Items{{"- x", "y"}}), "## T\n\n- \\- x\n- y\n");
}

TEST(ToMarkdown, ShowsValueAndErrorInOneCell) {
  Table table{{{"name"}, {"empty"}, {"value", true}, {"± error", false, 1}, {"agrees"}},
              {{"a|b", "", "12", "± 3", "NO"}, {"c", "", "5", "", "yes"}}};
  table.caution = "NO";
  EXPECT_EQ(MarkdownOf(table),
            "## T\n\n"
            "| name | value ± error | agrees |\n"
            "| --- | --: | --- |\n"
            "| a\\|b | 12 ± 3 | **NO** |\n"
            "| c | 5 | yes |\n");
}

TEST(ToMarkdown, ShowsFactsFormulasAndOmissions) {
  EXPECT_EQ(MarkdownOf(Facts{{"model", "b |th'|"}, {"status", "failed", Emphasis::kAlarm}}),
            "## T\n\n| | |\n| --- | --- |\n| model | b \\|th'\\| |\n| status | **failed** |\n");
  EXPECT_EQ(MarkdownOf(Formula{"b\u00A0th' = 0"}), "## T\n\n```text\nb th' = 0\n```\n");
  Table table{{{"n"}}, {{"1"}, {"9"}}};
  table.rows_before = 1;
  table.left_out = "... 7 more";
  EXPECT_EQ(MarkdownOf(table), "## T\n\n| n |\n| --- |\n| 1 |\n| ... 7 more |\n| 9 |\n");
}

TEST(ToMarkdown, StartsWithTheSummary) {
  EXPECT_THAT(ToMarkdown(ExampleComparedIdentification()), StartsWith(R"(# Pendulum: swing.csv

## Summary

1801 of 2000 samples, 1.5 s (held, then released) to 19.5 s (the end of the recording).

Recommended: coulomb: the only one that converged.

| law | rms residual | ΔBIC | |
| --- | --: | --: | --- |
| coulomb | 0.200 deg | 0.0 | recommended |

No result with drag: 100 iterations were not enough.

**The law coulomb does not describe all readings: residuals of 0.200 deg (rms) exceed the noise. Look at them (--report), or try another window (--from, --to). The rig disagrees: inertia 3.9 % larger (z 4.2): mass, length, support, bob or gear.**

| coulomb | value ± total error | unit | error from |
| --- | --: | --- | --- |
| inertia | 0.0790 ± 0.0010 | kg m^2 | gravity torque |
| viscous | 0.0030 ± 0.0005 | N m s/rad | noise |
| coulomb | 0 | N m | at its bound |
| release_angle | 24.236 ± 0.011 | deg | noise |
| zero_angle | 0.572958 | deg | fixed |

```text
0.0790 th'' + 0.0030 th' + 1.80 sin th = 0
```

Weakly identifiable: viscous. Improve first: gravity torque; weigh the pendulum held horizontal: inertia ± 1.3 %, at best ± 0.32 %.

The textbook's log decrement gives I_O 0.08020 (1.5 % more), b 0.003060 (agrees).

## Warnings

- there is a gap of 0.5 s after 7 s
)"));
}

TEST(ToMarkdown, SaysFirstThatThereIsNoResult) {
  EXPECT_THAT(ToMarkdown(ExampleRateIdentification()),
              HasSubstr("**No result with coulomb (not_converged): 100 iterations were not enough.**\n"));
}

TEST(ToMarkdown, StartsAJointFitWithTheAgreement) {
  EXPECT_THAT(ToMarkdown(ExampleJointIdentification()), StartsWith(R"(# Pendulum: 2 recordings of one rig

## Summary

2702 of 4000 samples: run.csv, b c.csv.

The recordings agree on inertia, viscous.
)"));
}

// The stars and bars of a strip must be escaped; otherwise Markdown would read them as emphasis and as table cells.
TEST(ToMarkdown, ShowsStripsVerbatimForAJointFit) {
  EXPECT_THAT(ToMarkdown(ExampleJointIdentification()),
              HasSubstr("| 1 separate | 0.07890 ± 0.00030 | -0.4 | -------\\*-------- |\n"));
}

TEST(ToMarkdown, WorksWithoutAFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  report.recordings.front().checks.clear();
  EXPECT_THAT(ToMarkdown(report), HasSubstr("Nothing was fitted: these are formulas of the linear pendulum"));
}

TEST(ToMarkdown, EscapesMarkupInAFileName) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.path = "a|<script>\n# [x](http://y)";
  const std::string text = ToMarkdown(report);
  EXPECT_THAT(text, StartsWith("# Pendulum: a\\|\\<script>?# [x\\](http://y)\n"));
  EXPECT_THAT(text, HasSubstr("| file | a\\|\\<script>?# [x\\](http://y) |\n"));
}

std::vector<std::string> TitlesOf(const std::string& text, const std::string& before, const std::string& behind) {
  std::vector<std::string> titles;
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at + 1)) {
    titles.push_back(text.substr(at + before.size(), text.find(behind, at) - at - before.size()));
  }
  return titles;
}

TEST(ToMarkdown, HasEverySectionOfTheText) {
  for (const Identification& report :
       {ExampleIdentification(), ExampleRateIdentification(), ExampleComparedIdentification(),
        ExampleComparedJointIdentification(), ExampleFailedJointIdentification()}) {
    EXPECT_THAT(TitlesOf(ToText(ReportSections(report)), "[[", "]]"),
                IsSubsetOf(TitlesOf(ToMarkdown(report), "\n## ", "\n\n")));
  }
}

}  // namespace
}  // namespace pendulum::markdown_test
