#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the published schema with the example that json_test.cc checks, and with results of fit_pendulum.

  result_schema_test.py PATH/TO/fit_pendulum       needs python3-jsonschema
"""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

import swing

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "include/pendulum/report/result.schema.json").read_text(encoding="utf-8"))
EXAMPLE = json.loads((ROOT / "tests/report/result_example.json").read_text(encoding="utf-8"))
# Keys that earlier results do not have, or that some results do not need.
ADDED = ("summary", "budget", "total_interval95", "advice", "total_std_error", "error_budget", "sensor", "rig_verdict", "ambiguities", "suspicions",
         "unseen_friction_std_error", "text_in_degrees")
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
RECORDING = ["recordings", 0]
OWN_FIT = ["recordings", 0, "fits", 0]  # the part of the first recording in the first fit
TOOL = ""  # path of the binary, from the command line


def is_added(path, key):
    """Whether earlier results may lack the key: those of warnings always had a text, numbers did not."""
    return key in ADDED or (key == "text" and "warnings" not in path) or (key == "agrees" and "parameters" in path)


class Schema(unittest.TestCase):
    def assert_refused(self, change):
        """Checks that the example is invalid after `change`."""
        result = copy.deepcopy(EXAMPLE)
        change(result)
        self.assertNotEqual(result, EXAMPLE)
        self.assertFalse(VALIDATOR.is_valid(result))

    def test_is_a_schema(self):
        VALIDATOR.check_schema(SCHEMA)

    def test_holds_for_the_example(self):
        VALIDATOR.validate(EXAMPLE)

    def test_requires_every_key_and_no_other(self):
        forms, constancy = [*RECORDING, "closed_forms"], [*OWN_FIT, "constancy"]
        for path in ([], ["tool"], RECORDING, ["fits", 0], ["fits", 0, "parameters", "viscous"], OWN_FIT,
                     [*OWN_FIT, "noise"], [*OWN_FIT, "statistics"], [*OWN_FIT, "covariance"], ["fits", 0, "statistics"],
                     ["fits", 0, "solver"], ["fits", 0, "covariance"], ["fits", 0, "systematic_covariance"],
                     ["fits", 0, "identifiability", 0], ["fits", 0, "derived", "natural_frequency"], ["warnings", 0],
                     [*RECORDING, "sampling"], [*OWN_FIT, "closed_form", 0], forms, [*forms, "linear"],
                     [*forms, "linear", "inertia"], [*forms, "decrement"], [*forms, "envelopes", 0], ["comparison"],
                     ["comparison", "rows", 0], ["comparison", "rows", 1], ["comparison", "rows", 0, "cross_validation"],
                     ["comparison", "tests", 0], ["comparison", "tests", 1], constancy, [*constancy, "halves"],
                     [*constancy, "halves", "rows", 0], [*constancy, "amplitude"], [*constancy, "amplitude", "windows", 0],
                     [*constancy, "amplitude", "trends", 0]):
            part = EXAMPLE
            for step in path:
                part = part[step]
            for key in part:
                if is_added(path, key) or (path[-1:] == ["linear"] and key == "corrected_inertia"):  # not with linear gravity
                    continue
                with self.subTest(path=path, missing=key):
                    self.assert_refused(lambda result, key=key: self.at(result, path).pop(key))
            with self.subTest(path=path, unknown=True):
                self.assert_refused(lambda result: self.at(result, path).update(unknown=1))

    @staticmethod
    def at(result, path):
        for step in path:
            result = result[step]
        return result

    def test_requires_a_reason_for_a_missing_standard_error(self):
        self.assert_refused(lambda result: result["fits"][0]["parameters"]["coulomb"].pop("reason"))
        self.assert_refused(lambda result: result["fits"][0]["derived"]["damping_ratio"].pop("reason"))
        self.assert_refused(lambda result: self.at(result, OWN_FIT)["closed_form"][2].pop("reason"))

    def test_requires_a_reason_for_missing_constancy(self):
        self.assert_refused(lambda result: result["recordings"][0]["fits"][1].pop("constancy_reason"))
        self.assert_refused(lambda result: self.at(result, OWN_FIT).update(constancy_reason="too short"))
        self.assert_refused(lambda result: self.at(result, OWN_FIT)["constancy"]["halves"].update(p=None))

    def test_requires_a_reason_for_missing_predictions_and_tests(self):
        self.assert_refused(lambda result: result["comparison"]["rows"][0].update(forward_prediction=None))
        self.assert_refused(lambda result: result["comparison"]["rows"][0].update(is_compared=False))
        self.assert_refused(lambda result: result["comparison"]["tests"][0].update(p=None))

    def test_requires_a_criterion_unless_there_is_no_likelihood(self):
        self.assert_refused(lambda result: result["comparison"].update(criterion=None))
        self.assert_refused(lambda result: result["comparison"].update(likelihood="none"))
        result = copy.deepcopy(EXAMPLE)
        result["comparison"].update(likelihood="none", criterion=None, recommended=None)
        VALIDATOR.validate(result)

    def test_holds_without_a_comparison(self):
        result = copy.deepcopy(EXAMPLE)
        result["comparison"] = None
        VALIDATOR.validate(result)

    def test_requires_a_reason_for_missing_closed_forms(self):
        for key in ("linear", "decrement"):
            self.assert_refused(lambda result, key=key: result["recordings"][0]["closed_forms"].update({key: None}))
            result = copy.deepcopy(EXAMPLE)
            result["recordings"][0]["closed_forms"].update({key: None, "reason": "too few turning points"})
            VALIDATOR.validate(result)
        self.assert_refused(lambda result: result["recordings"][0].update(closed_forms=None))

    def test_holds_without_fits_and_without_closed_forms(self):
        result = copy.deepcopy(EXAMPLE)
        (recording,) = result["recordings"]
        result["fits"], recording["fits"], recording["start"] = [], [], None
        VALIDATOR.validate(result)
        recording.update(closed_forms=None, reason="only 2 turning points can be located")
        VALIDATOR.validate(result)

    def test_requires_the_fits_in_the_recordings_too(self):
        self.assert_refused(lambda result: result.update(fits=[]))
        self.assert_refused(lambda result: result["recordings"][0].update(fits=[]))
        self.assert_refused(lambda result: result["recordings"][0].update(start=None))

    def test_requires_one_unit_for_residuals(self):
        self.assert_refused(lambda result: result["recordings"][0].update(resolution_rad_s=None))
        for path in (["fits", 0], OWN_FIT):
            self.assert_refused(lambda result, path=path: self.at(result, path)["statistics"].update(rms_residual_rad_s=0.1))
            self.assert_refused(lambda result, path=path: self.at(result, path)["statistics"].pop("rms_residual_rad"))
        self.assert_refused(lambda result: self.with_sigma(result["comparison"]["rows"][0], "rms_residual"))
        self.assert_refused(lambda result: self.with_sigma(result["comparison"]["rows"][0]["cross_validation"], "rms"))

    def test_allows_only_four_outcomes(self):
        self.assert_refused(lambda result: result["fits"][0].update(status="ok"))

    def test_allows_only_five_kinds_of_noise(self):
        for model in ("gaussian", "quantized", "huber", "student", "edges"):
            result = copy.deepcopy(EXAMPLE)
            self.at(result, OWN_FIT)["noise"]["model"] = model
            VALIDATOR.validate(result)
        self.assert_refused(lambda result: self.at(result, OWN_FIT)["noise"].update(model="cauchy"))

    def test_allows_only_three_verdicts(self):
        self.assert_refused(lambda result: result["fits"][0]["identifiability"][0].update(verdict="perhaps"))

    def test_requires_no_statistics_of_a_failed_fit(self):
        self.assert_refused(lambda result: result["fits"][0].update(status="failed"))
        for key in ("noise", "statistics"):
            self.assert_refused(lambda result, key=key: self.at(result, OWN_FIT).update({key: None}))

    def test_holds_if_every_fit_or_one_of_two_failed(self):
        result = copy.deepcopy(EXAMPLE)
        self.assertEqual(len(result["fits"]), 2)
        for fit, own in zip(result["fits"], result["recordings"][0]["fits"], strict=True):
            fit.update(status="failed", equation=None, statistics=None)
            own.update(noise=None, statistics=None)
            VALIDATOR.validate(result)
        own["noise"] = EXAMPLE["recordings"][0]["fits"][0]["noise"]
        self.assertFalse(VALIDATOR.is_valid(result))

    def test_allows_only_the_outcomes_of_a_separate_fit(self):
        result = copy.deepcopy(EXAMPLE)
        self.at(result, OWN_FIT)["separate"] = "not_converged: too few iterations"
        VALIDATOR.validate(result)
        for wrong in ("ok", "not_converged", "converged: so it is"):
            self.assert_refused(lambda result, wrong=wrong: self.at(result, OWN_FIT).update(separate=wrong))

    def test_requires_what_one_recording_always_shares(self):
        self.assert_refused(lambda result: result["fits"][0]["parameters"].pop("inertia"))
        self.assert_refused(lambda result: result["fits"][0]["shared"].remove("inertia"))

    def test_compares_several_recordings_and_not_one(self):
        self.assert_refused(lambda result: result.update(recordings=[]))
        self.assert_refused(lambda result: result["recordings"].append(copy.deepcopy(result["recordings"][0])))
        self.assert_refused(lambda result: result["fits"][0].update(homogeneity={}))

    @staticmethod
    def with_sigma(part, name):
        """The part with a number in the form for readings with different units."""
        part[name + "_sigma"] = part.pop(name + "_rad")


def result_of(recordings, *flags, rig=None):
    """The tool's output for these texts of recordings."""
    names = [f"run_{k + 1}.csv" for k in range(len(recordings))]
    with tempfile.TemporaryDirectory() as folder:
        for name, text in zip(names, recordings, strict=True):
            (pathlib.Path(folder) / name).write_text(text, encoding="utf-8")
        if rig:
            (pathlib.Path(folder) / "rig.json").write_text(json.dumps(rig), encoding="utf-8")
            flags = (*flags, "--rig", "rig.json")
        run = subprocess.run([TOOL, "--data", ",".join(names), "--json", "-", *flags], cwd=folder, capture_output=True,
                             text=True, encoding="utf-8", timeout=60, check=False)
    if run.returncode not in (0, 1):
        raise AssertionError(run.stderr)
    return json.loads(run.stdout)


class Results(unittest.TestCase):
    @staticmethod
    def assert_valid(data, *flags, rig=None):
        VALIDATOR.validate(result_of([data], *flags, rig=rig))

    def test_angle_without_a_rig(self):
        self.assert_valid(swing.angle_csv(), "--model", "viscous")

    def test_angle_with_an_uncertain_rig(self):
        self.assert_valid(swing.angle_csv(), rig={**swing.RIG, "bob_mass": {"value": 0.38, "std_dev": 0.001}})

    def test_rate(self):
        self.assert_valid(swing.rate_csv())

    def test_resolution_in_the_file(self):
        self.assert_valid("# resolution: 0.00001\n" + swing.angle_csv(), "--from", "2.5")

    def test_closed_forms_only(self):
        self.assert_valid(swing.angle_csv(), "--closed_form_only", rig=swing.RIG)
        self.assert_valid(swing.rate_csv(), "--closed_form_only", "--model", "drag")

    def test_fixed_parameters_and_one_at_its_bound(self):
        frictionless = {**swing.TRUTH, "viscous": 0.0, "coulomb": 0.0}
        self.assert_valid(swing.angle_csv(truth=frictionless), "--model", "drag", "--fix", "zero_angle=0.01",
                          "--from", "0", "--to", "12")


LOW = dict(swing.TRUTH, release_angle=0.25, release_time=1.4, zero_angle=-0.02)


class JointSchema(unittest.TestCase):
    """Results of two recordings with two models; the second recording is too short for a test of constancy."""

    @classmethod
    def setUpClass(cls):
        second = swing.angle_csv(duration=5.0, sigma=0.002, truth=LOW, seed=31)
        cls.result = result_of([swing.angle_csv(), second], "--model", "viscous,coulomb",
                               rig={**swing.RIG, "bob_mass": {"value": 0.38, "std_dev": 0.001}})

    def assert_refused(self, change):
        """Checks that the result is invalid after `change`."""
        result = copy.deepcopy(self.result)
        change(result)
        self.assertNotEqual(result, self.result)
        self.assertFalse(VALIDATOR.is_valid(result))

    def assert_holds(self, change):
        result = copy.deepcopy(self.result)
        change(result)
        VALIDATOR.validate(result)

    def test_holds_for_the_result(self):
        VALIDATOR.validate(self.result)
        self.assertEqual(len(self.result["recordings"]), 2)

    def test_requires_every_key_and_no_other(self):
        homogeneity, own = ["fits", 1, "homogeneity"], ["recordings", 1, "fits", 1]
        for path in ([], ["recordings", 1], ["fits", 1], ["fits", 1, "parameters", "viscous"], ["fits", 1, "statistics"],
                     ["fits", 1, "covariance"], ["fits", 1, "solver"], homogeneity,
                     [*homogeneity, "parameters", "inertia"], [*homogeneity, "parameters", "inertia", "random_effects"],
                     [*homogeneity, "parameters", "inertia", "recordings", 0], own, [*own, "parameters", "zero_angle"],
                     [*own, "noise"], [*own, "statistics"], ["comparison", "rows", 0], ["recordings", 1, "closed_forms"]):
            for key in Schema.at(self.result, path):
                with self.subTest(path=path, missing=key):
                    if key == "rms_residual_rad" and path == ["fits", 1, "statistics"]:  # only for readings of one unit
                        continue
                    if is_added(path, key):
                        continue
                    self.assert_refused(lambda result, key=key: Schema.at(result, path).pop(key))
            with self.subTest(path=path, unknown=True):
                self.assert_refused(lambda result: Schema.at(result, path).update(unknown=1))

    def test_requires_what_only_several_recordings_have(self):
        self.assert_refused(lambda result: result["recordings"].pop())
        self.assert_refused(lambda result: result["fits"][0].update(homogeneity=None))
        self.assert_refused(lambda result: result["recordings"][1].update(fits=[]))
        self.assert_refused(lambda result: result["recordings"][1].update(start=None))

        def without_fits(result):
            for each in (result, *result["recordings"]):
                each["fits"] = []

        self.assert_refused(without_fits)

    def test_requires_a_reason_for_missing_closed_forms(self):
        self.assert_refused(lambda result: result["recordings"][1].update(closed_forms=None))
        reason = "only 2 turning points can be located"
        self.assert_holds(lambda result: result["recordings"][1].update(closed_forms=None, reason=reason))

    def test_requires_a_reason_for_a_missing_test(self):
        none = {"statistic": None, "p": None, "agrees": None, "parameters": {}, "amplitude_dependence": []}
        self.assert_refused(lambda result: result["fits"][0]["homogeneity"].update(none))
        self.assert_refused(lambda result: result["fits"][0]["homogeneity"].update(reason="there is one"))
        none["reason"] = "all shared parameters are fixed, so there is nothing to compare"
        self.assert_holds(lambda result: result["fits"][0]["homogeneity"].update(none))
        self.assert_refused(lambda result: result["fits"][0]["homogeneity"].update(none, agrees=True))

    def test_requires_a_reason_for_an_undetermined_estimate(self):
        inertia = ["fits", 0, "homogeneity", "parameters", "inertia", "recordings", 0]
        none = {"estimate": None, "std_error": None, "z": None}
        self.assert_refused(lambda result: Schema.at(result, inertia).update(none))
        none["reason"] = "the recording on its own does not determine it"
        self.assert_holds(lambda result: Schema.at(result, inertia).update(none))

    def test_requires_no_statistics_of_a_failed_fit(self):
        self.assert_refused(lambda result: result["fits"][0].update(status="failed"))

    def test_requires_one_unit_for_residuals(self):
        self.assert_refused(lambda result: result["fits"][0]["statistics"].update(rms_residual_rad_s=0.1))
        self.assert_holds(lambda result: result["fits"][0]["statistics"].pop("rms_residual_rad"))
        self.assert_holds(lambda result: Schema.with_sigma(result["comparison"]["rows"][0], "rms_residual"))


class JointResults(unittest.TestCase):
    def assert_valid(self, recordings, *flags, status="converged", rig=None):
        result = result_of(recordings, *flags, rig=rig)
        VALIDATOR.validate(result)
        self.assertEqual(result["fits"][-1]["status"], status)
        return result

    @classmethod
    def setUpClass(cls):
        cls.first = swing.angle_csv()
        cls.second = swing.angle_csv(sigma=0.002, truth=LOW, seed=31)

    def test_recordings_that_agree(self):
        (fit,) = self.assert_valid([self.first, self.second], rig=swing.RIG)["fits"]
        self.assertIs(fit["homogeneity"]["agrees"], True)

    def test_recordings_that_disagree(self):
        other = swing.angle_csv(sigma=0.002, truth=dict(LOW, coulomb=0.006), seed=33)
        (fit,) = self.assert_valid([self.first, self.second, other])["fits"]
        self.assertEqual(fit["homogeneity"]["outliers"], [3])

    def test_two_pendulums(self):
        other = swing.angle_csv(truth=dict(swing.TRUTH, inertia=0.05))
        result = self.assert_valid([self.first, other], "--model", "viscous,coulomb", status="not_converged")
        self.assertEqual([row["is_compared"] for row in result["comparison"]["rows"]], [True, True])  # the separate fits

    def test_angle_and_rate(self):
        result = self.assert_valid([self.first, swing.rate_csv()], "--model", "viscous,coulomb")
        self.assertNotIn("rms_residual_rad", result["fits"][1]["statistics"])
        self.assertIn("rms_residual_sigma", result["comparison"]["rows"][0])

    def test_some_parameters_shared(self):
        self.assert_valid([self.first, self.second], "--shared", "inertia", rig=swing.RIG)

    def test_a_model_without_the_shared_parameters_fails(self):
        result = self.assert_valid([self.first, self.second], "--model", "viscous,coulomb", "--shared", "coulomb")
        self.assertEqual(result["fits"][0]["status"], "failed")
        self.assertNotIn("fixed", result["fits"][0]["homogeneity"]["reason"])

    def test_trajectories_that_cannot_be_computed(self):
        result = self.assert_valid([self.first, self.second], "--fix", "viscous=1e6", status="failed")
        self.assertIsNone(result["recordings"][0]["fits"][0]["amplitude_rad"])

    def test_all_shared_parameters_fixed(self):
        self.assert_valid([self.first, self.second], "--fix", "inertia=0.0438,viscous=0.0017,coulomb=0.0022")

    def test_at_a_bound(self):
        undamped = [swing.angle_csv(truth=dict(truth, coulomb=0.0), seed=seed)
                    for seed, truth in ((36, swing.TRUTH), (37, LOW))]
        result = self.assert_valid(undamped, "--bounds", "viscous=0.004:", rig=swing.RIG)
        self.assertIs(result["fits"][0]["parameters"]["viscous"]["at_bound"], True)

    def test_windows_too_short_for_constancy(self):
        result = self.assert_valid([self.first, self.second], "--model", "drag", "--to", "4.5")
        self.assertIn("constancy_reason", result["recordings"][0]["fits"][0])

    def test_friction_that_the_recordings_do_not_determine(self):
        recordings = [swing.angle_csv(sigma=0.002, truth=dict(truth, coulomb=0.0), seed=seed)
                      for seed, truth in ((40, swing.TRUTH), (41, LOW))]
        (fit,) = self.assert_valid(recordings, "--model", "stribeck", status="not_identifiable")["fits"]
        self.assertTrue(fit["reason"])  # the last digits decide which of the equally good points it reports

    def test_a_fixed_release_angle_that_is_wrong_for_one_recording(self):
        result = self.assert_valid([self.first, self.second], "--fix", "release_angle=0.42", status="not_converged")
        self.assertIs(result["recordings"][1]["fits"][0]["parameters"]["release_angle"]["fixed"], True)

    def test_profiles(self):
        self.assert_valid([self.first, self.second], "--interval", "profile", rig=swing.RIG)

    def test_counts_and_their_calibration(self):
        counts = [text.replace("angle_deg", "adc_counts") for text in (self.first, self.second)]
        calibration = '# calibration: {"schema_version": 1, "input": "counts", "angle_unit": "deg", "coefficients": [0, 1]}\n'
        result = self.assert_valid([calibration + counts[0], self.second])
        self.assertEqual([recording["calibration"] is None for recording in result["recordings"]], [False, True])
        self.assert_valid(counts, "--model", "linear")

    def test_releases_of_one_recording(self):
        self.assert_valid([swing.two_releases()], "--release", "all", "--shared", "all")


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
