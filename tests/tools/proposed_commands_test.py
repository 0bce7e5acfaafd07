#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Follows the commands that refusals propose. Each leads to the true values or to the next question.

  proposed_commands_test.py PATH/TO/fit_pendulum
"""

import json
import math
import pathlib
import random
import shlex
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line
MOST_QUESTIONS = 4
PER_TORQUE = {name: swing.TRUTH[name] / swing.GRAVITY_TORQUE for name in ("inertia", "viscous", "coulomb")}  # s^2, s, 1
SAMPLES = swing.swing(rate_hz=50, duration=20.0)  # time [s], angle [rad], rate [rad/s]
NOISE = random.Random(30)


def rows(columns, separator=","):
    """The rows of a file; `columns` gives the texts of time, angle and rate with noise."""
    lines = []
    for time, angle, rate in SAMPLES:
        lines.append(separator.join(columns(time, angle + NOISE.gauss(0, 0.002), rate + NOISE.gauss(0, 0.01))))
    return "\n".join(lines) + "\n"


def degrees(angle):
    return f"{math.degrees(angle):.4f}"


def along_and_across(angle, rate, radius=0.3, gravity=9.81):
    """Acceleration with gravity [m/s^2] along the rod, outwards, and across it, of a sensor at `radius` [m]."""
    friction = PER_TORQUE["viscous"] * rate + PER_TORQUE["coulomb"] * math.copysign(1, rate) * (abs(rate) > 0.05)
    acceleration = -(math.sin(angle) + friction) / PER_TORQUE["inertia"]
    return (-radius * rate**2 - gravity * math.cos(angle) + NOISE.gauss(0, 0.02),
            radius * acceleration + gravity * math.sin(angle) + NOISE.gauss(0, 0.02))


def accelerations(header, scale, digits):
    """A file of time [s], acceleration along the rod and across it; the factor converts m/s^2."""
    def columns(time, angle, rate):
        return (f"{time:.2f}", *(f"{scale * each:.{digits}f}" for each in along_and_across(angle, rate)), "0.0")
    return header + rows(columns)


def torsion_balance(step):
    """Readings in mm of a balance with a period of 215 s and a decay time of 600 s; whole seconds without a unit."""
    lines = ["t,spot_mm"]
    for k in range(200):
        angle = 80 * math.exp(-k * step / 600) * math.cos(2 * math.pi * k * step / 215)
        lines.append(f"{k * step},{250 + angle + NOISE.gauss(0, 0.5):.1f}")
    return "\n".join(lines) + "\n"


class ProposedCommandsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def follow(self, text, *flags):
        """Fits the text and follows the proposals. Returns the last run, its JSON if it has an answer, and the proposals."""
        (self.folder / "run.csv").write_text(text, encoding="utf-8")
        command, proposals = [TOOL, "--data", "run.csv", *flags], []
        while True:
            run = subprocess.run([*command, "--json", "fit.json"], cwd=self.folder, stdin=subprocess.DEVNULL,
                                 capture_output=True, text=True, encoding="utf-8", timeout=120, check=False)
            last = run.stderr.splitlines()[-1] if run.stderr else ""
            if run.returncode in (0, 1) or not last.startswith("try: "):
                break
            command = shlex.split(last.removeprefix("try: "))
            command = [part for part in command if part not in ("--json", "fit.json")]
            proposals.append(shlex.join(command))
            self.assertLessEqual(len(proposals), MOST_QUESTIONS, proposals)
        result = json.loads((self.folder / "fit.json").read_text(encoding="utf-8")) if run.returncode == 0 else None
        return run, result, proposals

    def assert_true(self, result, proposals, truth):
        parameters = swing.parameters_of(result)
        for name, value in truth.items():
            found = parameters[name]
            error = found["total_std_error"] or max(abs(bound - found["estimate"]) for bound in found["interval95"]) / 2
            self.assertLess(abs(found["estimate"] - value), 4 * error, (name, found, proposals))

    def assert_leads_to_the_truth(self, text, *flags, truth=None):
        run, result, proposals = self.follow(text, *flags)
        self.assertEqual(run.returncode, 0, (proposals, run.stderr))
        self.assert_true(result, proposals, truth or PER_TORQUE)

    def test_angle_without_a_unit(self):
        self.assert_leads_to_the_truth("time_s,pm\n" + rows(lambda t, a, r: (f"{t:.2f}", f"{a:.5f}")))

    def test_gyro_axes_without_a_unit(self):
        self.assert_leads_to_the_truth("time,x,y,z\n" + rows(
            lambda t, a, r: (f"{t:.2f}", f"{0.001 * r:.5f}", f"{0.894 * r:.5f}", f"{0.447 * r:.5f}")))

    def test_points_without_names(self):
        """Millimetres from the pivot, downwards and sideways."""
        self.assert_leads_to_the_truth(rows(
            lambda t, a, r: (f"{t:.3f}", f"{430 * math.sin(a):.2f}", f"{-430 * math.cos(a):.2f}"), "\t"))

    def test_accelerations_without_a_unit(self):
        truth = {"inertia": PER_TORQUE["inertia"]}
        for header, scale, digits in (("timestamp,ax,ay,az\n", 1, 3), ("t,ax,ay,az\n", 1 / 9.80665, 4),
                                      ("", 1000 / 9.80665, 0)):
            with self.subTest(header=header, scale=scale):
                self.assert_leads_to_the_truth(accelerations(header, scale, digits), truth=truth)

    def test_slow_balance_in_whole_seconds(self):
        inertia = 1 / ((2 * math.pi / 215)**2 + 1 / 600**2)
        self.assert_leads_to_the_truth(torsion_balance(10), truth={"inertia": inertia, "viscous": 2 * inertia / 600})

    def test_runs_beside_each_other(self):
        self.assert_leads_to_the_truth("Time (s) Run #1,Angle (deg) Run #1,Time (s) Run #2,Angle (deg) Run #2\n" + rows(
            lambda t, a, r: (f"{t:.2f}", degrees(a), f"{t:.2f}", degrees(-0.9 * a))))

    def test_drive_from_rest_before_the_free_swing(self):
        lines = ["time_s,angle_deg"]
        for k in range(6000):
            t = 0.02 * k
            amplitude = 1.5 * (1 - math.exp(-0.06 * min(t, 60))) * math.exp(-0.06 * max(t - 60, 0))
            lines.append(f"{t:.2f},{math.degrees(amplitude * math.cos(5 * t)) + NOISE.gauss(0, 0.3):.2f}")
        inertia = 1 / (25 + 0.06**2)
        self.assert_leads_to_the_truth("\n".join(lines) + "\n", "--gravity", "linear",
                                       truth={"inertia": inertia, "viscous": 0.12 * inertia})

    def test_nothing_is_proposed_that_nobody_can_know(self):
        """The rate of rows without times, and what passages of a gate or light do not hold."""
        for text in ("angle_deg\n" + rows(lambda t, a, r: (degrees(a),)),
                     rows(lambda t, a, r: (degrees(a),)),
                     "\n".join(str(6000 + 803 * k + k % 2 * 14) for k in range(60)) + "\n"):
            run, _, proposals = self.follow(text)
            self.assertEqual((run.returncode, proposals), (4, []), run.stderr)
        run, _, proposals = self.follow("time_s,light\n" + rows(lambda t, a, r: (f"{t:.2f}", f"{512 + 300 * a:.0f}")))
        self.assertNotIn("--unit deg", " ".join(proposals), run.stderr)


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
