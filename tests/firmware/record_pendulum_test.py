#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the whole chain: simulated potentiometer, firmware, line, record_pendulum and fit_pendulum must recover the true
values. Usage: record_pendulum_test.py BUILD_FOLDER. The clock is virtual, so the recordings are the same at each run. Two
short ones are made in real time, with the shipped record_pendulum at a pseudo terminal."""

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


def tool(name, *arguments, folder="bin"):
    return subprocess.run([BUILD / folder / name, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          check=False)


def record_with(path, logger_flags, *flags, board="uno", is_real_time=False):
    """Records from a simulated board into `path`."""
    with simulated_lab.Logger(BUILD, path.parent, *SWING, *logger_flags, board=board, name=f"tty_{path.stem}",
                              is_real_time=is_real_time) as logger:
        return tool("record_pendulum", "--port", logger.port, "--out", path, *flags,
                    folder="bin" if is_real_time else "tests/virtual_clock")


def metadata(path):
    lines = [line[2:].split(": ", 1) for line in path.read_text().splitlines() if line.startswith("# ") and ": " in line]
    return dict(lines)


class Recordings(unittest.TestCase):
    """A folder for the recordings of a class of tests."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)

    def values(self, name):
        rows = [line for line in (self.folder / f"{name}.csv").read_text().splitlines() if not line.startswith("#")]
        return [tuple(map(float, row.split(","))) for row in rows[1:]]


class RecordPendulumTest(Recordings):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        (cls.folder / "calibration.json").write_text(json.dumps(CALIBRATION))
        with concurrent.futures.ThreadPoolExecutor() as executor:
            jobs = {name: executor.submit(cls.record, name, *bench) for name, bench in BENCHES.items()}
            jobs["damaged"] = executor.submit(record_with, cls.folder / "damaged.csv", ["--flip", 5e-4, "--drop", 5e-4],
                                              "--rate_hz", 1000, "--seconds", 30)
            jobs["boot"] = executor.submit(record_with, cls.folder / "boot.csv", ["--boot_seconds", 1.8], "--seconds", 2)
            cls.done = {name: job.result() for name, job in jobs.items()}

    @classmethod
    def record(cls, name, board, rate, oversample, ppm, noise, nonlinearity):
        return record_with(
            cls.folder / f"{name}.csv",
            ["--clock_ppm", ppm, "--noise", noise, "--nonlinearity", nonlinearity, "--seed", 5],
            "--rate_hz", rate, "--oversample", oversample, "--seconds", SECONDS, "--calibration",
            cls.folder / "calibration.json", board=board)

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
                self.assertLess(error, 35e-6)  # 30e-6 is the host's
                self.assertLess(abs(scale - 1 / (1 + 1e-6 * ppm)), 4 * error)

    def test_the_fit_recovers_the_true_values(self):
        for name in BENCHES:
            with self.subTest(name):
                done = tool("fit_pendulum", "--data", self.folder / f"{name}.csv", "--rig", RIG, "--json", "-")
                self.assertEqual(done.returncode, 0, done.stderr)
                result = json.loads(done.stdout)
                parameters = {**result["fits"][0]["parameters"], **result["recordings"][0]["fits"][0]["parameters"]}
                self.assertGreater(parameters["inertia"]["systematic_std_error"], 0)  # from the clock
                for parameter, true in TRUTH.items():
                    found = parameters[parameter]
                    error = math.hypot(found["std_error"], found["systematic_std_error"] or 0)
                    z = (found["estimate"] - true) / error
                    print(f"{name}: {parameter} {found['estimate']:.6g} ± {error:.2g}, z {z:.2f}")
                    self.assertLess(abs(z), 4, f"{parameter} {found}")

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


class RealTimeTest(Recordings):
    """Recordings that need no more from the computer than that neither program is stalled for 3 s, when the recorder
    takes the logger for lost."""

    def test_a_recording_is_complete(self):
        # The boot loader is busy for longer than the half second after which the recorder repeats its commands.
        done = record_with(self.folder / "run.csv", ["--boot_seconds", 0.7], "--seconds", 2, is_real_time=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([time for time, _ in self.values("run")], [i / 200 for i in range(400)])
        self.assertEqual(metadata(self.folder / "run.csv")["lost_samples"], "0")

    def test_a_pulled_cable_loses_no_received_samples(self):
        done = record_with(self.folder / "unplugged.csv", ["--unplug_after", 2], "--seconds", 3600, is_real_time=True)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("check the cable", done.stdout)
        # Unplugged after 2 s of sampling; a frame of 8 samples may have been in transit.
        self.assertGreaterEqual(len(self.values("unplugged")), 400 - 2 * 8)
        self.assertFalse((self.folder / "unplugged.csv.part").exists())


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
