# SPDX-License-Identifier: Apache-2.0
"""Recordings for the tests of the tools, from an independent short integration of the equation of motion; how they read a fit."""

import math
import random

TRUTH = {"inertia": 0.079, "viscous": 0.003, "coulomb": 0.004, "release_angle": 0.423, "release_time": 1.9,
         "zero_angle": 0.01}
RIG = {"bob_mass": 0.380, "rod_mass": 0.095, "rod_length": 0.43, "gravity": 9.81}
GRAVITY_TORQUE = (RIG["bob_mass"] + RIG["rod_mass"] / 2) * RIG["gravity"] * RIG["rod_length"]  # N m


def parameters_of(result):
    """All parameters of the first fit of a result, by name: the shared ones, then those of the first recording."""
    return {**result["fits"][0]["parameters"], **result["recordings"][0]["fits"][0]["parameters"]}


def _step(angle, rate, h, truth):
    """One step of the classical Runge-Kutta method; sgn smoothed over 1e-3 rad/s."""

    def acceleration(x, v):
        friction = truth["viscous"] * v + truth["coulomb"] * math.tanh(v / 1e-3)
        return -(GRAVITY_TORQUE * math.sin(x) + friction) / truth["inertia"]

    a1 = acceleration(angle, rate)
    v2, a2 = rate + h / 2 * a1, acceleration(angle + h / 2 * rate, rate + h / 2 * a1)
    v3, a3 = rate + h / 2 * a2, acceleration(angle + h / 2 * v2, rate + h / 2 * a2)
    v4, a4 = rate + h * a3, acceleration(angle + h * v3, rate + h * a3)
    return angle + h / 6 * (rate + 2 * v2 + 2 * v3 + v4), rate + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)


def swing(duration=12.0, rate_hz=100, truth=TRUTH):
    """Samples (time [s], angle [rad], rate [rad/s]) of a held and released pendulum, without the zero angle."""
    angle, rate, steps = truth["release_angle"], 0.0, 20
    samples = []
    for k in range(int(duration * rate_hz) + 1):
        time = k / rate_hz
        samples.append((time, angle, rate))
        if time >= truth["release_time"] - 1e-9:
            for _ in range(steps):
                angle, rate = _step(angle, rate, 1 / rate_hz / steps, truth)
    return samples


def angle_csv(duration=12.0, sigma=0.003, truth=TRUTH, seed=20):
    """The text of a recording in degrees with white noise of `sigma` radians, equal for every call."""
    noise = random.Random(seed)
    lines = ["time_s,angle_deg"]
    for time, angle, _ in swing(duration, truth=truth):
        lines.append(f"{time:.3f},{math.degrees(angle + truth['zero_angle'] + noise.gauss(0, sigma)):.5f}")
    return "\n".join(lines) + "\n"


def rate_csv(duration=12.0, sigma=0.01, truth=TRUTH):
    """The text of a gyro's recording in rad/s with a bias of 0.02 rad/s."""
    noise = random.Random(21)
    lines = ["time_s,gyro_rad_s"]
    for time, _, rate in swing(duration, truth=truth):
        lines.append(f"{time:.3f},{rate + 0.02 + noise.gauss(0, sigma):.6f}")
    return "\n".join(lines) + "\n"


def two_releases():
    """The text of a recording: held and released, taken back by hand within 2 s, held and released again."""
    noise = random.Random(22)
    released = [angle for _, angle, _ in swing(10.0)]
    end = released[-1]
    back = [end + (released[0] - end) * s * s * (3 - 2 * s) for s in (k / 200 for k in range(1, 200))]
    lines = ["time_s,angle_deg"]
    for k, angle in enumerate(released + back + released):
        lines.append(f"{k / 100:.3f},{math.degrees(angle + noise.gauss(0, 0.002)):.5f}")
    return "\n".join(lines) + "\n"
