#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts how often `fit_pendulum --model all` recommends a law, and which, for recordings without faults.

  law_study.py BIN_DIR [--count 200] [--jobs 2] [--cells 'coulomb*'] [--json OUT.json]

A cell is a true law and a kind of noise, length or resolution. The laws are those of the textbook rig: `viscous` without dry
friction, `coulomb`, `drag` with quadratic drag of 0.002 N m s²/rad², and `stribeck` with stiction of twice the dry friction and a
rate of 0.4 rad/s. The user states G and a sensor without faults. Prints rows of the table in RECOMMENDATION.md. Exit code 1 if a
law is recommended in fewer than 95 % of the recordings of a cell, or if more than 5 % of its recommendations are a law with a
term that the true law does not have.
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
MOST_WRONG = 0.05
LAWS = ("viscous", "coulomb", "drag", "stribeck", "asymmetric", "dahl", "load")  # that --model all compares
CONDITIONS = {"white": lambda lab: None, **CHANGES}
CELLS = {f"{law}, {condition}": (law, condition)
         for law, condition in (*itertools.product(("viscous", "coulomb", "drag"), CONDITIONS), ("stribeck", "to rest"))}
# Laws without a term that the true law does not have.
WITHIN = {"viscous": {"viscous"}, "coulomb": {"viscous", "coulomb"}, "drag": {"viscous", "coulomb", "drag"},
          "stribeck": {"viscous", "coulomb", "stribeck"}}


def set_law(lab: Lab, law: str) -> None:
    """Gives the textbook rig, whose law is coulomb, another one."""
    changes = {"viscous": {"coulomb": 0.0}, "drag": {"drag": 0.002},
               "stribeck": {"stiction": 2 * lab.law.coulomb, "stribeck_rate": 0.4}}
    lab.set_friction(**changes.get(law, {}))


def run(tool: pathlib.Path, cell: str, seed: int) -> dict:
    """Simulates and fits one recording."""
    law, condition = CELLS[cell]
    lab = textbook_lab(seed)
    set_law(lab, law)
    CONDITIONS[condition](lab)
    with tempfile.TemporaryDirectory() as folder:
        code, result, message = judging.run_tool(tool, pathlib.Path(folder), record(lab), "all", judging.EXACT_SENSOR)
    comparison = (result or {}).get("comparison") or {}
    return {"seed": seed, "exit_code": code, "message": message, "recommended": comparison.get("recommended"),
            "reason": comparison.get("reason"), "criterion": comparison.get("criterion"),
            "bic": {row["model"]: row.get("bic") for row in comparison.get("rows", [])}}


def line(cell: str, names: collections.Counter) -> str:
    """A row of the table."""
    law, condition = CELLS[cell]
    return f"| {law} | {condition} | " + " | ".join(str(names[name]) for name in (*LAWS, None)) + " |"


def is_faulty(cell: str, names: collections.Counter) -> bool:
    """Whether a law is recommended too rarely, or one that says too much too often."""
    given = names.total() - names[None]
    wrong = given - sum(names[name] for name in WITHIN[CELLS[cell][0]])
    return given < LEAST_RECOMMENDED * names.total() or wrong > MOST_WRONG * given


def main() -> int:
    """Runs the cells, prints a row of each and returns the exit code."""
    parser = study.parser_of(__doc__)
    parser.add_argument("--count", type=int, default=200, help="recordings of each cell")
    study.add_cells(parser)
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    cells = study.cells_of(parser, arguments, CELLS)
    print("| law | recordings | " + " | ".join((*LAWS, "none")) + " |\n" + "|---" * (len(LAWS) + 3) + "|")
    rows, faulty = [], []
    with study.runner(arguments.jobs) as run_all:
        for cell in cells:
            found = run_all(run, [(tool, cell, FIRST_SEED + index) for index in range(arguments.count)])
            names = collections.Counter(each["recommended"] for each in found)
            faulty += [cell] if is_faulty(cell, names) else []
            print(line(cell, names), flush=True)
            rows.append({"cell": cell, "recommended": {str(name): count for name, count in names.items()}, "recordings": found})
            study.write(arguments.json, rows)
    print(f"fails: {'; '.join(faulty)}" if faulty else "passes", file=sys.stderr)
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
