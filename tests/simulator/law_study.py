#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts how often `fit_pendulum --model all` recommends a law, and which, for recordings without faults.

  law_study.py BIN_DIR [--count 200] [--jobs 2] [--cells 'coulomb*'] [--json OUT.json]

A cell is a true law and a kind of noise, length or resolution. The laws are those of the textbook rig: `viscous` without dry
friction, `coulomb`, and `drag` with quadratic drag of 0.002. The user states G and a sensor without faults. Exit code 1 if a law
is recommended in fewer than 95 % of the recordings of a cell, or if more than 5 % of its recommendations are a law with a term
that the true law does not have.
"""

import collections
import itertools
import os
import pathlib
import sys
import tempfile

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import judging  # noqa: E402, because NumPy reads the environment when it is imported
import study  # noqa: E402
from coverage_study import CHANGES  # noqa: E402
from lab import Lab, record, textbook_lab  # noqa: E402

FIRST_SEED = 900_000
LEAST_RECOMMENDED = 0.95
LAWS = {"viscous": {"coulomb": 0.0}, "coulomb": {}, "drag": {"drag": 0.002}}
MOST_WRONG = 0.05
SIMPLER = {"viscous": {"viscous"}, "coulomb": {"viscous", "coulomb"}, "drag": {"viscous", "coulomb", "drag"}}
CONDITIONS = {"white": lambda lab: None, **CHANGES}
CELLS = {f"{law}, {condition}": (law, condition) for law, condition in itertools.product(LAWS, CONDITIONS)}


def drawn(cell: str, seed: int) -> Lab:
    """The rig of one recording."""
    law, condition = CELLS[cell]
    lab = textbook_lab(seed)
    lab.set_friction(**LAWS[law])
    CONDITIONS[condition](lab)
    return lab


def run(tool: pathlib.Path, cell: str, seed: int) -> dict:
    """Simulates and fits one recording."""
    with tempfile.TemporaryDirectory() as folder:
        code, result, message = judging.run_tool(tool, pathlib.Path(folder), record(drawn(cell, seed)), "all", judging.EXACT_SENSOR)
    comparison = (result or {}).get("comparison") or {}
    return {"seed": seed, "exit_code": code, "message": message, "recommended": comparison.get("recommended"),
            "reason": comparison.get("reason"), "criterion": comparison.get("criterion"),
            "bic": {row["model"]: row.get("bic") for row in comparison.get("rows", [])}}


def main() -> int:
    """Runs the cells, prints a row of each and returns the exit code."""
    parser = study.parser_of(__doc__)
    parser.add_argument("--count", type=int, default=200, help="recordings of each cell")
    study.add_cells(parser)
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    cells = study.cells_of(parser, arguments, CELLS)
    rows, fails = [], False
    with study.runner(arguments.jobs) as run_all:
        for cell in cells:
            found = run_all(run, [(tool, cell, FIRST_SEED + index) for index in range(arguments.count)])
            names = collections.Counter(each["recommended"] for each in found)
            codes = collections.Counter(each["exit_code"] for each in found)
            given = len(found) - names[None]
            wrong = given - sum(names[name] for name in SIMPLER[CELLS[cell][0]])
            is_faulty = given < LEAST_RECOMMENDED * len(found) or wrong > MOST_WRONG * given
            fails = fails or is_faulty
            print(f"{cell:30} {dict(names)} exit codes {dict(codes)}{'  fails' if is_faulty else ''}", flush=True)
            rows.append({"cell": cell, "recommended": {str(name): count for name, count in names.items()}, "recordings": found})
            study.write(arguments.json, rows)
    return 1 if fails else 0


if __name__ == "__main__":
    sys.exit(main())
