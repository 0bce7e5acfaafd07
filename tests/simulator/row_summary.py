# SPDX-License-Identifier: Apache-2.0
"""What the recordings of a row say together."""

import collections.abc
import math
import statistics

from judging import START, Judged, Outcome
from scenarios import Row

LEAST_JUDGED = 0.9  # of the recordings, for each parameter, so that a tool that withdraws its errors does not pass
COVERAGE = {"exact": (0.93, 0.97), "clean": (0.93, 1.0), "modelled": (0.93, 0.99), "budgeted": (0.93, 1.0),
            "inherent": (0.93, 1.0)}  # of total 95 % intervals
USELESS = 0.5  # of the value: a total error above it is no result,
WIDER = 2.0  # unless noise alone explains it: the error is below this many times that of noise
# Of the recordings of a row, or one: tests at 1 in 1000 sometimes reject. A tool that always doubts would be silent nowhere,
# and one that names a wrong cause sends the reader to look at the wrong part.
MOST_ALARMS = 0.1
LARGEST_Z = 99999  # beyond it a z is cut, so that the JSON has no infinity


def finite(value: float, digits: int) -> float:
    """The value rounded to significant digits, without infinities."""
    return float(f"{max(-LARGEST_Z, min(LARGEST_Z, value)):.{digits}g}")


def share_covered(judged: list[Judged]) -> float | None:
    """Share of the total 95 % intervals that contain the true value."""
    return round(sum(each.is_covered for each in judged) / len(judged), 3) if judged else None


def of_parameter(judged: list[Judged]) -> dict:
    """z and errors of one parameter."""
    return {"judged": len(judged),
            "median": finite(statistics.median(each.z for each in judged), 3),
            "rms": finite(math.sqrt(statistics.fmean(min(abs(each.z), LARGEST_Z)**2 for each in judged)), 3),
            "largest": finite(max((each.z for each in judged), key=abs), 3),
            "coverage": share_covered(judged),
            "relative_error": finite(statistics.median(each.relative_error for each in judged), 3)}


def verdict(names: collections.abc.Set[str], outcome: Outcome) -> str:
    """Of a recording whose inertia or friction is wrong: what the tool says of it. The first that applies counts."""
    if outcome.is_named(names):
        return "named"
    if outcome.is_doubted:
        return "doubted"
    return "misnamed" if outcome.is_misnamed(names) else "silent"


def is_remarked(row: Row, outcome: Outcome) -> bool:
    """Whether a remark that stands in every report would explain what is wrong."""
    return (row.group == "friction" and outcome.is_unseen) or (row.kind == "inherent" and outcome.is_remarked(row.names))


def summarize(row: Row, outcomes: list[Outcome], noise: dict | None = None) -> dict:
    """The row of the table: counts of recordings, z, errors and coverage, and the reasons why it fails. `noise` is the row with
    the errors of noise alone."""
    by_name = collections.defaultdict(list)
    for outcome in outcomes:
        for name, each in outcome.judged.items():
            by_name[name].append(each)
    wrong = [outcome for outcome in outcomes if outcome.is_wrong]
    verdicts = collections.Counter(verdict(row.names, outcome) for outcome in wrong)
    without_warning = [each for outcome in outcomes if not (outcome.is_named(row.names) or outcome.is_doubted)
                       for each in outcome.judged.values()]
    all_judged = [each for of_name in by_name.values() for each in of_name]
    summary = {
        "row": row.name, "group": row.group, "cause": row.words, "kind": row.kind, "model": row.model,
        "is_core": row.is_core, "reference": row.reference, "parameters": list(row.parameters), "recordings": len(outcomes),
        "not_converged": sum(outcome.exit_code == 1 for outcome in outcomes),
        "failed": sum(outcome.exit_code not in (0, 1) for outcome in outcomes),
        "expected": sum(outcome.expected for outcome in outcomes),
        "judged": len(all_judged),
        # Of the recordings whose inertia or friction is wrong:
        "wrong": len(wrong),
        "silent": verdicts["silent"],
        "doubted_wrong": verdicts["doubted"],
        "misnamed_wrong": verdicts["misnamed"],
        "named_wrong": verdicts["named"],
        "remarked": sum(verdict(row.names, outcome) == "silent" and is_remarked(row, outcome) for outcome in wrong),
        # Of all recordings:
        "silent_start": sum(outcome.is_start_wrong and verdict(row.names, outcome) in ("silent", "misnamed")
                            for outcome in outcomes),
        "doubted": sum(outcome.is_doubted for outcome in outcomes),
        "named": sum(outcome.is_named(row.names) for outcome in outcomes),
        "misnamed": sum(outcome.is_misnamed(row.names) for outcome in outcomes),
        "coverage": share_covered(all_judged),
        "coverage_without_warning": share_covered(without_warning),
        "z": {name: of_parameter(of_name) for name, of_name in by_name.items()},
        "causes": dict(collections.Counter(cause for outcome in outcomes for cause in outcome.causes)),
        "codes": dict(collections.Counter(code for outcome in outcomes for code in outcome.codes)),
    }
    return summary | {"fails": faults(summary, noise)}


def judged_in(summary: dict, name: str) -> int:
    """The number of recordings whose fit has an error of this parameter, or of what replaces it in motion."""
    others = {"release_angle": "initial_angle", "release_time": "initial_rate"}
    return sum(summary["z"][each]["judged"] for each in (name, others.get(name)) if each in summary["z"])


def faults(summary: dict, noise: dict | None = None) -> list[str]:
    """Why a row does not pass; empty if it does."""
    of_noise = {name: each["relative_error"] for name, each in noise["z"].items()} if noise else {}
    found = [f"{summary[key]} {words}" for key, words in (
        ("silent", "silently wrong"), ("misnamed_wrong", "wrong, with another cause named"),
        ("silent_start", "silently wrong about the start"), ("failed", "failed")) if summary[key]]
    for name in summary["parameters"]:
        if judged_in(summary, name) < LEAST_JUDGED * summary["recordings"]:
            found.append(f"{name} without an error in {summary['recordings'] - judged_in(summary, name)}")
    for name, of_name in summary["z"].items():
        if name not in START and of_name["relative_error"] > max(USELESS, WIDER * of_noise.get(name, 0.0)):
            found.append(f"{name} ± {100 * of_name['relative_error']:.0f} %")
    most, is_clean = max(1, MOST_ALARMS * summary["recordings"]), summary["kind"] in ("exact", "clean")
    if summary["misnamed"] > most:
        found.append(f"{summary['misnamed']} {'false alarms' if is_clean else 'with another cause named'}")
    if is_clean and summary["doubted"] > most:
        found.append(f"{summary['doubted']} false doubts")
    return found + coverage_faults(summary)


def coverage_faults(summary: dict) -> list[str]:
    """Whether the intervals cover too seldom or too often. Of what the fit cannot have only those without a warning count."""
    coverage = summary["coverage_without_warning" if summary["kind"] == "inherent" else "coverage"]
    if coverage is None:
        return []
    low, high = COVERAGE[summary["kind"]]
    spread = 2 * math.sqrt(0.05 * 0.95 / summary["judged"])
    return [] if low - spread <= coverage <= high + spread else [f"coverage {coverage:.2f}"]
