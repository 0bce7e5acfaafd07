#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of refit_pendulums as a process: refit_pendulums_cli_test.py PATH_OF_THE_TOOL."""

import contextlib
import csv
import json
import os
import pathlib
import pty
import resource
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

import jsonschema

from refit_lab import DATASETS, Lab, RIG, SIMULATED, TIMEOUT_S, TOOL, TOOLS, as_nobody, sound
from sanitizers import is_sanitized, memory_limit

sys.path.insert(0, str(DATASETS.parent / "scripts"))

from result_schema_3 import with_schema_3  # noqa: E402, because the path comes first

SCHEMA = DATASETS.parent / "include/pendulum/report/result.schema.json"

# Number of runs, enough that some are in progress for seconds; and how often a tool is killed.
MANY = 24 if is_sanitized(TOOL) else 120
KILLS = 5 if is_sanitized(TOOL) else int(os.environ.get("PENDULUM_KILLS", "50"))
PENDULUMS = 24 if is_sanitized(TOOL) else 200


def exact(text):
    """JSON with its numbers as text, so that equal means bit for bit."""
    return json.loads(text, parse_float=str, parse_int=str)


class SameAsFitPendulum(Lab):
    """The store has the same results as fit_pendulum for each file, bit for bit, for any processes and any order."""

    def fitted(self, path, *more):
        done = subprocess.run([TOOLS / "fit_pendulum", "--data", self.folder / path, "--model", "viscous,coulomb", "--json", "-",
                               *more], capture_output=True, text=True, timeout=TIMEOUT_S)
        result = exact(done.stdout)
        result["recordings"][0]["path"] = path
        return result, done.returncode

    def test_results_equal_those_of_fit_pendulum(self):
        paths = self.simulate(6)
        shutil.copy(DATASETS / "textbook_rig.csv", self.folder)
        manifest = self.manifest([{"path": path, "rig": str(RIG)} for path in paths] +
                                 [{"path": paths[0], "id": "window", "rig": str(RIG), "from_s": "0.1", "to_s": "5"},
                                  {"path": "textbook_rig.csv", "id": "none"}])
        self.refit(manifest, "a.sqlite", "--seed", "7", "--noise", "gaussian")
        with sqlite3.connect(self.folder / "a.sqlite") as database:
            stored = {row[0]: (exact(row[1]), row[2]) for row in database.execute("SELECT id, result, exit_code FROM runs")}
        self.assertEqual(len(stored), 8)
        flags = {"window": ["--from", "0.1", "--to", "5", "--rig", RIG], "none": []}
        for run, (result, code) in stored.items():
            path = {"window": paths[0], "none": "textbook_rig.csv"}.get(run, run)
            expected, expected_code = self.fitted(path, "--seed", "7", "--noise", "gaussian", *flags.get(run, ["--rig", RIG]))
            self.assertEqual(result, expected, run)
            self.assertEqual(code, expected_code, run)

    def test_columns_equal_the_result_json(self):
        self.refit(self.manifest(self.simulate(2)), "a.sqlite")
        stored = self.rows("a.sqlite")
        for (table, run, model, name), row in stored.items():
            run_row = stored["runs", run, None, None]
            result = json.loads(run_row["result"])
            if table == "runs":
                self.assertEqual(row["data_sha256"], result["recordings"][0]["sha256"])
                self.assertEqual(row["recommended"], result["comparison"]["recommended"])
                continue
            fit, own = next(pair for pair in zip(result["fits"], result["recordings"][0]["fits"]) if pair[0]["model"] == model)
            if table == "fits":
                self.assertEqual((row["status"], row["bic"], row["rms_residual"], row["residual_unit"]),
                                 (fit["status"], fit["statistics"]["bic"], fit["statistics"]["rms_residual_rad"], "rad"))
            else:
                quantity = {**fit["parameters"], **own["parameters"], **fit["derived"]}[name]
                self.assertEqual((row["estimate"], row["std_error"], row["unit"]),
                                 (quantity["estimate"], quantity["std_error"], quantity["unit"]), name)

    def test_rows_do_not_depend_on_threads_shards_order_or_packing(self):
        paths = self.simulate(9)
        paths.insert(4, "runs/missing.csv")
        manifest = self.manifest(paths)
        self.refit(manifest, "one.sqlite", "--threads", "1", code=3)
        expected = self.rows("one.sqlite")
        self.refit(manifest, "five.sqlite", "--threads", "5", code=3)
        self.assertEqual(self.rows("five.sqlite"), expected)
        for shard in (2, 0, 1):
            (self.folder / "out").mkdir(exist_ok=True)
            self.refit(manifest, f"out/shard-{shard}.sqlite", "--shard", f"{shard}/3")
        self.run_tool("merge", "--shard_dir", "out", "--shard_count", "3", "--store", "merged.sqlite", code=3)
        self.assertEqual(self.rows("merged.sqlite"), expected)
        self.run_tool("pack", "--manifest", manifest, "--out", "runs.pack")
        shutil.rmtree(self.folder / "runs")
        self.refit("runs.pack", "packed.sqlite", code=3)
        self.assertEqual(self.rows("packed.sqlite"), expected)
        self.simulate(9)
        self.refit(self.manifest(paths[::-1], "reversed.csv"), "reversed.sqlite", code=3)
        turned = self.rows("reversed.sqlite")
        for row in (*turned.values(), *expected.values()):
            row.pop("position", None)
        self.assertEqual(turned, expected)


class Interruptions(Lab):
    """No run is lost, and none is stored twice."""

    def test_a_refit_killed_at_random_moments_ends_with_the_same_store(self):
        manifest = self.manifest(self.simulate(MANY))
        begin = time.monotonic()
        self.refit(manifest, "whole.sqlite")
        needed = time.monotonic() - begin
        finished = 0
        for kill in range(KILLS):
            # Moments over the whole run, including commits; multiples of the golden ratio act as random numbers.
            process = self.start("--manifest", manifest, "--models", "viscous,coulomb", "--store", "killed.sqlite")
            try:
                process.wait(timeout=0.02 + needed * ((0.618 * (kill + 1)) % 1) / 4)
                finished += 1
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
            process.communicate()
            if (self.folder / "killed.sqlite").exists():
                self.assertTrue(sound(self.folder / "killed.sqlite"))
        self.assertLess(finished, 0.75 * KILLS)
        self.refit(manifest, "killed.sqlite")
        self.assertEqual(self.rows("killed.sqlite"), self.rows("whole.sqlite"))

    def test_ctrl_c_keeps_finished_runs_and_reports_the_number_left(self):
        manifest = self.manifest(self.simulate(MANY))
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 75)):
            process = self.start("--manifest", manifest, "--models", "viscous,coulomb", "--store", "stopped.sqlite", "--force")
            self.wait_for("stopped.sqlite.lock")
            time.sleep(0.2)
            process.send_signal(number)
            _, said = process.communicate(timeout=TIMEOUT_S)
            self.assertEqual(process.returncode, code, said)
            self.assertRegex(said, r"are left; run the same command to continue")
        self.refit(manifest, "stopped.sqlite")
        self.refit(manifest, "whole.sqlite")
        self.assertEqual(self.rows("stopped.sqlite"), self.rows("whole.sqlite"))

    def test_refits_only_what_changed(self):
        paths = self.simulate(5)
        rig = self.folder / "rig.json"
        shutil.copy(RIG, rig)
        entries = [{"path": path, "rig": "rig.json" if i == 1 else str(RIG)} for i, path in enumerate(paths)]
        manifest = self.manifest(entries)
        self.assertIn("5 runs tried, 0 were current", self.refit(manifest, "a.sqlite")[1])
        self.assertIn("0 runs tried, 5 were current", self.refit(manifest, "a.sqlite")[1])
        with open(self.folder / paths[0], "a", encoding="utf-8") as file:
            file.write("# another byte\n")
        self.assertIn("1 run tried, 4 were current", self.refit(manifest, "a.sqlite")[1])
        rig.write_text(rig.read_text() + "\n")
        self.assertIn("1 run tried, 4 were current", self.refit(manifest, "a.sqlite")[1])
        entries[2]["to_s"] = "5"
        self.assertIn("1 run tried, 4 were current", self.refit(self.manifest(entries), "a.sqlite")[1])
        self.assertIn("5 runs tried", self.refit(manifest, "a.sqlite", "--interval", "profile")[1])
        self.assertIn("5 runs tried", self.refit(manifest, "a.sqlite", "--interval", "profile", "--force")[1])

    def test_results_stay_when_their_recordings_are_gone(self):
        files = self.simulate(4)
        manifest = self.manifest(files)
        self.refit(manifest, "a.sqlite")
        before = self.rows("a.sqlite")
        (self.folder / files[0]).parent.rename(self.folder / "elsewhere")
        out, messages = self.refit(manifest, "a.sqlite", code=3)
        self.assertIn("4 keep a former result", messages)
        self.assertIn("0 of 4 recordings fitted; 4 with a former result only", " ".join(out.split()))
        (self.folder / "elsewhere").rename((self.folder / files[0]).parent)
        self.assertIn("0 runs tried, 4 were current", self.refit(manifest, "a.sqlite")[1])
        self.assertEqual(self.rows("a.sqlite"), before)

    def test_a_full_disk_is_reported_and_the_store_stays_valid(self):
        manifest = self.manifest(self.simulate(60))
        self.refit(manifest, "whole.sqlite")
        small = self.folder / "small"
        small.mkdir()
        kilobytes = (self.folder / "whole.sqlite").stat().st_size // 2048
        # A file system of half the store's size; its mount namespace ends with the process.
        script = (f'mount -t tmpfs -o size={kilobytes}k none "{small}" && "{TOOL}" --manifest {manifest} --models viscous,coulomb '
                  f'--store small/a.sqlite; code=$?; cp small/a.sqlite full.sqlite; exit $code')
        command = ["unshare", "--mount"] + ([] if os.geteuid() == 0 else ["--user", "--map-root-user"])
        done = subprocess.run([*command, "sh", "-c", script], cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 73, done.stderr)
        self.assertRegex(done.stderr, r"cannot write small/a.sqlite: .*full")
        stored = self.rows("full.sqlite")
        self.assertEqual(sum(key[0] == "runs" for key in stored), 60)
        self.refit(manifest, "full.sqlite")
        self.assertEqual(self.rows("full.sqlite"), self.rows("whole.sqlite"))

    def test_a_file_size_limit_is_reported_like_a_full_disk(self):
        manifest = self.manifest(self.simulate(60))
        _, said = self.refit(manifest, "a.sqlite", code=73,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (300000, 300000)))
        self.assertIn("cannot write a.sqlite", said)
        self.refit(manifest, "a.sqlite")
        self.refit(manifest, "whole.sqlite")
        self.assertEqual(self.rows("a.sqlite"), self.rows("whole.sqlite"))

    def test_a_read_only_store_is_reported_and_unchanged(self):
        manifest = self.manifest(self.simulate(2))
        self.refit(manifest, "a.sqlite")
        before = (self.folder / "a.sqlite").read_bytes()
        (self.folder / "a.sqlite").chmod(0o444)
        self.folder.chmod(0o555)
        self.addCleanup(self.folder.chmod, 0o755)
        _, said = self.refit(manifest, "a.sqlite", "--force", code=73, preexec_fn=as_nobody)
        self.assertIn("cannot write a.sqlite", said)
        self.assertEqual((self.folder / "a.sqlite").read_bytes(), before)
        out, _ = self.run_tool("status", "--store", "a.sqlite", preexec_fn=as_nobody)
        self.assertIn("2 of 2 recordings fitted.", out)

    def test_a_store_in_use_exits_75(self):
        manifest = self.manifest(self.simulate(MANY))
        process = self.start("--manifest", manifest, "--models", "viscous,coulomb", "--store", "a.sqlite")
        self.wait_for("a.sqlite.lock")
        _, said = self.refit(manifest, "a.sqlite", code=75)
        self.assertIn("another process writes to this file", said)
        self.assertIn("[[Runs]]", self.run_tool("status", "--details", "--store", "a.sqlite")[0])
        process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(process.returncode, 0)
        self.assertFalse((self.folder / "a.sqlite.lock").exists())


class HostileManifests(Lab):
    """A wrong manifest is refused with its line before any fit; wrong files cost only their own rows."""

    def test_files_that_cannot_be_fitted_are_rows_with_reasons(self):
        good = self.simulate(1)[0]
        (self.folder / "empty.csv").touch()
        (self.folder / "binary.csv").write_bytes(bytes(range(256)) * 50)
        (self.folder / "text.csv").write_text("time_s,angle_deg\n0,zero\n")
        (self.folder / "folder.csv").mkdir()
        os.mkfifo(self.folder / "pipe.csv")
        manifest = self.manifest([good, "missing.csv", "empty.csv", "binary.csv", "text.csv", "folder.csv", "pipe.csv",
                                  {"path": good, "id": "no rig", "rig": "nowhere.json"},
                                  {"path": good, "id": "wrong rig", "rig": "text.csv"},
                                  {"path": "/dev/zero"}])
        _, said = self.refit(manifest, "a.sqlite", code=3)
        self.assertIn("9 could not be fitted; the recording, rig or calibration of 2 runs is missing", said)
        stored = self.rows("a.sqlite")
        codes = {key[1]: row["exit_code"] for key, row in stored.items() if key[0] == "runs"}
        self.assertEqual(codes, {good: codes[good], "missing.csv": 3, "empty.csv": codes["empty.csv"], "binary.csv": 4,
                                 "text.csv": 4, "folder.csv": 4, "pipe.csv": 4, "no rig": 3, "wrong rig": 4, "/dev/zero": 4})
        for (table, run, model, _), row in stored.items():
            if table == "fits" and run != good:
                self.assertEqual(row["status"], "failed")
                self.assertRegex(row["reason"], r"\w+ \w+")
        self.assertEqual(stored["runs", "text.csv", None, None]["reason"].split(" ")[0], "text.csv:2:3:")

    def test_file_names_may_contain_any_characters(self):
        good = (self.folder / self.simulate(1)[0]).read_bytes()
        names = ["with blanks.csv", 'a "quote".csv', "a,comma;semi.csv", "line\nbreak.csv", "ünïcode 摆.csv", "-dash.csv",
                 "<script>alert(1)</script>.csv".replace("/", "|"), "'; DROP TABLE runs; --.csv", "percent %s %n.csv", "x" * 200 + ".csv"]
        for name in names:
            (self.folder / name).write_bytes(good)
        self.refit(self.manifest([{"path": name, "note": name} for name in names]), "a.sqlite")
        with sqlite3.connect(self.folder / "a.sqlite") as database:
            found = database.execute("SELECT id, exit_code, columns, result FROM runs ORDER BY position").fetchall()
        self.assertEqual([row[0] for row in found], names)
        for name, code, columns, result in found:
            self.assertLess(code, 2, name)
            self.assertEqual(json.loads(columns), {"note": name})
            self.assertEqual(json.loads(result)["recordings"][0]["path"], name)
        self.run_tool("export", "--store", "a.sqlite", "--out", "a.csv")
        with open(self.folder / "a.csv", newline="", encoding="utf-8") as file:
            self.assertEqual([row["note"] for row in csv.DictReader(file)], [name for name in names for _ in range(2)])

    def test_manifest_errors_name_the_line(self):
        for text, words in {
            "path,id\na.csv,1\nb.csv,1\n": 'bad.csv:3: the id "1" is also at bad.csv:2',
            "id\n1\n": "bad.csv:1: the header has no column path",
            "path,path\na,b\n": 'bad.csv:1: the header has the column "path" twice',
            "path,id\na.csv\n": "bad.csv:2: the row has 1 fields, the header 2",
            "path,models\na.csv,viscous\nb.csv,tar\n": "bad.csv:3: column models: there is no model 'tar'",
            "path,from_s\na.csv,soon\n": 'bad.csv:2: column from_s: "soon" is not a time',
            "path,from_s,to_s\na.csv,3,2\n": "bad.csv:2: from_s 3 is not before to_s 2",
            'path,id\n"a.csv,1\n': "bad.csv:2: a field begins with a double quote that is never closed",
            'path,id\na"b.csv,1\n': "bad.csv:2: there is a double quote inside a field",
            "path\n\0\n": "bad.csv:2:1: there is a NUL byte",
            "": "bad.csv: the manifest is empty",
        }.items():
            (self.folder / "bad.csv").write_text(text)
            _, said = self.refit("bad.csv", "a.sqlite", code=4)
            self.assertIn(words, said)
        (self.folder / "bad.csv").write_text("path,id\n")
        self.assertIn("names no recording", self.refit("bad.csv", "a.sqlite", code=5)[1])
        self.assertIn("there is no such file", self.refit("nowhere.csv", "a.sqlite", code=3)[1])

    def test_a_million_lines_are_read_in_bounded_memory(self):
        lines = 10**5 if is_sanitized(TOOL) else 10**6  # half a minute with a sanitizer, without a limit of memory
        with open(self.folder / "million.csv", "w", encoding="utf-8") as file:
            file.write("path,id,operator\n")
            file.writelines(f'nowhere/run_{i}.csv,run {i},"O""Neil, A"\n' for i in range(lines))
        # Memory depends on the program and the store's page cache, not on a million entries.
        self.refit("million.csv", "a.sqlite", "--shard", "5/10000",
                   preexec_fn=memory_limit(TOOL, 300 << 20))
        stored = self.rows("a.sqlite")
        self.assertEqual([key[1] for key in stored if key[0] == "runs"], [f"run {i}" for i in range(5 * lines // 10000, 6 * lines // 10000)])

    def test_folders_and_patterns_are_searched_without_loops(self):
        self.simulate(2, "runs")
        (self.folder / "runs" / "deep" / "er").mkdir(parents=True)
        shutil.copy(self.folder / "runs" / "run_001.csv", self.folder / "runs" / "deep" / "er" / "a.csv")
        (self.folder / "runs" / "deep" / "loop").symlink_to("..")
        (self.folder / "runs" / "deep" / "self").symlink_to("self")
        (self.folder / "runs" / "notes.md").write_text("no recording")
        (self.folder / "runs" / "deep" / "rig.json").write_text("{}")
        for data, ids in {"runs": ["runs/deep/er/a.csv", "runs/run_001.csv", "runs/run_002.csv"],
                          "runs/**/*.csv": ["runs/deep/er/a.csv", "runs/run_001.csv", "runs/run_002.csv"],
                          "runs/run_00[2-9].csv,runs/*/er": ["runs/run_002.csv"],
                          "runs/run_*.csv,runs": ["runs/deep/er/a.csv", "runs/run_001.csv", "runs/run_002.csv"]}.items():
            if data.endswith("er"):
                self.assertIn("no file matches this pattern",
                              self.run_tool("--data", data, "--store", "b.sqlite", code=3)[1])
                continue
            store = f"{len(data)}.sqlite"
            said = self.run_tool("--data", data, "--store", store)[1]
            self.assertEqual("left out because of the name (1 *, 1 *.json, 1 *.md)" in said, "csv" not in data or "," in data)
            self.assertEqual(sorted(key[1] for key in self.rows(store) if key[0] == "runs"), ids)


class Reports(Lab):
    """Commands that report on a store."""

    def test_export_report_and_comparison(self):
        paths = self.simulate(6)
        manifest = self.manifest([{"path": path, "rig": str(RIG), "date": f"2026-03-{i + 1:02}"} for i, path in enumerate(paths)] +
                                 [{"path": "missing.csv", "rig": "", "date": ""}])
        self.refit(manifest, "a.sqlite", code=3)
        self.run_tool("export", "--store", "a.sqlite", "--out", "a.jsonl")
        lines = [json.loads(line) for line in (self.folder / "a.jsonl").read_text().splitlines()]
        self.assertEqual([line["id"] for line in lines], [*paths, "missing.csv"])
        self.assertEqual(lines[0]["manifest"], {"path": paths[0], "rig": str(RIG), "date": "2026-03-01"})
        self.assertEqual(lines[0]["result"]["fits"][1]["model"], "coulomb")
        self.assertEqual(lines[6]["result"], None)
        self.assertEqual(lines[6]["error"], {"exit_code": 3, "message": "missing.csv: there is no such file; check the path"})
        out, _ = self.run_tool("export", "--store", "a.sqlite", "--out", "-")
        table = list(csv.DictReader(out.splitlines()))
        self.assertEqual(len(table), 14)
        inertia = {row["id"]: float(row["inertia"]) for row in table if row["model"] == "coulomb" and row["inertia"]}
        self.assertEqual(inertia, {line["id"]: line["result"]["fits"][1]["parameters"]["inertia"]["estimate"] for line in lines[:6]})
        self.run_tool("report", "--store", "a.sqlite", "--out", "a.html", "--trend_by", "date", "--group_by", "rig")
        self.assertTrue('id="summary"' in (self.folder / "a.html").read_text())
        self.assertIn("the manifest has no column 'day'; it has date",
                      self.run_tool("report", "--store", "a.sqlite", "--out", "a.html", "--group_by", "day", code=2)[1])

    def test_different_pendulums_are_not_taken_for_repeats(self):
        (self.folder / "many").mkdir()
        subprocess.run([TOOLS / "simulate_pendulum", *SIMULATED, "--spread", "inertia=0.01,viscous=0.001", "--count", str(PENDULUMS),
                        "--out", "many/run.csv", "--manifest", "many/runs.csv"], cwd=self.folder, check=True, timeout=TIMEOUT_S)
        out, _ = self.run_tool("many/runs.csv", "--model", "coulomb", "--store", "a.sqlite")
        self.assertRegex(out, rf"(?s){PENDULUMS} of {PENDULUMS} recordings fitted\.\n    {PENDULUMS} different pendulums")
        self.assertNotIn("too small", out)
        # The same recordings without the truth: nothing says that they differ, but no repeats differ so much.
        out, _ = self.run_tool("--data", "many", "--rig", RIG, "--model", "coulomb", "--store", "b.sqlite")
        self.assertIn("are not taken for one pendulum", out)
        self.assertNotIn("too small", out)
        out, _ = self.run_tool("status", "--group_by", "all", "--store", "b.sqlite")
        self.assertIn("too small", out)

    def test_the_summary_fits_a_screen_and_names_missing_refused_and_outlying_recordings(self):
        for name in ("runs_1.csv", "runs_2.csv", "runs_3.csv", "runs_4.csv"):
            shutil.copy(DATASETS / name, self.folder)
        (self.folder / "text.csv").write_text("notes\n")
        paths = ["runs_1.csv", "runs_2.csv", "runs_3.csv", "runs_4.csv", "runs_5.csv", "text.csv"]
        out, _ = self.refit(self.manifest(paths), "a.sqlite", code=3)
        lines = out.splitlines()
        self.assertLessEqual(len(lines), 20, out)
        self.assertLessEqual(max(map(len, lines)), 80, out)
        self.assertEqual(lines[1], "    4 of 6 recordings fitted; 1 missing, 1 refused.")
        self.assertIn("taken for repeats of one pendulum", lines[2])
        self.assertIn("Missing: runs_5.csv.", out)
        self.assertIn("Refused: text.csv (", out)
        self.run_tool("report", "--store", "a.sqlite", "--out", "a.json")
        row = json.loads((self.folder / "a.json").read_text())["agreement"]["rows"][0]
        # fit_pendulum fits these recordings jointly with the same test.
        subprocess.run([TOOLS / "fit_pendulum", *paths[:4], "--rig", RIG, "--model", "coulomb", "--json", "joint.json"],
                       cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=TIMEOUT_S)
        joint = json.loads((self.folder / "joint.json").read_text())["fits"][0]["homogeneity"]
        self.assertAlmostEqual(row["statistic"] / joint["statistic"], 1, delta=1e-6)
        self.assertEqual([outlier["id"] for outlier in row["outliers"]], [paths[k - 1] for k in joint["outliers"]])
        self.assertIn("runs_4.csv (inertia", " ".join(out.split()))

    def test_quiet_prints_parameters_and_details_the_tables(self):
        manifest = self.manifest(self.simulate(3))
        out, _ = self.refit(manifest, "a.sqlite", "--quiet")
        self.assertRegex(out.splitlines()[0], r"^\w+ \S+ \S+ \S+")
        out, _ = self.run_tool("status", "--store", "a.sqlite", "--details")
        self.assertLess(out.index("[[Fits]]"), out.index("[[a.sqlite]]"))
        self.assertIn("contradict", self.run_tool("status", "--store", "a.sqlite", "--details", "--quiet", code=2)[1])

    def test_inertia_can_be_selected_from_results(self):
        paths = self.simulate(2) + ["missing.csv"]
        self.refit(self.manifest(paths), "a.sqlite", code=3)
        stored = self.rows("a.sqlite")
        with sqlite3.connect(self.folder / "a.sqlite") as database:
            found = database.execute("SELECT id, law, inertia, inertia_std_error, inertia_total_std_error, inertia_unit, status, "
                                     "verdict FROM results ORDER BY position").fetchall()
        self.assertEqual([row[0] for row in found], paths)
        for run, law, *values, status, verdict in found[:2]:
            result = json.loads(stored["runs", run, None, None]["result"])
            fit = next(fit for fit in result["fits"] if fit["model"] == result["comparison"]["recommended"])
            inertia = fit["parameters"]["inertia"]
            self.assertEqual((law, status, verdict), (fit["model"], "converged", fit["summary"]["verdict"]))
            self.assertEqual(values, [inertia[key] for key in ("estimate", "std_error", "total_std_error", "unit")])
        self.assertEqual(found[2][1:7], (None, None, None, None, None, "missing"))
        self.assertIn("there is no such file", found[2][7])

    def test_an_older_store_is_read_unchanged_and_gets_the_view_when_it_is_written(self):
        manifest = self.manifest(self.simulate(2))
        self.refit(manifest, "a.sqlite")
        with sqlite3.connect(self.folder / "a.sqlite") as database:
            database.executescript("DROP VIEW results; DROP VIEW all_fits; DROP INDEX unlisted_by_data; "
                                   "ALTER TABLE fits DROP COLUMN verdict; ALTER TABLE fits DROP COLUMN stale; "
                                   "ALTER TABLE fits DROP COLUMN json; "
                                   "ALTER TABLE quantities DROP COLUMN total_std_error; "
                                   "ALTER TABLE quantities DROP COLUMN inconstancy_std_error; "
                                   "ALTER TABLE quantities DROP COLUMN source_std_error; "
                                   "ALTER TABLE runs DROP COLUMN sources; ALTER TABLE runs DROP COLUMN stale; "
                                   "ALTER TABLE runs DROP COLUMN attempt; ALTER TABLE runs DROP COLUMN place; "
                                   "ALTER TABLE runs DROP COLUMN sentence; ALTER TABLE runs DROP COLUMN fitted; "
                                   "ALTER TABLE runs DROP COLUMN news; "
                                   "ALTER TABLE requests DROP COLUMN name; PRAGMA user_version = 3; "
                                   "CREATE VIEW results AS SELECT id, fits.* FROM runs JOIN fits USING(run)")
        (self.folder / "a.sqlite").chmod(0o444)
        self.folder.chmod(0o555)
        before = (self.folder / "a.sqlite").read_bytes()
        out, _ = self.run_tool("status", "--store", "a.sqlite", preexec_fn=as_nobody)
        self.assertIn("2 of 2 recordings fitted", out)
        self.assertEqual((self.folder / "a.sqlite").read_bytes(), before)
        self.folder.chmod(0o755)
        (self.folder / "a.sqlite").chmod(0o644)
        self.refit(manifest, "a.sqlite")
        with sqlite3.connect(self.folder / "a.sqlite") as database:
            for error, total in database.execute("SELECT inertia_std_error, inertia_total_std_error FROM results"):
                self.assertLessEqual(error, total)

    # The map of compare_builds is written apart from the upgrade of a store.
    def test_results_of_an_older_store_are_exported_in_the_present_schema(self):
        golden = DATASETS.parent / "tests/batch/golden/store_6.sql"
        with contextlib.closing(sqlite3.connect(self.folder / "old.sqlite")) as database:
            database.executescript(golden.read_text(encoding="utf-8"))
            former = [json.loads(text) for (text,) in database.execute("SELECT result FROM runs WHERE result IS NOT NULL")]
        self.run_tool("export", "--store", "old.sqlite", "--out", "results.jsonl")
        lines = [json.loads(line) for line in (self.folder / "results.jsonl").read_text().splitlines()]
        results = [line["result"] for line in lines if line["result"] is not None]
        self.assertEqual([result["schema_version"] for result in former], [2])
        self.assertEqual(results, [with_schema_3(result) for result in former])
        jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text())).validate(results[0])

    def test_comparison_reports_changed_values(self):
        manifest = self.manifest(self.simulate(3))
        self.refit(manifest, "a.sqlite")
        self.refit(manifest, "b.sqlite", "--threads", "1")
        out, _ = self.run_tool("compare", "a.sqlite", "b.sqlite")
        self.assertRegex(out, r"moved by more +0\n")
        with sqlite3.connect(self.folder / "b.sqlite") as database:
            database.executescript("PRAGMA foreign_keys = OFF; DELETE FROM fits WHERE model = 'viscous' AND run = 1; "
                                   "DELETE FROM quantities WHERE model = 'viscous' AND run = 1")
        self.assertRegex(self.run_tool("compare", "a.sqlite", "b.sqlite", code=1)[0], r"in a.sqlite only +1\n")
        self.assertRegex(self.run_tool("compare", "b.sqlite", "a.sqlite")[0], r"in a.sqlite only +1\n")
        heavier = json.loads(RIG.read_text())
        heavier["bob_mass"] = {**heavier["bob_mass"], "value": heavier["bob_mass"]["value"] * 2} if isinstance(
            heavier["bob_mass"], dict) else heavier["bob_mass"] * 2
        (self.folder / "heavier.json").write_text(json.dumps(heavier))
        self.refit(self.manifest([{"path": path, "rig": "heavier.json"} for path in self.simulate(3)]), "c.sqlite")
        out, _ = self.run_tool("compare", "a.sqlite", "c.sqlite", code=1)
        self.assertIn("Moved by more than their errors", out)
        self.assertIn("inertia", out)

    def test_progress_is_a_bar_on_a_terminal_and_lines_elsewhere(self):
        manifest = self.manifest(self.simulate(60))
        reader, writer = pty.openpty()
        _, said = self.refit(manifest, "a.sqlite")
        self.assertNotIn("\x1b", said)
        done = subprocess.Popen([TOOL, "--manifest", manifest, "--store", "b.sqlite", "--model", "viscous,coulomb"],
                                cwd=self.folder, stdout=subprocess.DEVNULL, stderr=writer)
        self.assertEqual(done.wait(timeout=TIMEOUT_S), 0)
        os.close(writer)
        shown = b""
        try:
            while piece := os.read(reader, 65536):
                shown += piece
        except OSError:  # the other end is closed
            pass
        os.close(reader)
        self.assertRegex(shown.decode(), r"\r\[#+\.+\] \d+ of 60 runs \(\d+ %\), [\d.]+ a second, \d+ s left")

    def test_wrong_flags_are_reported(self):
        for arguments, words in {
            (): "no store was given",
            ("--store", "a.sqlite"): "no runs were given",
            ("--store", "a.sqlite", "--manifest", "a", "--data", "b"): "--manifest and --data both name runs",
            ("--store", "a.sqlite", "--data", "b", "--shard", "3/3"): "--shard is '3/3'; it must be k/N",
            ("--store", "a.sqlite", "--data", "b", "--scratch", "."): "give --shard too",
            ("--store", "a.sqlite", "--data", "b", "--out", "."): "--out is not a flag of a refit",
            ("--store", "a.sqlite", "--data", "b", "--release", "all"): "--release all makes several results",
            ("statsu", "--store", "a.sqlite"): "'statsu' is not a command",
            ("status",): "status needs --store",
            ("status", "--store", "a.sqlite", "--force"): "--force is not a flag of status",
            ("compare", "a.sqlite"): "compare takes two stores",
            ("export", "--store", "a.sqlite", "--out", "a.txt"): "the name must end with .csv",
            ("missing", "--shard_dir", ".", "--shard_count", "0"): "it must be at least 1",
        }.items():
            self.assertIn(words, self.run_tool(*arguments, code=2)[1])
        self.assertIn("no.csv: there is no such file", self.run_tool("no.csv", "--store", "a.sqlite", code=3)[1])

    def test_files_that_are_no_stores_are_refused_and_unchanged(self):
        manifest = self.manifest(self.simulate(1))
        (self.folder / "text").write_text("these are notes\n" * 100)
        with sqlite3.connect(self.folder / "other.sqlite") as database:
            database.execute("CREATE TABLE runs(x)")
        for name, words in {"text": "this is not an SQLite file", "other.sqlite": "this is not a result store"}.items():
            before = (self.folder / name).read_bytes()
            self.assertIn(words, self.refit(manifest, name, code=4)[1])
            self.assertIn(words, self.run_tool("status", "--store", name, code=4)[1])
            self.assertEqual((self.folder / name).read_bytes(), before)
        self.assertIn("there is no such store", self.run_tool("status", "--store", "nowhere", code=3)[1])


if __name__ == "__main__":
    unittest.main()
