#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of joint fits: fit_pendulum fits several recordings of one rig together.

  joint_fit_cli_test.py PATH/TO/fit_pendulum
"""

import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line

PHYSICAL = ("inertia", "viscous", "coulomb")
OWN = ("release_angle", "release_time", "zero_angle")
LOW = dict(swing.TRUTH, release_angle=0.25, release_time=1.4, zero_angle=-0.02)
A = swing.angle_csv()
B = swing.angle_csv(sigma=0.002, truth=LOW, seed=31)
OTHER = swing.angle_csv(truth=dict(swing.TRUTH, inertia=0.05), seed=32)
FLAT = "time_s,angle_deg\n" + "".join(f"{k / 100:.2f},3.0\n" for k in range(500))


class JointTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("a.csv", A)
        self.write("b.csv", B)
        self.write("rig.json", json.dumps(swing.RIG))

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.folder / name).read_text(encoding="utf-8")

    def names(self):
        return {path.name for path in self.folder.iterdir()}

    def run_tool(self, *flags, stdin=None):
        return subprocess.run([TOOL, *flags], cwd=self.folder, capture_output=True, text=True, encoding="utf-8",
                              input=stdin, timeout=60, check=False)

    def fit(self, *flags, stdin=None):
        run = self.run_tool(*flags, stdin=stdin)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run

    def joint(self, *flags, data="a.csv,b.csv", stdin=None):
        """The result of a converged joint fit."""
        return json.loads(self.fit("--data", data, "--rig", "rig.json", *flags, "--json", "-", stdin=stdin).stdout)

    @staticmethod
    def own_fits(result):
        """The part of each recording in the only fit."""
        return [own for recording in result["recordings"] for own in recording["fits"]]

    def assert_refused(self, code, sentence, *flags):
        """Checks that the tool exits with the code, prints the sentence, and writes no file."""
        before = self.names()
        run = self.run_tool(*flags, "--json", "fit.json", "--residuals", "r.csv")
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr, f"fit_pendulum: {sentence}\n")
        self.assertEqual(self.names(), before)

    def assert_near(self, parameter, truth):
        self.assertLess(abs(parameter["estimate"] - truth), 4 * parameter["std_error"])


class JointFit(JointTest):
    def test_gives_one_result_for_all_recordings(self):
        result = self.joint()
        (fit,) = result["fits"]
        self.assertEqual(fit["status"], "converged")
        self.assertEqual([recording["path"] for recording in result["recordings"]], ["a.csv", "b.csv"])
        self.assertEqual(fit["shared"], list(PHYSICAL))
        self.assertEqual(list(fit["parameters"]), list(PHYSICAL))
        self.assertIs(fit["homogeneity"]["agrees"], True)
        for name in PHYSICAL:
            self.assert_near(fit["parameters"][name], swing.TRUTH[name])

    def test_each_recording_has_its_own_start_and_zero(self):
        for own, truth in zip(self.own_fits(self.joint()), (swing.TRUTH, LOW), strict=True):
            self.assertEqual(list(own["parameters"]), list(OWN))
            for name in OWN:
                self.assert_near(own["parameters"][name], truth[name])
            self.assertEqual(own["covariance"]["names"], [*PHYSICAL, *OWN])

    def test_recordings_stay_in_the_given_order(self):
        result = self.joint(data="b.csv,a.csv")
        self.assertEqual([recording["path"] for recording in result["recordings"]], ["b.csv", "a.csv"])
        for name in PHYSICAL:
            first = self.joint()["fits"][0]["parameters"][name]
            other = result["fits"][0]["parameters"][name]
            self.assertLess(abs(first["estimate"] - other["estimate"]), 0.1 * first["std_error"])

    def test_separate_estimates_equal_single_fits(self):
        homogeneity = self.joint()["fits"][0]["homogeneity"]
        for k, name in enumerate(("a.csv", "b.csv")):
            alone = self.joint(data=name)["fits"][0]["parameters"]["inertia"]
            of_joint = homogeneity["parameters"]["inertia"]["recordings"][k]
            self.assertAlmostEqual(of_joint["estimate"] / alone["estimate"], 1, delta=1e-9)

    def test_outputs_of_each_recording_are_numbered(self):
        before = self.names()
        self.fit("--data", "a.csv,b.csv", "--json", "fit.json", "--residuals", "r.csv", "--series", "series.json",
                 "--report", "page.html", "--markdown", "fit.md")
        self.assertEqual(self.names() - before,
                         {"fit.json", "r_001.csv", "r_002.csv", "series.json", "page.html", "fit.md"})
        series = json.loads(self.read("series.json"))
        self.assertEqual(len(series), 2)
        for k, name in enumerate(("a.csv", "b.csv")):
            readings = list(csv.DictReader(self.read(name).splitlines()))
            rows = list(csv.DictReader(self.read(f"r_00{k + 1}.csv").splitlines()))
            self.assertEqual(len(rows), len(readings))
            self.assertEqual(len(series[k]["time_s"]), len(readings))
            for i in (0, 700):
                measured = math.radians(float(readings[i]["angle_deg"]))
                self.assertAlmostEqual(float(rows[i]["measured_rad"]), measured, delta=1e-12)
                self.assertAlmostEqual(series[k]["measured"][i], measured, delta=1e-12)
                residual = float(rows[i]["measured_rad"]) - float(rows[i]["fitted_rad"])
                self.assertAlmostEqual(float(rows[i]["residual_rad"]), residual, delta=1e-12)

    def test_text_markdown_and_page_show_all_recordings(self):
        run = self.fit("--data", "a.csv,b.csv", "--rig", "rig.json", "--report", "page.html", "--markdown", "fit.md", "--details")
        for text in (run.stdout, self.read("fit.md")):
            for words in ("a.csv", "b.csv", "Do the recordings agree?", "Each recording's own"):
                self.assertIn(words, text)
        self.assertLessEqual(max(len(line) for line in run.stdout.splitlines()), 80)
        self.assertTrue(self.read("fit.md").startswith("# Pendulum: 2 recordings of one rig\n"))
        self.assertIn('"path":"b.csv"', self.read("page.html"))

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot draws the picture")
    def test_terminal_plot_draws_each_recording(self):
        run = self.fit("--data", "a.csv,b.csv", "--terminal_plot")
        first = run.stdout.index("recording 1 (a.csv)\n")
        second = run.stdout.index("recording 2 (b.csv)\n")
        self.assertLess(first, second)
        self.assertLess(second, run.stdout.index("[[2 recordings of one rig]]"))

    def test_plot_draws_each_recording_into_a_file_of_its_own(self):
        self.fit("--data", "a.csv,b.csv", "--plot", "fit.svg")
        for number, name in ((1, "a.csv"), (2, "b.csv")):
            self.assertIn(f"recording {number} ({name})", self.read(f"fit_00{number}.svg"))

    def test_recordings_of_a_list_are_fitted_together(self):
        self.write("list.txt", "# two\na.csv\n\nb.csv\n")
        listed = self.fit("--data_list", "list.txt", "--rig", "rig.json", "--json", "-").stdout
        self.assertEqual(json.loads(listed), self.joint())

    def test_standard_input_can_be_one_recording(self):
        result = self.joint(data="-,b.csv", stdin=A)
        self.assertEqual([recording["path"] for recording in result["recordings"]], ["standard input", "b.csv"])
        self.assertEqual(result["fits"][0]["parameters"], self.joint()["fits"][0]["parameters"])

    def test_file_names_with_blanks_and_non_ascii_letters(self):
        names = ("my run ①.csv", "Mañana_τ.csv")
        self.write(names[0], A)
        self.write(names[1], B)
        self.assertEqual([recording["path"] for recording in self.joint(data=",".join(names))["recordings"]], list(names))
        run = self.fit("--data", ",".join(names), "--residuals", "ré s.csv")
        for name in names:
            self.assertIn(name, run.stdout)
        self.assertLessEqual({"ré s_001.csv", "ré s_002.csv"}, self.names())

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot draws the picture")
    def test_a_file_name_cannot_control_the_terminal(self):
        self.write("a\x1B[2J.csv", A)  # ECMA-48: clears the screen
        run = self.fit("--data", "a\x1B[2J.csv,b.csv", "--terminal_plot")
        self.assertEqual([line for line in run.stdout.splitlines() if "\x1B" in line], [])
        self.assertIn("recording 1 (a?[2J.csv)\n", run.stdout)

    def test_threads_change_nothing(self):
        texts = {self.fit("--data", "a.csv,b.csv", "--model", "viscous,coulomb", "--threads", threads, "--json", "-").stdout
                 for threads in ("1", "2")}
        self.assertEqual(len(texts), 1)

    def test_models_are_compared_over_all_recordings(self):
        result = self.joint("--model", "viscous,coulomb")
        self.assertEqual([fit["model"] for fit in result["fits"]], ["viscous", "coulomb"])
        self.assertEqual([row["model"] for row in result["comparison"]["rows"]], ["viscous", "coulomb"])
        self.assertEqual(result["comparison"]["recommended"], "coulomb")

    def test_models_are_compared_by_separate_fits_if_recordings_disagree(self):
        self.write("b.csv", OTHER)
        run = self.run_tool("--data", "a.csv,b.csv", "--model", "viscous,coulomb", "--json", "fit.json")
        self.assertEqual(run.returncode, 1, run.stderr)
        comparison = json.loads(self.read("fit.json"))["comparison"]
        self.assertEqual(comparison["recommended"], "coulomb")
        k = [len(swing.parameters_of(json.loads(self.fit("--data", name, "--model", "coulomb", "--json", "-").stdout)))
             for name in ("a.csv", "b.csv")]
        self.assertEqual(comparison["rows"][1]["parameters"], sum(k) + 2)  # all parameters of each recording, and both sigmas

    def test_angles_and_rates_are_fitted_together(self):
        self.write("gyro.csv", swing.rate_csv())
        result = self.joint(data="a.csv,gyro.csv")
        (fit,) = result["fits"]
        angle, rate = self.own_fits(result)
        self.assertEqual(fit["status"], "converged")
        self.assertIn("zero_angle", angle["parameters"])
        self.assert_near(rate["parameters"]["rate_bias"], 0.02)
        for name in PHYSICAL:
            self.assert_near(fit["parameters"][name], swing.TRUTH[name])

    def test_fits_the_releases_of_one_recording(self):
        self.write("two.csv", swing.two_releases())
        result = self.joint("--release", "all", "--shared", "all", data="two.csv")
        (fit,) = result["fits"]
        self.assertEqual([(recording["path"], recording["release"]) for recording in result["recordings"]],
                         [("two.csv", 1), ("two.csv", 2)])
        starts = [own["parameters"]["release_time"]["estimate"] for own in self.own_fits(result)]
        self.assertAlmostEqual(starts[0], 1.9, delta=0.02)
        self.assertAlmostEqual(starts[1], 13.9, delta=0.02)  # 10.00 s, 1.99 s by hand, 1.9 s of hold, one sample each
        self.assert_near(fit["parameters"]["inertia"], swing.TRUTH["inertia"])


class SharedParameters(JointTest):
    def test_each_recording_has_its_own_unshared_parameters(self):
        result = self.joint("--shared", "inertia")
        (fit,) = result["fits"]
        self.assertEqual(list(fit["parameters"]), ["inertia"])
        self.assertIsNone(fit["equation"])
        first, second = (own["parameters"] for own in self.own_fits(result))
        self.assertNotEqual(first["viscous"]["estimate"], second["viscous"]["estimate"])
        for own in (first, second):
            self.assertEqual(list(own), ["viscous", "coulomb", *OWN])
            self.assert_near(own["viscous"], swing.TRUTH["viscous"])

    def test_recordings_with_different_friction_agree_if_it_is_not_shared(self):
        self.write("b.csv", swing.angle_csv(sigma=0.002, truth=dict(LOW, coulomb=0.006), seed=33))
        self.assertIs(self.joint()["fits"][0]["homogeneity"]["agrees"], False)
        result = self.joint("--shared", "inertia")
        self.assertIs(result["fits"][0]["homogeneity"]["agrees"], True)
        first, second = self.own_fits(result)
        self.assert_near(first["parameters"]["coulomb"], 0.004)
        self.assert_near(second["parameters"]["coulomb"], 0.006)

    def test_a_shared_parameter_can_be_fixed(self):
        (fit,) = self.joint("--fix", "coulomb=0.004")["fits"]
        self.assertEqual(list(fit["homogeneity"]["parameters"]), ["inertia", "viscous"])
        self.assertEqual(fit["parameters"]["coulomb"]["estimate"], 0.004)
        self.assertIs(fit["parameters"]["coulomb"]["fixed"], True)
        self.assert_near(fit["parameters"]["viscous"], swing.TRUTH["viscous"])

    def test_nothing_is_compared_if_all_parameters_are_fixed(self):
        (fit,) = self.joint("--fix", "inertia=0.079,viscous=0.003,coulomb=0.004")["fits"]
        self.assertIsNone(fit["homogeneity"]["p"])
        self.assertEqual(fit["homogeneity"]["reason"], "all shared parameters are fixed, so there is nothing to compare")

    # Inverse variances add: a prior as accurate as the data halves the variance for any number of recordings.
    def test_a_prior_of_a_shared_parameter_counts_once(self):
        flags = ("--fix", "viscous=0.003,coulomb=0.004")
        (without,) = self.joint(*flags)["fits"]
        error = without["parameters"]["inertia"]["std_error"]
        mean = without["parameters"]["inertia"]["estimate"] + error
        (with_prior,) = self.joint(*flags, "--prior", f"inertia={mean!r}:{error!r}")["fits"]
        inertia = with_prior["parameters"]["inertia"]
        self.assertAlmostEqual(inertia["std_error"] / error, math.sqrt(0.5), delta=0.02)
        self.assertAlmostEqual((inertia["estimate"] - without["parameters"]["inertia"]["estimate"]) / error, 0.5, delta=0.05)


class Refusals(JointTest):
    def test_two_different_pendulums_are_reported_and_written(self):
        self.write("b.csv", OTHER)
        run = self.run_tool("--data", "a.csv,b.csv", "--json", "fit.json")
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stderr, r"\Afit_pendulum: no result with \w+ \(not_converged\)\n\Z")  # the text says why
        self.assertRegex(" ".join(run.stdout.split()), "No result with .* these are not swings of one pendulum ")
        (fit,) = json.loads(self.read("fit.json"))["fits"]
        self.assertEqual(fit["status"], "not_converged")
        self.assertIs(fit["homogeneity"]["agrees"], False)
        self.assertIsNone(fit["parameters"]["inertia"]["std_error"])

    def test_names_the_recording_of_another_rig(self):
        self.write("c.csv", swing.angle_csv(truth=dict(LOW, release_angle=0.35), seed=34))
        self.write("other.csv", swing.angle_csv(truth=dict(swing.TRUTH, inertia=0.0794), seed=35))
        # 0.0794 / 0.079 = 1.005; four inertias of which one is 0.5 % larger have a standard deviation of 0.25 %. A clock
        # that may be 1 % off makes an inertia 2 % uncertain, and masses and length leave 0.4 %.
        result = self.joint(data="a.csv,other.csv,b.csv,c.csv")
        homogeneity = result["fits"][0]["homogeneity"]
        self.assertEqual(homogeneity["outliers"], [2])
        self.assertRegex(homogeneity["verdict"],
                         r"; recording 2 \(other.csv\) disagrees with the others: its inertia is 0\.(49|5|51) % larger; .*"
                         r"; the errors from other sources are larger than that\Z")
        self.assertNotIn("recordings_disagree", [warning["code"] for warning in result["warnings"]])
        self.assertEqual(result["fits"][0]["summary"]["level"], "caution")
        exact = self.run_tool("--data", "a.csv,other.csv,b.csv,c.csv", "--sensor", "ideal", "--json", "-")
        result = json.loads(exact.stdout)
        self.assertIn("recordings_disagree", [warning["code"] for warning in result["warnings"]])
        self.assertEqual(result["fits"][0]["summary"]["level"], "bad")
        result = self.joint(data="a.csv,-,b.csv,c.csv", stdin=self.read("other.csv"))
        self.assertIn("; recording 2 (standard input) disagrees ", result["fits"][0]["homogeneity"]["verdict"])

    def test_a_missing_file_among_several(self):
        self.assert_refused(3, "nowhere.csv: there is no such file; check the path", "--data", "a.csv,nowhere.csv,b.csv")

    def test_a_file_without_a_swing_among_several(self):
        self.write("flat.csv", FLAT)
        self.assert_refused(5, "flat.csv: the reading is constant, so there is no swing; check the sensor, or choose "
                            "another column", "--data", "a.csv,flat.csv")

    def test_one_swing_has_nothing_to_share(self):
        self.assert_refused(2, "--shared is for several recordings, or several releases of one (--release all), but "
                               "there is only one swing", "--data", "a.csv", "--shared", "all")

    def test_a_name_that_cannot_be_shared(self):
        self.assert_refused(2, "--shared names 'mass', which recordings cannot share; they can share inertia, viscous, "
                            "coulomb, or all, or none", "--data", "a.csv,b.csv", "--shared", "inertia,mass")

    def test_no_bootstrap_of_a_joint_fit(self):
        self.assert_refused(2, "--interval bootstrap is only for separate fits (--shared none); for a joint fit use "
                               "covariance or profile", "--data", "a.csv,b.csv", "--interval", "bootstrap")

    def test_residuals_of_several_recordings_need_files(self):
        run = self.run_tool("--data", "a.csv,b.csv", "--residuals", "-")
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr, "fit_pendulum: --residuals - takes one recording, but there are 2; give a file "
                                     "name, to which the number is added\n")

    def test_residuals_do_not_overwrite_an_input(self):
        self.write("r_002.csv", B)
        self.assert_refused(2, "--residuals r_002.csv would overwrite the input of --data", "--data", "a.csv,r_002.csv")

    def test_recordings_that_describe_different_rigs(self):
        self.write("a.csv", f"# rig: {json.dumps(swing.RIG)}\n" + A)
        self.write("b.csv", f"# rig: {json.dumps(dict(swing.RIG, bob_mass=0.4))}\n" + B)
        self.assert_refused(4, "a.csv and b.csv describe different rigs (# rig), but recordings that are fitted "
                               "together must have one rig; give it with --rig, or fit the recordings separately "
                               "with --shared none", "--data", "a.csv,b.csv")
        self.joint()  # --rig takes precedence

    def test_the_same_readings_in_another_file(self):
        self.write("copy.csv", "# exported again\n" + A)
        self.assert_refused(2, "a.csv and copy.csv are the same recording: all readings are equal; name it once",
                            "--data", "a.csv,copy.csv")

    def test_one_resolution_for_readings_of_two_units(self):
        rows = [line.split(",") for line in A.splitlines() if line[0].isdigit()]
        self.write("rad.csv", "time_s,angle_rad\n" +
                   "".join(f"{time},{math.radians(float(angle)):.9f}\n" for time, angle in rows[1:]))
        self.assert_refused(2, "--resolution is in the file's unit, but a.csv is in deg and rad.csv in rad; write a "
                               "line # resolution: VALUE into each file instead", "--data", "a.csv,rad.csv", "--resolution", "0.1")

    # result.schema.json: the format in which a message names its recording.
    def test_warnings_name_their_recording(self):
        prior = ("--prior", "inertia=0.0795:0.000001")
        messages = [warning["message"] for warning in self.joint(*prior)["warnings"] if warning["code"] == "prior_conflict"]
        self.assertEqual([message.split(": ")[0] for message in messages], ["each recording"])
        self.write("gap.csv", "".join(line for k, line in enumerate(A.splitlines(True)) if not 300 < k < 340))
        messages = [warning["message"] for warning in self.joint(data="b.csv,gap.csv")["warnings"]]
        self.assertTrue(any(message.startswith("recording 2 (gap.csv): ") for message in messages), messages)

    def test_recordings_that_describe_one_rig(self):
        expected = self.joint()["fits"]
        self.write("a.csv", f"# rig: {json.dumps(swing.RIG)}\n" + A)
        for text in (B, f"# rig: {json.dumps(swing.RIG)}\n" + B):  # the rig is given in one file or in both
            self.write("b.csv", text)
            result = json.loads(self.fit("--data", "a.csv,b.csv", "--json", "-").stdout)
            self.assertEqual(result["fits"][0]["parameters"], expected[0]["parameters"])
            self.assertEqual(result["rig"], swing.RIG)


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
