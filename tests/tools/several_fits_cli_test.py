#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum on several recordings, and on one with several releases: each fit is that of its own run.

  several_fits_cli_test.py PATH/TO/fit_pendulum
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line


def two_releases():
    """Held and released, taken back by hand within 2 s, held and released once more."""
    noise = random.Random(22)
    released = [angle for _, angle, _ in swing.swing(10.0)]
    end = released[-1]
    back = [end + (released[0] - end) * s * s * (3 - 2 * s) for s in (k / 200 for k in range(1, 200))]
    lines = ["time_s,angle_deg"]
    for k, angle in enumerate(released + back + released):
        lines.append(f"{k / 100:.3f},{math.degrees(angle + noise.gauss(0, 0.002)):.5f}")
    return "\n".join(lines) + "\n"


class SeveralFits(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("a.csv", swing.angle_csv())
        self.write("b.csv", swing.angle_csv(sigma=0.002, truth=dict(swing.TRUTH, coulomb=0.006)))
        self.write("two.csv", two_releases())

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.folder / name).read_bytes()

    def names(self):
        return {path.name for path in self.folder.iterdir()}

    def run_tool(self, *flags):
        return subprocess.run([TOOL, *flags], cwd=self.folder, capture_output=True, text=True, encoding="utf-8",
                              timeout=60, check=False)

    def fit(self, *flags):
        run = self.run_tool(*flags)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def assert_refused(self, code, sentence, *flags):
        """The tool stops with the code and that sentence, and no file is new."""
        before = self.names()
        run = self.run_tool(*flags)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr, f"fit_pendulum: {sentence}\n")
        self.assertEqual(self.names(), before)

    def assert_numbered_as_single(self, *flags):
        """Runs with flags that name a.csv and b.csv; the numbered outputs are those of the single runs."""
        for name in "ab":
            self.fit("--data", f"{name}.csv", "--json", f"{name}.json", "--residuals", f"{name}_residuals.csv")
        before = self.names()
        run = self.fit(*flags, "--json", "fit.json", "--residuals", "r.csv")
        self.assertEqual(self.names() - before, {"fit_001.json", "fit_002.json", "r_001.csv", "r_002.csv"})
        for number, name in ((1, "a"), (2, "b")):
            self.assertEqual(self.read(f"fit_00{number}.json"), self.read(f"{name}.json"))
            self.assertEqual(self.read(f"r_00{number}.csv"), self.read(f"{name}_residuals.csv"))
            self.assertEqual(json.loads(self.read(f"fit_00{number}.json"))["data"]["path"], f"{name}.csv")
            self.assertIn(f"{name}.csv", run.stdout)

    def test_recordings_between_commas(self):
        self.assert_numbered_as_single("--data", "a.csv,b.csv")

    def test_recordings_of_a_list(self):
        self.write("list.txt", "# two\na.csv\n\nb.csv\n")
        self.assert_numbered_as_single("--data_list", "list.txt")

    def test_one_recording_of_a_list_is_not_numbered(self):
        self.write("list.txt", "a.csv\n")
        self.fit("--data_list", "list.txt", "--json", "fit.json")
        self.assertIn("fit.json", self.names())

    def test_all_releases(self):
        self.fit("--data", "two.csv", "--release", "all", "--json", "fit.json")
        starts = []
        for number in (1, 2):
            self.fit("--data", "two.csv", "--release", str(number), "--json", "one.json")
            self.assertEqual(self.read(f"fit_00{number}.json"), self.read("one.json"))
            parameters = json.loads(self.read("one.json"))["fits"][0]["parameters"]
            starts.append(parameters["release_time"]["estimate"])
        self.assertAlmostEqual(starts[0], 1.9, delta=0.02)
        self.assertAlmostEqual(starts[1], 13.9, delta=0.02)  # 10.00 s, 1.99 s by hand, 1.9 s held, and a sample each
        self.assertNotIn("fit_003.json", self.names())

    def test_a_release_that_there_is_not(self):
        self.assert_refused(2, "there is no free swing 3 in the recording; it has 2", "--data", "two.csv", "--release",
                            "3", "--json", "fit.json")

    def test_several_fits_have_no_place_on_one_stream(self):
        sentence = " - takes one fit, and there are 2; name a file, and they are numbered"
        self.assert_refused(2, "--json" + sentence, "--data", "a.csv,b.csv", "--json", "-")
        self.assert_refused(2, "--residuals" + sentence, "--data", "two.csv", "--release", "all", "--json", "fit.json",
                            "--residuals", "-")

    def test_nothing_is_written_when_one_recording_is_refused(self):
        self.write("flat.csv", "time_s,angle_deg\n" + "".join(f"{k / 100:.2f},3.0\n" for k in range(500)))
        self.assert_refused(5, "flat.csv: the reading is constant: there is no swing in it; check the sensor, or choose "
                            "another column", "--data", "a.csv,flat.csv", "--json", "fit.json")
        before = self.names()
        self.assertEqual(self.run_tool("--data", "a.csv,nowhere.csv", "--json", "fit.json").returncode, 3)
        self.assertEqual(self.names(), before)

    def test_nothing_is_written_over_an_input(self):
        self.write("fit_002.json", swing.angle_csv())
        before = self.read("fit_002.json")
        self.assert_refused(2, "--json fit_002.json would overwrite the input of --data", "--data", "a.csv,fit_002.json",
                            "--json", "fit.json")
        self.assertEqual(self.read("fit_002.json"), before)


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
