#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests scripts/compare_builds on results of schema versions 2 and 3 that are written here. Needs python3-jsonschema."""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "scripts"))

from result_schema_3 import with_schema_3  # noqa: E402, because the path comes first

VALIDATOR = jsonschema.Draft202012Validator(json.loads((TOP / "include/pendulum/report/result.schema.json").read_text()))
SHARED = {"inertia": 0.08, "viscous": 0.003}
START = {"release_angle": 0.4, "release_time": 1.5, "zero_angle": 0.01}
NO_FORMS = "only 2 turning points can be located"


def parameter(value):
    return {"estimate": value, "std_error": 0.1, "interval95": [0, 1], "systematic_std_error": None, "unit": "1", "fixed": False,
            "at_bound": False}


def numbers_of(values):
    """The parameters with these estimates, and what there is beside them. Each entry of a matrix differs from the others."""
    names = list(values)
    matrix = {"names": names, "matrix": [[10 * i + j for j in range(len(names))] for i in range(len(names))]}
    rows = [{"parameter": name, "verdict": "identifiable", "direction": [], "advice": None} for name in names]
    return {"parameters": {name: parameter(value) for name, value in values.items()}, "covariance": matrix, "correlation": matrix,
            "systematic_covariance": {"names": names[1:], "matrix": [row[1:] for row in matrix["matrix"][1:]]},
            "std_error_method": "covariance", "identifiability": rows}


def of_one_swing(effective_samples):
    """The members that belong to one swing."""
    noise = {"model": "gaussian", "reason": "no resolution", "sigma_rad": 0.001, "sigma_std_error": 1e-5, "resolution_rad": None,
             "saturated_samples": 0, "lag1_correlation": 0.1, "correlation": "white"}
    statistics = {"rms_residual_rad": 0.001, "log_likelihood": 50, "aic": -90, "aicc": -89, "bic": -80, "durbin_watson": 2.1,
                  "ljung_box_p": 0.4, "runs_p": 0.5, "effective_samples": effective_samples}
    return {"noise": noise, "statistics": statistics, "closed_form": [], "constancy": None, "constancy_reason": "too short"}


def data(path, release):
    return {"path": path, "sha256": None, "samples": 100, "used_samples": 90, "duration_s": 9, "sample_rate_hz": 10,
            "resolution_rad": None, "resolution_source": None, "clock_scale": 1, "clock_scale_std_dev": 0, "sensor": None,
            "window_s": [1, 10], "window_reason": None, "releases": [], "release": release, "start": "release", "sampling": None}


def result(**parts):
    warnings = [{"code": "lack_of_fit", "message": "the residuals are more than noise"}]
    return {"schema_version": 2, "tool": {"name": "fit_pendulum", "version": "0.1.0"}, "rig": None, "comparison": None,
            "warnings": warnings, "reason": NO_FORMS, **parts}


FIT = {"model": "viscous", "status": "converged", "reason": "converged", "equation": "th'' = 0", "derived": {},
       "interval_method": None, "solver": {"iterations": 3, "evaluations": 4, "termination": "done", "attempts": []}}
ONE = result(
    data=data("a.csv", 1), calibration=None, closed_forms=None,
    fits=[{**FIT, **numbers_of({**SHARED, **START}), **of_one_swing(90), "suspicions": [], "ambiguities": []}])
SEVERAL = result(
    data=[data("a.csv", 1), data("b.csv", 2)], calibration=[None, {"input": "volts"}], closed_forms=[None, None],
    fits=[{**FIT, **numbers_of({"inertia": 0.08}), "shared": ["inertia"],
           "statistics": {key: 1 for key in ("log_likelihood", "aic", "aicc", "bic", "effective_samples")},
           "homogeneity": {"statistic": None, "dof": 0, "p": None, "agrees": None, "outliers": [], "verdict": "not compared",
                           "parameters": {}, "amplitude_dependence": [], "reason": "all are fixed"},
           "runs": [{"path": "a.csv", "release": 1, "amplitude_rad": 0.2, **numbers_of({**SHARED, **START}), **of_one_swing(90),
                     "separate": "converged"},
                    {"path": "b.csv", "release": 2, "amplitude_rad": None, **numbers_of({**SHARED, **START, "viscous": 0.004}),
                     **of_one_swing(80), "separate": "failed: no swing"}]}])


def estimates(part):
    return {name: each["estimate"] for name, each in part["parameters"].items()}


def rated(part):
    return [row["parameter"] for row in part["identifiability"]]


class Schema3Test(unittest.TestCase):
    def test_one_recording(self):
        new = with_schema_3(ONE)
        VALIDATOR.validate(new)
        (recording,), (fit,), (own,) = new["recordings"], new["fits"], new["recordings"][0]["fits"]
        self.assertEqual((recording["path"], recording["release"], recording["reason"]), ("a.csv", 1, NO_FORMS))
        self.assertEqual((estimates(fit), estimates(own)), (SHARED, START))
        self.assertEqual((rated(fit), rated(own)), (list(SHARED), list(START)))
        self.assertEqual((fit["shared"], fit["homogeneity"]), (list(SHARED), None))
        self.assertEqual(fit["covariance"], {"names": ["inertia", "viscous"], "matrix": [[0, 1], [10, 11]]})
        self.assertEqual(fit["systematic_covariance"], {"names": ["viscous"], "matrix": [[11]]})
        self.assertEqual(own["covariance"], ONE["fits"][0]["covariance"])
        self.assertNotIn("runs_p", fit["statistics"])
        for key in ("noise", "statistics", "constancy_reason", "suspicions"):
            self.assertEqual(own[key], ONE["fits"][0][key])
        self.assertEqual((fit["ambiguities"], own["separate"], own["amplitude_rad"]), ([], "converged", None))

    def test_several_recordings(self):
        new = with_schema_3(SEVERAL)
        VALIDATOR.validate(new)
        (fit,), (first, second) = new["fits"], new["recordings"]
        self.assertEqual((first["path"], second["path"]), ("a.csv", "b.csv"))
        self.assertEqual((first["calibration"], second["calibration"]), (None, {"input": "volts"}))
        self.assertEqual((fit["shared"], estimates(fit)), (["inertia"], {"inertia": 0.08}))
        self.assertEqual(fit["homogeneity"], SEVERAL["fits"][0]["homogeneity"])
        (own,) = first["fits"]
        self.assertEqual((estimates(own), own["amplitude_rad"]), ({"viscous": 0.003, **START}, 0.2))
        self.assertEqual(own["covariance"]["names"], [*SHARED, *START])
        (own,) = second["fits"]
        self.assertEqual((estimates(own)["viscous"], own["statistics"]["effective_samples"]), (0.004, 80))
        self.assertEqual((own["model"], own["separate"]), ("viscous", "failed: no swing"))
        self.assertNotIn("path", own)

    def test_a_failed_fit_and_none(self):
        failed = copy.deepcopy(ONE)
        failed["fits"][0].update(status="failed", reason="no trajectory", equation=None, noise=None, statistics=None)
        new = with_schema_3(failed)
        VALIDATOR.validate(new)
        self.assertEqual(new["recordings"][0]["fits"][0]["separate"], "failed: no trajectory")
        new = with_schema_3({**ONE, "fits": [], "data": {**ONE["data"], "start": None}})
        VALIDATOR.validate(new)
        self.assertEqual((new["fits"], new["recordings"][0]["fits"]), ([], []))

    def test_a_result_of_version_3_stays(self):
        new = with_schema_3(ONE)
        self.assertIs(with_schema_3(new), new)


class CompareTest(unittest.TestCase):
    def compare(self, old, new, *flags):
        """Exit code and the lines of differences."""
        with tempfile.TemporaryDirectory() as folder:
            for name, kept in (("old", old), ("new", new)):
                (pathlib.Path(folder) / name).mkdir()
                (pathlib.Path(folder) / name / "case.json").write_text(json.dumps(kept))
            done = subprocess.run([sys.executable, "-B", TOP / "scripts/compare_builds", "compare", "old", "new", *flags], cwd=folder,
                                  capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout.splitlines()[:-1]

    def test_old_results_are_compared_in_the_new_form(self):
        for old in (ONE, SEVERAL):
            new = with_schema_3(old)
            self.assertEqual(self.compare({"json": old, "series": {"unit": "rad"}}, {"json": new, "series": [{"unit": "rad"}]}), (0, []))
            self.assertEqual(self.compare({"json_001": old}, {"json_001": new}), (0, []))
            self.assertEqual(self.compare({"rows": [{"result": old}]}, {"rows": [{"result": new}]}), (0, []))
            self.assertEqual(self.compare({"json": old}, {"json": old}), (0, []))

    def test_differences_are_named_where_they_are_now(self):
        new = with_schema_3(copy.deepcopy(ONE))
        new["recordings"][0]["fits"][0]["noise"]["sigma_rad"] = 0.002
        place = "case.json.json.recordings[0].fits[0]"
        self.assertEqual(self.compare({"json": ONE}, {"json": new}), (1, [f"{place}.noise.sigma_rad: 0.001, now 0.002"]))

    def test_the_amplitude_of_one_recording_is_an_added_key(self):
        new = with_schema_3(copy.deepcopy(ONE))
        new["recordings"][0]["fits"][0]["amplitude_rad"] = 0.3
        self.assertEqual(self.compare({"json": ONE}, {"json": new})[0], 1)
        self.assertEqual(self.compare({"json": ONE}, {"json": new}, "--added", "amplitude_rad"), (0, []))
        several = with_schema_3(copy.deepcopy(SEVERAL))
        several["recordings"][0]["fits"][0]["amplitude_rad"] = 0.3  # was 0.2
        self.assertEqual(self.compare({"json": SEVERAL}, {"json": several}, "--added", "amplitude_rad")[0], 1)

    def test_rows_of_a_batch_that_are_missing(self):
        rows = [{"id": "a", "result": ONE}, {"id": "b", "result": None}]
        self.assertEqual(self.compare({"rows": rows}, {"rows": [{"id": "a", "result": with_schema_3(ONE)}]}),
                         (1, ["case.json.rows: 2 entries, now 1"]))

    def test_no_result_in_common(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-B", TOP / "scripts/compare_builds", "compare", folder, folder],
                                  capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (2, "compare_builds: the two folders have no result in common\n"))


if __name__ == "__main__":
    unittest.main()
