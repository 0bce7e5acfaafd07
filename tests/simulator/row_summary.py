# SPDX-License-Identifier: Apache-2.0
"""What the recordings of a row say together."""

import collections
import math
import statistics

from judging import Outcome
from scenarios import Row

LEAST_JUDGED = 0.9  # of the expected parameters, so that a tool that does not fit does not pass
COVERAGE = {"clean": (0.93, 0.97), "modelled": (0.93, 0.99), "budgeted": (0.93, 1.0)}  # of total 95 % intervals
# Warnings that tell the user to doubt the error bars without naming a cause.
DOUBTS = {"lack_of_fit", "correlated_residuals", "not_constant", "offset_unsteady", "offset_jumps", "another_minimum",
          "inertia_differs_from_rig", "zero_drift", "ends_trimmed", "presliding"}
LARGEST_Z = 99999  # beyond it a z is cut, so that the JSON has no infinity


def finite(value: float, digits: int) -> float:
    """The value rounded to significant digits, without infinities."""
    return float(f"{max(-LARGEST_Z, min(LARGEST_Z, value)):.{digits}g}")


def summarize(row: Row, outcomes: list[Outcome]) -> dict:
    """The row of the table: counts of recordings, median and extreme z, coverage and the reasons why it fails."""
    judged = [each for outcome in outcomes for each in outcome.judged.values()]
    named = [outcome.is_named(row.names) or (row.kind == "inherent" and outcome.is_ambiguous(row.names))
             for outcome in outcomes]
    said = [row.group == "friction" and outcome.is_unseen for outcome in outcomes]
    by_name = collections.defaultdict(list)
    for outcome in outcomes:
        for name, each in outcome.judged.items():
            by_name[name].append(each)
    summary = {
        "row": row.name, "group": row.group, "cause": row.words, "kind": row.kind, "model": row.model,
        "recordings": len(outcomes),
        "not_converged": sum(outcome.exit_code == 1 for outcome in outcomes),
        "failed": sum(outcome.exit_code not in (0, 1) for outcome in outcomes),
        "expected": sum(outcome.expected for outcome in outcomes),
        "judged": len(judged),
        "wrong": sum(outcome.is_wrong for outcome in outcomes),
        "silent": sum(outcome.is_wrong and not (is_named or is_said)
                      for outcome, is_named, is_said in zip(outcomes, named, said)),
        "silent_and_no_doubt": sum(
            outcome.is_wrong and not (is_named or is_said) and not DOUBTS.intersection(outcome.codes)
            for outcome, is_named, is_said in zip(outcomes, named, said)),
        "said": sum(said),
        "named": sum(named),
        "coverage": round(sum(each.is_covered for each in judged) / len(judged), 3) if judged else None,
        "z": {name: {"median": finite(statistics.median(each.z for each in of_name), 3),
                     "largest": finite(max((each.z for each in of_name), key=abs), 3),
                     "coverage": round(sum(each.is_covered for each in of_name) / len(of_name), 3),
                     "relative_error": finite(statistics.median(each.relative_error for each in of_name), 3)}
              for name, of_name in by_name.items()},
        "causes": dict(collections.Counter(cause for outcome in outcomes for cause in outcome.causes)),
        "codes": dict(collections.Counter(code for outcome in outcomes for code in outcome.codes)),
    }
    return summary | {"fails": faults(summary)}


def faults(summary: dict) -> list[str]:
    """Why a row does not pass; empty if it does. An inherent row passes if it names its cause whenever it is wrong."""
    found = []
    if summary["silent"]:
        found.append(f"{summary['silent']} silently wrong")
    if summary["failed"]:
        found.append(f"{summary['failed']} failed")
    if summary["judged"] < LEAST_JUDGED * summary["expected"]:
        found.append(f"{summary['judged']} of {summary['expected']} parameters judged")
    if summary["kind"] in COVERAGE and summary["judged"]:
        low, high = COVERAGE[summary["kind"]]
        spread = 2 * math.sqrt(0.05 * 0.95 / summary["judged"])
        if not low - spread <= summary["coverage"] <= high + spread:
            found.append(f"coverage {summary['coverage']:.2f}")
    return found
