#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks verdicts, summaries and tables on results written by hand. Needs python3-scipy."""

import copy
import dataclasses
import json
import math
import pathlib
import tempfile
import unittest

import numpy

import table_text
from judging import Judged, Outcome, judge, judge_result
from lab import record, textbook_lab
from row_summary import summarize
from scenarios import ROWS, Row

PARAMETER = {"estimate": 10.4, "std_error": 0.1, "interval95": [10.2, 10.6], "systematic_std_error": None, "unit": "s",
             "fixed": False, "at_bound": False}
OWN_FIT = {"parameters": {"initial_angle": {**PARAMETER, "estimate": 1.0}},
           "suspicions": [{"name": "gain", "size": 0.01, "significance": 8.0},
                          {"name": "lag", "size": 0.0, "significance": 0.3, "significant": False}]}
RESULT = {"recordings": [{"window_s": [2.5, 20.0], "fits": [OWN_FIT]}],
          "fits": [{"parameters": {"inertia": PARAMETER},
                    "ambiguities": [{"cause": "a support that yields", "meaning": "more inertia", "experiment": "clamp it"}]}],
          "warnings": [{"code": "zero_drift", "message": "The zero drifts."}]}
ROW = Row("gain_1", "sensor", "gain", "budgeted", lambda lab: None, frozenset({"gain"}),
          parameters=("inertia",))


class Truth:
    """The true values of a recording, and the time at which they were requested."""

    def true_range(self, name, first_stamp):
        self.first_stamp = first_stamp
        return {"inertia": (10.0, 10.0), "initial_angle": (1.1, 1.1)}.get(name)


class JudgeTest(unittest.TestCase):
    def test_z_is_in_total_errors(self):
        self.assertAlmostEqual(judge({**PARAMETER, "interval95": None}, 10.0, 10.0).z, 4)
        with_rig = judge({**PARAMETER, "systematic_std_error": 0.3}, 10.0, 10.0)
        self.assertAlmostEqual(with_rig.z, 0.4 / math.hypot(0.2 / 1.959964, 0.3))
        self.assertTrue(with_rig.is_covered)
        self.assertAlmostEqual(judge({**PARAMETER, "total_std_error": 0.2}, 10.0, 10.0).z, 2)

    def test_interval_decides_about_coverage(self):
        self.assertFalse(judge(PARAMETER, 10.1, 10.1).is_covered)
        self.assertTrue(judge({**PARAMETER, "interval95": [10.0, 10.6]}, 10.1, 10.1).is_covered)

    def test_parameter_at_its_bound_is_judged_by_its_interval(self):
        bound = {**PARAMETER, "estimate": 0.0, "std_error": None, "interval95": [0.0, 0.5], "at_bound": True}
        self.assertTrue(judge(bound, 0.4, 0.4).is_covered)
        self.assertAlmostEqual(judge(bound, 1.0, 1.0).z, -1.959964 * 2)

    def test_total_error_is_that_of_the_interval_if_it_is_wider(self):
        wide = judge({**PARAMETER, "interval95": [9.4, 10.6]}, 10.0, 10.0)
        self.assertAlmostEqual(wide.z, 0.4 / (1.0 / 1.959964))
        self.assertAlmostEqual(wide.relative_error, 0.1 / 1.959964)

    def test_fixed_parameter_and_one_without_error_are_not_judged(self):
        self.assertIsNone(judge({**PARAMETER, "fixed": True}, 10.0, 10.0))
        self.assertIsNone(judge({**PARAMETER, "std_error": None, "interval95": None}, 10.0, 10.0))


class ResultTest(unittest.TestCase):
    def test_start_in_motion_replaces_the_release(self):
        truth = Truth()
        outcome = judge_result(0, RESULT, truth, ("inertia", "release_angle", "release_time"))
        self.assertEqual(set(outcome.judged), {"inertia", "initial_angle"})
        self.assertEqual(truth.first_stamp, 2.5)
        self.assertEqual(outcome.expected, 3)

    def test_only_significant_suspicions_name_a_cause(self):
        outcome = judge_result(0, RESULT, Truth(), ("inertia",))
        self.assertTrue(outcome.is_named({"gain"}))
        self.assertFalse(outcome.is_named({"lag"}))
        self.assertTrue(outcome.is_named({"zero_drift"}))
        self.assertFalse(outcome.is_named({"drift"}))  # a part of a code names nothing
        self.assertFalse(outcome.is_named({"support"}))
        self.assertTrue(outcome.is_remarked({"support"}))
        self.assertTrue(outcome.is_misnamed({"lag"}))
        self.assertTrue(outcome.is_misnamed(frozenset()))  # a false alarm
        self.assertFalse(outcome.is_misnamed({"gain"}))

    def test_constancy_is_tested_if_halves_or_windows_are_compared(self):
        def tested(halves_p, trends):
            result = copy.deepcopy(RESULT)
            own = result["recordings"][0]["fits"][0]
            own["constancy"] = {"halves": {"p": halves_p}, "amplitude": {"trends": trends}}
            return judge_result(0, result, Truth(), ("inertia",)).is_constancy_tested

        self.assertFalse(judge_result(0, RESULT, Truth(), ("inertia",)).is_constancy_tested)
        self.assertTrue(tested(0.4, []))
        self.assertFalse(tested(None, [{"p": None}]))
        self.assertTrue(tested(None, [{"p": 0.2}]))

    def test_fit_that_did_not_converge_is_not_judged(self):
        self.assertEqual(judge_result(1, RESULT, Truth(), ("inertia",)).judged, {})

    def test_moving_start_is_judged_on_the_files_clock(self):
        lab = textbook_lab(3)
        lab.set("clock", drift=0.5)  # 1.5 s of the file in one second
        recording = record(lab)
        self.assertAlmostEqual(recording.true_range("release_time", 0)[0], 1.5 * lab.hand.time)
        self.assertAlmostEqual(recording.true_range("initial_angle", 1.5)[0], lab.hand.angle)

    def test_zero_is_the_reading_at_rest_and_each_value_of_a_drift_is_true(self):
        lab = textbook_lab(3)
        lab.set("sensor", zero=0.1, drift=-0.02)
        lab.set_curve(eccentricity=0.03, eccentric_phase=math.pi / 2)
        low, high = record(lab).true_range("zero_angle", 0)
        self.assertAlmostEqual(low, 0.11)
        self.assertAlmostEqual(high, 0.13)
        self.assertAlmostEqual(judge({**PARAMETER, "interval95": None}, 10.0, 10.3).z, 1)
        self.assertAlmostEqual(judge(PARAMETER, 10.0, 11.0).z, 0)


class SummaryTest(unittest.TestCase):
    def test_is_strict_json_for_numbers_of_numpy(self):
        class NumpyTruth(Truth):
            def true_range(self, name, first_stamp):
                return (numpy.float64(10), numpy.float64(10))

        summary = summarize(ROW, [judge_result(0, RESULT, NumpyTruth(), ("inertia",))])
        self.assertEqual(json.loads(json.dumps(summary, allow_nan=False))["judged"], 1)

    def outcome(self, z, causes=(), exit_code=0, codes=(), parameter=None):
        parameter = {**PARAMETER, "estimate": 10 + 0.1 * z, "interval95": None, **(parameter or {})}
        result = copy.deepcopy(RESULT)
        result["fits"][0]["parameters"] = {"inertia": parameter}
        result["recordings"][0]["fits"] = [{"parameters": {}, "suspicions": [{"name": name} for name in causes]}]
        result["warnings"] = [{"code": code, "message": "A warning."} for code in codes]
        return judge_result(exit_code, result, Truth(), ("inertia",))

    def test_wrong_is_named_or_doubted_or_misnamed_or_silent(self):
        outcomes = [self.outcome(1), self.outcome(-6, ["gain"], codes=["lack_of_fit"]), self.outcome(7, ["lag"]),
                    self.outcome(8), self.outcome(6, codes=["rig_errors_assumed"]),
                    self.outcome(6, ["lag"], codes=["not_constant"])]
        summary = summarize(ROW, outcomes)
        self.assertEqual([summary[key] for key in ("wrong", "named_wrong", "doubted_wrong", "misnamed_wrong", "silent")],
                         [5, 1, 1, 1, 2])
        self.assertEqual([summary[key] for key in ("named", "doubted", "misnamed")], [1, 2, 2])
        self.assertEqual(summary["z"]["inertia"]["largest"], 8)
        self.assertIn("2 silently wrong", summary["fails"])
        self.assertIn("1 wrong, with another cause named", summary["fails"])

    def test_remark_of_every_report_does_not_end_the_silence(self):
        row = dataclasses.replace(ROW, kind="inherent", group="friction", names=frozenset({"support"}))
        outcome = self.outcome(40, parameter={"unseen_friction_std_error": 2.0})
        summary = summarize(row, [outcome])
        self.assertEqual((summary["silent"], summary["remarked"], summary["named"]), (1, 1, 0))
        self.assertTrue(outcome.is_unseen)
        self.assertFalse(Outcome(1, 1).is_unseen)

    def test_error_of_a_zero_is_counted_apart(self):
        row = dataclasses.replace(ROW, parameters=("inertia", "zero_angle"))
        outcome = self.outcome(0)
        outcome.judged["zero_angle"] = Judged(-9.0, False, 0.01)
        summary = summarize(row, [outcome])
        self.assertEqual((summary["wrong"], summary["silent_start"]), (0, 1))
        self.assertIn("1 silently wrong about the start", summary["fails"])

    def test_row_without_fits_fails(self):
        summary = summarize(ROW, [self.outcome(0, exit_code=1), Outcome(-1, 1)])
        self.assertEqual((summary["not_converged"], summary["failed"], summary["coverage"]), (1, 1, None))
        self.assertEqual(summary["doubted"], 1)
        self.assertIn("inertia without an error in 2", summary["fails"])

    def test_row_in_which_the_tool_withdraws_its_errors_fails(self):
        withdrawn = {"std_error": None, "interval95": None}
        summary = summarize(ROW, [self.outcome(0)] * 8 + [self.outcome(0, parameter=withdrawn)] * 2)
        self.assertIn("inertia without an error in 2", summary["fails"])

    def test_errors_that_contain_everything_fail(self):
        summary = summarize(ROW, [self.outcome(1, parameter={"systematic_std_error": 6.0})] * 3)
        self.assertEqual(summary["wrong"], 0)
        self.assertAlmostEqual(summary["z"]["inertia"]["rms"], 0.1 / 6, delta=1e-4)
        self.assertAlmostEqual(summary["z"]["inertia"]["relative_error"], 0.6, delta=1e-3)
        self.assertIn("inertia ± 60 %", summary["fails"])
        noise = summarize(ROW, [self.outcome(1, parameter={"systematic_std_error": 4.0})] * 3)
        wide = [self.outcome(1, parameter={"systematic_std_error": 6.0})] * 3
        self.assertEqual(summarize(ROW, wide, noise)["fails"], [])

    def test_false_alarms_fail_a_row_in_which_nothing_is_wrong(self):
        row = dataclasses.replace(ROW, kind="clean", names=frozenset())
        self.assertIn("2 false alarms", summarize(row, [self.outcome(0, ["lag"])] * 2 + [self.outcome(0)] * 8)["fails"])
        misled = [self.outcome(0, ["lag"])] * 2
        self.assertIn("2 with another cause named", summarize(ROW, misled + [self.outcome(0)] * 8)["fails"])
        doubtful = [self.outcome(0, codes=["lack_of_fit"])] * 2
        self.assertIn("2 false doubts", summarize(row, doubtful + [self.outcome(0)] * 8)["fails"])

    def test_inherent_row_is_judged_by_the_recordings_without_a_warning(self):
        row = dataclasses.replace(ROW, kind="inherent")
        self.assertEqual(summarize(row, [self.outcome(30, ["gain"])] * 9 + [self.outcome(0)])["fails"], [])
        self.assertIn("coverage 0.10", summarize(row, [self.outcome(3)] * 9 + [self.outcome(0)])["fails"])

    def test_row_of_covered_estimates_passes(self):
        self.assertEqual(summarize(ROW, [self.outcome(z) for z in (0.1, -1.0, 1.5, 0.7)])["fails"], [])

    def test_every_row_names_a_cause_or_has_none_to_name(self):
        for row in ROWS.values():
            self.assertTrue(row.names or row.kind in ("exact", "clean") or row.name.startswith("event_log"), row.name)

    def test_every_row_is_compared_with_one_in_which_nothing_is_wrong(self):
        for row in ROWS.values():
            self.assertEqual(ROWS[row.reference].kind, "exact", row.name)

    def test_errors_are_compared_with_those_of_noise(self):
        noise = summarize(dataclasses.replace(ROW, name="exact_white"), [self.outcome(0)])
        wide = summarize(ROW, [self.outcome(0, parameter={"systematic_std_error": math.sqrt(99) / 10})])
        self.assertEqual(table_text.cells(wide, [noise, wide])[3], "10, -, -")


class TableTest(unittest.TestCase):
    def test_update_writes_the_rows_of_the_group_between_the_marks(self):
        summary = summarize(ROW, [SummaryTest().outcome(6)])
        with tempfile.TemporaryDirectory() as folder:
            table, page = pathlib.Path(folder, "TABLE.json"), pathlib.Path(folder, "page.md")
            table.write_text(json.dumps({"rows": [summary]}), encoding="utf-8")
            head = "<!-- output: tests/simulator/table_text.py tests/simulator/TABLE.json {} -->\n"
            page.write_text("a\n" + head.format("sensor") + "old\n<!-- end -->\n" + head.format("hand") + "<!-- end -->\n",
                            encoding="utf-8")
            table_text.update(page, table)
            text = page.read_text(encoding="utf-8")
        self.assertIn("| gain | 1 | 1 | 0 | 0 | 0 | 0.00 | 6, -, - | 1, -, - % | -, -, - |", text)
        self.assertEqual(text.count("| gain |"), 1)
        self.assertNotIn("old", text)


if __name__ == "__main__":
    unittest.main()
