#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Adds a small store of the present schema to tests/batch/golden, unless there is one:

    python3 -B tests/batch/golden_stores.py build/release/bin

golden_stores_test.cc upgrades each of them. Never change one: stores like it exist. Those of versions 1 to 4 were made
from version 5 with the migrations of their time."""

import contextlib
import pathlib
import sqlite3
import subprocess
import sys
import tempfile

GOLDEN = pathlib.Path(__file__).resolve().parent / "golden"


def make(tools, folder):
    """A store with one fitted run, one missing run, and one run of a service."""
    subprocess.run([tools / "simulate_pendulum", "--out", "run.csv", "--duration", "6", "--rate", "30", "--set",
                    "inertia=0.044,viscous=0.001,coulomb=0.002,release_angle=0.4,release_time=0.3"], cwd=folder, check=True)
    (folder / "runs.csv").write_text("path,id,bench\nrun.csv,a,left\nnone.csv,b,right\n")
    refit = subprocess.run([tools / "refit_pendulums", "runs.csv", "--models", "coulomb", "--store", "golden.sqlite"],
                           cwd=folder, check=False, stdout=subprocess.DEVNULL)
    if refit.returncode != 3:  # the missing run
        sys.exit(f"refit_pendulums ended with {refit.returncode}")
    with contextlib.closing(sqlite3.connect(folder / "golden.sqlite")) as database:
        database.executescript("""
INSERT INTO runs(run, id, position, path, rig, calibration, models, columns)
  VALUES(3, 'c', 2, 'sent.csv', '', '', '', '{}');
INSERT INTO files VALUES(1, 'sha', x'74');
INSERT INTO batches VALUES(1, 'batch', '2026-11-29T12:00:00Z');
INSERT INTO requests(run, batch, created, flags, data) VALUES(3, 1, '2026-11-29T12:00:00Z', '{}', 1);
INSERT INTO answers VALUES('key', 'sha', '/v1/fits/c', '2026-11-29T12:00:00Z')""")
    return folder / "golden.sqlite"


def main():
    with tempfile.TemporaryDirectory() as folder:
        store = make(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder))
        with contextlib.closing(sqlite3.connect(store)) as database:
            version = database.execute("PRAGMA user_version").fetchone()[0]
            path = GOLDEN / f"store_{version}.sql"
            if path.exists():
                return f"{path} exists already"
            lines = [line for line in database.iterdump() if not line.startswith("CREATE VIEW results")]
            ident = database.execute("PRAGMA application_id").fetchone()[0]
            lines += [f"PRAGMA application_id = {ident};", f"PRAGMA user_version = {version};"]
            path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return None


if __name__ == "__main__":
    sys.exit(main())
