# SPDX-License-Identifier: Apache-2.0
"""The rows of the table of hazards: what each does to the textbook rig, and how a fit may name it.

`kind` says what the tools promise:
  clean     nothing is wrong
  modelled  the fit has a term for it
  budgeted  the recording cannot show it, and the total error contains it
  inherent  a free swing cannot show it at all, or the fitted law lacks it; the fitted number means something else
`names` are the causes of JSON `suspicions`, the warning codes, or words of `ambiguities`, that name the row's cause.
Causes that act alike on the readings stand for each other: a curve of the sensor also changes its gain.
"""

import collections.abc
import dataclasses
import math

from camera import Camera
from friction import Bristles
from lab import Lab, step_of
from pendulum import yielding_support

DEG = math.radians(1)
CURVE = frozenset({"gain", "nonlinearity"})
RELEASE = frozenset({"release", "push", "lag", "hold"})
DRIFT = frozenset({"drift", "zero_drift", "offset_unsteady"})
LAW = frozenset({"friction_law", "presliding", "position_friction"})
RIG = frozenset({"inertia_differs_from_rig", "frequency_differs_from_rig"})
PLAY = frozenset({"backlash", "hysteresis"})
CLOCK = frozenset({"clock"})
HOLD = frozenset({"hold", "push"})
ANGLE = ("inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle")
GYRO = ("inertia", "viscous", "coulomb", "rate_bias")


@dataclasses.dataclass(frozen=True)
class Row:
    """One row: a cause and its size."""

    name: str
    group: str  # clean, sensor, clock, hand, mounting, friction, camera
    words: str  # cause and size, for a reader
    kind: str
    change: collections.abc.Callable[[Lab], None]
    names: frozenset[str] = frozenset()
    model: str = "coulomb"
    parameters: tuple[str, ...] = ANGLE  # that are judged
    optional: tuple[str, ...] = ()  # judged where the fit gives an error: the recording may not show them


ROWS: dict[str, Row] = {}


def add(group: str, name: str, words: str, kind: str, names: frozenset[str], change, **more) -> None:
    """Registers a row."""
    ROWS[name] = Row(name, group, words, kind, change, names, **more)


def add_sizes(group: str, name: str, words: str, kind: str, names: frozenset[str], sizes: list, change, **more) -> None:
    """Registers a row for each size; `{}` in name and words stands for it."""
    for size in sizes:
        add(group, name.format(size), words.format(size), kind, names, lambda lab, size=size: change(lab, size), **more)


def set_bits(lab: Lab, bits: int) -> None:
    """A converter of other resolution, with noise of as many counts."""
    lab.set("sensor", resolution=step_of(bits), sigma=lab.sensor.sigma / step_of(10) * step_of(bits))


def set_noise(lab: Lab, counts: float, correlation: float = 0.0) -> None:
    """Noise in counts."""
    lab.set("sensor", sigma=counts * lab.sensor.resolution, correlation=correlation)


def set_mean(lab: Lab, conversions: int, counts: float, is_said: bool = True) -> None:
    """Readings that are means of several conversions, each with noise of so many counts."""
    lab.set("sensor", conversions=conversions, sigma=counts * lab.sensor.resolution)
    if is_said:
        lab.metadata += [f"oversample: {conversions}", f"window_s: {conversions * lab.sensor.conversion_time:g}"]


def set_gyro(lab: Lab) -> None:
    """A gyro instead of the potentiometer."""
    lab.is_gyro = True
    lab.set("sensor", zero=lab.rng.uniform(-0.02, 0.02), sigma=0.01, resolution=0.0)


def set_bristles(lab: Lab, reach_deg: float, damping: float = 0.0) -> None:
    """Presliding: dry friction grows over this angle. The hand has pulled the contact to its limit."""
    sliding = lab.body.friction
    stiffness = sliding.coulomb / (reach_deg * DEG)
    lab.set("body", friction=Bristles(sliding, stiffness, damping))
    lab.deflection = lab.side * reach_deg * DEG


def set_load(lab: Lab) -> None:
    """Dry friction in proportion to the force on the bearing."""
    lab.set_friction(load_share=1.0, length_over_gravity=lab.body.length / lab.body.gravity)


def set_events(lab: Lab) -> None:
    """A logger that reads a thousand times a second and sends a row only where the count changes."""
    lab.is_event_log = True
    lab.set("clock", rate=1000.0)
    set_noise(lab, 0.1)


def set_camera(lab: Lab, **values) -> None:
    """A video at 60 frames a second."""
    lab.set("clock", rate=60.0)
    lab.camera = Camera(level=lab.rng.uniform(-0.02, 0.02), **values)


def side(lab: Lab) -> int:
    """A random sign."""
    return int(lab.rng.choice([-1, 1]))


def turn(lab: Lab) -> float:
    """A random phase [rad]."""
    return float(lab.rng.uniform(0, 2 * math.pi))


NONE: frozenset[str] = frozenset()
add_sizes("clean", "clean_{}_bits", "{} bits", "clean", NONE, [8, 10, 12, 14], set_bits)
add("clean", "clean_white_2", "white noise of 2 counts", "clean", NONE, lambda lab: set_noise(lab, 2.0))
add("clean", "clean_white_0.1", "noise of 0.1 count", "clean", NONE, lambda lab: set_noise(lab, 0.1))
add_sizes("clean", "clean_ar_{}", "noise of 1 count with a correlation of {}", "clean", NONE, [0.5, 0.9],
          lambda lab, correlation: set_noise(lab, 1.0, correlation))
add("clean", "clean_jitter", "samples 0.05 ms beside their time stamps", "clean", NONE,
    lambda lab: lab.set("clock", jitter=5e-5))
add("clean", "clean_gyro", "a gyro", "clean", NONE, set_gyro, parameters=GYRO)
add("clean", "clean_pixels", "a video", "clean", NONE, set_camera)

add_sizes("sensor", "gain_{}", "gain wrong by {} %", "budgeted", CURVE, [0.3, 1],
          lambda lab, percent: lab.set_curve(gain=percent / 100 * side(lab)))
add("sensor", "gyro_scale_1", "scale of a gyro wrong by 1 %", "budgeted", CURVE | {"scale"},
    lambda lab: (set_gyro(lab), lab.set_curve(gain=0.01 * side(lab))), parameters=GYRO)
add("sensor", "cubic", "curve: cubic, 0.5 % at 24 deg", "budgeted", CURVE,
    lambda lab: lab.set_curve(cubic=0.005 * side(lab)))
add("sensor", "sine", "curve: 0.3 deg, a sine over 60 deg", "modelled", CURVE,
    lambda lab: lab.set_curve(wave=0.3 * DEG, wave_phase=turn(lab)))
add("sensor", "eccentric", "eccentric by 0.5 deg", "budgeted", CURVE,
    lambda lab: lab.set_curve(eccentricity=0.5 * DEG, eccentric_phase=turn(lab)))
add_sizes("sensor", "backlash_{}", "backlash of {} deg", "modelled", PLAY, [0.05, 0.2],
          lambda lab, width: lab.set("sensor", play=width * DEG))
add_sizes("sensor", "lag_{}", "filter with a lag of {} ms", "modelled", RELEASE, [5, 20],
          lambda lab, milliseconds: lab.set("sensor", lag=milliseconds / 1000))
add("sensor", "delay_2", "readings 2 ms late", "budgeted", RELEASE, lambda lab: lab.set("sensor", delay=0.002))
add_sizes("sensor", "mean_{}", "means of {} readings, noise of 0.25 count", "modelled", NONE, [4, 16],
          lambda lab, conversions: set_mean(lab, conversions, 0.25))
add_sizes("sensor", "mean_{}_quiet", "means of {} readings, noise of 0.05 count", "modelled", NONE, [4, 16],
          lambda lab, conversions: set_mean(lab, conversions, 0.05))
add("sensor", "mean_16_unsaid", "means of 16 readings, unknown to the tool", "modelled", frozenset({"averaging"}),
    lambda lab: set_mean(lab, 16, 0.25, is_said=False))
add("sensor", "drift_linear", "zero drifts by 0.2 deg, linearly", "modelled", DRIFT,
    lambda lab: lab.set("sensor", drift=0.2 * DEG * side(lab)))
add("sensor", "drift_thermal", "zero drifts by 0.3 deg, mostly in 5 s", "modelled", DRIFT,
    lambda lab: lab.set("sensor", thermal=0.3 * DEG * side(lab)))
add("sensor", "event_log", "rows only where the count changes, noise of 0.1 count", "modelled",
    frozenset({"event_noise"}), set_events)

add("clock", "clock_header", "10.3 ms between samples, the header says 100 Hz", "budgeted", CLOCK,
    lambda lab: lab.set("clock", true_interval_scale=1.03, has_stamps=False))
add("clock", "clock_100ppm", "time stamps 100 ppm fast", "budgeted", CLOCK, lambda lab: lab.set("clock", drift=1e-4))

add("hand", "finger", "finger leaves in 50 ms, with 0.3 of the torque", "modelled", RELEASE,
    lambda lab: lab.set("hand", finger_share=0.3))
add("hand", "push", "released with 0.05 rad/s", "modelled", RELEASE, lambda lab: lab.set("hand", push=0.05))
add("hand", "hold_angle", "held 0.4 deg beside the release angle", "modelled", HOLD,
    lambda lab: lab.set("hand", offset=0.4 * DEG * side(lab)))
add("hand", "hold_creep", "hold creeps by 0.4 deg", "modelled", HOLD,
    lambda lab: lab.set("hand", creep=0.4 * DEG * side(lab)))

add("mounting", "support_light", "support of twice the mass yields, 8 Hz", "inherent", RIG | {"support"},
    lambda lab: lab.set("body", support=yielding_support(lab.body, 2, 8)))
add("mounting", "support_heavy", "support of ten times the mass yields, 20 Hz", "inherent", RIG | {"support"},
    lambda lab: lab.set("body", support=yielding_support(lab.body, 10, 20)))
add("mounting", "stiffness_2", "torsional stiffness of 2 % of G", "inherent", RIG | {"spring", "stiffness"},
    lambda lab: lab.set("body", spring=0.02 * lab.body.gravity_torque))
add("mounting", "length_10", "length wrong by 10 % in the rig file", "inherent", RIG | {"length"},
    lambda lab: lab.rig.update(rod_length=1.1 * lab.rig["rod_length"]))

add("friction", "stribeck_narrow", "Stribeck zone of 1 rad/s, fitted as coulomb", "inherent", LAW,
    lambda lab: lab.set_friction(stiction=1.5 * lab.law.coulomb, stribeck_rate=1.0))
# A zone that the readings do not show leaves coulomb and stiction interchangeable; one of them may then be at its bound.
add_sizes("friction", "stribeck_{}", "Stribeck zone of {} rad/s, fitted as stribeck", "modelled", LAW, [0.1, 0.03],
          lambda lab, rate: lab.set_friction(stiction=2 * lab.law.coulomb, stribeck_rate=rate),
          model="stribeck", parameters=tuple(name for name in ANGLE if name != "coulomb"),
          optional=("coulomb", "stiction", "stribeck_rate"))
add("friction", "drag_unseen", "quadratic drag, fitted as coulomb", "inherent", LAW,
    lambda lab: lab.set_friction(drag=0.002))
add("friction", "drag", "quadratic drag, fitted as drag", "modelled", LAW, lambda lab: lab.set_friction(drag=0.002),
    model="drag", parameters=ANGLE + ("drag",))
add("friction", "presliding_unseen", "presliding (Dahl) over 0.5 deg, fitted as coulomb", "inherent", LAW,
    lambda lab: set_bristles(lab, 0.5))
add("friction", "presliding_dahl", "presliding (Dahl) over 0.5 deg, fitted as dahl", "modelled", LAW,
    lambda lab: set_bristles(lab, 0.5), model="dahl", parameters=ANGLE + ("presliding_angle",))
add("friction", "presliding_lugre", "presliding (LuGre) over 0.2 deg, fitted as dahl", "modelled", LAW,
    lambda lab: set_bristles(lab, 0.2, 0.003), model="dahl")
add("friction", "load_unseen", "dry friction in proportion to the load, fitted as coulomb", "inherent", LAW, set_load)
add("friction", "load", "dry friction in proportion to the load, fitted as load", "modelled", LAW, set_load,
    model="load", parameters=tuple(name if name != "coulomb" else "load_friction" for name in ANGLE))
add("friction", "position_friction", "dry friction varies by 30 % with the angle", "inherent", LAW,
    lambda lab: lab.set_friction(place_share=0.3, place_phase=turn(lab)))

add("camera", "pixels_aspect", "pixels 1 % wider than high", "budgeted", CURVE,
    lambda lab: set_camera(lab, aspect=0.01))
add("camera", "pixels_lens", "lens moves the edge by 2 %", "budgeted", CURVE,
    lambda lab: set_camera(lab, lens=0.02))
add("camera", "pixels_yaw", "camera turned by 10 deg", "budgeted", CURVE,
    lambda lab: set_camera(lab, yaw=10 * DEG))
