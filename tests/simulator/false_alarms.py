#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts how often fit_pendulum names a cause where nothing is wrong.

  false_alarms.py BIN_DIR [--count 2000] [--jobs 2] [--most 0.01] [--json OUT.json]

The recordings are those of the textbook rig with white or AR(1) noise and 8 to 14 bits, as many of each kind. Nothing is
stated about the sensor, so each cause may be suspected. A cause is named by a suspicion, or by a warning that stands for a
cause. Exit code 1 if the share is above --most, or if fewer than 0.9 of the parameters could be judged.
"""

import collections
import itertools
import json
import os
import pathlib
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import judging  # noqa: E402, because NumPy reads the environment when it is imported
import study  # noqa: E402
from lab import textbook_lab  # noqa: E402
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
    return study.fit(tool, lab, "coulomb", ANGLE)


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
    parser = study.parser_of(__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--most", type=float, default=0.01, help="largest share of alarms")
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    with study.runner(arguments.jobs) as run_all:
        found = summary(run_all(run, [(tool, index) for index in range(arguments.count)]))
    print(json.dumps(found, indent=1))
    study.write(arguments.json, found)
    too_many = found["alarms"] > arguments.most * found["recordings"]
    return 1 if too_many or found["judged"] < LEAST_JUDGED * found["expected"] else 0


if __name__ == "__main__":
    sys.exit(main())
