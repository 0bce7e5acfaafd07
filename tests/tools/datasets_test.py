#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The recordings in datasets/ are what their script and their README say: datasets_test.py PATH_OF_simulate_pendulum."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATASETS = ROOT / "datasets"
RECORDINGS = ["coulomb", "textbook_rig", "to_rest"]
BINARY = pathlib.Path()


def samples(name):
    """Times and values of a recording in datasets/."""
    lines = (DATASETS / f"{name}.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")][1:]
    return [float(row[0]) for row in rows], [float(row[1]) for row in rows]


class DatasetsTest(unittest.TestCase):
    def check_reproduced(self, folder):
        names = sorted(path.name for path in pathlib.Path(folder).iterdir())
        self.assertEqual(names, sorted(f"{name}{end}" for name in RECORDINGS for end in (".csv", "_truth.json")))
        for name in names:
            self.assertEqual((pathlib.Path(folder) / name).read_bytes(), (DATASETS / name).read_bytes(), name)

    def test_script_reproduces_them_byte_for_byte(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([ROOT / "scripts/make_datasets", BINARY.parent, folder], check=True)
            self.check_reproduced(folder)

    def test_script_refuses_a_third_argument(self):
        done = subprocess.run([ROOT / "scripts/make_datasets", "a", "b", "c"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("too many arguments", done.stderr)

    def test_commands_of_the_readme_reproduce_them_byte_for_byte(self):
        commands = re.search(r"```sh\n(.*?)```", (DATASETS / "README.md").read_text(), re.DOTALL)[1]
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(DATASETS / "textbook_rig.json", folder)
            environment = {**os.environ, "PATH": f"{BINARY.parent}:{os.environ['PATH']}"}
            subprocess.run(["bash", "-e", "-c", commands], cwd=folder, env=environment, check=True)
            (pathlib.Path(folder) / "textbook_rig.json").unlink()
            self.check_reproduced(folder)

    def test_readme_tells_of_every_file(self):
        readme = (DATASETS / "README.md").read_text()
        for path in DATASETS.iterdir():
            if path.name != "README.md":
                known = "*_truth.json" if path.name.endswith("_truth.json") else path.name
                self.assertIn(f"`{known}`", readme)

    def test_recording_of_the_textbook_rig_has_the_published_frequency(self):
        times, values = samples("textbook_rig")
        truth = json.loads((DATASETS / "textbook_rig_truth.json").read_text())
        level = math.degrees(truth["zero_angle"])
        falls = [i for i in range(1, len(times)) if values[i - 1] > level >= values[i]]
        period = (times[falls[-1]] - times[falls[0]]) / (len(falls) - 1)
        self.assertAlmostEqual(2 * math.pi / period, 4.8, delta=0.1)  # published: about 4.8 rad/s

    def test_pendulum_of_to_rest_rests_from_50_s_on_and_swings_at_40_s(self):
        times, values = samples("to_rest")
        rest = [value for time, value in zip(times, values) if time >= 50]
        swing = [value for time, value in zip(times, values) if 39 <= time < 41]
        self.assertLess(max(rest) - min(rest), 10 * 0.1985)  # noise of one count: ten counts are five sigma either way
        self.assertGreater(max(swing) - min(swing), 2 * 0.1985 * 5)


if __name__ == "__main__":
    BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
