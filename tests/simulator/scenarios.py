# SPDX-License-Identifier: Apache-2.0
"""The rows of the table of hazards: what each does to the textbook rig, and how a fit may name it.

`kind` says what the tools promise:
  exact     nothing is wrong, and the user states that the sensor is ideal
  clean     nothing is wrong, and nothing is stated
  modelled  the fit has a term for it
  budgeted  the recording cannot show it, and the total error contains it
  inherent  a free swing cannot show it at all, or the fitted law lacks it; the fitted number means something else
A kind excuses nothing: an estimate that is silently wrong fails any row. `names` are the causes of JSON `suspicions` and the
codes of warnings that name the row's cause. Two causes stand for each other only if the reader must look at the same
thing: gain and curve of a sensor (calibrate it), a push and a finger that leaves slowly (the hand), presliding and another
law of friction. The rows that are `is_core` have the sizes for which the tools must answer; the others were added later.
"""

import collections.abc
import dataclasses
import math

from camera import Camera
from friction import Bristles
from lab import RIG, Lab, step_of
from pendulum import yielding_support

DEG = math.radians(1)
CURVE = frozenset({"gain", "nonlinearity"})
LAG = frozenset({"lag"})
HAND = frozenset({"push"})  # its message: pushed, or let go slowly
HOLD = frozenset({"hold", "hold_left_out", "hold_disagrees"})
DRIFT = frozenset({"drift", "zero_drift", "offset_unsteady"})
PLAY = frozenset({"backlash"})
CLOCK = frozenset({"clock", "clock_implausible"})
MEAN = frozenset({"means_assumed", "means_possible"})
LAW = frozenset({"friction_law"})
PRESLIDING = frozenset({"friction_law", "presliding"})
PLACE = frozenset({"position_friction"})
SUPPORT = frozenset({"support"})
SPRING = frozenset({"spring"})
LENGTH = frozenset({"rig_implausible", "inertia_differs_from_rig", "frequency_differs_from_rig"})
ANGLE = ("inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle")
GYRO = ("inertia", "viscous", "coulomb", "rate_bias")
SHORT, TO_REST = 6.0, 50.0  # s, with the hold of 2 s


@dataclasses.dataclass(frozen=True)
class Row:
    """One row: a cause and its size."""

    name: str
    group: str  # exact, clean, sensor, clock, hand, mounting, friction, camera
    words: str  # cause and size, for a reader
    kind: str
    change: collections.abc.Callable[[Lab], None]
    names: frozenset[str] = frozenset()
    model: str = "coulomb"
    parameters: tuple[str, ...] = ANGLE  # that are judged
    optional: tuple[str, ...] = ()  # judged where the fit gives an error: the recording may not show them
    is_core: bool = False
    reference: str = "exact_white"  # the row whose errors are those of noise alone


ROWS: dict[str, Row] = {}


def add(group: str, name: str, words: str, kind: str, names: frozenset[str], change, **more) -> None:
    """Registers a row."""
    ROWS[name] = Row(name, group, words, kind, change, names, **more)


def add_sizes(group: str, name: str, words: str, kind: str, names: frozenset[str], sizes: list, change,
              core: list | None = None, **more) -> None:
    """Registers a row for each size; `{}` in name and words stands for it. `core` are the sizes that are core."""
    for size in sizes:
        add(group, name.format(size), words.format(size), kind, names, lambda lab, size=size: change(lab, size),
            is_core=size in (sizes if core is None else core), **more)


def set_bits(lab: Lab, bits: int) -> None:
    """A converter of other resolution, with noise of as many counts."""
    lab.set("sensor", resolution=step_of(bits), sigma=lab.sensor.sigma / step_of(10) * step_of(bits))


def set_noise(lab: Lab, counts: float, correlation: float = 0.0) -> None:
    """Noise in counts."""
    lab.set("sensor", sigma=counts * lab.sensor.resolution, correlation=correlation)


def set_mean(lab: Lab, conversions: int, counts: float, says: str = "nothing") -> None:
    """Readings that are means of several conversions, each with noise of so many counts. The file may say how many they are, or
    the step of one conversion."""
    lab.set("sensor", conversions=conversions, sigma=counts * lab.sensor.resolution)
    if says == "step":
        lab.metadata.append(f"resolution: {lab.sensor.resolution / DEG:.6g}")
    if says == "count":
        lab.metadata += [f"oversample: {conversions}", f"window_s: {conversions * lab.sensor.conversion_time:g}"]


def set_gyro(lab: Lab) -> None:
    """A gyro instead of the potentiometer."""
    lab.is_gyro = True
    lab.set("sensor", zero=lab.rng.uniform(-0.02, 0.02), sigma=0.01, resolution=0.0)


def set_bristles(lab: Lab, stiffness: float, damping: float = 0.0) -> None:
    """Presliding: a contact of this stiffness [N m/rad] that slides at dry friction. The hand has pulled it to its limit."""
    sliding = lab.body.friction
    lab.set("body", friction=Bristles(sliding, stiffness, damping))
    lab.deflection = lab.side * sliding.coulomb / stiffness


def set_reach(lab: Lab, reach_deg: float, damping: float = 0.0) -> None:
    """Presliding over this angle."""
    set_bristles(lab, lab.law.coulomb / (reach_deg * DEG), damping)


def set_load(lab: Lab) -> None:
    """Dry friction in proportion to the force on the bearing."""
    lab.set_friction(load_share=1.0, length_over_gravity=lab.body.length / lab.body.gravity)


def set_events(lab: Lab, counts: float, rate: float = 100.0) -> None:
    """A logger that reads so often and sends a row only where the count changes; noise in counts."""
    lab.is_event_log = True
    lab.set("clock", rate=rate)
    set_noise(lab, counts)


def set_stribeck(lab: Lab, rate: float, duration: float) -> None:
    """Dry friction that is twice as large at rest and falls within this rate [rad/s]."""
    lab.duration = duration
    lab.set_friction(stiction=2 * lab.law.coulomb, stribeck_rate=rate)


def set_known_inertia(lab: Lab, scale: float) -> None:
    """A rig file with G, wrong by this factor, to 0.2 %, and the true inertia to 0.3 %."""
    torque, inertia = scale * lab.body.gravity_torque, lab.body.inertia
    lab.rig = {"gravity_torque": {"value": torque, "std_dev": 0.002 * torque},
               "inertia": {"value": inertia, "std_dev": 0.003 * inertia}}


def set_duration(lab: Lab, seconds: float) -> None:
    """A recording of this length."""
    lab.duration = seconds


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
CLEAN = {"white": ("noise of 0.25 count", lambda lab: None),
         "ar": ("noise of 0.25 count with a correlation of 0.9", lambda lab: set_noise(lab, 0.25, 0.9)),
         "quiet": ("noise of 0.1 count", lambda lab: set_noise(lab, 0.1)),
         "short": ("4 s of swing", lambda lab: set_duration(lab, SHORT)),
         "rest": ("until the pendulum rests", lambda lab: set_duration(lab, TO_REST))}
for cell, (words, change) in CLEAN.items():
    add("exact", f"exact_{cell}", words, "exact", NONE, change, reference=f"exact_{cell}")
add_sizes("exact", "exact_{}_bits", "{} bits", "exact", NONE, [8, 12, 14], set_bits, core=[])
add("exact", "exact_white_2", "noise of 2 counts", "exact", NONE, lambda lab: set_noise(lab, 2.0))
add_sizes("exact", "exact_ar_{}", "noise of 1 count with a correlation of {}", "exact", NONE, [0.5, 0.9],
          lambda lab, correlation: set_noise(lab, 1.0, correlation), core=[])
add("exact", "exact_jitter", "samples 0.05 ms beside their time stamps", "exact", NONE,
    lambda lab: lab.set("clock", jitter=5e-5))
add("exact", "exact_gyro", "a gyro", "exact", NONE, set_gyro, parameters=GYRO, reference="exact_gyro")
add("exact", "exact_pixels", "a video", "exact", NONE, set_camera, reference="exact_pixels")

for cell, (words, change) in CLEAN.items():
    add("clean", f"clean_{cell}", words, "clean", NONE, change, is_core=True, reference=f"exact_{cell}")
add("clean", "clean_gyro", "a gyro", "clean", NONE, set_gyro, parameters=GYRO, reference="exact_gyro")
add("clean", "clean_pixels", "a video", "clean", NONE, set_camera, reference="exact_pixels")

add_sizes("sensor", "gain_{}", "gain wrong by {} %", "budgeted", CURVE, [0.3, 1],
          lambda lab, percent: lab.set_curve(gain=percent / 100 * side(lab)))
add("sensor", "gyro_scale_1", "scale of a gyro wrong by 1 %", "budgeted", CURVE,
    lambda lab: (set_gyro(lab), lab.set_curve(gain=0.01 * side(lab))), parameters=GYRO, is_core=True, reference="exact_gyro")
add("sensor", "cubic", "curve: cubic, 0.5 % at 24 deg", "budgeted", CURVE,
    lambda lab: lab.set_curve(cubic=0.005 * side(lab)), is_core=True)
add("sensor", "sine", "curve: 0.3 deg, a sine over 60 deg", "modelled", CURVE,
    lambda lab: lab.set_curve(wave=0.3 * DEG, wave_phase=turn(lab)), is_core=True)
add("sensor", "eccentric", "eccentric by 0.5 deg over a turn", "budgeted", CURVE,
    lambda lab: lab.set_curve(eccentricity=0.5 * DEG, eccentric_phase=turn(lab)), is_core=True)
add_sizes("sensor", "backlash_{}", "backlash of {} deg", "modelled", PLAY, [0.05, 0.2],
          lambda lab, width: lab.set("sensor", play=width * DEG, play_place=lab.rng.uniform(-1, 1)), core=[0.05])
add_sizes("sensor", "lag_{}", "filter with a lag of {} ms", "modelled", LAG, [5, 20],
          lambda lab, milliseconds: lab.set("sensor", lag=milliseconds / 1000))
add("sensor", "delay_2", "readings 2 ms late", "budgeted", LAG, lambda lab: lab.set("sensor", delay=0.002))
for conversions, said, counts in ((4, "nothing", 0.1), (4, "nothing", 0.25), (4, "step", 0.1),
                                  (16, "nothing", 0.1), (16, "nothing", 0.25), (16, "step", 0.25)):
    add("sensor", f"mean_{conversions}_{'step_' if said == 'step' else ''}{counts}",
        f"means of {conversions} readings, noise of {counts} count" + (", the step is stated" if said == "step" else ""),
        "modelled", MEAN, lambda lab, how=(conversions, counts, said): set_mean(lab, *how), is_core=True)
add_sizes("sensor", "mean_{}_said", "means of {} readings, noise of 0.05 count, the number is stated", "modelled", MEAN,
          [4, 16], lambda lab, conversions: set_mean(lab, conversions, 0.05, "count"), core=[])
add("sensor", "drift_thermal", "zero drifts by 0.2 deg, mostly in 5 s", "modelled", DRIFT,
    lambda lab: lab.set("sensor", thermal=0.2 * DEG * side(lab)), is_core=True)
add("sensor", "drift_linear", "zero drifts by 0.2 deg, linearly", "modelled", DRIFT,
    lambda lab: lab.set("sensor", drift=0.2 * DEG * side(lab)))
add_sizes("sensor", "event_log_{}", "rows only where the count changes, noise of {} count", "modelled",
          NONE, [0.05, 0.25], set_events)
add("sensor", "event_log_fast", "the same from 1000 readings a second, noise of 0.1 count", "modelled", NONE,
    lambda lab: set_events(lab, 0.1, 1000.0))

add("clock", "clock_loop", "10.3 ms between samples, the times are made up for 10 ms", "budgeted", CLOCK,
    lambda lab: lab.set("clock", true_interval_scale=1.03, are_made_up=True), is_core=True)
add("clock", "clock_header", "10.3 ms between samples, no times, the header says 100 Hz", "budgeted", CLOCK,
    lambda lab: lab.set("clock", true_interval_scale=1.03, has_stamps=False))
add("clock", "clock_100ppm", "time stamps 100 ppm fast", "budgeted", CLOCK, lambda lab: lab.set("clock", drift=1e-4),
    is_core=True)

add("hand", "finger", "finger lets go in 50 ms", "modelled", HAND, lambda lab: lab.set("hand", finger_share=1.0), is_core=True)
add("hand", "finger_0.3", "finger leaves in 50 ms, with 0.3 of the torque", "modelled", HAND,
    lambda lab: lab.set("hand", finger_share=0.3))
add("hand", "push", "released with 0.05 rad/s", "modelled", HAND, lambda lab: lab.set("hand", push=0.05), is_core=True)
add("hand", "hold_angle", "held 0.4 deg beside the release angle", "modelled", HOLD,
    lambda lab: lab.set("hand", offset=0.4 * DEG * side(lab)), is_core=True)
add("hand", "hold_creep", "hold creeps by 0.3 deg", "modelled", HOLD,
    lambda lab: lab.set("hand", creep=0.3 * DEG * side(lab)), is_core=True)

add("mounting", "support", "support of 5 times the mass yields, 12 Hz", "inherent", SUPPORT,
    lambda lab: lab.set("body", support=yielding_support(lab.body, 5, 12)), is_core=True)
add("mounting", "support_light", "support of twice the mass yields, 8 Hz", "inherent", SUPPORT,
    lambda lab: lab.set("body", support=yielding_support(lab.body, 2, 8)))
add("mounting", "support_heavy", "support of ten times the mass yields, 20 Hz", "inherent", SUPPORT,
    lambda lab: lab.set("body", support=yielding_support(lab.body, 10, 20)))
add("mounting", "stiffness_2", "torsional stiffness of 2 % of G", "inherent", SPRING,
    lambda lab: lab.set("body", spring=0.02 * lab.body.gravity_torque), is_core=True)
add("mounting", "length_10", "length wrong by 10 % in the rig file", "inherent", LENGTH,
    lambda lab: setattr(lab, "rig", RIG | {"rod_length": 1.1 * RIG["rod_length"]}), is_core=True)

# The same with a geometry that is known: it shows that something is wrong.
add("mounting", "stiffness_known", "torsional stiffness of 2 % of G, and the rig file gives the inertia", "inherent", SPRING,
    lambda lab: (lab.set("body", spring=0.02 * lab.body.gravity_torque), set_known_inertia(lab, 1.0)))
add("mounting", "length_known", "length wrong by 10 % in a G of 0.2 %, and the rig file gives the inertia", "inherent", LENGTH,
    lambda lab: set_known_inertia(lab, 1.1))

add("friction", "stribeck_unseen", "Stribeck zone of 1 rad/s, fitted as coulomb", "inherent", LAW,
    lambda lab: lab.set_friction(stiction=1.5 * lab.law.coulomb, stribeck_rate=1.0), is_core=True)
# A zone that the readings do not show leaves coulomb and stiction interchangeable; one of them may then be at its bound.
for name, words, rate, seconds in (("0.03", "of 0.03 rad/s", 0.03, 20.0), ("0.1", "of 0.1 rad/s", 0.1, 20.0),
                                   ("0.03_rest", "of 0.03 rad/s, to rest", 0.03, TO_REST),
                                   ("0.1_rest", "of 0.1 rad/s, to rest", 0.1, TO_REST),
                                   ("0.01_rest", "of 0.01 rad/s, to rest", 0.01, TO_REST)):
    add("friction", f"stribeck_{name}", f"Stribeck zone {words}, fitted as stribeck", "modelled", LAW,
        lambda lab, how=(rate, seconds): set_stribeck(lab, *how), model="stribeck",
        parameters=tuple(each for each in ANGLE if each != "coulomb"), optional=("coulomb", "stiction", "stribeck_rate"),
        is_core=True, reference="exact_white" if seconds == 20 else "exact_rest")
add("friction", "drag_unseen", "quadratic drag, fitted as coulomb", "inherent", LAW,
    lambda lab: lab.set_friction(drag=0.002))
add("friction", "drag", "quadratic drag, fitted as drag", "modelled", LAW, lambda lab: lab.set_friction(drag=0.002),
    model="drag", parameters=ANGLE + ("drag",))
add("friction", "presliding", "presliding (Dahl), 2 N m/rad, fitted as coulomb", "inherent", PRESLIDING,
    lambda lab: set_bristles(lab, 2.0), is_core=True)
add("friction", "presliding_short", "the same in 4 s of swing", "inherent", PRESLIDING,
    lambda lab: (set_bristles(lab, 2.0), set_duration(lab, SHORT)), is_core=True, reference="exact_short")
add("friction", "presliding_wide", "presliding (Dahl) over 0.5 deg, fitted as coulomb", "inherent", PRESLIDING,
    lambda lab: set_reach(lab, 0.5))
add("friction", "presliding_dahl", "presliding (Dahl) over 0.5 deg, fitted as dahl", "modelled", PRESLIDING,
    lambda lab: set_reach(lab, 0.5), model="dahl", parameters=ANGLE + ("presliding_angle",))
add("friction", "presliding_lugre", "presliding (LuGre) over 0.2 deg, fitted as dahl", "modelled", PRESLIDING,
    lambda lab: set_reach(lab, 0.2, 0.003), model="dahl")
add("friction", "load_unseen", "dry friction in proportion to the load, fitted as coulomb", "inherent", LAW | PLACE, set_load,
    is_core=True)
add("friction", "load", "dry friction in proportion to the load, fitted as load", "modelled", LAW | PLACE, set_load,
    model="load", parameters=tuple(name if name != "coulomb" else "load_friction" for name in ANGLE))
add("friction", "position_friction", "dry friction varies by 30 % with the angle, 8 waves a turn", "inherent", PLACE,
    lambda lab: lab.set_friction(place_share=0.3, place_waves=8.0, place_phase=turn(lab)), is_core=True)

add("camera", "pixels_aspect", "pixels 1 % wider than high", "budgeted", CURVE,
    lambda lab: set_camera(lab, aspect=0.01), is_core=True, reference="exact_pixels")
add("camera", "pixels_lens", "lens moves the edge by 2 %", "budgeted", CURVE,
    lambda lab: set_camera(lab, lens=0.02), reference="exact_pixels")
add("camera", "pixels_yaw", "camera turned by 10 deg", "budgeted", CURVE,
    lambda lab: set_camera(lab, yaw=10 * DEG), is_core=True, reference="exact_pixels")
