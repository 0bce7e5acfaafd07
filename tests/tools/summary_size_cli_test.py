# SPDX-License-Identifier: Apache-2.0
"""The report of each recording in datasets/ under each law fits on a screen: 20 lines of 80 columns, standard output and
standard error together. The lines of a comparison come on top."""

import pathlib
import subprocess
import sys
import unittest
from concurrent.futures import ThreadPoolExecutor

FIT_PENDULUM = pathlib.Path(sys.argv.pop(1)).resolve()
DATASETS = pathlib.Path(__file__).resolve().parents[2] / "datasets"
LINES, COLUMNS = 20, 80
BY_FLAGS = ["--bob_mass", "1000g", "--rod_mass", "120g", "--rod_length", "60cm"]
# With warnings and assumptions: a rig without errors and without g, a part of a swing, noise of a wrong kind.
RECORDINGS = [["coulomb.csv"], ["to_rest.csv"], ["excel_export.csv"], ["recorded.csv", "--rig", "recorded_rig.json"],
              ["recorded.csv", *BY_FLAGS], ["recorded.csv", "--to", "9"], ["to_rest.csv", "--noise", "gaussian"],
              ["serial_monitor.txt", "--calibration", "potentiometer_calibration.json", *BY_FLAGS],
              ["textbook_rig.csv", "--rig", "textbook_rig.json"], ["textbook_rig.csv", *BY_FLAGS], ["runs_1.csv,runs_2.csv,runs_3.csv,runs_4.csv"]]
LAWS = ["viscous", "coulomb", "drag", "stribeck", "asymmetric", "dahl", "load", "linear", "linear_coulomb"]


def report(arguments):
    """The lines that a person sees."""
    done = subprocess.run([FIT_PENDULUM, "--data", *arguments], cwd=DATASETS, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=300)
    return done.returncode, done.stdout.decode().splitlines()


class SummarySizeTest(unittest.TestCase):
    def check(self, commands):
        """Several recordings have a zero each, in --details."""
        with ThreadPoolExecutor(2) as pool:
            reports = list(pool.map(report, commands))
        for command, (code, lines) in zip(commands, reports):
            with self.subTest(" ".join(command)):
                self.assertIn(code, (0, 1), lines)
                self.assertLessEqual(len(lines), LINES, "\n".join(lines))
                self.assertLessEqual(max(map(len, lines)), COLUMNS, "\n".join(lines))
                self.assertTrue(code == 1 or "," in command[0] or any("zero_angle" in line for line in lines), "\n".join(lines))

    def test_each_recording_under_each_law(self):
        self.check([[*recording, "--model", law] for recording in RECORDINGS for law in LAWS])


if __name__ == "__main__":
    unittest.main()
