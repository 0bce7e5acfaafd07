#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the law coulomb to recordings whose dry friction builds up over an angle after each reversal (Dahl).

  presliding_study.py BIN_DIR [--stopping 72] [--varied 500] [--jobs 2] [--most 0.01] [--json OUT.json]

Two studies of a rig with G/I of 19.1 1/s^2 and the sensor of the table of hazards. Stiffness of presliding and amplitude are
drawn.
  stopping  dry friction stops the swing within 6 to 20 half swings, the recording ends 1.5 s later
  varied    the same with other amplitudes, 6 to 40 half swings, 20 to 500 samples a second, and windows of 0.4 to 1.2 of the
            time to the stop
Each prints the share of recordings with exit code 0 whose inertia or friction is more than 5 total errors from the truth (the
interval where it is wider), and z of inertia and the errors, separately where the tool tested whether the parameters are
constant. Exit code 1 if a share is above --most.
"""

import collections
import dataclasses
import math
import os
import pathlib
import statistics
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import judging  # noqa: E402, because NumPy reads the environment when it is imported
import study  # noqa: E402
from lab import GRAVITY_TORQUE, Lab, textbook_lab  # noqa: E402
from row_summary import finite, verdict  # noqa: E402
from scenarios import DEG, PRESLIDING, set_bristles  # noqa: E402

FIRST_SEEDS = {"stopping": 500_000, "varied": 600_000}
INERTIA = GRAVITY_TORQUE / 19.1  # kg m^2
HALF_SWING = math.pi / math.sqrt(19.1)  # s, of small swings
STIFFNESSES = (1.0, 30.0)  # N m/rad
JUDGED = ("inertia", "viscous", "coulomb")


def logarithmic(lab: Lab, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return math.exp(lab.rng.uniform(math.log(low), math.log(high)))


def stopping_coulomb(viscous: float, amplitude: float, half_swings: float) -> float:
    """Dry friction [N m] that stops a linear pendulum of this amplitude [rad] after so many half swings.

    A half swing takes A to A r - (1 + r) tau_c/G with r = exp(-b HALF_SWING/(2 I)).
    """
    ratio = math.exp(-viscous * HALF_SWING / (2 * INERTIA))
    taken = (1 + ratio) * (1 - ratio**half_swings) / (1 - ratio)
    return GRAVITY_TORQUE * amplitude * ratio**half_swings / taken


def drawn(name: str, seed: int) -> Lab:
    """The rig of one recording."""
    lab = textbook_lab(seed)
    is_varied = name == "varied"
    angle = lab.rng.uniform(*((5, 60) if is_varied else (8, 40))) * DEG
    half_swings = lab.rng.uniform(6, 40 if is_varied else 20)
    lab.set("body", inertia=INERTIA)
    lab.set("hand", angle=math.copysign(angle, lab.hand.angle))
    lab.set_friction(coulomb=stopping_coulomb(lab.law.viscous, angle, half_swings))
    set_bristles(lab, logarithmic(lab, *STIFFNESSES))
    swing = half_swings * HALF_SWING
    lab.duration = lab.hand.time + swing + 1.5
    if is_varied:
        lab.set("clock", rate=round(logarithmic(lab, 20, 500)))
        lab.duration = lab.hand.time + swing * lab.rng.uniform(0.4, 1.2)
    return lab


@dataclasses.dataclass(frozen=True)
class Fitted:
    """One recording: how it was drawn, and what the tool says."""

    seed: int
    drawn: dict
    outcome: judging.Outcome


def run(tool: pathlib.Path, name: str, seed: int) -> Fitted:
    """Simulates and fits one recording."""
    lab = drawn(name, seed)
    outcome = study.fit(tool, lab, "coulomb", JUDGED)
    return Fitted(seed, {"amplitude_deg": finite(abs(lab.hand.angle) / DEG, 3), "coulomb": finite(lab.law.coulomb, 3),
                         "presliding_deg": finite(lab.law.coulomb / lab.body.friction.stiffness / DEG, 3),
                         "rate_hz": lab.clock.rate, "swing_s": finite(lab.duration - lab.hand.time, 3)}, outcome)


def of_inertia(outcomes: list[judging.Outcome]) -> dict:
    """z of inertia and the total errors of these recordings."""
    z = [outcome.judged["inertia"].z for outcome in outcomes if "inertia" in outcome.judged]
    errors = {name: [outcome.judged[name].relative_error for outcome in outcomes if name in outcome.judged] for name in JUDGED}
    return {"recordings": len(outcomes), "with_error": len(z),
            "wrong": sum(outcome.is_wrong for outcome in outcomes),
            "z": {key: finite(value(z), 3) for key, value in (("median", statistics.median), ("lowest", min), ("highest", max))
                  if z},
            "relative_error": {name: finite(statistics.median(each), 3) for name, each in errors.items() if each}}


def summary(fits: list[Fitted]) -> dict:
    """What the recordings of a study say together."""
    converged = [fit.outcome for fit in fits if fit.outcome.exit_code == 0]
    wrong = [fit for fit in fits if fit.outcome.is_wrong]
    return {
        "recordings": len(fits), "exit_codes": dict(collections.Counter(fit.outcome.exit_code for fit in fits)),
        "wrong": len(wrong), "share_wrong": finite(len(wrong) / len(fits), 3) if fits else 0.0,
        "wrong_by": dict(collections.Counter(name for fit in wrong for name, each in fit.outcome.judged.items()
                                             if abs(each.z) > judging.WRONG)),
        "wrong_and": dict(collections.Counter(verdict(PRESLIDING, fit.outcome) for fit in wrong)),
        "named": sum(outcome.is_named(PRESLIDING) for outcome in converged),
        "without_error": {name: sum(name not in outcome.judged for outcome in converged) for name in JUDGED},
        "coverage": {name: finite(statistics.fmean(of_name), 3) for name in JUDGED
                     if (of_name := [outcome.judged[name].is_covered for outcome in converged if name in outcome.judged])},
        "tested": of_inertia([outcome for outcome in converged if outcome.is_constancy_tested]),
        "untested": of_inertia([outcome for outcome in converged if not outcome.is_constancy_tested]),
        "wrong_recordings": [{"seed": fit.seed, **fit.drawn, "is_tested": fit.outcome.is_constancy_tested,
                              "z": {name: finite(each.z, 3) for name, each in fit.outcome.judged.items()},
                              "codes": fit.outcome.codes} for fit in wrong]}


def text(study_name: str, found: dict) -> str:
    """The summary for the terminal."""
    lines = [f"{study_name}: {found['recordings']} recordings, exit codes {found['exit_codes']}",
             f"  wrong with exit 0: {found['wrong']} ({100 * found['share_wrong']:.1f} %) {found['wrong_by']}, "
             f"{found['wrong_and']}",
             f"  presliding or another law named in {found['named']}; without an error: {found['without_error']}",
             f"  covered: {found['coverage']}"]
    for name in ("tested", "untested"):
        of_name = found[name]
        errors = ", ".join(f"{each} {100 * value:.2g} %" for each, value in of_name["relative_error"].items())
        lines.append(f"  constancy {name}: {of_name['recordings']}, wrong {of_name['wrong']}; z of inertia {of_name['z']}; "
                     f"median total error {errors}")
    return "\n".join(lines)


def main() -> int:
    """Runs the studies, prints them and returns the exit code."""
    parser = study.parser_of(__doc__)
    parser.add_argument("--stopping", type=int, default=72)
    parser.add_argument("--varied", type=int, default=500)
    parser.add_argument("--most", type=float, default=0.01, help="largest share of wrong recordings")
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    found = {}
    with study.runner(arguments.jobs) as run_all:
        for name, count in (("stopping", arguments.stopping), ("varied", arguments.varied)):
            found[name] = summary(run_all(run, [(tool, name, FIRST_SEEDS[name] + index) for index in range(count)]))
            print(text(name, found[name]), flush=True)
    study.write(arguments.json, found)
    return 1 if any(each["share_wrong"] > arguments.most for each in found.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
