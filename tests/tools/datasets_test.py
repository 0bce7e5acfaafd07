#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the recordings in datasets/ match their script and the user guide: datasets_test.py PATH_OF_simulate_pendulum."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import swing

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATASETS = ROOT / "datasets"
RECORDINGS = ["coulomb", "textbook_rig", "to_rest"]
FOREIGN = ["excel_export.csv", "excel_export_truth.json", "potentiometer_calibration.json", "serial_monitor.txt",
           "serial_monitor_truth.json",
           *(f"runs_{run}{end}" for run in range(1, 5) for end in (".csv", "_truth.json"))]  # made by the script only
BINARY = pathlib.Path()


def samples(name):
    """Times and values of a recording in datasets/."""
    lines = (DATASETS / f"{name}.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")][1:]
    return [float(row[0]) for row in rows], [float(row[1]) for row in rows]


class DatasetsTest(unittest.TestCase):
    def check_reproduced(self, folder, foreign):
        names = sorted(path.name for path in pathlib.Path(folder).iterdir())
        ours = [f"{name}{end}" for name in RECORDINGS for end in (".csv", "_truth.json")]
        self.assertEqual(names, sorted(ours + foreign))
        for name in names:
            self.assertEqual((pathlib.Path(folder) / name).read_bytes(), (DATASETS / name).read_bytes(), name)

    def test_script_reproduces_the_recordings_byte_for_byte(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([ROOT / "scripts/make_datasets", BINARY.parent, folder], check=True)
            self.check_reproduced(folder, FOREIGN)

    def test_script_refuses_a_third_argument(self):
        done = subprocess.run([ROOT / "scripts/make_datasets", "a", "b", "c"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("too many arguments", done.stderr)

    def test_the_guide_describes_every_file(self):
        guide = (ROOT / "src/docs/examples.md").read_text()
        for path in DATASETS.iterdir():
            if path.suffix != ".md":
                known = "*_truth.json" if path.name.endswith("_truth.json") else path.name
                self.assertIn(f"`{known}`", guide)

    def test_foreign_files_have_their_typical_formats(self):
        excel = (DATASETS / "excel_export.csv").read_bytes()
        self.assertTrue(excel.startswith(b"\xef\xbb\xbfTime (s);Angle (deg)\r\n0;"))
        self.assertEqual(excel.count(b"\n"), excel.count(b"\r\n"))
        self.assertNotIn(b".", excel)
        paste = (DATASETS / "serial_monitor.txt").read_text().splitlines()
        for line in paste[1:]:
            self.assertRegex(line, r"\A14:01:\d\d\.\d{3} -> \d+,\d{1,4}\Z")
        self.assertNotIn("->", paste[0])

    def fit(self, *flags):
        """The result of fit_pendulum with these flags, in datasets/."""
        tool = BINARY.parent / "fit_pendulum"
        if not tool.exists():
            self.skipTest("fit_pendulum is not built")
        run = subprocess.run([tool, *flags, "--json", "-"], cwd=DATASETS, check=True,
                             capture_output=True, text=True)
        return json.loads(run.stdout)

    def check_fit(self, result, name, parameters):
        truth = json.loads((DATASETS / f"{name}_truth.json").read_text())
        for parameter in parameters:
            found = swing.parameters_of(result)[parameter]
            self.assertLess(abs(found["estimate"] - truth[parameter]), 4 * found["std_error"], parameter)

    def test_foreign_files_are_fitted(self):
        paste = self.fit("--data", "serial_monitor.txt", "--time_column", "1:us", "--unit", "counts", "--rig", "textbook_rig.json",
                         "--calibration", "potentiometer_calibration.json")
        self.check_fit(paste, "serial_monitor", ("inertia", "viscous", "coulomb", "release_angle"))
        self.assertEqual(paste["warnings"][0]["code"], "incomplete_row")
        excel = self.fit("--data", "excel_export.csv", "--model", "viscous", "--rig", "textbook_rig.json")
        self.check_fit(excel, "excel_export", ("inertia", "viscous", "release_angle"))

    def test_recording_of_the_textbook_rig_has_the_published_frequency(self):
        times, values = samples("textbook_rig")
        truth = json.loads((DATASETS / "textbook_rig_truth.json").read_text())
        level = math.degrees(truth["zero_angle"])
        falls = [i for i in range(1, len(times)) if values[i - 1] > level >= values[i]]
        period = (times[falls[-1]] - times[falls[0]]) / (len(falls) - 1)
        self.assertAlmostEqual(2 * math.pi / period, 4.8, delta=0.1)  # published: about 4.8 rad/s

    def test_to_rest_swings_at_40_s_and_rests_from_50_s_on(self):
        times, values = samples("to_rest")
        rest = [value for time, value in zip(times, values) if time >= 50]
        swing = [value for time, value in zip(times, values) if 39 <= time < 41]
        self.assertLess(max(rest) - min(rest), 10 * 0.1985)  # noise of one count: ten counts are five sigma on either side
        self.assertGreater(max(swing) - min(swing), 2 * 0.1985 * 5)


if __name__ == "__main__":
    BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
