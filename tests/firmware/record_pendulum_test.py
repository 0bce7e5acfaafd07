#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the whole chain in real time: simulated potentiometer, firmware, line, record_pendulum and fit_pendulum must
recover the true values. Usage: record_pendulum_test.py BUILD_FOLDER. All recordings run in parallel, because they
mostly wait."""

import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import simulated_lab

TOP = pathlib.Path(__file__).resolve().parents[2]
RIG = TOP / "datasets/textbook_rig.json"
BUILD = pathlib.Path()
SECONDS = 65
TRUTH = {"inertia": 0.079, "viscous": 0.002, "coulomb": 0.004, "release_angle": 0.5}
SWING = ["--rig", RIG, "--set", "inertia=0.079,viscous=0.002,coulomb=0.004,release_angle=0.5,release_time=1.5"]
DEG_PER_COUNT = 270 / 1024
CALIBRATION = {"input": "counts", "angle_unit": "deg", "input_range": [0, 1023],
               "coefficients": [0.5 * DEG_PER_COUNT - 135, DEG_PER_COUNT]}
# Board, samples per second, conversions per sample, clock error [ppm, positive: too fast], noise [counts], nonlinearity
# [counts].
BENCHES = {
    "uno_200": ("uno", 200, 1, 3000, 0.5, 0.5),
    "uno_1000": ("uno", 1000, 1, -1500, 0.5, 0.25),
    "mega_200": ("mega", 200, 1, 0, 0.7, 0.0),
    "mega_1000": ("mega", 1000, 1, 2000, 0.6, 0.25),
    "uno_200_mean_of_16": ("uno", 200, 16, -4000, 1.0, 0.0),
}


def tool(name, *arguments, **options):
    return subprocess.run([BUILD / "bin" / name, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          check=False, **options)


def metadata(path):
    lines = [line[2:].split(": ", 1) for line in path.read_text().splitlines() if line.startswith("# ") and ": " in line]
    return dict(lines)


class RecordPendulumTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        (cls.folder / "calibration.json").write_text(json.dumps(CALIBRATION))
        cls.record_all()
        if not cls.is_quiet():
            print("the computer stalled during the recordings; recording everything again")
            cls.record_all()

    @classmethod
    def is_quiet(cls):
        """Whether the computer never stalled. The clocks are then known ten times better than this limit."""
        errors = [metadata(cls.folder / f"{name}.csv").get("clock_scale_std_dev", "1") for name in BENCHES]
        return max(map(float, errors)) < 300e-6

    @classmethod
    def record_all(cls):
        with concurrent.futures.ThreadPoolExecutor(8) as executor:
            jobs = {name: executor.submit(cls.record, name, *bench) for name, bench in BENCHES.items()}
            jobs["unplugged"] = executor.submit(cls.record_unplugged)
            jobs["damaged"] = executor.submit(cls.record_damaged)
            jobs["boot"] = executor.submit(cls.record_behind_a_boot_loader)
            cls.done = {name: job.result() for name, job in jobs.items()}

    @classmethod
    def record_with(cls, name, logger_flags, *flags, board="uno"):
        path = cls.folder / f"{name}.csv"
        with simulated_lab.Logger(BUILD, cls.folder, *SWING, *logger_flags, board=board, name=f"tty_{name}") as logger:
            return tool("record_pendulum", "--port", logger.port, "--out", path, "--overwrite", *flags)

    @classmethod
    def record(cls, name, board, rate, oversample, ppm, noise, nonlinearity):
        return cls.record_with(
            name, ["--clock_ppm", ppm, "--noise", noise, "--nonlinearity", nonlinearity, "--seed", 5],
            "--rate_hz", rate, "--oversample", oversample, "--seconds", SECONDS, "--calibration",
            cls.folder / "calibration.json", board=board)

    @classmethod
    def record_unplugged(cls):
        return cls.record_with("unplugged", ["--unplug_after", 8], "--seconds", 30)

    @classmethod
    def record_damaged(cls):
        return cls.record_with("damaged", ["--flip", 5e-4, "--drop", 5e-4], "--rate_hz", 1000, "--seconds", 30)

    @classmethod
    def record_behind_a_boot_loader(cls):
        return cls.record_with("boot", ["--boot_seconds", 1.8], "--seconds", 2)

    def values(self, name):
        rows = [line for line in (self.folder / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
        return [tuple(map(float, row.split(","))) for row in rows[1:]]

    def test_nothing_is_lost_and_times_are_exact(self):
        for name, (_, rate, *_) in BENCHES.items():
            with self.subTest(name):
                self.assertEqual(self.done[name].returncode, 0, self.done[name].stderr)
                rows = self.values(name)
                self.assertEqual(len(rows), SECONDS * rate)
                for i, (time, _) in enumerate(rows):
                    self.assertAlmostEqual(time, i / rate, delta=1e-9)
                self.assertEqual(metadata(self.folder / f"{name}.csv")["lost_samples"], "0")

    def test_the_clock_is_corrected_within_the_stated_error(self):
        for name, (_, _, _, ppm, *_) in BENCHES.items():
            with self.subTest(name):
                said = metadata(self.folder / f"{name}.csv")
                scale, error = float(said["clock_scale"]), float(said["clock_scale_std_dev"])
                self.assertLess(error, 0.003)  # measured; 35e-6 unless the machine is very busy
                self.assertLess(abs(scale - 1 / (1 + 1e-6 * ppm)), 4 * error)

    def test_the_fit_recovers_the_true_values(self):
        for name in BENCHES:
            with self.subTest(name):
                done = tool("fit_pendulum", "--data", self.folder / f"{name}.csv", "--rig", RIG, "--json", "-")
                self.assertEqual(done.returncode, 0, done.stderr)
                parameters = json.loads(done.stdout)["fits"][0]["parameters"]
                self.assertGreater(parameters["inertia"]["systematic_std_error"], 0)  # from the clock
                for parameter, true in TRUTH.items():
                    found = parameters[parameter]
                    error = math.hypot(found["std_error"], found["systematic_std_error"] or 0)
                    z = (found["estimate"] - true) / error
                    print(f"{name}: {parameter} {found['estimate']:.6g} ± {error:.2g}, z {z:.2f}")
                    self.assertLess(abs(z), 4, f"{parameter} {found}")

    def test_a_pulled_cable_loses_no_received_samples(self):
        done = self.done["unplugged"]
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("check the cable", done.stdout)
        rows = self.values("unplugged")
        # Unplugged after 8 s of sampling; a frame of 8 samples may have been in transit.
        self.assertGreaterEqual(len(rows), 1600 - 2 * 8)
        self.assertFalse((self.folder / "unplugged.csv.part").exists())

    def test_damaged_samples_are_counted_and_kept_samples_are_right(self):
        done = self.done["damaged"]
        self.assertEqual(done.returncode, 1, done.stderr)
        rows = self.values("damaged")
        lost = int(metadata(self.folder / "damaged.csv")["lost_samples"])
        self.assertGreater(lost, 0)
        self.assertEqual(len(rows) + sum(round((b[0] - a[0]) * 1000) - 1 for a, b in zip(rows, rows[1:])),
                         round(rows[-1][0] * 1000) + 1)
        # Without noise, the codes of a smooth motion never jump; a wrong code would.
        steepest = 0.5 * 4.8 / math.radians(DEG_PER_COUNT) / 1000  # counts per sample: amplitude times frequency
        for (before, a), (after, b) in zip(rows, rows[1:]):
            self.assertLessEqual(abs(b - a), steepest * (after - before) * 1000 + 2)

    def test_the_recorder_waits_for_a_boot_loader(self):
        done = self.done["boot"]
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.values("boot")), 400)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
