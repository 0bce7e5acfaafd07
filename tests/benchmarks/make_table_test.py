#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the table of benchmarks from numbers whose ratios were calculated by hand."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import make_table

SCRIPT = pathlib.Path(make_table.__file__)
OURS, THEIRS, FLOOR = "sensitivities/coulomb/release", "smoothed_rk4/sensitivities", "floor/sensitivities"


def runs(name, times, unit="us", **counters):
    """A benchmark's repetitions as Google Benchmark prints them, followed by their aggregates."""
    return [
        *({"name": name, "run_name": name, "run_type": "iteration", "cpu_time": time, "real_time": 7 * time,
           "time_unit": unit, **counters} for time in times),
        {"name": name + "_median", "run_name": name, "run_type": "aggregate", "cpu_time": 1e9, "time_unit": unit}]


def fit(*seconds):
    """A fit as scipy_users.py prints it."""
    return {"version": "1.10.1", "seconds": seconds, "evaluations": 150, "estimates": {"viscous": 0.0027},
            "relative_errors": {"viscous": 0.1}}


def everything():
    """All benchmarks of the table, at 10 us each."""
    names = {row.name for row in make_table.rows()} - {"scipy", "lmfit"}
    names = [name.replace("error:*", "error:5e-7").replace("*", "1") for name in sorted(names)]
    return [run for name in names for run in runs(name, [10.0], max_error_rad=1e-9, bytes_per_sample=48.0,
                                                share_of_cores=0.9)]


def measured(benchmarks):
    return make_table.benchmark_times({"benchmarks": benchmarks})[0]


class RatioTest(unittest.TestCase):
    def test_ratio_of_medians_and_quartiles_of_all_pairs(self):
        # 660 / 110; the pairs are 5, 5.45, 5.5, 6, 6, 6.6, 10, 10.9, 12. The third and the seventh bound the middle
        # half.
        found = measured(runs(OURS, [100, 120, 110]) + runs(THEIRS, [1.2, 0.6, 0.66], "ms"))
        value, spread = make_table.ratio(found[THEIRS], found[OURS])
        self.assertAlmostEqual(value, 6)
        self.assertAlmostEqual(spread[0], 5.5)
        self.assertAlmostEqual(spread[1], 10)

    def test_a_counter_is_the_median_of_its_repetitions(self):
        found = measured([run for share in (0.9, 0.2, 0.8) for run in runs("batch/refit", [1], share_of_cores=share)])
        self.assertEqual(found["batch/refit"]["share_of_cores"], 0.8)

    def test_one_repetition_has_no_spread(self):
        found = measured(runs(OURS, [100]) + runs(THEIRS, [500]))
        self.assertEqual(make_table.ratio(found[THEIRS], found[OURS]), (5, [5, 5]))

    def test_instructions_of_one_more(self):
        lines = ["fit\t5\t1500", "fit\t25\t3500", "half\t5\t1500"]
        self.assertEqual(make_table.instructions_each(lines), {"fit": 100})  # 2000 / 20


class RequirementTest(unittest.TestCase):
    def results(self, *benchmarks):
        found = measured([run for benchmark in benchmarks for run in benchmark])
        found.update(make_table.python_times({"scipy": fit(4.0, 6.0, 5.0), "lmfit": fit(4.0)}))
        return {one["what"]: one for one in make_table.collect(found, {})["required"] if "value" in one}

    def check(self, result, value, met):
        self.assertAlmostEqual(result["value"], value)
        self.assertEqual(result["met"], met)

    def test_speed_and_accuracy_of_sensitivities(self):
        results = self.results(runs(make_table.WITHIN_1E8, [100], max_error_rad=2e-8), runs(THEIRS, [490]))
        self.check(results["sensitivities: times faster than smoothed_rk4"], 4.9, False)
        self.check(results["sensitivities: largest error of the trajectory [rad]"], 2e-8, False)

    def test_ratio_of_inlined_code_has_no_target(self):
        result = self.results(runs(make_table.WITHIN_1E8, [100]), runs("smoothed_rk4_flattened/sensitivities", [217]))[
            "sensitivities: times faster than smoothed_rk4 with every call inlined ([[gnu::flatten]])"]
        self.assertAlmostEqual(result["value"], 2.17)
        self.assertNotIn("met", result)
        self.assertEqual(make_table.requirement_text(result), f"| {result['what']} | none | 2.17 (2.17 to 2.17) |  |")

    def test_stretch(self):
        result = self.results(runs("fit", [100]), runs("smoothed_rk4/solve", [700]))[
            "fit: times faster than smoothed_rk4's solve"]
        self.check(result, 7, True)
        self.assertEqual((result["stretch"], result["stretch_met"]), ("≥ 10", False))

    def test_a_refit_of_the_bootstrap(self):
        # One fit of 10 us and 999 refits of 4 us.
        results = self.results(runs("fit", [10]), runs("bootstrap", [4006]))
        self.check(results["bootstrap: time of one of the 999 refits, relative to a fit"], 0.4, True)

    def test_cost_linear_in_samples(self):
        results = self.results(runs("fit/samples:100000", [2.5], "ms"), runs("fit/samples:1000000", [30], "ms"))
        self.check(results["time per sample in a fit of 10^6 samples, relative to a fit of 10^5"], 1.2, True)

    def test_speed_relative_to_python(self):
        results = self.results(runs("file_to_json", [4], "ms"))
        self.check(results["file to JSON: times faster than SciPy's fit"], 1250, True)
        self.check(results["file to JSON: times faster than lmfit's fit"], 1000, True)

    def test_memory(self):
        results = self.results(runs("fit_memory/samples:1000000/iterations:1", [1], bytes_per_sample=200.0))
        self.check(results["memory of a fit of 10^6 samples [bytes per sample]"], 200, False)


class TextTest(unittest.TestCase):
    def test_row(self):
        found = measured(runs(OURS, [100], max_error_rad=8.5e-11) + runs(THEIRS, [1.5], "ms") + runs(FLOOR, [40]))
        result = make_table.row_result(make_table.Row(OURS, THEIRS, FLOOR), found)
        self.assertEqual(make_table.row_text(result),
                         f"| `{OURS}` | 100 µs | 15.0 (15.0 to 15.0) | 2.50 | 8.5e-11 rad |")

    def test_times(self):
        self.assertEqual([make_table.time_text(time) for time in (0.25, 43.21, 1270, 6.5e6)],
                         ["0.250 µs", "43.2 µs", "1.27 ms", "6.50 s"])

    def test_filter_matches_whole_names(self):
        pattern = make_table.benchmark_filter()
        for name in (OURS, "fit", "fit_memory/samples:1000000/iterations:1", "sensitivities/max_trace_error:1e-6"):
            self.assertTrue(re.search(pattern, name), name)
        for name in ("sensitivities/drag/release", "floor/sensitivities/portable/samples:1000000",
                     "fit_jointly/white_2.5/recordings:2", "fit/counts:0x5/gaussian"):
            self.assertFalse(re.search(pattern, name), name)

    def test_expanded_rows_are_sorted_by_their_number(self):
        found = measured([run for error in ("1e-06", "0.001", "1e-12")
                          for run in runs(f"sensitivities/max_trace_error:{error}", [1])] + runs(OURS, [1]))
        expanded = make_table.expand(make_table.Row("sensitivities/max_trace_error:*"), found)
        self.assertEqual([row.name.rpartition(":")[2] for row in expanded], ["1e-12", "1e-06", "0.001"])


class ProcessTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, benchmarks):
        """Exit code, complaints and RESULTS.md."""
        context = {"date": "2026-01-31T12:00:00+00:00", "load_avg": [0.5]}
        for name, text in {
                "benchmarks": json.dumps({"context": context, "benchmarks": benchmarks}),
                "scipy": json.dumps({"scipy": fit(7.0), "lmfit": fit(6.0)}),
                "instructions": "".join(f"{what}\t{count}\t{100 * count}\n" for what in make_table.HOT_PATHS
                                        for count in (5, 25)),
                "binary": "\0GCC: (Debian 12.2.0-14) 12.2.0\0"}.items():
            (self.folder / name).write_text(text)
        files = [part for name in ("benchmarks", "scipy", "instructions", "binary")
                 for part in (f"--{name}", self.folder / name)]
        done = subprocess.run([sys.executable, "-B", SCRIPT, *files, "--command", "scripts/benchmark", "--out",
                               self.folder], capture_output=True, text=True)
        table = self.folder / "RESULTS.md"
        return done.returncode, done.stderr, table.read_text() if table.exists() else ""

    def test_a_complete_table(self):
        code, complaints, table = self.make(everything())
        self.assertEqual((code, complaints), (0, ""))
        self.assertNotIn("missing", table)
        self.assertIn("GCC: (Debian 12.2.0-14) 12.2.0; 2026-01-31", table)
        self.assertIn("| sensitivities: times faster than smoothed_rk4 | ≥ 5 | 1.00 (1.00 to 1.00) | **missed** |",
                      table)
        self.assertEqual(json.loads((self.folder / "RESULTS.json").read_text())["instructions"]["fit"], 100)

    def test_missing_benchmarks_are_named(self):
        code, complaints, table = self.make([run for run in everything() if run["run_name"] != THEIRS])
        self.assertEqual(code, 1)
        self.assertIn(f"make_table: the benchmark {THEIRS} is missing.\n", complaints)
        self.assertIn("'sensitivities: times faster than smoothed_rk4' could not be measured", complaints)
        self.assertIn(f"| `{THEIRS}` | missing |", table)

    def test_failed_benchmarks_are_named(self):
        failed = {"run_name": THEIRS, "run_type": "iteration", "error_occurred": True, "error_message": "no trajectory"}
        code, complaints, _ = self.make([run for run in everything() if run["run_name"] != THEIRS] + [failed])
        self.assertEqual(code, 1)
        self.assertIn(f"{THEIRS} failed: no trajectory", complaints)

    def test_flags(self):
        done = subprocess.run([sys.executable, "-B", SCRIPT, "--out", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--benchmarks is missing", done.stderr)


if __name__ == "__main__":
    unittest.main()
