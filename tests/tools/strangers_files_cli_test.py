# SPDX-License-Identifier: Apache-2.0
"""Files as strangers have them, each fitted with its name alone; a few need the column that only a person knows.

PENDULUM_RECORDINGS names the folder of the recordings; the files lie in the folder `cases` beside it. Without it the test
is skipped. The files were simulated, so the true values are known: they must lie within 4 standard errors, statistical and
systematic together, and what was assumed must be said.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from typing import NamedTuple

FIT_PENDULUM = pathlib.Path(sys.argv.pop(1)).resolve()
MOST = 4  # standard errors
USUAL = {"gravity_over_inertia": 24.0, "viscous_over_inertia": 0.050, "coulomb_over_inertia": 0.120}


class Case(NamedTuple):
    """A file, the flags that only a person knows, the true values, and the warnings that say what was assumed."""

    file: str
    flags: tuple[str, ...] = ()
    truth: dict[str, float] = USUAL
    warnings: tuple[str, ...] = ()


CASES = [
    Case("time_header/t_symbol.csv"),
    Case("time_header/time.csv", warnings=("time_unit_assumed",)),
    Case("time_header/Time_ms.csv", warnings=("time_unit_assumed",)),
    Case("time_header/elapsed.csv"),
    Case("spreadsheets/phyphox.xls"),
    Case("spreadsheets/phyphox.xlsx"),
    Case("preambles/cassy.txt"),
    Case("preambles/labview.lvm", warnings=("time_unit_assumed",)),
    Case("rule_or_unit_row/dashes.txt"),
    Case("wall_clock/hms.csv", warnings=("times_of_day",)),
    Case("wall_clock/iso.csv", warnings=("times_of_day",)),
    Case("volts_in_brackets/datastudio.txt", ("--calibration", "volts_in_brackets/calibration.json")),
    Case("usb_bursts/run.csv", warnings=("time_bursts",)),
    Case("three_digit_times/run.csv", warnings=("time_rounded",)),
    Case("side_by_side_runs/runs.csv", ("--time_column", "t1_s:s", "--value_column", "theta1_deg")),
    Case("side_by_side_runs/runs.csv", ("--value_column", "theta2_deg")),
    Case("three_axes/run.csv", warnings=("value_column_assumed",)),
    Case("phyphox_state/run.phyphox"),
    Case("slow_phone_acceleration/run.csv", ("--value_column", "Linear Acceleration y (m/s^2)"),
         {"gravity_over_inertia": 27.75, "viscous_over_inertia": 0.115}),
    Case("slow_phone_acceleration/run.csv", (), {"gravity_over_inertia": 27.75, "viscous_over_inertia": 0.115},
         ("value_column_assumed",)),
    Case("string_wobble/run.csv", (),
         {"gravity_over_inertia": 24.60, "viscous_over_inertia": 0.010, "coulomb_over_inertia": 0.10}),
    Case("slow_torsion_balance/run.csv", ("--value_column", "spot_mm", "--model", "linear"),
         {"small_angle_period": 516}),
    Case("torsion_dry_friction/run.csv", (),
         {"gravity_over_inertia": 12.33, "viscous_over_inertia": 0.016, "coulomb_over_inertia": 0.030},
         ("linear_restoring_torque",)),
]


def standard_error(value: dict) -> float:
    """Statistical and systematic error of a value together."""
    return math.hypot(value["std_error"], value.get("systematic_std_error") or 0)


@unittest.skipUnless(os.environ.get("PENDULUM_RECORDINGS"), "PENDULUM_RECORDINGS names no folder")
class StrangersFilesTest(unittest.TestCase):
    """Each case is a subtest; -v prints the table."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.cases = pathlib.Path(os.environ["PENDULUM_RECORDINGS"]).resolve().parent / "cases"

    def fit(self, case: Case) -> dict:
        """The result of fit_pendulum, which must exit with 0."""
        out = self.folder / "fit.json"
        command = [FIT_PENDULUM, "--data", case.file, *case.flags, "--json", out]
        done = subprocess.run(command, cwd=self.cases, capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(out.read_text(encoding="utf-8"))

    def test_every_file_gives_the_true_values(self):
        for case in CASES:
            with self.subTest(file=case.file, flags=case.flags):
                result = self.fit(case)
                derived = result["fits"][0]["derived"]
                codes = [warning["code"] for warning in result["warnings"]]
                for name, true in case.truth.items():
                    value = derived[name]
                    z = (value["estimate"] - true) / standard_error(value)
                    print(f"{case.file:36} {name:22} {value['estimate']:.6g} ± {standard_error(value):.2g}  z {z:+.1f}")
                    self.assertLess(abs(z), MOST, f"{name} is {value['estimate']}, not {true}")
                for code in case.warnings:
                    self.assertIn(code, codes)

    def test_the_window_that_a_person_chooses_is_found(self):
        windows = [("junk", ("--model", "viscous"), ("--from", "3")), ("hold", (), ("--from", "0")),
                   ("tail", (), ("--to", "15"))]
        for name, flags, window in windows:
            with self.subTest(file=name):
                file = f"window/{name}.csv"
                found = self.fit(Case(file, flags))["fits"][0]["derived"]
                given = self.fit(Case(file, (*flags, *window)))["fits"][0]["derived"]
                for key in ("gravity_over_inertia", "viscous_over_inertia"):
                    difference = found[key]["estimate"] - given[key]["estimate"]
                    print(f"{file:36} {key:22} {found[key]['estimate']:.6g}, with {' '.join(window)} "
                          f"{given[key]['estimate']:.6g} ± {standard_error(given[key]):.2g}")
                    self.assertLess(abs(difference), MOST * math.hypot(standard_error(given[key]),
                                                                       standard_error(found[key])))

    def test_the_large_swings_are_kept_and_presliding_is_named(self):
        result = self.fit(Case("window/presliding_gyro.csv"))
        begin, end = result["recordings"][0]["window_s"]
        self.assertLess(begin, 0.5)
        self.assertLess(end, 7)
        self.assertIn("presliding", [warning["code"] for warning in result["warnings"]])

    def test_two_runs_beside_each_other_are_named(self):
        command = [FIT_PENDULUM, "--data", "side_by_side_runs/runs.csv"]
        done = subprocess.run(command, cwd=self.cases, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn('"theta1_deg" and "theta2_deg"', done.stderr)


if __name__ == "__main__":
    unittest.main()
