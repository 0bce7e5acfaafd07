#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the law stribeck to recordings in which the pendulum sticks at the end, which alone tells of stiction.

  stiction_study.py BIN_DIR [--count 200] [--rates 0.03,0.05,0.1,0.3,1] [--jobs 2] [--json OUT.json]

A rig with G of 3.708 N m, inertia 0.12, viscous 0.015, coulomb 0.03 and stiction 0.06 (each drawn with a few per cent), released
at 1.2 rad, an encoder of 4096 counts with noise of 0.15 count, 200 samples a second for 30 s; the user states G and a sensor
without faults. For each Stribeck rate [rad/s] it prints exit codes, the share of recordings in which the answer is wrong with
exit code 0, and for each parameter how many have an interval, the coverage of the intervals, z, the median error, and the
median of the error over the least possible one: that of the Cramér-Rao bound, from differences of simulated motions at the
true values and the information of rounded readings.
Exit code 1 if fewer than 95 % of the recordings of a rate end with a result, more than 1 % are wrong, or intervals of a
parameter cover less than 0.9 or are more than 1.5 times as long as the bound says.
"""

import collections
import copy
import math
import os
import pathlib
import statistics
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy  # noqa: E402, because it reads the environment when it is imported
from scipy.stats import norm  # noqa: E402

import judging  # noqa: E402
import study  # noqa: E402
from lab import Lab, textbook_lab, true_motion  # noqa: E402
from motion import Array  # noqa: E402
from row_summary import finite, of_parameter  # noqa: E402

FIRST_SEED = 800_000
BOUNDED = 40  # recordings of a rate for which the bound is computed
GRAVITY_TORQUE = 1.8 * 9.81 * 0.21  # N m
ALWAYS = ("inertia", "viscous", "release_angle", "release_time", "zero_angle")
FRICTION = ("coulomb", "stiction", "stribeck_rate")
LEAST_ENDED, MOST_WRONG, LEAST_COVERED, LONGEST = 0.95, 0.01, 0.9, 1.5
# Where each parameter is in a lab, and the step of its differences, small beside its error.
PLACES = {"inertia": ("body", "inertia", 1e-7), "viscous": ("friction", "viscous", 1e-6), "coulomb": ("friction", "coulomb", 1e-6),
          "stiction": ("friction", "stiction", 1e-6), "stribeck_rate": ("friction", "stribeck_rate", 1e-5),
          "release_angle": ("hand", "angle", 1e-6), "release_time": ("hand", "time", 1e-6), "zero_angle": ("sensor", "zero", 1e-6)}


def drawn(rate: float, seed: int) -> Lab:
    """The rig of one recording."""
    lab = textbook_lab(seed)

    def near(value: float) -> float:
        return value * lab.rng.uniform(0.95, 1.05)

    lab.set("body", inertia=near(0.12), gravity_torque=GRAVITY_TORQUE, mass=1.8)
    lab.set_friction(viscous=near(0.015), coulomb=near(0.03), stiction=near(0.06), stribeck_rate=near(rate))
    lab.set("hand", angle=near(1.2), time=lab.rng.uniform(1.45, 1.55))
    step = 2 * math.pi / 4096
    lab.set("sensor", zero=-0.01, sigma=0.15 * step, resolution=step)
    lab.set("clock", rate=200.0)
    lab.rig = {"gravity_torque": {"value": GRAVITY_TORQUE, "std_dev": 0}}
    lab.duration = 30.0
    return lab


def information(sigma: float, step: float) -> float:
    """Fisher's information on the value in one rounded reading, on average over where the value lies between two levels."""
    places = numpy.linspace(0, 1, 201)[:-1, None]
    edges = numpy.arange(-10, 12)[None, :] - 0.5
    below = norm.cdf((edges - places) * step / sigma)
    slope = -norm.pdf((edges - places) * step / sigma) / sigma
    chance, change = numpy.diff(below, axis=1), numpy.diff(slope, axis=1)
    return float(numpy.mean(numpy.sum(numpy.where(chance > 1e-300, change**2 / numpy.maximum(chance, 1e-300), 0), axis=1)))


def readings(lab: Lab, times: Array) -> Array:
    """Readings without noise."""
    return true_motion(lab).angle(times) + lab.sensor.zero


def moved(lab: Lab, name: str, by: float) -> Lab:
    """The lab with one parameter changed."""
    part, key, _ = PLACES[name]
    other = copy.copy(lab)
    if part == "friction":
        other.set_friction(**{key: getattr(lab.law, key) + by})
    else:
        other.set(part, **{key: getattr(getattr(lab, part), key) + by})
    return other


def least_errors(lab: Lab) -> dict[str, float]:
    """The Cramér-Rao bounds of the standard errors, from central differences at the true values."""
    times = lab.clock.true_times(lab.duration, lab.rng)
    slopes = [(readings(moved(lab, name, step), times) - readings(moved(lab, name, -step), times)) / (2 * step)
              for name, (_, _, step) in PLACES.items()]
    slopes = numpy.array(slopes)
    scale = numpy.linalg.norm(slopes, axis=1)
    normal = (slopes / scale[:, None]) @ (slopes / scale[:, None]).T * information(lab.sensor.sigma, lab.sensor.resolution)
    errors = numpy.sqrt(numpy.diag(numpy.linalg.inv(normal))) / scale
    return dict(zip(PLACES, errors.tolist()))


def run(tool: pathlib.Path, rate: float, seed: int) -> tuple[int, judging.Outcome, dict[str, float]]:
    """Simulates and fits one recording. Returns its seed, the outcome, and each parameter's error over
    its bound, for the first recordings."""
    outcome = study.fit(tool, drawn(rate, seed), "stribeck", ALWAYS, judging.EXACT_SENSOR, FRICTION)
    if seed >= FIRST_SEED + BOUNDED:
        return seed, outcome, {}
    lab = drawn(rate, seed)
    least = least_errors(lab)
    truth = {name: getattr(lab.law if part == "friction" else getattr(lab, part), key) for name, (part, key, _) in PLACES.items()}
    longer = {name: outcome.judged[name].relative_error * abs(truth[name]) / least[name] for name in outcome.judged
              if name in truth}
    return seed, outcome, longer


def summary(fits: list[tuple[int, judging.Outcome, dict[str, float]]]) -> dict:
    """What the recordings of one rate say together."""
    ended = [outcome for _, outcome, _ in fits if outcome.exit_code == 0]
    over_least = {name: finite(statistics.median(longer[name] for _, _, longer in fits if name in longer), 3)
                  for name in PLACES if any(name in longer for _, _, longer in fits)}
    judged = {name: [outcome.judged[name] for outcome in ended if name in outcome.judged] for name in (*ALWAYS, *FRICTION)}
    return {"recordings": len(fits), "exit_codes": dict(collections.Counter(each.exit_code for _, each, _ in fits)),
            "ended": finite(len(ended) / len(fits), 3),
            "wrong": [{"seed": seed, "z": {name: finite(each.z, 3) for name, each in outcome.judged.items()}}
                      for seed, outcome, _ in fits if outcome.is_wrong],
            "without": [{"seed": seed, "message": outcome.message} for seed, outcome, _ in fits if outcome.exit_code],
            "doubted": sum(outcome.is_doubted for outcome in ended),
            "codes": dict(collections.Counter(code for outcome in ended for code in (*outcome.codes, *outcome.causes))),
            "parameters": {name: of_parameter(of_name) | {"over_least": over_least.get(name, 0.0)}
                           for name, of_name in judged.items() if of_name}}


def text(rate: float, found: dict) -> str:
    """The summary for the terminal."""
    lines = [f"{rate} rad/s: {found['recordings']} recordings, exit codes {found['exit_codes']}, wrong "
             f"{len(found['wrong'])}, doubted {found['doubted']}, {found['codes']}"]
    lines += [f"  {name:<14} {each}" for name, each in found["parameters"].items()]
    lines += [f"  wrong: {each}" for each in found["wrong"][:6]] + [f"  {each}" for each in found["without"][:6]]
    return "\n".join(lines)


def fails(found: dict) -> bool:
    """Whether the recordings of a rate miss what they must show."""
    return (found["ended"] < LEAST_ENDED or len(found["wrong"]) > MOST_WRONG * found["recordings"] or
            any(each["coverage"] < LEAST_COVERED or each["over_least"] > LONGEST for each in found["parameters"].values()))


def main() -> int:
    """Runs the study, prints it and returns the exit code."""
    parser = study.parser_of(__doc__)
    parser.add_argument("--count", type=int, default=200, help="recordings of each rate")
    parser.add_argument("--rates", default="0.03,0.05,0.1,0.3,1")
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    found = {}
    with study.runner(arguments.jobs) as run_all:
        for rate in map(float, arguments.rates.split(",")):
            found[rate] = summary(run_all(run, [(tool, rate, FIRST_SEED + index) for index in range(arguments.count)]))
            print(text(rate, found[rate]), flush=True)
    study.write(arguments.json, found)
    return 1 if any(map(fails, found.values())) else 0


if __name__ == "__main__":
    sys.exit(main())
