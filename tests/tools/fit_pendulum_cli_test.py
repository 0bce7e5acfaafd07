#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum like a user: exit codes, sentences, files.

  fit_pendulum_cli_test.py PATH/TO/fit_pendulum
"""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import swing

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ""  # path of the binary, from the command line

GOOD_DATA = swing.angle_csv()


def strict_json(text):
    """Parses JSON that must not contain NaN or Infinity."""

    def refuse(constant):
        raise ValueError(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


class CliTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("run.csv", GOOD_DATA)
        self.write("rig.json", json.dumps(swing.RIG))

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def run_tool(self, *flags, stdout=subprocess.PIPE):
        return subprocess.run([TOOL, *flags], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, text=True,
                              encoding="utf-8", timeout=60, check=False)

    def names(self):
        return {path.name for path in self.folder.iterdir()}

    def assert_refused(self, code, sentence, *flags):
        """Checks that the tool exits with the code and one sentence that matches, and writes nothing."""
        before = self.names()
        run = self.run_tool(*flags)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertRegex(run.stderr, r"\Afit_pendulum: [^\n]+\n(?:try: fit_pendulum [^\n]+\n)?\Z".replace(
            "try: fit_pendulum", "try: " + re.escape(TOOL)))
        self.assertRegex(run.stderr, sentence)
        self.assertEqual(self.names(), before)

    def assert_data_refused(self, code, sentence, text):
        self.write("bad.csv", text)
        self.assert_refused(code, sentence, "--data", "bad.csv", "--json", "fit.json", "--residuals", "res.csv")

    def assert_flags_refused(self, sentence, *flags):
        self.assert_refused(2, sentence, "--json", "fit.json", *flags)


class BadData(CliTest):
    def test_missing_file(self):
        self.assert_refused(3, "nowhere.csv", "--data", "nowhere.csv", "--json", "fit.json")

    def test_empty_file(self):
        self.assert_data_refused(5, "bad.csv", "")

    def test_header_only(self):
        self.assert_data_refused(5, "bad.csv", "time_s,angle_deg\n")

    def test_unknown_column(self):
        self.assert_data_refused(4, 'none of the columns "time_s", "temperature_C" is an angle',
                                 GOOD_DATA.replace("angle_deg", "temperature_C"))

    def test_text_in_a_number(self):
        self.assert_data_refused(4, "bad.csv:6:", GOOD_DATA.replace("\n0.040,", "\n0.04O,"))

    def test_nan(self):
        lines = GOOD_DATA.splitlines()
        lines[10] = lines[10].split(",")[0] + ",nan"
        self.write("nan.csv", "\n".join(lines) + "\n")
        run = self.run_tool("--data", "nan.csv")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("empty cells", run.stdout)
        self.assertIn("1 row was left out", self.run_tool("--data", "nan.csv", "--details").stdout)

    def test_three_samples(self):
        self.assert_data_refused(5, "bad.csv", "time_s,angle_deg\n0,1\n0.1,2\n0.2,1\n")

    def test_constant_signal(self):
        rows = "".join(f"{k / 100},1.5\n" for k in range(1000))
        self.assert_data_refused(5, "fit_pendulum: ", "time_s,angle_deg\n" + rows)

    def test_window_beyond_the_recording(self):
        self.assert_refused(5, "window", "--data", "run.csv", "--from", "100")


class BadRig(CliTest):
    def test_negative_mass(self):
        self.write("bad.json", json.dumps({**swing.RIG, "bob_mass": -0.38}))
        self.assert_refused(4, "bad.json.*bob_mass", "--data", "run.csv", "--rig", "bad.json", "--json", "fit.json")

    def test_unknown_key(self):
        self.write("bad.json", json.dumps({**swing.RIG, "colour": 1}))
        self.assert_refused(4, "bad.json.*colour", "--data", "run.csv", "--rig", "bad.json")

    def test_missing_file(self):
        self.assert_refused(3, "nowhere.json", "--data", "run.csv", "--rig", "nowhere.json")


class BadFlags(CliTest):
    def test_unknown_flag(self):
        self.assert_flags_refused("--residual is not a flag.*--residuals", "--data", "run.csv", "--residual", "r.csv")

    def test_flag_without_value(self):
        self.assert_flags_refused("--data needs a value", "--data")

    def test_no_data(self):
        self.assert_flags_refused("no recording was given; .* fit_pendulum run.csv")

    def test_recordings_with_and_without_a_flag(self):
        self.assert_flags_refused("'run.csv' and --data both name recordings", "run.csv", "--data", "run.csv")

    def test_unknown_model_lists_the_models(self):
        self.assert_flags_refused("viscous, coulomb, drag, .*linear, linear_coulomb", "--data", "run.csv", "--model", "columb")

    def test_a_model_named_twice(self):
        self.assert_flags_refused("names viscous twice", "--data", "run.csv", "--model", "viscous,drag,viscous")

    def test_an_unknown_model_among_several(self):
        self.assert_flags_refused("mud", "--data", "run.csv", "--model", "viscous,mud")

    def test_fix_of_an_unknown_name(self):
        self.assert_flags_refused("no parameter 'mass'", "--data", "run.csv", "--fix", "mass=1")

    def test_fix_outside_the_bounds(self):
        self.assert_flags_refused("viscous", "--data", "run.csv", "--fix", "viscous=-1")

    def test_from_after_to(self):
        self.assert_flags_refused("--from 5 s does not lie before --to 2 s", "--data", "run.csv", "--from", "5", "--to",
                                  "2")

    def test_wrong_flags_in_a_file_exit_2(self):
        self.write("flags", "--colour=red\n")
        self.assertEqual(self.run_tool("--flagfile", "flags").returncode, 2)


class BadOutputs(CliTest):
    def test_no_such_folder(self):
        self.assert_refused(73, "no/fit.json", "--data", "run.csv", "--json", "no/fit.json", "--residuals", "res.csv")

    def test_folder(self):
        self.assert_refused(73, "directory", "--data", "run.csv", "--json", str(self.folder))

    def test_outputs_are_checked_before_the_data_are_read(self):
        self.assert_refused(73, "no/fit.json", "--data", "nowhere.csv", "--json", "no/fit.json")

    def test_output_over_the_data(self):
        self.assert_refused(2, "--residuals", "--data", "run.csv", "--residuals", "./run.csv")
        self.assertEqual((self.folder / "run.csv").read_text(encoding="utf-8"), GOOD_DATA)

    def test_two_outputs_in_one_file(self):
        self.assert_refused(2, "--json", "--data", "run.csv", "--json", "x", "--residuals", "./x")

    def test_an_old_result_survives_a_failure(self):
        self.write("fit.json", "old")
        self.write("bad.csv", "time_s,angle_deg\n")
        self.assertEqual(self.run_tool("--data", "bad.csv", "--json", "fit.json").returncode, 5)
        self.assertEqual((self.folder / "fit.json").read_text(encoding="utf-8"), "old")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_full_disk(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            run = self.run_tool("--data", "run.csv", stdout=full)
        self.assertEqual(run.returncode, 73)
        self.assertIn("No space left on device", run.stderr)


class GoodRun(CliTest):
    def fit(self, *flags):
        run = self.run_tool("--data", "run.csv", "--json", "fit.json", *flags)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        return run.stdout, strict_json((self.folder / "fit.json").read_text(encoding="utf-8"))

    def test_finds_the_truth_within_four_standard_errors(self):
        _, result = self.fit("--rig", "rig.json")
        fit = result["fits"][0]
        self.assertEqual(fit["status"], "converged")
        parameters = swing.parameters_of(result)
        self.assertEqual(set(parameters), set(swing.TRUTH))
        for name, parameter in parameters.items():
            self.assertLess(abs(parameter["estimate"] - swing.TRUTH[name]), 4 * parameter["std_error"], name)
        self.assertEqual(result["recordings"][0]["samples"], GOOD_DATA.count("\n") - 1)

    def test_table_has_all_sections(self):
        table, _ = self.fit("--rig", "rig.json", "--details")
        for part in ("[[Parameters]]", "inertia", "kg m^2", " ± ", "95 % interval", "th'' + ", " sin th = 0",
                     "[[Correlations]]", "[[Sampling]]", "[[Closed forms]]", "[[Closed forms against the fit]]",
                     "[[Turning points]]"):
            self.assertIn(part, table)

    def test_torques_are_in_units_of_gravity_torque_without_a_rig(self):
        table, result = self.fit("--details")
        self.assertIsNone(result["rig"])
        inertia = result["fits"][0]["parameters"]["inertia"]
        self.assertEqual(inertia["unit"], "s^2")
        self.assertAlmostEqual(inertia["estimate"], swing.TRUTH["inertia"] / swing.GRAVITY_TORQUE, places=4)
        self.assertIn("give --rig", " ".join(table.split()))

    def test_same_bytes_every_time(self):
        first = self.fit("--rig", "rig.json")
        self.assertEqual(first, self.fit("--rig", "rig.json"))

    def test_window_and_fixed_parameter(self):
        _, result = self.fit("--from", "3", "--to", "9", "--fix", "zero_angle=0.01")
        (recording,) = result["recordings"]
        self.assertEqual(recording["window_s"], [3, 9])
        self.assertEqual(recording["start"], "moving")
        own = recording["fits"][0]["parameters"]
        zero = own["zero_angle"]
        self.assertEqual((zero["estimate"], zero["std_error"], zero["fixed"]), (0.01, None, True))
        self.assertIn("initial_angle", own)

    def test_everything_fixed(self):
        truth = ",".join(f"{name}={value}" for name, value in swing.TRUTH.items())
        _, result = self.fit("--rig", "rig.json", "--fix", truth)
        own = result["recordings"][0]["fits"][0]
        for part in (result["fits"][0], own):
            self.assertEqual(part["covariance"], {"names": [], "matrix": []})
        self.assertAlmostEqual(own["noise"]["sigma_rad"], 0.003, delta=3e-4)

    def test_residuals_are_measured_minus_fitted(self):
        self.fit("--residuals", "res.csv")
        with open(self.folder / "res.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["time_s", "measured_rad", "fitted_rad", "residual_rad",
                                         "linear_closed_form_rad", "nonlinear_closed_form_rad"])
        self.assertTrue(all(all(row.values()) for row in rows))
        self.assertEqual(len(rows), GOOD_DATA.count("\n") - 1)
        for row in rows:
            difference = float(row["measured_rad"]) - float(row["fitted_rad"])
            self.assertAlmostEqual(float(row["residual_rad"]), difference, delta=1e-15)

    def test_plot_is_the_picture_that_its_name_says(self):
        for name, begin in (("fit.svg", b"<?xml"), ("fit.png", b"\x89PNG"), ("fit.pdf", b"%PDF")):
            self.fit("--plot", name)
            self.assertTrue((self.folder / name).read_bytes().startswith(begin), name)

    def test_plot_needs_a_name_that_says_its_kind_and_a_fit(self):
        self.assert_flags_refused("--plot 'fit.jpg' must end in .svg, .png or .pdf", "--data", "run.csv", "--plot", "fit.jpg")
        self.assert_flags_refused("--plot needs a fit, but --closed_form_only makes none", "--data", "run.csv",
                                  "--closed_form_only", "--plot", "fit.svg")

    def test_result_compares_the_fit_with_closed_forms(self):
        _, result = self.fit("--rig", "rig.json")
        (recording,) = result["recordings"]
        rows = recording["fits"][0]["closed_form"]
        self.assertTrue(rows)
        parameters = result["fits"][0]["parameters"]
        for row in rows:
            if row["quantity"].startswith("inertia"):
                self.assertEqual((row["fit"], row["unit"]), (parameters["inertia"]["estimate"], "kg m^2"))
        inertia = recording["closed_forms"]["decrement"]["parameters"]["inertia"]
        self.assertLess(abs(inertia["estimate"] - swing.TRUTH["inertia"]), 4 * inertia["std_error"])

    def test_series_has_samples_turning_points_and_models(self):
        _, result = self.fit("--series", "series.json")
        (series,) = strict_json((self.folder / "series.json").read_text(encoding="utf-8"))
        (recording,) = result["recordings"]
        samples = recording["used_samples"]
        self.assertEqual((len(series["time_s"]), len(series["measured"]), series["unit"]), (samples, samples, "rad"))
        self.assertEqual({name: {key: len(values) for key, values in model.items()}
                          for name, model in series["models"].items()},
                         {"coulomb": dict.fromkeys(("fitted", "fitted_std_error", "residual", "linear_closed_form",
                                                    "nonlinear_closed_form"), samples)})
        peaks = series["peaks"]
        self.assertEqual([peak["number"] for peak in peaks], list(range(1, len(peaks) + 1)))
        self.assertEqual(len(peaks), recording["closed_forms"]["turning_points"])
        self.assertGreaterEqual(len(series["extrema"]), len(peaks))

    def test_dash_writes_only_that_file_to_standard_output(self):
        run = self.run_tool("--data", "run.csv", "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(strict_json(run.stdout)["schema_version"], 3)

    def test_writes_only_the_requested_files(self):
        before = self.names()
        self.fit("--residuals", "/dev/null")
        self.assertEqual(self.names(), before | {"fit.json"})

    def test_gyro(self):
        self.write("gyro.csv", swing.rate_csv())
        run = self.run_tool("--data", "gyro.csv", "--from", "2", "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        result = strict_json(run.stdout)
        own = result["recordings"][0]["fits"][0]
        for part in (result["fits"][0], own):
            self.assertIn("rms_residual_rad_s", part["statistics"])
        bias = own["parameters"]["rate_bias"]
        self.assertLess(abs(bias["estimate"] - 0.02), 4 * bias["std_error"])

    def test_every_model(self):
        for model in ("linear", "viscous", "coulomb", "drag"):
            with self.subTest(model=model):
                run = self.run_tool("--data", "run.csv", "--model", model, "--json", "fit.json")
                self.assertIn(run.returncode, (0, 1), run.stderr)
                result = strict_json((self.folder / "fit.json").read_text(encoding="utf-8"))
                self.assertEqual(result["fits"][0]["model"], model)
                self.assertEqual(run.returncode == 0, result["fits"][0]["status"] == "converged")

    def test_the_textbooks_rig(self):
        data = ROOT / "datasets" / "textbook_rig.csv"
        if not data.exists():
            self.skipTest("datasets/textbook_rig.csv is not there")
        run = self.run_tool("--data", str(data), "--rig", str(data.with_suffix(".json")), "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertAlmostEqual(strict_json(run.stdout)["fits"][0]["parameters"]["inertia"]["estimate"], 0.079, places=3)


class ClosedFormsOnly(CliTest):
    def forms(self, data, *flags):
        run = self.run_tool("--data", data, "--closed_form_only", "--json", "-", *flags)
        self.assertEqual(run.returncode, 0, run.stderr)
        result = strict_json(run.stdout)
        (recording,) = result["recordings"]
        self.assertEqual((result["fits"], recording["fits"]), ([], []))
        return recording["closed_forms"], run.stderr

    def assert_near_truth(self, forms, **truth):
        for name, value in truth.items():
            estimate = forms["decrement"]["parameters"][name]
            self.assertLess(abs(estimate["estimate"] - value), 4 * estimate["std_error"], name)

    def test_text_has_turning_points_but_no_fit(self):
        run = self.run_tool("--data", "run.csv", "--closed_form_only", "--details")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertRegex(run.stdout, r"(?s)\[\[Turning points\]\].*\[\[Closed forms\]\].*\[\[Sampling\]\].*\[\[Data\]\]")
        for part in ("[[Fit]]", "[[Parameters]]", "against the fit"):
            self.assertNotIn(part, run.stdout)

    def test_finds_the_truth_of_an_angle(self):
        forms, _ = self.forms("run.csv", "--rig", "rig.json")
        self.assertEqual(forms["model"], "coulomb")
        self.assert_near_truth(forms, **{name: swing.TRUTH[name] for name in ("inertia", "viscous", "coulomb", "zero_angle")})

    def test_counts_need_no_calibration(self):
        # 0.05 rad is small: sin th = th to 0.04 %, and the period is longer by 1 + 0.05^2 / 16. Friction is only
        # viscous, as in the linear law.
        truth = {**swing.TRUTH, "release_angle": 0.05, "coulomb": 0.0}
        scale = 1e4  # counts per radian
        rows = [f"{time:.3f},{round(scale * angle + 5000)}" for time, angle, _ in swing.swing(12.0, truth=truth)]
        self.write("counts.csv", "\n".join(["time_s,adc_counts", *rows]) + "\n")
        forms, warnings = self.forms("counts.csv")
        self.assertEqual((forms["model"], forms["decrement"]["parameters"]["zero_angle"]["unit"]), ("linear", "counts"))
        self.assertIn("noise_counts", forms)
        self.assertRegex(warnings, "warning: counts.csv: the readings are in counts.*model linear")
        inertia = swing.TRUTH["inertia"] / swing.GRAVITY_TORQUE
        self.assertAlmostEqual(forms["linear"]["inertia"]["estimate"] / inertia, 1, delta=1e-3)
        viscous = swing.TRUTH["viscous"] / swing.GRAVITY_TORQUE
        self.assertAlmostEqual(forms["linear"]["viscous"]["estimate"] / viscous, 1, delta=0.05)

    def test_a_fit_refuses_counts(self):
        self.write("counts.csv", GOOD_DATA.replace("angle_deg", "adc_counts"))
        self.assert_refused(4, "calibrat", "--data", "counts.csv", "--json", "fit.json")

    def test_series_has_no_models(self):
        self.forms("run.csv", "--series", "series.json")
        (series,) = strict_json((self.folder / "series.json").read_text(encoding="utf-8"))
        self.assertEqual(series["models"], {})
        self.assertTrue(series["peaks"])

    def test_refuses_flags_that_need_a_fit(self):
        self.assert_flags_refused("--residuals needs a fit, but --closed_form_only makes none", "--data", "run.csv",
                                  "--closed_form_only", "--residuals", "r.csv")

    def test_needs_turning_points(self):
        rows = "".join(f"{k / 100},{k * k / 1e4}\n" for k in range(1000))
        self.write("bad.csv", "time_s,angle_deg\n" + rows)
        self.assert_refused(5, "turn", "--data", "bad.csv", "--closed_form_only", "--from", "0", "--to", "9", "--json",
                            "forms.json")


class PeoplesHabits(CliTest):
    def fit(self, *flags):
        run = self.run_tool(*flags, "--json", "fit.json")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return strict_json((self.folder / "fit.json").read_text(encoding="utf-8"))

    def test_recording_without_a_flag(self):
        self.assertEqual(self.fit("run.csv")["fits"], self.fit("--data", "run.csv")["fits"])

    def test_values_of_the_rig_as_flags(self):
        # G = (M + m/2) g l and I_O = m l²/3 + M l²
        result = self.fit("run.csv", "--bob_mass", "380+-1g", "--rod_mass=0.12", "--rod_length", "43cm")
        self.assertEqual(result["rig"], {"bob_mass": {"value": 0.38, "std_dev": 0.001}, "rod_mass": 0.12,
                                         "rod_length": 0.43, "gravity": 9.806})
        warnings = {warning["code"]: warning["message"] for warning in result["warnings"]}
        self.assertIn("--rod_mass 0.12 kg", warnings["rig_unit_assumed"])
        self.assertIn("--g", warnings["gravity_assumed"])

    def test_a_flag_overrides_the_rig_file(self):
        self.write("rig.json", json.dumps({"gravity_torque": 5}))
        result = self.fit("run.csv", "--rig", "rig.json", "--gravity_torque", "2000mNm")
        self.assertEqual(result["rig"], {"gravity_torque": 2.0})
        self.assertIn("rig_overridden", {warning["code"] for warning in result["warnings"]})

    def test_incomplete_rig(self):
        self.assert_refused(2, "--rod_mass is missing beside --bob_mass", "run.csv", "--bob_mass", "380g", "--rod_length",
                            "43cm")
        self.assert_refused(2, "--bob_mass is '380cm'; it must be a number with a unit", "run.csv", "--bob_mass", "380cm")

    def test_calibration_from_a_table(self):
        # A sensor with 54 deg per volt; -135 deg at 0 V.
        rows = GOOD_DATA.splitlines()[1:]
        volts = "".join("{},{:.6f}\n".format(time, (float(angle) + 135) / 54) for time, angle in (row.split(",") for row in rows))
        self.write("volts.csv", "time_s,pot_volts\n" + volts)
        self.write("table.csv", "pot_volts,angle_deg\n1,-81.1\n2,-27\n3,27.1\n4,81\n")
        result = self.fit("volts.csv", "--calibration", "table.csv")
        self.assertAlmostEqual(result["recordings"][0]["calibration"]["coefficients"][1], 54.04, places=6)
        warning = next(each for each in result["warnings"] if each["code"] == "calibration_from_table")
        self.assertIn("a straight line through the 4 points of table.csv", warning["message"])

    def test_refusal_ends_with_the_command_to_try(self):
        rows = GOOD_DATA.splitlines()[1:]
        self.write("no unit.csv", "time_s,pm\n" + "".join("{},{:.4f}\n".format(t, float(a) / 57.2958) for t, a in (row.split(",") for row in rows)))
        refused = self.run_tool("no unit.csv", "--model", "viscous")
        self.assertEqual(refused.returncode, 4)
        self.assertRegex(refused.stderr, r"\ntry: \S*fit_pendulum 'no unit.csv' --model viscous --unit rad\n\Z")
        command = refused.stderr.splitlines()[-1].removeprefix("try: ")
        tried = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertIn(tried.returncode, (0, 1), tried.stderr)


class Answers(CliTest):
    def test_help_has_several_names(self):
        text = self.run_tool("--help").stdout
        for flag in ("-h", "-help"):
            run = self.run_tool(flag)
            self.assertEqual((run.returncode, run.stdout), (0, text))
        self.assertRegex(text, r"\A[^\n]+\n\n(?:  fit_pendulum [^\n]+\n){3,6}\nInput:\n  --data ")
        full = self.run_tool("--helpfull").stdout
        self.assertIn("logtostderr", full)

    def test_help_shows_only_the_tools_flags(self):
        run = self.run_tool("--help")
        self.assertEqual(run.returncode, 0)
        self.assertNotIn("\nOther:\n", run.stdout)
        for flag in ("data", "rig", "model", "start", "from", "to", "fix", "json", "residuals", "series",
                     "closed_form_only", "calibration",
                     "time_column", "value_column", "unit", "sample_rate_hz", "help", "version"):
            self.assertRegex(run.stdout, rf"(?m)^  --{flag} ")
        self.assertNotIn("logtostderr", run.stdout)

    def test_prints_the_projects_version(self):
        project = re.search(r"VERSION ([0-9.]+)\n", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1])
        self.assertEqual(self.run_tool("--version").stdout, f"fit_pendulum {project.group(1)}\n")


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
