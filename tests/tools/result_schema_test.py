#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the published schema against the example that json_test.cc proves, and against results of fit_pendulum.

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
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
TOOL = ""  # path of the binary, from the command line


class Schema(unittest.TestCase):
    def assert_refused(self, change):
        """The example is no longer valid once `change` has been at it."""
        result = copy.deepcopy(EXAMPLE)
        change(result)
        self.assertNotEqual(result, EXAMPLE)
        self.assertFalse(VALIDATOR.is_valid(result))

    def test_is_a_schema(self):
        VALIDATOR.check_schema(SCHEMA)

    def test_holds_for_the_example(self):
        VALIDATOR.validate(EXAMPLE)

    def test_wants_every_key_and_no_other(self):
        for path in ([], ["tool"], ["data"], ["fits", 0], ["fits", 0, "parameters", "viscous"], ["fits", 0, "noise"],
                     ["fits", 0, "statistics"], ["fits", 0, "solver"], ["fits", 0, "covariance"],
                     ["fits", 0, "systematic_covariance"], ["fits", 0, "identifiability", 0],
                     ["fits", 0, "derived", "natural_frequency"], ["warnings", 0], ["data", "sampling"],
                     ["fits", 0, "closed_form", 0], ["closed_forms"], ["closed_forms", "linear"],
                     ["closed_forms", "linear", "inertia"], ["closed_forms", "decrement"],
                     ["closed_forms", "envelopes", 0], ["comparison"], ["comparison", "rows", 0],
                     ["comparison", "rows", 1], ["comparison", "rows", 0, "cross_validation"],
                     ["comparison", "tests", 0], ["comparison", "tests", 1], ["fits", 0, "constancy"],
                     ["fits", 0, "constancy", "halves"], ["fits", 0, "constancy", "halves", "rows", 0],
                     ["fits", 0, "constancy", "amplitude"], ["fits", 0, "constancy", "amplitude", "windows", 0],
                     ["fits", 0, "constancy", "amplitude", "trends", 0]):
            part = EXAMPLE
            for step in path:
                part = part[step]
            for key in part:
                if path[-1:] == ["linear"] and key == "corrected_inertia":  # there is none with linear gravity
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

    def test_wants_a_reason_for_a_missing_standard_error(self):
        self.assert_refused(lambda result: result["fits"][0]["parameters"]["coulomb"].pop("reason"))
        self.assert_refused(lambda result: result["fits"][0]["derived"]["damping_ratio"].pop("reason"))
        self.assert_refused(lambda result: result["fits"][0]["closed_form"][2].pop("reason"))

    def test_wants_a_reason_for_missing_constancy(self):
        self.assert_refused(lambda result: result["fits"][1].pop("constancy_reason"))
        self.assert_refused(lambda result: result["fits"][0].update(constancy_reason="too short"))
        self.assert_refused(lambda result: result["fits"][0]["constancy"]["halves"].update(p=None))

    def test_wants_a_reason_for_missing_predictions_and_tests(self):
        self.assert_refused(lambda result: result["comparison"]["rows"][0].update(forward_prediction=None))
        self.assert_refused(lambda result: result["comparison"]["rows"][0].update(judged=False))
        self.assert_refused(lambda result: result["comparison"]["tests"][0].update(p=None))

    def test_knows_a_criterion_unless_there_is_no_likelihood(self):
        self.assert_refused(lambda result: result["comparison"].update(criterion=None))
        self.assert_refused(lambda result: result["comparison"].update(likelihood="none"))
        result = copy.deepcopy(EXAMPLE)
        result["comparison"].update(likelihood="none", criterion=None, recommended=None)
        VALIDATOR.validate(result)

    def test_holds_without_a_comparison(self):
        result = copy.deepcopy(EXAMPLE)
        result["comparison"] = None
        VALIDATOR.validate(result)

    def test_wants_a_reason_for_missing_closed_forms(self):
        for key in ("linear", "decrement"):
            self.assert_refused(lambda result, key=key: result["closed_forms"].update({key: None}))
            result = copy.deepcopy(EXAMPLE)
            result["closed_forms"].update({key: None, "reason": "too few turning points"})
            VALIDATOR.validate(result)

    def test_holds_without_fits_and_without_closed_forms(self):
        result = copy.deepcopy(EXAMPLE)
        result["fits"] = []
        result["data"]["start"] = None
        VALIDATOR.validate(result)
        result["closed_forms"] = None
        result["reason"] = "only 2 turning points can be located"
        VALIDATOR.validate(result)

    def test_wants_one_unit_for_residuals(self):
        self.assert_refused(lambda result: result["data"].update(resolution_rad_s=None))

    def test_knows_four_outcomes(self):
        self.assert_refused(lambda result: result["fits"][0].update(status="ok"))

    def test_knows_four_kinds_of_noise(self):
        for model in ("gaussian", "quantized", "huber", "student"):
            result = copy.deepcopy(EXAMPLE)
            result["fits"][0]["noise"]["model"] = model
            VALIDATOR.validate(result)
        self.assert_refused(lambda result: result["fits"][0]["noise"].update(model="cauchy"))

    def test_knows_three_verdicts(self):
        self.assert_refused(lambda result: result["fits"][0]["identifiability"][0].update(verdict="perhaps"))

    def test_wants_no_statistics_of_a_failed_fit(self):
        self.assert_refused(lambda result: result["fits"][0].update(status="failed"))


class Results(unittest.TestCase):
    def assert_valid(self, data, *flags, rig=None):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "run.csv").write_text(data, encoding="utf-8")
            if rig:
                (pathlib.Path(folder) / "rig.json").write_text(json.dumps(rig), encoding="utf-8")
                flags = (*flags, "--rig", "rig.json")
            run = subprocess.run([TOOL, "--data", "run.csv", "--json", "-", *flags], cwd=folder, capture_output=True,
                                 text=True, encoding="utf-8", timeout=60, check=False)
        self.assertIn(run.returncode, (0, 1), run.stderr)
        VALIDATOR.validate(json.loads(run.stdout))

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


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
