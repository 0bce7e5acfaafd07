#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""coverage_study as a process: tables, progress, exit codes. coverage_study_cli_test.py PATH_OF_coverage_study."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

BINARY = pathlib.Path()
PARAMETERS = ["inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle"]


class CoverageStudyTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_tool(self, *arguments):
        return subprocess.run([BINARY, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=120)

    def check_refused(self, code, message, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stdout, "")

    def check_done(self, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def test_list_names_the_scenarios(self):
        done = self.check_done("--list")
        names = [line.split()[0] for line in done.stdout.splitlines()]
        self.assertEqual(names[:3], ["scenario", "white_2.5", "white_0.5"])
        self.assertIn("to_rest", names)
        self.assertEqual(done.stderr, "")

    def test_has_a_line_for_each_parameter_and_does_not_depend_on_threads(self):
        one = self.check_done("--scenario", "white_2.5", "--count", "20", "--threads", "1")
        three = self.check_done("--scenario", "white_2.5", "--count", "20", "--threads", "3")
        self.assertEqual(one.stdout, three.stdout)
        rows = [line.split() for line in one.stdout.splitlines()]
        self.assertEqual([row[1] for row in rows[1:7]], PARAMETERS)
        self.assertEqual({row[0] for row in rows[1:7]}, {"white_2.5"})
        self.assertEqual(rows[9][:3], ["white_2.5", "20", "20"])

    def test_another_seed_gives_other_numbers(self):
        one = self.check_done("--scenario", "white_2.5", "--count", "5")
        other = self.check_done("--scenario", "white_2.5", "--count", "5", "--seed", "100")
        self.assertNotEqual(one.stdout, other.stdout)

    def test_progress_is_only_for_terminals(self):
        done = self.check_done("--scenario", "white_2.5,moving", "--count", "10")
        self.assertEqual(done.stderr, "")

    def test_exits_0_even_if_parameters_fail(self):
        done = self.check_done("--scenario", "ar_0.9", "--count", "1")
        self.assertIn("ar_0.9", done.stdout)

    def test_writes_markdown_in_addition_to_the_table_or_instead_of_it(self):
        done = self.check_done("--scenario", "moving", "--count", "2", "--markdown", "coverage.md")
        self.assertTrue(done.stdout.startswith("scenario"))
        page = (self.folder / "coverage.md").read_text()
        self.assertIn("```sh\ncoverage_study --scenario moving --count 2 --seed 1\n```", page)
        self.assertIn("| moving | initial_rate |", page)
        alone = self.check_done("--scenario", "moving", "--count", "2", "--markdown", "-")
        self.assertEqual(alone.stdout, page)

    def test_help_and_version_succeed_on_stdout(self):
        self.assertIn("--scenario", self.check_done("--help").stdout)
        self.assertRegex(self.check_done("--version").stdout, r"^coverage_study \d+\.\d+\.\d+\n$")

    def test_wrong_flags_exit_2(self):
        self.check_refused(2, "--scenario is missing")
        self.check_refused(2, "no scenario 'storm'; the scenarios are white_2.5", "--scenario", "storm")
        self.check_refused(2, "did you mean --count?", "--scenario", "moving", "--cuont", "1")
        self.check_refused(2, "--count is 0", "--scenario", "moving", "--count", "0")
        self.check_refused(2, "--threads is -1", "--scenario", "moving", "--threads", "-1")
        self.check_refused(2, "'stray' does not belong to a flag", "--scenario", "moving", "stray")

    def test_an_output_that_cannot_be_written_exits_73_before_the_study(self):
        done = self.run_tool("--scenario", "moving", "--count", "10", "--markdown", "none/coverage.md")
        self.assertEqual(done.returncode, 73)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("cannot write", done.stderr)
        self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
