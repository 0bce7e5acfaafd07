# SPDX-License-Identifier: Apache-2.0
"""Recordings from other sources, each fitted with no flag but --model, as by a user without further knowledge.

PENDULUM_RECORDINGS names their folder; without it the test is skipped. The expected values are fits by an independent
program in windows chosen by a person (Runge-Kutta, tanh for the sign of the rate, SciPy least squares), and published
values. The residuals are compared where both windows overlap. Prints the table with -v.
"""

import csv
import functools
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from typing import NamedTuple, Optional

FIT_PENDULUM = pathlib.Path(sys.argv.pop(1)).resolve()
END = math.inf


class Reference(NamedTuple):
    """An independent fit: window [s], then G / I [1/s^2] and rms residual [rad or rad/s] of two models."""

    start: float
    end: float
    coulomb: tuple[float, float]
    drag: tuple[float, float]
    published: Optional[float] = None  # G / I


REFERENCES = {
    "bookip_adip": Reference(4, 115, (40.273, 0.00806), (40.291, 0.00235), 40.304),
    "cubli_PRINT_00": Reference(2, 12, (88.625, 0.0165), (88.625, 0.0165)),
    "cubli_PRINT_01": Reference(3.2, 12.5, (88.782, 0.0165), (88.783, 0.0165)),
    "davidw_wood": Reference(0.3, END, (29.534, 0.0117), (29.524, 0.011)),
    "ferrucci_1525": Reference(0.3, END, (21.471, 0.014), (21.468, 0.0023), 21.419),
    "ganesh_gyro": Reference(30, END, (22.055, 0.0317), (22.055, 0.0317), 22.145),
    "hasi_newpend": Reference(3, 150, (14.001, 0.01), (14.001, 0.01)),
    "jensen_01": Reference(1, END, (120.26, 0.00595), (120.26, 0.00595)),
    "jensen_03": Reference(0.4, END, (120.41, 0.00379), (120.41, 0.00379)),
    "jiarui_8047": Reference(0.3, END, (6.7736, 0.0028), (6.773, 0.000952), 6.7355),
    "jiarui_8053": Reference(0.3, END, (13.06, 0.00234), (13.059, 0.00104), 12.935),
    "macstepien_osc": Reference(1, 28, (87.209, 0.0043), (87.211, 0.0043)),
    "multiarm_freeswing1": Reference(0.4, 5.6, (65.302, 0.00107), (65.302, 0.00107)),
    "nielsskov_pend1": Reference(3, 68, (30.777, 0.0157), (30.858, 0.00259), 30.986),
    "pendulepi_A": Reference(0, END, (21.573, 0.0558), (21.771, 0.00358), 21.759),
    "sonyneto_0312": Reference(1, END, (53.413, 0.0289), (53.41, 0.0287)),
    "stienen_Ea45": Reference(1.75, 28.5, (10.716, 0.00476), (10.716, 0.00476)),
    "stienen_Ef_R01": Reference(1.5, 14.5, (10.884, 0.00335), (10.884, 0.00335)),
    "tylertian_lab1": Reference(0.3, END, (14.796, 0.0151), (14.787, 0.00804)),
    "yfysiks_data2_25": Reference(10, END, (43.635, 0.00643), (43.634, 0.00641)),
    "yfysiks_data32": Reference(11.5, END, (37.166, 0.0162), (37.222, 0.00592)),
}

# Two recordings of the same rig each.
PAIRS = [("stienen_Ea45", "stienen_Ef_R01"), ("cubli_PRINT_00", "cubli_PRINT_01"), ("jensen_01", "jensen_03")]

# The potentiometer's line as published by its owners: angle = (V - 0.6945) 1.5769 / (0.9513 - 0.4708) rad.
SLOPE = 1.5769 / (0.9513 - 0.4708)
CALIBRATION = {"schema_version": 1, "input": "volts", "angle_unit": "rad", "coefficients": [-0.6945 * SLOPE, SLOPE]}


class Fit(NamedTuple):
    """The outcome of a run: the first fit of its result, its window, and its rms over the reference's window."""

    exit_code: int
    result: dict
    rms: float

    @property
    def gravity_over_inertia(self) -> float:
        return 1 / self.result["fits"][0]["parameters"]["inertia"]["estimate"]


def inertia_of(result: dict) -> tuple[float, float]:
    """Estimate, and the combined standard and systematic error."""
    inertia = result["fits"][0]["parameters"]["inertia"]
    return inertia["estimate"], math.hypot(inertia["std_error"], inertia["systematic_std_error"] or 0)


def inertia_of_run(result: dict) -> tuple[float, float]:
    """Estimate, and the part of its error that another run of the same rig, sensor and clock does not have."""
    inertia = result["fits"][0]["parameters"]["inertia"]
    budget = inertia["error_budget"]
    return inertia["estimate"], math.hypot(*(budget.get(source, 0) for source in ("noise", "inconstancy", "friction_law")))


def scatter_of_windows(result: dict) -> float:
    """rms difference between windows of the recording and the whole, over the combined errors; 0 without windows."""
    estimate, error = inertia_of(result)
    constancy = result["recordings"][0]["fits"][0]["constancy"]
    windows = ((constancy or {}).get("amplitude") or {}).get("windows", [])
    squares = [(w["inertia"] - estimate) ** 2 / (error**2 + w["inertia_std_error"] ** 2) for w in windows]
    return math.sqrt(sum(squares) / len(squares)) if squares else 0


def rms_between(path: pathlib.Path, start: float, end: float) -> float:
    """rms of the residuals whose times lie in [start, end]."""
    with path.open(encoding="utf-8") as file:
        rows = csv.DictReader(file)
        column = next(name for name in rows.fieldnames if name.startswith("residual"))
        squares = [float(row[column]) ** 2 for row in rows if start <= float(row["time_s"]) <= end]
    return math.sqrt(sum(squares) / len(squares))


@functools.cache
def fit(name: str, model: str) -> Fit:
    """Fits a recording; repeated calls return the stored result."""
    recording = pathlib.Path(os.environ["PENDULUM_RECORDINGS"]) / (name + ".csv")
    with tempfile.TemporaryDirectory() as folder:
        return fit_in(pathlib.Path(folder), recording, model, REFERENCES[name])


def fit_in(folder: pathlib.Path, recording: pathlib.Path, model: str, reference: Reference) -> Fit:
    command = [FIT_PENDULUM, "--data", recording, "--model", model]
    command += ["--json", folder / "fit.json", "--residuals", folder / "residuals.csv"]
    if recording.name.startswith("cubli"):
        (folder / "calibration.json").write_text(json.dumps(CALIBRATION))
        command += ["--calibration", folder / "calibration.json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if not (folder / "fit.json").exists():
        raise AssertionError(f"{recording.name}: exit code {done.returncode}: {done.stderr}")
    rms = rms_between(folder / "residuals.csv", reference.start, reference.end)
    return Fit(done.returncode, json.loads((folder / "fit.json").read_text()), rms)


@unittest.skipUnless("PENDULUM_RECORDINGS" in os.environ, "PENDULUM_RECORDINGS is not set")
class Recordings(unittest.TestCase):
    def check(self, name: str, model: str) -> str:
        """Checks one fit; returns its row of the table."""
        reference = REFERENCES[name]
        expected, rms = getattr(reference, model)
        found = fit(name, model)
        start, end = found.result["recordings"][0]["window_s"]
        warnings = {warning["code"] for warning in found.result["warnings"]}
        self.assertEqual(found.exit_code, 0, name)
        self.assertAlmostEqual(found.gravity_over_inertia / expected, 1, delta=0.01, msg=name)
        self.assertLessEqual(found.rms, 1.1 * rms, name)
        self.assertLess(scatter_of_windows(found.result), 2, name)
        if reference.published:
            self.assertAlmostEqual(found.gravity_over_inertia / reference.published, 1, delta=0.01, msg=name)
        # The window contains most of the window chosen by a person.
        overlap = min(end, reference.end) - max(start, reference.start)
        self.assertGreater(overlap, 0.8 * (min(reference.end, end) - reference.start), name)
        percent = 100 * (found.gravity_over_inertia / expected - 1)
        return (
            f"| {name} | {model} | {start:.2f}..{end:.2f} | {found.gravity_over_inertia:.4f} | {percent:+.3f} % "
            f"| {found.rms / rms:.3f} | {', '.join(sorted(warnings))} |"
        )

    def check_all(self, model: str, names: list[str]) -> None:
        self.assertTrue(names)
        lines = []
        for name in names:
            with self.subTest(recording=name):
                lines.append(self.check(name, model))
        print("\n" + "\n".join(lines))

    def test_coulomb_finds_window_period_and_residuals_of_the_reference(self):
        # Recordings without quadratic drag have equal references for both models; for these the test of drag is enough.
        self.check_all("coulomb", [name for name, reference in REFERENCES.items() if reference.coulomb != reference.drag])

    def test_drag_finds_window_period_and_residuals_of_the_reference(self):
        self.check_all("drag", list(REFERENCES))

    def test_errors_explain_how_runs_of_one_rig_differ(self):
        for model in ("viscous", "coulomb", "drag"):
            z = []
            for pair in PAIRS:
                (first, first_error), (second, second_error) = (inertia_of_run(fit(name, model).result) for name in pair)
                z.append((first - second) / math.hypot(first_error, second_error))
                self.assertLess(abs(z[-1]), 3, (model, pair))
            self.assertLess(sum(each**2 for each in z), 12.84, model)  # p 0.005 of chi-square with 3 degrees of freedom


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
