# SPDX-License-Identifier: Apache-2.0
"""Common parts of the tests of scripts/cluster: recordings with a manifest in a folder with an unusual name, and the content of a
store."""

import contextlib
import os
import pathlib
import signal
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import processes

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts/cluster"
MOTION = "inertia=0.02,viscous=0.001,coulomb=0.001,release_angle=0.4,release_time=0.5"
MODELS = "viscous,coulomb"
SKIPPED = 77


def skip_without(programs):
    """Skips this test if a program is not installed; in continuous integration that is a failure."""
    if programs:
        print(f"this test needs {', '.join(programs)}; install with scripts/install_dependencies --cluster")
        sys.exit(1 if os.environ.get("PENDULUM_CI") == "1" else SKIPPED)


def timeless_rows(connection, table):
    """The rows of a table without the times of its refits, and from where they were started."""
    columns = [name for _, name, *_ in connection.execute(f"PRAGMA table_info({table})") if name != "fitted"]
    where = "WHERE key NOT IN ('began', 'ended', 'folder')" if table == "meta" else ""
    return connection.execute(f"SELECT {', '.join(columns)} FROM {table} {where}")


def rows(store):
    """{table: rows} of a store, all columns of all tables but the times, in no particular order."""
    with contextlib.closing(sqlite3.connect(f"{store.as_uri()}?mode=ro", uri=True)) as connection:
        tables = connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        return {name: sorted(timeless_rows(connection, name), key=repr) for name, in tables}


def pairs(store):
    """(run, model) of every result, sorted."""
    with contextlib.closing(sqlite3.connect(f"{store.as_uri()}?mode=ro", uri=True)) as connection:
        return sorted(connection.execute("SELECT id, model FROM all_fits"))


def work_on(store):
    """The refit_pendulums processes that fit this store, without the shells above them."""
    return [pid for pid in processes.all_pids()
            if {b"--store", os.fsencode(store)} <= set(processes.arguments_of(pid))]


class RefitCase(unittest.TestCase):
    """TOOL is the path of refit_pendulums, COUNT the number of recordings; self.folder is new for each test."""

    TOOL = pathlib.Path()
    COUNT = 300

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.recordings = pathlib.Path(temporary.name) / 'it\'s "one" rig, 100 %a'
        cls.recordings.mkdir()
        simulate = cls.TOOL.parent / "simulate_pendulum"
        subprocess.run([simulate, "--model", "coulomb", "--set", MOTION, "--noise", "0.2", "--resolution", "0.1985",
                        "--duration", "10", "--count", str(cls.COUNT), "--out", "run.csv"], cwd=cls.recordings,
                       check=True, timeout=60)
        names = sorted(path.name for path in cls.recordings.glob("run_*.csv"))
        (cls.recordings / "runs.csv").write_text("path,id\n" + "".join(f"{name},{name[:-4]}\n" for name in names),
                                                 encoding="utf-8")
        cls.expected = sorted((name[:-4], model) for name in names for model in MODELS.split(","))

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(dir=self.recordings)
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.store = self.folder / "all.sqlite"
        self.shards = self.folder / "all.sqlite.shards"

    def script(self, name, *arguments, code=0, **options):
        """The output of a script of scripts/cluster."""
        done = subprocess.run([SCRIPTS / name, *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=options.pop("timeout", 60), stdin=subprocess.DEVNULL, check=False, **options)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def request(self, shards):
        return ["--manifest", "../runs.csv", "--models", MODELS, "--store", "all.sqlite", "--shards", str(shards)]

    def start_of_one_process(self):
        """Starts a fit of everything without shards; store_of_one_process waits for it."""
        folder = self.folder / "one"
        folder.mkdir()
        process = subprocess.Popen([self.TOOL, "--manifest", self.recordings / "runs.csv", "--models", MODELS, "--store",
                                    folder / "shard-0.sqlite", "--shard", "0/1", "--threads", "1"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def store_of_one_process(self, process):
        self.assertEqual(process.wait(120), 0)
        store = self.folder / "one.sqlite"
        subprocess.run([self.TOOL, "merge", "--shard_dir", self.folder / "one", "--shard_count", "1", "--store", store],
                       check=True, timeout=60, capture_output=True)
        return store

    def check_store(self, shards):
        """Checks that every run and model occurs once, every shard is published, and no file of an attempt is left."""
        self.assertEqual(pairs(self.store), self.expected)
        names = {path.name for path in self.shards.iterdir()}
        self.assertEqual(names, {"logs", "request"} | {f"shard-{number}.sqlite" for number in range(shards)})

    def hold_shard(self, candidates=None):
        """Stops the processes of a shard before it is done; returns (number of the shard, processes). The shard is one of
        candidates() if given."""
        def hold():
            for path in self.shards.glob("shard-*.sqlite.attempt-*"):
                store = path.with_name(path.name.partition(".attempt-")[0])
                number = store.stem.partition("-")[2]
                if candidates and number not in candidates():
                    continue
                work = work_on(store)
                processes.kill(work, signal.SIGSTOP)
                if work and path.exists() and not store.exists():
                    return number, work
                processes.kill(work, signal.SIGCONT)
            return None

        return processes.wait_until("a shard is being fitted", hold, 20)

    def log(self, shard):
        path = self.shards / f"logs/shard-{shard}.log"
        return path.read_text(encoding="utf-8") if path.exists() else ""
