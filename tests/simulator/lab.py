# SPDX-License-Identifier: Apache-2.0
"""One recording of the textbook rig: random parameters, the true motion, the file, and the true values.

The rig is that of datasets/textbook_rig.json. Its potentiometer has 2^bits counts, 10 bits of 0.1985 deg unless a scenario
says otherwise. The user states G, exactly, and nothing else.
"""

import dataclasses
import json
import math
import pathlib

import numpy

from camera import Camera
from clocks import Clock, changes_only
from friction import Bristles, Sliding
from hands import Hand
from motion import Array, Motion, swing
from pendulum import Body
from sensors import Sensor

RIG = {key: entry["value"] for key, entry in
       json.loads((pathlib.Path(__file__).resolve().parents[2] / "datasets/textbook_rig.json").read_text(encoding="utf-8")).items()}
TOTAL_MASS = RIG["bob_mass"] + RIG["rod_mass"]
GRAVITY_TORQUE = (RIG["bob_mass"] + RIG["rod_mass"] / 2) * RIG["gravity"] * RIG["rod_length"]  # MODEL.md eq. (1.2)
POTENTIOMETER_TURN = math.radians(0.1985) * 1024
EXACT_TORQUE = {"gravity_torque": {"value": GRAVITY_TORQUE, "std_dev": 0}}


def step_of(bits: int) -> float:
    """Quantization step of the potentiometer [rad]."""
    return POTENTIOMETER_TURN / 2**bits


@dataclasses.dataclass
class Lab:
    """Everything that makes a recording. Scenarios change it before it is simulated. `rng` draws its noise."""

    rng: numpy.random.Generator
    body: Body
    hand: Hand
    sensor: Sensor
    clock: Clock = Clock()
    duration: float = 20.0  # s
    deflection: float = 0.0  # of the contact at the release, rad
    is_gyro: bool = False
    is_event_log: bool = False
    camera: Camera | None = None
    camera_sigma: float = 0.3  # px
    rig: dict = dataclasses.field(default_factory=lambda: dict(EXACT_TORQUE))  # what the user states
    metadata: list[str] = dataclasses.field(default_factory=list)

    def set(self, part: str, **values) -> None:
        """Replaces values of a part, such as set("sensor", lag=0.005)."""
        setattr(self, part, dataclasses.replace(getattr(self, part), **values))

    def set_curve(self, **values) -> None:
        """Replaces values of the sensor's curve."""
        self.set("sensor", curve=dataclasses.replace(self.sensor.curve, **values))

    def set_friction(self, **values) -> None:
        """Replaces values of the law of sliding friction."""
        self.set("body", friction=dataclasses.replace(self.body.friction, **values))

    @property
    def side(self) -> float:
        """Sign of the release angle."""
        return math.copysign(1, self.hand.angle)

    @property
    def law(self) -> Sliding:
        """The law of sliding friction."""
        friction = self.body.friction
        return friction.sliding if isinstance(friction, Bristles) else friction


@dataclasses.dataclass(frozen=True)
class Recording:
    """The file of a recording, and what is true. True times are those of the file's clock."""

    text: str
    rig: dict
    motion: Motion
    truth: dict[str, float]
    stamp_scale: float
    zero_span: tuple[float, float] = (0.0, 0.0)  # from the true zero to its lowest and highest value in the recording
    release_span: float = 0.0  # s on the file's clock in which the hand leaves

    def true_range(self, name: str, first_stamp: float) -> tuple[float, float] | None:
        """The true value of a parameter of a fit whose first used sample has this time, as a range: a zero that drifts and a
        release that takes time have several true values. None if there is none."""
        start = {"initial_angle": self.motion.angle, "initial_rate": self.motion.rate}
        if name in start:
            value = float(start[name](numpy.array([first_stamp / self.stamp_scale]))[0])
        elif name in self.truth:
            value = self.truth[name]
        else:
            return None
        low, high = {"zero_angle": self.zero_span, "release_time": (0.0, self.release_span)}.get(name, (0.0, 0.0))
        return value + low, value + high


def textbook_lab(seed: int) -> Lab:
    """The textbook rig with a 10-bit potentiometer, about 24 deg, a hold of about 2 s, and white noise of 0.25 count; all that
    is not the rig's varies by a few per cent with the seed."""
    rng = numpy.random.default_rng(seed)
    body = Body(inertia=0.079 * rng.uniform(0.95, 1.05), gravity_torque=GRAVITY_TORQUE, mass=TOTAL_MASS,
                gravity=RIG["gravity"],
                friction=Sliding(viscous=0.003 * rng.uniform(0.95, 1.05), coulomb=0.004 * rng.uniform(0.95, 1.05)))
    hand = Hand(angle=rng.choice([-1, 1]) * math.radians(rng.uniform(23.5, 24.5)), time=rng.uniform(1.95, 2.05))
    sensor = Sensor(zero=math.radians(rng.uniform(-2, 2)), sigma=0.25 * step_of(10), resolution=step_of(10))
    return Lab(rng, body, hand, sensor)


def true_motion(lab: Lab) -> Motion:
    """The motion from the release to beyond the end of the recording."""
    hand = lab.hand
    end = lab.duration * lab.clock.true_interval_scale + 1.0
    return swing(lab.body, hand.time, end, hand.angle, hand.rate, lab.deflection, hand.torque(lab.body.gravity_torque),
                 hand.leaves, hand.held)


def _columns(lab: Lab, motion: Motion) -> tuple[str, Array, list[Array]]:
    """Header without time, stamps and columns of readings."""
    times = lab.clock.true_times(lab.duration, lab.rng)
    stamps = lab.clock.stamps(len(times))
    if lab.camera:
        pixels = lab.camera.pixels(motion.angle(times))
        return "x_px,y_px", stamps, [column + lab.rng.normal(0, lab.camera_sigma, len(times)) for column in pixels]
    readings = lab.sensor.read(motion.rate if lab.is_gyro else motion.angle, times, lab.rng)
    if lab.is_event_log:
        stamps, readings = changes_only(stamps, readings)
    return ("gyro_rad_s", stamps, [readings]) if lab.is_gyro else ("angle_deg", stamps, [numpy.degrees(readings)])


def _text(lab: Lab, names: str, stamps: Array, columns: list[Array]) -> str:
    lines = [f"# {line}" for line in lab.metadata]
    rows = list(zip(*columns))
    if lab.clock.has_stamps:
        return "\n".join([*lines, f"time_s,{names}",
                          *(f"{stamp:.6f}," + ",".join(f"{value:.7g}" for value in row)
                            for stamp, row in zip(stamps, rows))]) + "\n"
    lines.append(f"# sample_rate_hz: {lab.clock.rate:g}")
    return "\n".join([*lines, names, *(",".join(f"{value:.7g}" for value in row) for row in rows)]) + "\n"


def record(lab: Lab) -> Recording:
    """Simulates the recording."""
    motion, law = true_motion(lab), lab.law
    names, stamps, columns = _columns(lab, motion)
    truth = {"inertia": lab.body.inertia, "viscous": law.viscous, "coulomb": law.coulomb, "drag": law.drag,
             "release_angle": lab.hand.angle, "release_time": lab.hand.time * lab.clock.stamp_scale}
    if law.load_share == 1:
        truth["load_friction"] = law.coulomb
    if isinstance(lab.body.friction, Bristles):
        truth["presliding_angle"] = law.coulomb / lab.body.friction.stiffness
    if law.stiction is not None:
        truth |= {"stiction": law.stiction, "stribeck_rate": law.stribeck_rate}
    drift = lab.sensor.zero_motion(numpy.linspace(0, lab.duration, 1000), lab.duration)
    if lab.camera:
        truth["zero_angle"] = lab.camera.level
    else:  # what the sensor shows where gravity has no torque
        truth["rate_bias" if lab.is_gyro else "zero_angle"] = lab.sensor.zero + float(lab.sensor.curve(numpy.zeros(1))[0])
    return Recording(_text(lab, names, stamps, columns), lab.rig, motion, truth, lab.clock.stamp_scale,
                     (float(drift.min()), float(drift.max())),
                     lab.hand.finger_time * lab.clock.stamp_scale if lab.hand.finger_share else 0.0)
