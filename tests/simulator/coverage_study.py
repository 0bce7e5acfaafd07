#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts how often fit_pendulum's total intervals contain the truth if defects are drawn from what the user states of them.

  coverage_study.py BIN_DIR [--count 2000] [--jobs 2] [--cells 'gain,lag*'] [--json OUT.json]

A cell is one or more causes. Each recording of the textbook rig has a size of each of them, drawn from the standard
deviation that its user states with --sensor or in the rig; the other causes have none, which is stated too. In the cell
`defaults` the user states nothing of the sensor, and all its causes are drawn from what is assumed for an angle sensor
(src/docs/rigs_and_calibration.md). In the cells `clean` all is exact; noise, length and resolution differ. In the cells `means`
each row is the mean of some readings, which the file says. Exit code 1 if a parameter of a cell has a share of 95 %
intervals with the truth outside COVERAGE by more than two standard deviations of such a count, or a root mean square of z
below LEAST_Z, if too many estimates have no error, or if more than MOST_ALARMS of the clean recordings are doubted or have a
cause named.
"""

import collections
import dataclasses
import math
import os
import pathlib
import sys
import zlib

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy  # noqa: E402, because it reads the environment when it is imported

import judging  # noqa: E402
import study  # noqa: E402
from lab import RIG, Lab, textbook_lab  # noqa: E402
from row_summary import LEAST_JUDGED, of_parameter  # noqa: E402
from scenarios import ANGLE, DEG, ROWS, set_mean, set_noise  # noqa: E402

FIRST_SEED = 200_000
COVERAGE = (0.93, 0.97)
# What a bent curve shows at angle 0 is its own zero, but the budget of the zero counts all of the bend.
MAY_COVER_MORE = {"zero_angle"}
LEAST_Z = 0.4
ORDERS = 7  # of Legendre's polynomials, the bent curve of a sensor: 0 and 2 to 6
WARMING = 5  # time constants of a warm-up in a recording
# Standard deviations: relative, rad, s. As --sensor states them, and as they are assumed for an angle sensor and its clock.
STATED = {"gain": 0.01, "nonlinearity": 0.1 * DEG, "lag": 0.005, "backlash": 0.05 * DEG, "drift": 0.05 * DEG, "clock": 0.003}
ASSUMED = {"gain": 0.01, "nonlinearity": 0.25 * DEG, "lag": 0.012, "backlash": 0.05 * DEG, "drift": 0.05 * DEG, "clock": 5e-5}
ASSUMED_CUBIC = 0.01  # of the amplitude
# Those of a rig: kg, m, m/s^2.
RIG_SIZES = {"bob_mass": 0.001, "rod_mass": 0.001, "rod_length": 0.001, "gravity": 0.015}
MOST_ALARMS = 0.01
QUIET = 0.1  # counts of noise; of means with no more, rounding hides the noise, and intervals may cover more


@dataclasses.dataclass(frozen=True)
class Cell:
    """Causes whose sizes are drawn, or a change of clean recordings."""

    causes: tuple[str, ...] = ()
    change: collections.abc.Callable[[Lab], None] | None = None
    is_clean: bool = False
    highest: float = COVERAGE[1]


def mean_cell(conversions: int, counts: float) -> Cell:
    """Means of so many readings with noise of so many counts each."""
    return Cell(change=lambda lab: set_mean(lab, conversions, counts, "count"), is_clean=True,
                highest=1.0 if counts <= QUIET else COVERAGE[1])


CHANGES = {"AR(1) 0.5": lambda lab: set_noise(lab, 0.25, 0.5),
           **{words: ROWS[f"exact_{row}"].change
              for words, row in (("AR(1) 0.9", "ar"), ("AR(1) 0.5, 1 count", "ar_0.5"), ("AR(1) 0.9, 1 count", "ar_0.9"),
                                 ("0.1 count", "quiet"), ("4 s", "short"), ("to rest", "rest"), ("8 bits", "8_bits"),
                                 ("12 bits", "12_bits"), ("14 bits", "14_bits"))}}
CELLS = {"clean": Cell(is_clean=True), **{name: Cell((name,)) for name in (*STATED, "rig")},
         "gain, lag, clock": Cell(("gain", "lag", "clock")),
         "nonlinearity, backlash, drift": Cell(("nonlinearity", "backlash", "drift")),
         "rig, gain, drift": Cell(("rig", "gain", "drift")),
         "lag, nonlinearity, clock": Cell(("lag", "nonlinearity", "clock")),
         "defaults": Cell(tuple(ASSUMED)),
         **{f"clean, {name}": Cell(change=change, is_clean=True) for name, change in CHANGES.items()},
         **{f"means of {conversions}, {counts} count": mean_cell(conversions, counts)
            for conversions in (4, 16) for counts in (0, 0.1, 0.25, 0.5)}}


def draw_sensor(lab: Lab, causes: tuple[str, ...], sizes: dict[str, float]) -> None:
    """Draws the sizes of the sensor's causes. A lag and a play have one sign; the hold is anywhere in the gap."""
    def draw(cause: str) -> float:
        return lab.rng.normal(0, sizes[cause]) if cause in causes else 0.0

    scale = abs(lab.hand.angle)
    bends = [0.0 if order == 1 else draw("nonlinearity") for order in range(ORDERS)]
    if sizes is ASSUMED:
        bends[3] *= ASSUMED_CUBIC * scale / sizes["nonlinearity"]
    lab.set_curve(gain=draw("gain"), bends=tuple(bends), scale=scale)
    lab.set("sensor", delay=abs(draw("lag")), play=abs(draw("backlash")), play_place=lab.rng.uniform(-1, 1),
            drift=draw("drift"), thermal=draw("drift"), thermal_time=lab.duration / WARMING)
    lab.set("clock", drift=draw("clock"))


def draw_rig(lab: Lab) -> None:
    """Draws the rig's true values about those that its user states, with their errors."""
    true = {key: value + lab.rng.normal(0, RIG_SIZES[key]) for key, value in RIG.items()}
    length, bob, rod = true["rod_length"], true["bob_mass"], true["rod_mass"]
    lab.set("body", gravity_torque=(bob + rod / 2) * true["gravity"] * length, mass=bob + rod, gravity=true["gravity"],
            inertia=(bob + rod / 3) * length**2)
    lab.rig = {key: {"value": value, "std_dev": RIG_SIZES[key]} for key, value in RIG.items()}


def run(tool: pathlib.Path, cell: str, seed: int) -> judging.Outcome:
    """Simulates and fits one recording."""
    lab, causes, change = textbook_lab(seed), CELLS[cell].causes, CELLS[cell].change
    lab.rng = numpy.random.default_rng([seed, zlib.crc32(cell.encode())])
    is_stated = cell != "defaults"
    draw_sensor(lab, causes, STATED if is_stated else ASSUMED)
    if "rig" in causes:
        draw_rig(lab)
    if change:
        change(lab)
    sensor = judging.EXACT_SENSOR | {cause: STATED[cause] for cause in causes if cause in STATED} if is_stated else None
    return study.fit(tool, lab, "coulomb", ANGLE, sensor)


def summary(cell: str, outcomes: list[judging.Outcome]) -> dict:
    """What the recordings of a cell say together."""
    by_name = collections.defaultdict(list)
    for outcome in outcomes:
        for name, each in outcome.judged.items():
            by_name[name].append(each)
    return {"cell": cell, "recordings": len(outcomes),
            "judged": sum(map(len, by_name.values())), "expected": sum(outcome.expected for outcome in outcomes),
            "named": sum(bool(outcome.all_causes) for outcome in outcomes),
            "alarms": sum(outcome.is_doubted or bool(outcome.all_causes) for outcome in outcomes),
            "codes": dict(collections.Counter(code for outcome in outcomes for code in (*outcome.codes, *outcome.causes))),
            "z": {name: of_parameter(by_name[name]) for name in ANGLE if by_name[name]}}


def faults(found: dict) -> list[str]:
    """Why a cell does not pass; empty if it does."""
    cell, low, faulty = CELLS[found["cell"]], COVERAGE[0], []
    for name, each in found["z"].items():
        spread = 2 * math.sqrt(0.05 * 0.95 / each["judged"])
        highest = 1 if name in MAY_COVER_MORE else cell.highest + spread
        if not low - spread <= each["coverage"] <= highest or each["rms"] < LEAST_Z:
            faulty.append(f"{name} covered {each['coverage']:.3f}, rms z {each['rms']:.2f}")
    if found["judged"] < LEAST_JUDGED * found["expected"]:
        faulty.append(f"{found['expected'] - found['judged']} of {found['expected']} without an error")
    if cell.is_clean and found["alarms"] > MOST_ALARMS * found["recordings"]:
        faulty.append(f"{found['alarms']} alarms")
    return faulty


def line(found: dict) -> str:
    """A row of the printed table: coverage and rms z of each parameter."""
    numbers = "".join(f"{each['coverage']:7.3f} {each['rms']:5.2f}" for each in found["z"].values())
    return f"{found['cell']:30}{found['named']:6}{found['alarms']:7} {numbers}  {'; '.join(faults(found)) or 'passes'}"


def main() -> int:
    """Runs the cells, prints a row of each and returns the exit code."""
    parser = study.parser_of(__doc__)
    parser.add_argument("--count", type=int, default=2000, help="recordings of each cell")
    study.add_cells(parser)
    arguments = parser.parse_args()
    tool = study.tool_of(parser, arguments)
    cells = study.cells_of(parser, arguments, CELLS)
    print(f"{'cell':30}{'named':>6}{'alarms':>7} " + "".join(f"{name[:12]:>13}" for name in ANGLE))
    rows = []
    with study.runner(arguments.jobs) as run_all:
        for cell in cells:
            rows.append(summary(cell, run_all(run, [(tool, cell, FIRST_SEED + index) for index in range(arguments.count)])))
            print(line(rows[-1]), flush=True)
            study.write(arguments.json, rows)
    return 1 if any(map(faults, rows)) else 0


if __name__ == "__main__":
    sys.exit(main())
