#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum on several recordings, each separately (--shared none), and on one with several releases: each fit
equals the single fit of its run.

  several_fits_cli_test.py PATH/TO/fit_pendulum
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line

EACH = ("--shared", "none")
FLAT = "time_s,angle_deg\n" + "".join(f"{k / 100:.2f},3.0\n" for k in range(500))
FLAT_SENTENCE = ("flat.csv: the reading is constant, so there is no swing; check the sensor, or choose another "
                 "column")
NO_HOLD = ("the recording does not begin with a hold: the first swing shows that the release was before the first "
           "sample; use --start moving")


def without_hold(text):
    """The recording from 0.1 s after its first release on, while the pendulum falls."""
    header, *rows = text.splitlines(keepends=True)
    return header + "".join(row for row in rows if float(row.split(",")[0]) >= swing.TRUTH["release_time"] + 0.1)


class SeveralFits(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("a.csv", swing.angle_csv())
        self.write("b.csv", swing.angle_csv(sigma=0.002, truth=dict(swing.TRUTH, coulomb=0.006)))
        self.write("two.csv", swing.two_releases())

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.folder / name).read_bytes()

    def path_in(self, name):
        """The path of the recording that a result describes."""
        return json.loads(self.read(name))["recordings"][0]["path"]

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
        """Checks that the tool exits with the code, prints the sentence, and writes no file."""
        before = self.names()
        run = self.run_tool(*flags)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr, f"fit_pendulum: {sentence}\n")
        self.assertEqual(self.names(), before)

    def assert_numbered_as_single(self, *flags):
        """Runs with flags for a.csv and b.csv; the numbered outputs must equal those of the single runs."""
        for name in "ab":
            self.fit("--data", f"{name}.csv", "--json", f"{name}.json", "--residuals", f"{name}_residuals.csv")
        before = self.names()
        run = self.fit(*flags, *EACH, "--json", "fit.json", "--residuals", "r.csv")
        self.assertEqual(self.names() - before, {"fit_001.json", "fit_002.json", "r_001.csv", "r_002.csv"})
        for number, name in ((1, "a"), (2, "b")):
            self.assertEqual(self.read(f"fit_00{number}.json"), self.read(f"{name}.json"))
            self.assertEqual(self.read(f"r_00{number}.csv"), self.read(f"{name}_residuals.csv"))
            self.assertEqual(self.path_in(f"fit_00{number}.json"), f"{name}.csv")
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
            starts.append(swing.parameters_of(json.loads(self.read("one.json")))["release_time"]["estimate"])
        self.assertAlmostEqual(starts[0], 1.9, delta=0.02)
        self.assertAlmostEqual(starts[1], 13.9, delta=0.02)  # 10.00 s, 1.99 s by hand, 1.9 s of hold, one sample each
        self.assertNotIn("fit_003.json", self.names())

    def test_a_release_that_does_not_exist(self):
        self.assert_refused(2, "two.csv: there is no free swing 3 in the recording; it has 2", "--data", "two.csv", "--release",
                            "3", "--json", "fit.json")

    def test_several_fits_need_files(self):
        sentence = " - takes one fit, but there are 2; give a file name, to which the number is added"
        self.assert_refused(2, "--json" + sentence, "--data", "a.csv,b.csv", *EACH, "--json", "-")
        self.assert_refused(2, "--residuals" + sentence, "--data", "two.csv", "--release", "all", "--json", "fit.json",
                            "--residuals", "-")

    def test_standard_output_is_refused_before_any_recording_is_read(self):
        sentence = "--json - takes one fit, but there are 2; give a file name, to which the number is added"
        self.write("junk.csv", "junk\n")
        self.assert_refused(2, sentence, "--data", "junk.csv,nowhere.csv", *EACH, "--json", "-")
        self.assert_refused(2, sentence, "--data", "junk.csv,nowhere.csv", *EACH, "--release", "all", "--json",
                            "-")

    def assert_first_and_last_written(self, code, sentence, *flags):
        """Runs with flags for a.csv, a recording that cannot be fitted, and b.csv."""
        run = self.run_tool(*flags, *EACH, "--json", "fit.json", "--residuals", "r.csv")
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stderr, f"fit_pendulum: {sentence}\n")
        for name in "ab":
            number = "001" if name == "a" else "003"
            self.assertEqual(self.path_in(f"fit_{number}.json"), f"{name}.csv")
            self.assertIn(f"r_{number}.csv", self.names())
            self.assertIn(f"{name}.csv", run.stdout)
        self.assertFalse(self.names() & {"fit_002.json", "r_002.csv", "fit.json"})

    def test_a_failed_recording_does_not_change_the_numbers_of_the_others(self):
        self.write("flat.csv", FLAT)
        self.write("list.txt", "a.csv\nflat.csv\nb.csv\n")
        self.assert_first_and_last_written(5, FLAT_SENTENCE, "--data", "a.csv,flat.csv,b.csv")
        self.assert_first_and_last_written(5, FLAT_SENTENCE, "--data_list", "list.txt")
        self.assert_first_and_last_written(3, "nowhere.csv: there is no such file; check the path", "--data",
                                           "a.csv,nowhere.csv,b.csv")

    def test_a_message_names_its_recording(self):
        self.write("moving.csv", without_hold(swing.angle_csv()))
        self.assert_first_and_last_written(5, "moving.csv: " + NO_HOLD, "--data", "a.csv,moving.csv,b.csv", "--start",
                                           "release")
        self.assert_refused(5, "moving.csv: " + NO_HOLD, "--data", "moving.csv", "--start", "release", "--json", "one.json")

    def test_the_exit_code_is_the_largest(self):
        self.write("flat.csv", FLAT)
        run = self.run_tool("--data", "flat.csv,nowhere.csv,a.csv", *EACH, "--json", "fit.json")
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertEqual(len(run.stderr.splitlines()), 2)
        self.assertIn("fit_003.json", self.names())

    def test_nothing_is_written_when_none_can_be_fitted(self):
        self.write("flat.csv", FLAT)
        self.assert_refused(5, FLAT_SENTENCE, "--data", "flat.csv", "--json", "fit.json")
        self.assert_refused(5, FLAT_SENTENCE + "\nfit_pendulum: nowhere.csv: there is no such file; check the path",
                            "--data", "flat.csv,nowhere.csv", *EACH, "--json", "fit.json")

    def test_releases_of_several_recordings_are_numbered_consecutively(self):
        self.write("flat.csv", FLAT)
        run = self.run_tool("--data", "flat.csv,two.csv,a.csv", *EACH, "--release", "all", "--json", "fit.json")
        self.assertEqual(run.returncode, 5, run.stderr)
        written = {name: self.path_in(name) for name in self.names() if "fit_" in name}
        self.assertEqual(written, {"fit_002.json": "two.csv", "fit_003.json": "two.csv", "fit_004.json": "a.csv"})

    def test_a_failed_release_does_not_affect_the_other(self):
        self.write("two.csv", without_hold(swing.two_releases()))
        run = self.run_tool("--data", "two.csv", "--release", "all", "--start", "release", "--json", "fit.json")
        self.assertEqual(run.returncode, 5, run.stderr)
        self.assertEqual(run.stderr, "fit_pendulum: two.csv: free swing 1: " + NO_HOLD + "\n")
        self.assertIn("fit_002.json", self.names())
        self.assertNotIn("fit_001.json", self.names())

    def assert_kept(self, name, flag, *flags):
        """Checks that the recording of that name is refused as an output and not overwritten."""
        before = self.read(name)
        self.assert_refused(2, f"--json {name} would overwrite the input of {flag}", *flags)
        self.assertEqual(self.read(name), before)

    def test_no_output_overwrites_an_input(self):
        self.write("fit_002.json", swing.angle_csv())
        self.write("list.txt", "a.csv\nfit_002.json\n")
        self.write("one.txt", "a.csv\n")
        self.assert_kept("fit_002.json", "--data", "--data", "a.csv,fit_002.json", *EACH, "--json", "fit.json")
        self.assert_kept("fit_002.json", "--data_list", "--data_list", "list.txt", *EACH, "--json", "fit.json")
        self.assert_kept("a.csv", "--data_list", "--data_list", "one.txt", "--json", "a.csv")

    def test_no_output_of_a_release_overwrites_an_input(self):
        self.write("fit_002.json", swing.two_releases())
        self.assert_kept("fit_002.json", "--data", "--data", "fit_002.json", "--release", "all", "--json", "fit.json")

    def test_flags_given_twice(self):
        self.assert_refused(2, "--data is given twice; give all values in one flag, separated by commas: --data "
                               "a.csv,b.csv",
                            "--data", "a.csv", "--data", "b.csv")
        self.assert_refused(2, "--model is given twice; leave one of them out", "--data", "a.csv", "--model", "viscous",
                            "--model=drag")

    def test_standard_input_is_read_once(self):
        self.assert_refused(2, "--data '-,-' names standard input twice, but it can be read only once", "--data", "-,-")


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
