# SPDX-License-Identifier: Apache-2.0
"""Workbooks and saved states as phyphox makes them, simulated with a known truth.

They lie in the folder cases beside the folder that PENDULUM_RECORDINGS names; without it the test is skipped.
"""

import json
import os
import pathlib
import subprocess
import sys
import unittest

FIT_PENDULUM = pathlib.Path(sys.argv.pop(1)).resolve()
CASES = pathlib.Path(os.environ.get("PENDULUM_RECORDINGS", "/nowhere")).parent / "cases"

TRUTH = {"gravity_over_inertia": 24.0, "viscous_over_inertia": 0.050, "coulomb_over_inertia": 0.120}  # 1/s^2, 1/s, 1/s^2

# The files and their column of the axis that swings.
FILES = {
    "spreadsheets/phyphox.xlsx": "Raw Data/Gyroscope z (rad/s)",
    "spreadsheets/phyphox.xls": "Raw Data/Gyroscope z (rad/s)",
    "phyphox_state/run.phyphox": "Rotation z (rad/s)",
}


@unittest.skipUnless(CASES.is_dir(), "PENDULUM_RECORDINGS has no folder cases beside it")
class WorkbookFiles(unittest.TestCase):
    def test_the_fit_finds_the_truth(self):
        for name, column in FILES.items():
            with self.subTest(file=name):
                command = [FIT_PENDULUM, "--data", CASES / name, "--value_column", column, "--json", "-"]
                done = subprocess.run(command, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                derived = json.loads(done.stdout)["fits"][0]["derived"]
                for quantity, truth in TRUTH.items():
                    found = derived[quantity]
                    self.assertLess(abs(found["estimate"] - truth), 4 * found["std_error"], quantity)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
