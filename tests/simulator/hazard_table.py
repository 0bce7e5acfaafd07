#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum on simulated recordings of each hazard, and compares every estimate with the truth.

  hazard_table.py BIN_DIR [--count 30] [--jobs 2] [--rows 'gain_*,lag_5'] [--json TABLE.json] [--update]

It needs python3-scipy. The simulator is independent of the project's C++ code. A recording is silently wrong if the tool
converged (exit 0), an estimate is more than 5 total errors from the truth, and neither a suspicion nor a warning names the
cause. A row fails if a recording is silently wrong or without a fit, if fewer than 0.9 of the parameters could be judged,
or if the total 95 % intervals cover too seldom or too often. --json writes the table; rows that are not run keep their
place in it. --update also writes it into the guide. Exit code 1 if a row fails.
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
GUIDE = HERE.parents[1] / "src/docs/what_goes_wrong.md"


def run(tool: pathlib.Path, name: str, seed: int) -> judging.Outcome:
    """Simulates and fits one recording. All rows have the same pendulums, each row has its own noise."""
    row, lab = ROWS[name], textbook_lab(seed)
    lab.rng = numpy.random.default_rng([seed, zlib.crc32(name.encode())])
    row.change(lab)
    with tempfile.TemporaryDirectory() as folder:
        return judging.fit(tool, pathlib.Path(folder), record(lab), row.model, row.parameters, row.kind == "clean",
                           row.optional)


def table_of(tool: pathlib.Path, names: list[str], count: int, jobs: int, path: pathlib.Path | None) -> list[dict]:
    """Runs the rows. Prints each as it is done, and writes it to the file, so that an interrupted run loses nothing."""
    rows = []
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        futures = {name: [pool.submit(run, tool, name, FIRST_SEED + index) for index in range(count)] for name in names}
        for name, of_row in futures.items():
            rows.append(summarize(ROWS[name], [future.result() for future in of_row]))
            print(table_text.line(rows[-1]), flush=True)
            if path:
                write(path, tool, rows)
    return rows


def merged(path: pathlib.Path, rows: list[dict]) -> list[dict]:
    """The rows of the file with the new ones in their place, in the order of the scenarios."""
    former = json.loads(path.read_text(encoding="utf-8"))["rows"] if path.exists() else []
    by_name = {row["row"]: row for row in [*former, *rows]}
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
    parser.add_argument("--rows", default="*", help="patterns with commas between them")
    parser.add_argument("--json", type=pathlib.Path, help="writes the table")
    parser.add_argument("--update", action="store_true", help="writes TABLE.json and the guide")
    arguments = parser.parse_args()
    names = [name for name in ROWS if any(fnmatch.fnmatch(name, part) for part in arguments.rows.split(","))]
    if not names:
        parser.error(f"no row matches {arguments.rows}; there are {', '.join(ROWS)}")
    tool = arguments.bin_dir.resolve() / "fit_pendulum"
    if not tool.exists():
        parser.error(f"there is no {tool}")
    path = arguments.json or (HERE / "TABLE.json" if arguments.update else None)
    print(table_text.HEAD)
    rows = table_of(tool, names, arguments.count, arguments.jobs, path)
    if arguments.update:
        table_text.update(GUIDE, path)
    failing = [row["row"] for row in rows if row["fails"]]
    print(f"{len(rows) - len(failing)} of {len(rows)} rows pass; {sum(row['silent'] for row in rows)} recordings silently wrong")
    return 1 if failing else 0


if __name__ == "__main__":
    sys.exit(main())
