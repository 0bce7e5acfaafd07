#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits a few simulated recordings of some rows of the table of hazards: hazards_test.py PATH/TO/fit_pendulum.

scripts/truth runs all rows with more recordings. Needs python3-scipy.
"""

import functools
import pathlib
import sys
import unittest

from hazard_table import FIRST_SEED, run
from row_summary import summarize
from scenarios import ROWS

TOOL = pathlib.Path()  # from the command line
RECORDINGS = 2
# Rows in which nothing may be wrong without a word. Add a row when the tool names its cause or has it in its budget.
HANDLED = ("exact_white", "clean_white", "clean_quiet", "clean_gyro", "gain_1", "sine", "lag_20", "mean_4_0.25",
           "drift_thermal", "clock_header", "push", "hold_angle", "drag", "presliding_dahl", "load")
# Rows in which the right cause must be named.
NAMED = ("sine", "drift_thermal", "hold_angle")
# Rows in which nothing is wrong: no cause may be named.
CLEAN = ("exact_white", "clean_white", "clean_quiet", "clean_gyro")
# Largest total errors of clean_white over those of noise alone. A wide budget would make every row pass.
LARGEST_RATIO = {"inertia": 20, "viscous": 3, "coulomb": 3}


class HazardsTest(unittest.TestCase):
    @staticmethod
    @functools.cache
    def summary(name):
        return summarize(ROWS[name], [run(TOOL, name, FIRST_SEED + index) for index in range(RECORDINGS)])

    def test_handled_rows_are_not_silently_wrong(self):
        for name in HANDLED:
            with self.subTest(name):
                found = self.summary(name)
                for key in ("silent", "misnamed_wrong", "silent_start", "failed"):
                    self.assertEqual(found[key], 0, (key, found))
                self.assertEqual([fault for fault in found["fails"] if "without an error" in fault], [], found)

    def test_causes_are_named(self):
        for name in NAMED:
            with self.subTest(name):
                self.assertEqual(self.summary(name)["named"], RECORDINGS)

    def test_clean_rows_name_no_cause(self):
        for name in CLEAN:
            with self.subTest(name):
                self.assertEqual(self.summary(name)["misnamed"], 0)

    def test_total_errors_are_not_far_above_those_of_noise(self):
        clean, noise = self.summary("clean_white")["z"], self.summary("exact_white")["z"]
        for name, most in LARGEST_RATIO.items():
            self.assertLess(clean[name]["relative_error"], most * noise[name]["relative_error"], name)


if __name__ == "__main__":
    TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
