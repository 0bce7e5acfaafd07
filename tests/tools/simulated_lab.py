# SPDX-License-Identifier: Apache-2.0
"""A lab with a random pendulum. simulate_pendulum makes the free swings, and this module the motions by hand."""

import csv
import dataclasses
import json
import math
import pathlib
import random
import subprocess

Row = tuple[float, float]  # time [s], reading [deg or deg/s]
Start = dict[str, float]  # release_angle and release_time, or initial_angle and initial_rate


@dataclasses.dataclass
class Recording:
    """A recording as a user has it, and the true parameters."""

    rows: list[Row]
    truth: dict[str, float]  # the law and zero_angle or rate_bias; empty if the motion is not a free swing
    releases: list[Row] = dataclasses.field(default_factory=list)  # time [s] and angle [rad] of each
    metadata: list[str] = dataclasses.field(default_factory=list)
    header: str = "time_s,angle_deg"
    zero_span: float = 0  # rad: every zero within +- this of the true value was correct at some time
    clock_turn: float = 0  # s: the clock shows times modulo this; 0 for a normal clock
    model_given: bool = True  # whether the user gives --model

    def text(self) -> str:
        """The CSV file."""
        lines = [f"# {line}" for line in self.metadata] + [self.header]
        return "\n".join(lines + [f"{time:.12g},{value:.10g}" for time, value in self.rows]) + "\n"

    def readings(self, change) -> "Recording":
        """The recording with change(time, reading) in place of each reading."""
        self.rows = [(time, change(time, value)) for time, value in self.rows]
        return self

    def stamps(self, change) -> "Recording":
        """The recording with change(time) in place of each time stamp."""
        self.rows = [(change(time), value) for time, value in self.rows]
        return self


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    """A random number whose logarithm is uniform."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


class Lab:
    """One pendulum, its sensor and the hand. Hazards change the fields before they request a swing.

    White noise is at least one step of the sensor; otherwise the error bars of least squares would be wrong.
    """

    def __init__(self, simulator: pathlib.Path, folder: pathlib.Path, rng: random.Random, model: str):
        self.simulator, self.folder, self.rng, self.model = simulator, folder, rng, model
        inertia = log_uniform(rng, 0.02, 0.2)
        self.law = {"inertia": inertia, "viscous": 2 * log_uniform(rng, 0.005, 0.05) * math.sqrt(inertia)}
        if model != "viscous":
            self.law["coulomb"] = rng.uniform(0, 0.01)
        if model == "drag":
            self.law["drag"] = rng.uniform(0.02, 0.1) * inertia
        self.zero = math.radians(rng.uniform(-3, 3))  # or the bias of a rate sensor
        self.noise = rng.uniform(0.1, 0.5)
        self.resolution = self.noise * rng.uniform(0.3, 1)
        self.rate = rng.choice([50, 60, 75, 100, 125, 150, 200])
        self.seconds = rng.uniform(15, 30)
        self.unit = "deg"
        self.gravity = "sin"
        self.amplitude = math.radians(rng.uniform(15, 80))
        self.hold = rng.uniform(0.5, 3)
        self.start = self._moving() if rng.random() < 0.3 else self.released()

    @property
    def frequency(self) -> float:
        """Natural frequency, rad/s."""
        return 1 / math.sqrt(self.law["inertia"])

    def released(self, begin: int = 0) -> Start:
        """Held at the amplitude, on a random side, from sample `begin` on."""
        angle = self.rng.choice([-1, 1]) * self.amplitude
        return {"release_angle": angle, "release_time": begin / self.rate + self.hold}

    def _moving(self) -> Start:
        angle = self.amplitude * self.rng.uniform(-0.9, 0.9)
        rate = self.frequency * math.sqrt(2 * (math.cos(angle) - math.cos(self.amplitude)))
        return {"initial_angle": angle, "initial_rate": self.rng.choice([-1, 1]) * rate}

    def quantize(self, reading: float) -> float:
        """The nearest level of the sensor."""
        return round(reading / self.resolution) * self.resolution if self.resolution else reading

    def read(self, angle: float) -> float:
        """A reading [deg] of the angle [rad]."""
        return self.quantize(math.degrees(angle + self.zero) + self.rng.gauss(0, self.noise))

    def trace(self, start: Start, begin: int = 0, seconds: float | None = None, clean_unit: str = "") -> list[Row]:
        """A simulated swing from sample `begin` on; with a clean unit it has no noise, steps or offset."""
        unit = clean_unit or self.unit
        offset = "zero_angle" if unit in ("deg", "rad") else "rate_bias"
        values = {**self.law, **start, offset: 0 if clean_unit else self.zero}
        flags = {"model": self.model, "gravity": self.gravity, "unit": unit, "rate": self.rate,
                 "seed": self.rng.randrange(1, 2**31), "start_time": begin / self.rate,
                 "duration": self.seconds if seconds is None else seconds,
                 "noise": 0 if clean_unit else self.noise, "resolution": 0 if clean_unit else self.resolution,
                 "set": ",".join(f"{name}={value!r}" for name, value in values.items()),
                 "out": self.folder / "simulated.csv", "truth": self.folder / "simulated_truth.json"}
        command = [self.simulator, *(f"--{name}={value}" for name, value in flags.items())]
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=60)
        with (self.folder / "simulated.csv").open(encoding="utf-8") as file:
            lines = list(csv.reader(line for line in file if not line.startswith("#")))
        return [(float(time), float(value)) for time, value in lines[1:]]

    def recording(self, rows: list[Row], releases: list[Row]) -> Recording:
        """A recording of these rows, with the last simulated true values."""
        known = json.loads((self.folder / "simulated_truth.json").read_text(encoding="utf-8"))
        names = [*self.law, "zero_angle" if self.unit == "deg" else "rate_bias"]
        return Recording(rows, {name: known[name] for name in names}, releases, header=f"time_s,angle_{self.unit}")

    def swing(self) -> Recording:
        """The free swing from self.start."""
        released = "release_time" in self.start
        releases = [(self.start["release_time"], self.start["release_angle"])] if released else []
        return self.recording(self.trace(self.start), releases)

    def state(self, sample: int) -> tuple[float, float]:
        """Angle and rate of the free swing from self.start at a sample."""
        angles, rates = (self.trace(self.start, clean_unit=unit) for unit in ("rad", "rad_s"))
        return angles[sample][1], rates[sample][1]

    def peak_rate(self, sample: int) -> float:
        """The rate [rad/s] at its next passage through zero, from its energy at a sample."""
        angle, rate = self.state(sample)
        return math.sqrt(rate**2 + 2 * self.frequency**2 * (1 - math.cos(angle)))

    def by_hand(self, begin: int, angle: float, moves: list[Row]) -> list[Row]:
        """Readings from sample `begin` on while a hand leads the pendulum, starting at the angle [rad]. Each move is (seconds,
        angle at its end)."""
        rows: list[Row] = []
        for seconds, target in moves:
            count = max(1, round(seconds * self.rate))
            for i in range(count):
                at = angle + (target - angle) * (1 - math.cos(math.pi * i / count)) / 2
                rows.append(((begin + len(rows)) / self.rate, self.read(at)))
            angle = target
        return rows

    def wander(self, seconds: float, end: float | None = None) -> list[Row]:
        """Random moves of a hand, which finish at `end`."""
        moves: list[Row] = []
        while seconds > 0:
            step = min(seconds, self.rng.uniform(0.3, 1.2))
            moves.append((step, self.rng.uniform(-1, 1)))
            seconds -= step
        return moves if end is None else [*moves[:-1], (max(0.5, moves[-1][0]), end)]
