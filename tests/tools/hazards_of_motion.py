# SPDX-License-Identifier: Apache-2.0
"""Faults of hands and pendulums during a recording, registered in hazards.HAZARDS next to the logger's faults."""

import collections.abc
import math

from hazards import divide_turn, hazard, wrapped
from simulated_lab import Lab, Recording, Row

# Hand.


@hazard("junk before release", 1, 2.5, 5, unit=" s")
def _junk_before(lab: Lab, seconds: float) -> Recording:
    angle = lab.released()["release_angle"]
    junk = lab.by_hand(0, lab.rng.uniform(-1, 1), lab.wander(seconds, angle))
    time = len(junk) / lab.rate + lab.hold
    rows = lab.trace({"release_angle": angle, "release_time": time}, len(junk))
    return lab.recording(junk + rows, [(time, angle)])


@hazard("junk at the end", 1, 3, 5, unit=" s")
def _junk_after(lab: Lab, seconds: float) -> Recording:
    """The sensor is removed after the swing."""
    recording = lab.swing()
    last = math.radians(recording.rows[-1][1]) - lab.zero
    recording.rows += lab.by_hand(len(recording.rows), last, lab.wander(seconds))
    return recording


@hazard("hand pushes first half swing", 5, 20, 50, unit=" %")
def _hand_contact(lab: Lab, percent: float) -> Recording:
    """A hand leads the pendulum through the first half swing at its own pace and releases it farther out than a free
    pendulum would get.

    The moment and the angle of the release are then ambiguous, so there is no release to compare with.
    """
    held = lab.released()
    angle = held["release_angle"]
    far = -angle * (1 + percent / 100)
    rows = lab.by_hand(0, angle, [(lab.hold, angle), (math.pi / lab.frequency * lab.rng.uniform(0.8, 1.2), far)])
    return lab.recording(rows + lab.trace({"initial_angle": far, "initial_rate": 0}, len(rows)), [])


@hazard("knock", -40, -20, 20, 40, unit=" %")
def _knock(lab: Lab, percent: float) -> Recording:
    """In mid swing the rate changes by a share of its peak; a negative share removes energy.

    The knock comes while the swing is well above the noise, because residuals cannot show a later knock. Knocks of 5 %
    are excluded, because some leave no trace in the residuals but change friction by 8 of its standard errors.
    """
    first = lab.swing()
    sample = int(lab.rng.uniform(0.3, 0.6) * len(first.rows))
    while math.degrees(lab.peak_rate(sample) / lab.frequency) < 20 * lab.noise:
        sample = int(0.8 * sample)
    angle, rate = lab.state(sample)
    peak = lab.peak_rate(sample)
    rate += math.copysign(peak * percent / 100, rate)
    rest = lab.trace({"initial_angle": angle, "initial_rate": rate}, sample, lab.seconds - sample / lab.rate)
    return lab.recording(first.rows[:sample] + rest, first.releases)


@hazard("several releases", 2, 3)
def _several(lab: Lab, count: int) -> Recording:
    """Between two swings the pendulum is caught, held at rest, and lifted again."""
    rows: list[Row] = []
    releases: list[Row] = []
    for _ in range(count):
        lab.amplitude = math.radians(lab.rng.uniform(15, 80))
        angle = lab.released()["release_angle"]
        if rows:
            caught = math.radians(rows[-1][1]) - lab.zero
            rows += lab.by_hand(len(rows), caught, [(0.5, 0), (lab.rng.uniform(1, 3), 0), (1.5, angle)])
        releases.append((len(rows) / lab.rate + lab.hold, angle))
        start = {"release_angle": angle, "release_time": releases[-1][0]}
        rows += lab.trace(start, len(rows), lab.hold + lab.rng.uniform(8, 12))
    return lab.recording(rows, releases)


@hazard("stopped by hand", 40, 70, 90, unit=" %")
def _stopped(lab: Lab, percent: float) -> Recording:
    """Caught after this part of the recording, then held at its hanging position."""
    recording = lab.swing()
    count = len(recording.rows)
    recording.rows = recording.rows[:int(percent / 100 * count)]
    caught = math.radians(recording.rows[-1][1]) - lab.zero
    remaining = (count - len(recording.rows)) / lab.rate
    place = lab.rng.uniform(-0.03, 0.03)
    recording.rows += lab.by_hand(len(recording.rows), caught, [(lab.rng.uniform(0.1, 0.3), place), (remaining, place)])
    return recording


# Pendulum: unusual free swings.


@hazard("long rest at the end", 40, 80, unit=" s")
def _long_rest(lab: Lab, seconds: float) -> Recording:
    lab.seconds = seconds
    lab.law["viscous"] = 2 * lab.rng.uniform(0.02, 0.05) / lab.frequency
    return lab.swing()


@hazard("upright start", 175, 178, 179.9, unit=" deg")
def _upright(lab: Lab, degrees: float) -> Recording:
    lab.amplitude = math.radians(degrees)
    if "coulomb" in lab.law:
        # With more dry friction the pendulum would stay at the release angle.
        lab.law["coulomb"] = min(lab.law["coulomb"], 0.5 * math.sin(lab.amplitude))
    lab.start = lab.released()
    return lab.swing()


def over_the_top(lab: Lab, turns: int) -> Recording:
    """Pushed so that it goes over the top this many times; the rate is found by bisection."""
    if "drag" in lab.law:
        lab.law["drag"] *= 0.2  # otherwise three turns would need an extreme push
    low, high = 1.5, 24.0
    angle, side = lab.rng.uniform(-0.5, 0.5), lab.rng.choice([-1, 1])
    for _ in range(50):
        middle = (low + high) / 2
        lab.start = {"initial_angle": angle, "initial_rate": side * middle * lab.frequency}
        found = round(abs(lab.trace(lab.start, clean_unit="rad")[-1][1]) / (2 * math.pi))
        if found == turns:
            return lab.swing()
        low, high = (middle, high) if found < turns else (low, middle)
    raise RuntimeError(f"no push makes {turns} turns")


@hazard("rotations", 1, 2, 3, unit=" turns")
def _rotations(lab: Lab, turns: int) -> Recording:
    return over_the_top(lab, turns)


@hazard("wrapped rotations", 1, 2, 3, unit=" turns")
def _rotations_wrapped(lab: Lab, turns: int) -> Recording:
    divide_turn(lab)
    return wrapped(lab, over_the_top(lab, turns), -180)


# Motions that are not a free swing.


def observed(lab: Lab, angle: collections.abc.Callable[[float], float]) -> Recording:
    """Readings of an angle [rad] given as a function of time."""
    times = [i / lab.rate for i in range(int(lab.seconds * lab.rate))]
    return Recording([(time, lab.read(angle(time))) for time in times], {})


@hazard("driven", "growing", "beating", "steady", exit_code=5)
def _driven(lab: Lab, how: str) -> Recording:
    """A sinusoidal torque near resonance, from rest or after the transient."""
    inertia, damping = lab.law["inertia"], 2 * 0.04 * lab.frequency
    drive = lab.frequency * (lab.rng.choice([0.9, 1.1]) if how == "beating" else 1)
    damping = damping / 8 if how == "beating" else damping
    torque = lab.rng.uniform(0.2, 0.4) * (0.2 if how == "beating" else 0.08)
    step = 0.005
    time, state = (-15 / damping if how == "steady" else 0.0), (0.0, 0.0)

    def slope(at: float, angle: float, rate: float) -> tuple[float, float]:
        return rate, (torque * math.cos(drive * at) - math.sin(angle)) / inertia - damping * rate

    def advance(until: float) -> float:
        nonlocal time, state
        while time < until:
            k1 = slope(time, *state)
            k2 = slope(time + step / 2, *(x + step / 2 * k for x, k in zip(state, k1)))
            k3 = slope(time + step / 2, *(x + step / 2 * k for x, k in zip(state, k2)))
            k4 = slope(time + step, *(x + step * k for x, k in zip(state, k3)))
            state = tuple(x + step / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(state, k1, k2, k3, k4))
            time += step
        return state[0] + (until - time) * state[1]

    return observed(lab, advance)


@hazard("constant", "exactly", "noisy", exit_code=5)
def _constant(lab: Lab, how: str) -> Recording:
    angle = lab.rng.uniform(-0.5, 0.5)
    lab.noise = 0 if how == "exactly" else lab.noise
    return observed(lab, lambda _: angle)


@hazard("overdamped", 1.2, 3, exit_code=5)
def _overdamped(lab: Lab, damping_ratio: float) -> Recording:
    lab.law["viscous"] = 2 * damping_ratio / lab.frequency
    lab.start = lab.released()
    return Recording(lab.trace(lab.start), {})


@hazard("calibration sweep", 5, 9, unit=" angles", exit_code=5)
def _sweep(lab: Lab, count: int) -> Recording:
    """Held at one angle after another."""
    angles = [math.radians(90 * i / (count - 1) - 45) for i in range(count)]
    moves = [move for angle in angles for move in ((0.5, angle), (lab.rng.uniform(1.5, 3), angle))]
    return Recording(lab.by_hand(0, angles[0], moves), {})


@hazard("linear oscillator", 40, 60, 80, unit=" deg", exit_code=1, warning="not_a_pendulum")
def _linear(lab: Lab, degrees: float) -> Recording:
    lab.gravity, lab.amplitude = "linear", math.radians(degrees)
    lab.start = lab.released()
    return Recording(lab.trace(lab.start), {})


@hazard("two modes", 20, 50, 100, unit=" %", exit_code=1, warning="not_a_pendulum")
def _two_modes(lab: Lab, percent: float) -> Recording:
    """Adds a second decaying sinusoid with this share of the first one, like a bob on a string."""
    modes = [(lab.amplitude / 2 * share, lab.frequency * ratio, lab.rng.uniform(0, 2 * math.pi))
             for share, ratio in ((1, 1), (percent / 100, lab.rng.uniform(1.3, 2.5)))]
    decay = lab.rng.uniform(0.005, 0.03)
    return observed(lab, lambda time: sum(size * math.exp(-decay * rate * time) * math.cos(rate * time + phase)
                                          for size, rate, phase in modes))
