#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum on simulated recordings of each hazard, and compares every estimate with the truth.

  hazard_table.py BIN_DIR [--count 30] [--jobs 2] [--rows 'gain_*,lag_5'] [--json TABLE.json] [--update]

It needs python3-scipy. The simulator is independent of the project's C++ code. The total error is that of the total 95 %
interval where this is wider. A recording is wrong if the tool converged (exit 0) and inertia or a parameter of friction is more
than 5 total errors from the truth. Each column but `wrong` and `start` counts all recordings:
  silent   wrong, and the tool neither names a cause nor doubts the answer
  doubted  lack of fit, not constant, a conflict with a prior or the rig, or no result (exit 1)
  named    a suspicion or a warning names the right cause
  other    causes are named, but not the right one; where nothing is wrong these are false alarms
  start    release or zero are more than 5 total errors from the truth, and neither the cause is named nor the answer doubted
  none     exit code other than 0
  cover    share of all total 95 % intervals that contain the truth
Remarks that stand in every report (what no free swing can tell, unseen friction) do not count: the JSON has in `remarked` how
many silent recordings they would explain. rms z (1 if errors are right) and the median total error, in per cent of the
value, are those of inertia, viscous and dry friction; the last column has this error over that of the same recordings without
a defect and with the sensor stated as ideal. A budget that is too wide has a small z there and a large ratio.

A row fails if a recording is silently wrong, wrong with another cause named, or without an answer; if a parameter has no
error in more than a tenth of the recordings, or a median error above half its value that noise does not explain; if the
intervals cover too seldom or too often; or if more than a tenth have another cause named or, where nothing is wrong, are
doubted. --json writes the table; rows that are not run keep their place in it. --update also writes it into the guide.
Exit code 1 if a row fails.
"""

import argparse
import concurrent.futures
import fnmatch
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import zlib

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy  # noqa: E402, because it reads the environment when it is imported

import judging  # noqa: E402
import table_text  # noqa: E402
from lab import record, textbook_lab  # noqa: E402
from row_summary import summarize  # noqa: E402
from scenarios import ROWS  # noqa: E402

FIRST_SEED = 1000
HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "TABLE.json"
GUIDE = HERE.parents[1] / "src/docs/what_goes_wrong.md"


def run(tool: pathlib.Path, name: str, seed: int) -> judging.Outcome:
    """Simulates and fits one recording. All rows have the same pendulums, each row has its own noise."""
    row, lab = ROWS[name], textbook_lab(seed)
    lab.rng = numpy.random.default_rng([seed, zlib.crc32(name.encode())])
    row.change(lab)
    with tempfile.TemporaryDirectory() as folder:
        return judging.fit(tool, pathlib.Path(folder), record(lab), row.model, row.parameters,
                           judging.EXACT_SENSOR if row.kind == "exact" else None, row.optional)


def table_of(tool: pathlib.Path, names: list[str], count: int, jobs: int, path: pathlib.Path | None) -> list[dict]:
    """Runs the rows. Prints each as it is done, and writes it to the file, so that an interrupted run loses nothing."""
    rows, former = [], [*rows_of(path or TABLE), *rows_of(TABLE)]
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        futures = {name: [pool.submit(run, tool, name, FIRST_SEED + index) for index in range(count)] for name in names}
        for name, of_row in futures.items():
            noise = next((row for row in [*rows, *former] if row["row"] == ROWS[name].reference), None)
            rows.append(summarize(ROWS[name], [future.result() for future in of_row], noise))
            print(table_text.line(rows[-1], [*rows, *former]), flush=True)
            if path:
                write(path, tool, rows)
    return rows


def rows_of(path: pathlib.Path) -> list[dict]:
    """The rows of a file; none if it does not exist."""
    return json.loads(path.read_text(encoding="utf-8"))["rows"] if path.exists() else []


def merged(path: pathlib.Path, rows: list[dict]) -> list[dict]:
    """The rows of the file with the new ones in their place, in the order of the scenarios."""
    by_name = {row["row"]: row for row in [*rows_of(path), *rows]}
    return [by_name[name] for name in ROWS if name in by_name]


def write(path: pathlib.Path, tool: pathlib.Path, rows: list[dict]) -> None:
    """Writes the table."""
    version = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
    text = json.dumps({"version": version, "rows": merged(path, rows)}, indent=1)
    path.write_text(text + "\n", encoding="utf-8")


def main() -> int:
    """Runs the rows and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin_dir", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=30, help="recordings of each row")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--rows", default="*", help="patterns with commas between them; core: the core rows")
    parser.add_argument("--json", type=pathlib.Path, help="writes the table")
    parser.add_argument("--update", action="store_true", help="writes TABLE.json and the guide")
    arguments = parser.parse_args()
    parts = arguments.rows.split(",")
    names = [name for name, row in ROWS.items()
             if any(fnmatch.fnmatch(name, part) for part in parts) or ("core" in parts and row.is_core)]
    if not names:
        parser.error(f"no row matches {arguments.rows}; there are {', '.join(ROWS)}")
    tool = arguments.bin_dir.resolve() / "fit_pendulum"
    if not tool.exists():
        parser.error(f"there is no {tool}")
    path = arguments.json or (TABLE if arguments.update else None)
    print(table_text.HEAD)
    rows = table_of(tool, names, arguments.count, arguments.jobs, path)
    if arguments.update:
        table_text.update(GUIDE, path)
    core = [row for row in rows if row["is_core"]]
    for words, those in (("rows", rows), ("core rows", core)):
        print(f"{sum(not row['fails'] for row in those)} of {len(those)} {words} pass, "
              f"{sum(row['silent'] for row in those)} of {sum(row['recordings'] for row in those)} recordings silently wrong")
    return 1 if any(row["fails"] for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
