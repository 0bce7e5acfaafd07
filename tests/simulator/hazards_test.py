#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits a few simulated recordings of some rows of the table of hazards: hazards_test.py PATH/TO/fit_pendulum.

hazard_table.py runs all rows with more recordings. Needs python3-scipy.
"""

import pathlib
import sys
import unittest

from hazard_table import FIRST_SEED, run
from row_summary import LEAST_JUDGED, summarize
from scenarios import ROWS

TOOL = pathlib.Path()  # from the command line
RECORDINGS = 3
# Rows whose recordings must not be silently wrong. Add a row when the tool names its cause or has it in its budget.
HANDLED = ("clean_10_bits", "clean_ar_0.9", "clean_gyro", "gain_1", "lag_20", "mean_16_quiet", "drift_linear", "clock_header",
           "push", "hold_angle", "drag_unseen", "presliding_dahl", "load")
# Rows in which nothing is wrong: no suspicion may be named.
CLEAN = ("clean_10_bits", "clean_14_bits")


class HazardsTest(unittest.TestCase):
    def summary(self, name):
        return summarize(ROWS[name], [run(TOOL, name, FIRST_SEED + index) for index in range(RECORDINGS)])

    def test_handled_rows_are_not_silently_wrong(self):
        for name in HANDLED:
            with self.subTest(name):
                found = self.summary(name)
                self.assertEqual(found["silent"], 0, found)
                self.assertEqual(found["failed"], 0, found)
                self.assertGreaterEqual(found["judged"], LEAST_JUDGED * found["expected"], found)

    def test_clean_rows_name_no_cause(self):
        for name in CLEAN:
            with self.subTest(name):
                self.assertEqual(self.summary(name)["causes"], {})


if __name__ == "__main__":
    TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
