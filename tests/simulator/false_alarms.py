#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts how often fit_pendulum names a cause where nothing is wrong.

  false_alarms.py BIN_DIR [--count 2000] [--jobs 2] [--most 0.01] [--json OUT.json]

The recordings are those of the textbook rig with white or AR(1) noise and 8 to 14 bits, as many of each kind. Nothing is
stated about the sensor, so each cause may be suspected. A cause is named by a suspicion, or by a warning that stands for a
cause. Exit code 1 if the share is above --most, or if fewer than 0.9 of the parameters could be judged.
"""

import argparse
import collections
import concurrent.futures
import itertools
import json
import os
import pathlib
import sys
import tempfile

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import judging  # noqa: E402, because NumPy reads the environment when it is imported
from lab import record, textbook_lab  # noqa: E402
from row_summary import LEAST_JUDGED  # noqa: E402
from scenarios import ANGLE, set_bits, set_noise  # noqa: E402

FIRST_SEED = 100_000
KINDS = list(itertools.product((8, 10, 12, 14), ((0.1, 0.0), (0.5, 0.0), (2.0, 0.0), (1.0, 0.5), (1.0, 0.9))))
# Beside those that name a cause, because the message advises to look for one; others, such as lack_of_fit, are counted beside.
ALARMS = judging.CAUSE_CODES | {"not_constant"}


def run(tool: pathlib.Path, index: int) -> judging.Outcome:
    """Simulates and fits one recording in which nothing is wrong."""
    bits, (counts, correlation) = KINDS[index % len(KINDS)]
    lab = textbook_lab(FIRST_SEED + index)
    set_bits(lab, bits)
    set_noise(lab, counts, correlation)
    with tempfile.TemporaryDirectory() as folder:
        return judging.fit(tool, pathlib.Path(folder), record(lab), "coulomb", ANGLE)


def summary(outcomes: list[judging.Outcome]) -> dict:
    """Counts of alarms, by kind of noise and by cause."""
    alarms = [outcome.causes + sorted(ALARMS.intersection(outcome.codes)) for outcome in outcomes]
    by_kind = collections.Counter(index % len(KINDS) for index, names in enumerate(alarms) if names)
    judged = [each for outcome in outcomes for each in outcome.judged.values()]
    return {
        "recordings": len(outcomes), "alarms": sum(map(bool, alarms)),
        "not_fitted": sum(outcome.exit_code != 0 for outcome in outcomes),
        "judged": len(judged), "expected": sum(outcome.expected for outcome in outcomes),
        "coverage": sum(each.is_covered for each in judged) / max(1, len(judged)),
        "wrong": sum(outcome.is_wrong for outcome in outcomes),
        "names": dict(collections.Counter(name for names in alarms for name in names)),
        "codes": dict(collections.Counter(code for outcome in outcomes for code in outcome.codes)),
        "kinds": {f"{bits} bits, noise {counts} counts, correlation {correlation}": by_kind[index]
                  for index, (bits, (counts, correlation)) in enumerate(KINDS) if by_kind[index]}}


def main() -> int:
    """Runs the recordings, prints the counts and returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin_dir", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--most", type=float, default=0.01, help="largest share of alarms")
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    tool = arguments.bin_dir.resolve() / "fit_pendulum"
    if not tool.exists():
        parser.error(f"there is no {tool}")
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        work = [pool.submit(run, tool, index) for index in range(arguments.count)]
        found = summary([future.result() for future in work])
    text = json.dumps(found, indent=1)
    print(text)
    if arguments.json:
        arguments.json.write_text(text + "\n", encoding="utf-8")
    too_many = found["alarms"] > arguments.most * found["recordings"]
    return 1 if too_many or found["judged"] < LEAST_JUDGED * found["expected"] else 0


if __name__ == "__main__":
    sys.exit(main())
