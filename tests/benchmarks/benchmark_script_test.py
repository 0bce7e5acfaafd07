#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Errors that scripts/benchmark and scipy_users.py report before they measure anything."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]


class RefusalTest(unittest.TestCase):
    def check(self, command, code, sentence):
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(sentence, done.stderr)
        self.assertEqual(done.stdout, "")

    def check_script(self, arguments, code, sentence):
        self.check([TOP / "scripts/benchmark", *arguments], code, sentence)

    def check_python(self, arguments, code, sentence):
        self.check([sys.executable, "-B", TOP / "tests/benchmarks/scipy_users.py", *arguments], code, sentence)

    def test_unknown_options(self):
        self.check_script(["--fast"], 2, "benchmark: there is no option '--fast'; there are --bin DIR and --out DIR.")
        self.check_python(["a.csv", "--fast"], 2, "unrecognized arguments: --fast")

    def test_folder_is_missing(self):
        self.check_script(["--bin"], 2, "benchmark: --bin is without its folder.")

    def test_benchmarks_are_not_built(self):
        with tempfile.TemporaryDirectory() as folder:
            self.check_script(["--bin", folder], 1, f"{folder}/pendulum_benchmarks is missing; cmake --preset release")

    def test_recording_is_missing(self):
        self.check_python(["/nowhere.csv"], 1, "scipy_users: /nowhere.csv cannot be read: ")

    def test_header_is_wrong(self):
        self.check_python([TOP / "datasets/textbook_rig.json"], 1, "has no header time_s,angle_deg, or no samples")

    def test_no_repetitions(self):
        self.check_python(["a.csv", "--repetitions", "0"], 2, "--repetitions is 0; it is at least 1")


if __name__ == "__main__":
    unittest.main()
