# SPDX-License-Identifier: Apache-2.0
"""Batches for the tests of refit_pendulums: simulated recordings, the tool, and the content of its stores."""

import csv
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

TOOL = pathlib.Path(sys.argv.pop(1)).resolve()
TOOLS = TOOL.parent
DATASETS = pathlib.Path(__file__).resolve().parents[2] / "datasets"
RIG = DATASETS / "textbook_rig.json"
TIMEOUT_S = 300

# A swing of 6 s at 50 Hz: three periods of the textbook's rig (MODEL.md); a fit takes some milliseconds.
SIMULATED = ["--model", "coulomb", "--rig", str(RIG), "--duration", "6", "--rate", "50", "--noise", "0.3", "--resolution", "0.1985",
             "--set", "inertia=0.079,viscous=0.003,coulomb=0.004,release_angle=0.423,release_time=0.5"]


HISTORY = ("fitted", "news")  # when and by which refit a row was made, not what is in it


def rows(store, tables=("runs", "fits", "quantities")):
    """All rows of a store, with runs named by their ids, so that rows of stores made in different ways are equal."""
    found = {}
    with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as database:
        database.row_factory = sqlite3.Row
        ids = dict(database.execute("SELECT run, id FROM runs").fetchall())
        for table in tables:
            for row in database.execute(f"SELECT * FROM {table}"):
                values = {key: row[key] for key in row.keys() if key != "run" and key not in HISTORY}
                key = (table, ids[row["run"]], values.get("model"), values.get("name"))
                assert key not in found, f"twice: {key}"
                found[key] = values
    return found


def sound(store):
    """Whether SQLite finds no error in a store, including its foreign keys."""
    with sqlite3.connect(store) as database:
        return (database.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
                and database.execute("PRAGMA foreign_key_check").fetchall() == [])


class Lab(unittest.TestCase):
    """A separate folder for each test."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="refit_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def simulate(self, count, folder="runs", seed=1):
        """Simulates `count` recordings; returns their paths relative to the test's folder."""
        (self.folder / folder).mkdir(exist_ok=True)
        subprocess.run([TOOLS / "simulate_pendulum", *SIMULATED, "--count", str(count), "--seed", str(seed),
                        "--out", self.folder / folder / "run.csv"], check=True, timeout=TIMEOUT_S)
        return sorted(f"{folder}/{path.name}" for path in (self.folder / folder).glob("*.csv"))

    def manifest(self, entries, name="runs.csv"):
        """Writes a manifest: entries are paths, or dictionaries."""
        entries = [entry if isinstance(entry, dict) else {"path": entry, "rig": str(RIG)} for entry in entries]
        names = list(dict.fromkeys(key for entry in entries for key in entry))
        with open(self.folder / name, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, names, restval="")
            writer.writeheader()
            writer.writerows(entries)
        return name

    def start(self, *arguments, **options):
        return subprocess.Popen([TOOL, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, **options)

    def wait_for(self, name):
        """Waits until a file exists."""
        end = time.monotonic() + TIMEOUT_S
        while not (self.folder / name).exists():
            self.assertLess(time.monotonic(), end, f"{name} never came")
            time.sleep(0.005)

    def run_tool(self, *arguments, code=0, **options):
        """Runs the tool; returns its standard output and standard error."""
        done = subprocess.run([TOOL, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              timeout=TIMEOUT_S, **options)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done.stdout, done.stderr

    def refit(self, manifest, store, *more, code=0, **options):
        return self.run_tool("--manifest", manifest, "--models", "viscous,coulomb", "--store", store, *more, code=code,
                             **options)

    def rows(self, store):
        self.assertTrue(sound(self.folder / store))
        return rows(self.folder / store)


def as_nobody():
    """For preexec_fn: gives up root, which ignores permissions."""
    if os.geteuid() == 0:
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)
