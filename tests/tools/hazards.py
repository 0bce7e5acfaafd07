# SPDX-License-Identifier: Apache-2.0
"""Faults of the logger and the sensor, each as a change of a simulated recording that keeps its true values valid.

Faults of hands and pendulums are in hazards_of_motion.py; both register in HAZARDS.
"""

import collections.abc
import dataclasses
import math
import typing

from simulated_lab import Lab, Recording, log_uniform

Inject = collections.abc.Callable[[Lab, typing.Any], Recording]


@dataclasses.dataclass(frozen=True)
class Hazard:
    """One hazard at several strengths."""

    strengths: dict[str, typing.Any]
    inject: Inject
    exit_code: int = 0  # expected exit code if the motion is not a free swing
    warning: str = ""  # code of the warning expected with it


HAZARDS: dict[str, Hazard] = {}


def hazard(name: str, *strengths, unit: str = "", exit_code: int = 0, warning: str = ""):
    """Registers an injection under the name. Giving an exit code means that the recording is not a free swing."""

    def register(inject: Inject) -> Inject:
        labels = {f"{strength}{unit}": strength for strength in strengths or ("-",)}
        HAZARDS[name] = Hazard(labels, inject, exit_code, warning)
        return inject

    return register


def share_of_rows(lab: Lab, recording: Recording, share: float) -> list[int]:
    """Indices of this share of the rows, at least one, never the first."""
    count = max(1, round(share * len(recording.rows)))
    return sorted(lab.rng.sample(range(1, len(recording.rows)), count))


@hazard("none")
def _none(lab: Lab, _: str) -> Recording:
    return lab.swing()


# Clock and logger.


@hazard("gaps", 0.5, 2, 5, unit=" s")
def _gaps(lab: Lab, length: float) -> Recording:
    recording = lab.swing()
    count = min(lab.rng.randint(1, 3), int(lab.seconds / 2 / length))  # at least half of the recording remains
    starts = [lab.rng.uniform(0.5, lab.seconds - length - 0.5) for _ in range(count)]
    recording.rows = [row for row in recording.rows if not any(at <= row[0] < at + length for at in starts)]
    return recording


@hazard("event-driven", 1, 2, unit=" noise")
def _event_driven(lab: Lab, noises: float) -> Recording:
    """A logger that writes a row only for a new value."""
    lab.rate, lab.resolution = 200, noises * lab.noise
    recording = lab.swing()
    rows = recording.rows
    recording.rows = rows[:1] + [now for before, now in zip(rows, rows[1:]) if now[1] != before[1]]
    return recording


@hazard("duplicated stamps", 0.1, 1, 5, unit=" %")
def _duplicated(lab: Lab, percent: float) -> Recording:
    recording = lab.swing()
    times = [time for time, _ in recording.rows]
    for i in share_of_rows(lab, recording, percent / 100):
        recording.rows[i] = (times[i - 1], recording.rows[i][1])
    return recording


@hazard("non-increasing stamps", 1, 5, 20, unit=" rows")
def _non_increasing(lab: Lab, count: int) -> Recording:
    recording = lab.swing()
    for i in share_of_rows(lab, recording, count / len(recording.rows)):
        time, value = recording.rows[i]
        recording.rows[i] = (time - lab.rng.uniform(1.1, 2.5) / lab.rate, value)
    return recording


@hazard("frozen stamps", 3, 10, 30, unit=" rows")
def _frozen(lab: Lab, length: int) -> Recording:
    recording = lab.swing()
    for _ in range(lab.rng.randint(1, 3)):
        first = lab.rng.randrange(len(recording.rows) - length)
        for i in range(first, first + length):
            recording.rows[i] = (recording.rows[first][0], recording.rows[i][1])
    recording.rows.sort(key=lambda row: row[0])  # where two such runs of rows overlap
    return recording


@hazard("rounded stamps", 0.01, 0.03, 0.1, unit=" s")
def _rounded(lab: Lab, step: float) -> Recording:
    return lab.swing().stamps(lambda time: round(time / step) * step)


@hazard("micros() wraps", 0.02, 0.25, 0.5, 0.75, unit=" of it")
def _micros(lab: Lab, share: float) -> Recording:
    turn = 2**32
    offset = turn - round(share * lab.seconds * 1e6)
    recording = lab.swing().stamps(lambda time: (offset + round(time * 1e6)) % turn)
    recording.releases = [(time + offset / 1e6, angle) for time, angle in recording.releases]
    recording.header, recording.clock_turn = "time_us,angle_deg", turn / 1e6
    return recording


@hazard("clock scale", 0.1, 1, unit=" %")
def _clock(lab: Lab, percent: float) -> Recording:
    """The file gives the clock's scale with an error drawn from its standard deviation. Times stay on its clock."""
    stated = 1 + lab.rng.choice([-1, 1]) * percent / 100
    std_dev = 0.05 * percent / 100
    scale = lab.rng.gauss(stated, std_dev)
    recording = lab.swing().stamps(lambda time: time / scale)
    recording.releases = [(time / scale, angle) for time, angle in recording.releases]
    recording.metadata = [f"clock_scale: {stated!r}", f"clock_scale_std_dev: {std_dev!r}"]
    return recording


# Sensor.


@hazard("stale values", 2, 3, 5, unit=" rows")
def _stale(lab: Lab, length: int) -> Recording:
    """A tracker slower than the logger."""
    recording = lab.swing()
    values = [value for _, value in recording.rows]
    recording.rows = [(time, values[i - i % length]) for i, (time, _) in enumerate(recording.rows)]
    return recording


@hazard("spikes", 0.1, 1, 3, unit=" %")
def _spikes(lab: Lab, percent: float) -> Recording:
    recording = lab.swing()
    pairs = lab.rng.random() < 0.5
    for i in share_of_rows(lab, recording, percent / 100 / (2 if pairs else 1)):
        height = lab.rng.choice([-1, 1]) * lab.noise * log_uniform(lab.rng, 5, 100)
        for k in range(i, min(i + (2 if pairs else 1), len(recording.rows))):
            time, value = recording.rows[k]
            recording.rows[k] = (time, lab.quantize(value + height))
    return recording


@hazard("spikes to 0", 0.1, 1, 3, unit=" %")
def _spikes_to_zero(lab: Lab, percent: float) -> Recording:
    recording = lab.swing()
    for i in share_of_rows(lab, recording, percent / 100):
        recording.rows[i] = (recording.rows[i][0], 0.0)
    return recording


def saturated(lab: Lab, percent: float) -> Recording:
    """The sensor's range is smaller than the first peaks, on one side or on both."""
    middle, reach = math.degrees(lab.zero), math.degrees(lab.amplitude) * (1 - percent / 100)
    low, high = lab.rng.choice([(-1, 1), (-2, 1), (-1, 2)])
    low, high = lab.quantize(middle + low * reach), lab.quantize(middle + high * reach)
    recording = lab.swing().readings(lambda _, value: min(max(value, low), high))
    recording.metadata = [f"range: {low!r},{high!r}"]
    return recording


@hazard("saturated range told", 5, 20, 50, unit=" %")
def _saturated_told(lab: Lab, percent: float) -> Recording:
    return saturated(lab, percent)


@hazard("saturated range untold", 5, 20, 50, unit=" %")
def _saturated_untold(lab: Lab, percent: float) -> Recording:
    recording = saturated(lab, percent)
    recording.metadata = []
    return recording


def wrapped(lab: Lab, recording: Recording, low: float) -> Recording:
    """Readings wrapped to [low, low + 360)."""
    return recording.readings(lambda _, value: lab.quantize((value - low) % 360 + low))


def divide_turn(lab: Lab) -> None:
    """Makes a turn a whole number of sensor levels, as for an encoder."""
    lab.resolution = 360 / math.ceil(360 / lab.resolution)


@hazard("wraps at rest", 20, 50, 80, unit=" deg")
def _wraps_at_rest(lab: Lab, degrees: float) -> Recording:
    """Readings from 0 to 360 with rest at 0: every passage through the bottom jumps."""
    divide_turn(lab)
    lab.amplitude = math.radians(degrees)
    lab.start = lab.released()
    return wrapped(lab, lab.swing(), 0)


@hazard("wraps in large swings", 90, 130, 170, unit=" deg")
def _wraps_in_swing(lab: Lab, degrees: float) -> Recording:
    """Readings from -180 to 180 with rest so far from 0 that the swing crosses the jump on the side of the release."""
    divide_turn(lab)
    lab.amplitude = math.radians(degrees)
    lab.start = lab.released()
    lab.zero = math.copysign(math.radians(180 - degrees + lab.rng.uniform(5, 60)), lab.start["release_angle"])
    return wrapped(lab, lab.swing(), -180)


@hazard("hangs at 180 deg", "plain", "wrapped")
def _hangs_at_pi(lab: Lab, how: str) -> Recording:
    divide_turn(lab)
    lab.zero += math.pi
    return lab.swing() if how == "plain" else wrapped(lab, lab.swing(), -180)


# Readings of an encoder or a data logger in degrees: decimals, and whole fractions of a turn.
STEPS_DEG = (0.001, 0.01, 0.02, 0.05, 0.1, 360 / 4096, 360 / 8192, 360 / 16384, 360 / 32768, 360 / 65536)


def without_model(lab: Lab) -> None:
    """The user gives no model: the default is dry friction."""
    lab.model = "coulomb"
    lab.law.pop("drag", None)
    lab.law.setdefault("coulomb", lab.rng.uniform(0, 0.01))


@hazard("degrees labelled rad", 0.3, 0.6, 1.2, 2, 3, unit=" deg")
def _degrees_labelled_rad(lab: Lab, degrees: float) -> Recording:
    """A pendulum in small swings, whose period does not depend on the amplitude, as if it were a torsion spring."""
    without_model(lab)
    lab.amplitude, lab.zero = math.radians(degrees), 0
    lab.law["coulomb"] = lab.rng.uniform(0, 0.01) * lab.amplitude
    lab.resolution = lab.rng.choice([step for step in STEPS_DEG if step < 0.05 * degrees])
    lab.noise = lab.resolution * lab.rng.uniform(1, 3)
    lab.start = lab.released()
    recording = lab.swing()
    recording.header, recording.model_given = "time_s,angle_rad", False
    return recording


@hazard("radians labelled deg", 15, 40, 80, unit=" deg")
def _radians_labelled_deg(lab: Lab, degrees: float) -> Recording:
    """The readings are 57 times too small, but the period depends on the amplitude."""
    without_model(lab)
    lab.amplitude = math.radians(degrees)
    lab.start = lab.released()
    recording = lab.swing().readings(lambda _, value: math.radians(value))
    recording.model_given = False
    return recording


@hazard("spring without a model", 40, 60, 80, 170, unit=" deg")
def _spring(lab: Lab, degrees: float) -> Recording:
    """A torsion spring in degrees, with the default flags."""
    without_model(lab)
    lab.gravity, lab.amplitude = "linear", math.radians(degrees)
    lab.start = lab.released()
    recording = lab.swing()
    recording.model_given = False
    return recording


@hazard("encoder spring in rad", 60, 100, unit=" deg")
def _encoder_spring(lab: Lab, degrees: float) -> Recording:
    """The same in rad, with an encoder of a whole number of levels in a turn."""
    without_model(lab)
    lab.gravity, lab.amplitude, lab.zero = "linear", math.radians(degrees), 0
    lab.resolution = 360 / lab.rng.choice([500, 576, 578, 1000, 1024, 2048])
    lab.noise = lab.resolution * lab.rng.uniform(1, 2)
    lab.start = lab.released()
    recording = lab.swing().readings(lambda _, value: math.radians(value))
    recording.header, recording.model_given = "time_s,angle_rad", False
    return recording


@hazard("zero of the readings drifts", 0.05, 0.5, 5, unit=" deg")
def _drift(lab: Lab, degrees: float) -> Recording:
    resolution, lab.resolution = lab.resolution, 0
    recording = lab.swing()
    lab.resolution = resolution
    slope = lab.rng.choice([-1, 1]) * degrees / lab.seconds
    recording.zero_span = math.radians(degrees / 2)
    return recording.readings(lambda time, value: lab.quantize(value + slope * (time - lab.seconds / 2)))


@hazard("gyro with trembling hold", 0, 1, 5, unit=" deg/s")
def _gyro(lab: Lab, bias: float) -> Recording:
    """A hand trembles at 6 to 12 Hz until the release."""
    lab.unit, lab.hold, lab.zero = "deg_s", 2, math.radians(bias)
    lab.noise *= 2
    lab.resolution, resolution = 0, lab.resolution
    lab.start = lab.released()
    tremor = [(lab.rng.uniform(0.5, 2), 2 * math.pi * lab.rng.uniform(6, 12), lab.rng.uniform(0, 7)) for _ in range(3)]

    def trembling(time: float, value: float) -> float:
        fade = min(1, max(0, (lab.hold - time) / 0.1))
        return lab.quantize(value + fade * sum(size * math.sin(rate * time + phase) for size, rate, phase in tremor))

    recording = lab.swing()
    recording.header = "time_s,gyro_deg_s"
    lab.resolution = resolution
    return recording.readings(trembling)
