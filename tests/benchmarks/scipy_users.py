#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times the code that users of SciPy and lmfit would write for the reference run: scipy_users.py CSV [--repetitions N].

The trajectory comes from solve_ivp (LSODA), with dry friction smoothed to tanh(omega / 0.01 rad/s) and derivatives by
finite differences. scipy.optimize.least_squares and lmfit.minimize fit six parameters. rtol is 1e-8 and the relative
step of the differences 1e-3, as chosen by a user who knows that smaller steps are lost in the integrator's noise. With
this rtol and the default step, neither package finds the optimum. Of all combinations of rtol from 1e-6 to 1e-10 and
steps from 1e-6 to 1e-3 with which both packages find it, none is much faster. Prints one JSON object; seconds are the
CPU time of each repetition of the fit alone. Exit codes: 1 a package or the file is missing or the file is not such a
recording, 2 wrong flags.
"""

import argparse
import json
import math
import pathlib
import sys
import time

NAMES = ["inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle"]  # SI, rad, s
TRUTH = [0.079, 0.003, 0.001, 0.423, 1.9, 0.012]  # as in reference_run.h
START = [0.0762, 0.0036, 0.001, 0.41, 1.93, 0.002]  # from the rig's geometry and the plot, as in ceres_baseline.h
SCALE = [0.1, 0.003, 0.001, 0.4, 2.0, 0.01]  # orders of magnitude
NEVER_NEGATIVE = 3  # number of leading parameters that are never negative
RELATIVE_STEP = 1e-3  # of finite differences
RIG = pathlib.Path(__file__).resolve().parents[2] / "datasets" / "textbook_rig.json"


class Refusal(Exception):
    """An error that the user can correct."""


def gravity_torque():
    """Gravity torque of the rod and the bob at its end [N m]."""
    rig = json.loads(RIG.read_text())
    return (rig["bob_mass"] + rig["rod_mass"] / 2) * rig["rod_length"] * rig["gravity"]


def read_recording(path):
    """Times [s] and angles [rad] of a CSV file. Uses no package, so its errors can be reported without any."""
    try:
        lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
        if len(lines) < 2 or lines[0] != "time_s,angle_deg":
            raise Refusal(f"{path} has no header time_s,angle_deg, or no samples")
        rows = [tuple(map(float, line.split(","))) for line in lines[1:]]
        times, angles_deg = zip(*rows, strict=True)
    except (OSError, ValueError) as error:
        raise Refusal(f"{path} cannot be read: {error}") from error
    return times, [math.radians(angle) for angle in angles_deg]


class Residuals:
    """Measured - modelled [rad] for six parameters, and the number of evaluations."""

    def __init__(self, times, angles):
        import numpy

        self.times, self.angles = numpy.array(times), numpy.array(angles)
        self.gravity_torque = gravity_torque()
        self.evaluations = 0

    def __call__(self, parameters):
        self.evaluations += 1
        return self.angles - self.trajectory(*parameters)

    def trajectory(self, inertia, viscous, coulomb, release_angle, release_time, zero_angle):
        """The sensor's readings at the samples [rad]."""
        import numpy
        from scipy.integrate import solve_ivp

        def motion(_, state):
            angle, rate = state
            torque = self.gravity_torque * math.sin(angle) + viscous * rate + coulomb * math.tanh(rate / 0.01)
            return rate, -torque / inertia

        reading = numpy.full(len(self.times), release_angle + zero_angle)
        moving = self.times > release_time
        if moving.any():
            swing = solve_ivp(motion, (release_time, self.times[-1]), (release_angle, 0.0), method="LSODA",
                              t_eval=self.times[moving], rtol=1e-8, atol=1e-10)
            reading[moving] = swing.y[0] + zero_angle
        return reading


def fit_by_scipy(residuals):
    """The estimates of scipy.optimize.least_squares."""
    from scipy.optimize import least_squares

    lower = [0] * NEVER_NEGATIVE + [-math.inf] * (len(NAMES) - NEVER_NEGATIVE)
    return least_squares(residuals, START, method="trf", x_scale=SCALE, diff_step=RELATIVE_STEP,
                         bounds=(lower, math.inf)).x


def fit_by_lmfit(residuals):
    """The estimates of lmfit.minimize."""
    import lmfit

    parameters = lmfit.Parameters()
    for i, (name, start) in enumerate(zip(NAMES, START)):
        parameters.add(name, value=start, min=0 if i < NEVER_NEGATIVE else -math.inf)
    fit = lmfit.minimize(lambda p: residuals([p[name].value for name in NAMES]), parameters, method="leastsq",
                         epsfcn=RELATIVE_STEP**2)
    return [fit.params[name].value for name in NAMES]


def report(fit, version, recording, repetitions):
    """The fit's entry in the output."""
    seconds = []
    for _ in range(repetitions):
        residuals = Residuals(*recording)
        begin = time.process_time()
        estimates = [float(estimate) for estimate in fit(residuals)]
        seconds.append(time.process_time() - begin)
    return {
        "version": version,
        "seconds": seconds,
        "evaluations": residuals.evaluations,
        "estimates": dict(zip(NAMES, estimates)),
        "relative_errors": {name: abs(estimate / true - 1) for name, estimate, true in zip(NAMES, estimates, TRUTH)},
    }


def run(options):
    """The printed object."""
    recording = read_recording(options.csv)
    try:
        import lmfit
        import scipy
    except ImportError as error:
        raise Refusal(
            f"the Python package {error.name} is missing: run scripts/install_dependencies --benchmarks") from error
    return {
        "scipy": report(fit_by_scipy, scipy.__version__, recording, options.repetitions),
        "lmfit": report(fit_by_lmfit, lmfit.__version__, recording, options.repetitions),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("csv", type=pathlib.Path, help="the recording: time_s,angle_deg")
    parser.add_argument("--repetitions", type=int, default=1, help="fits of each; default 1")
    options = parser.parse_args()
    if options.repetitions < 1:
        parser.error(f"--repetitions is {options.repetitions}; it is at least 1")
    try:
        print(json.dumps(run(options), indent=2))
    except Refusal as refusal:
        sys.exit(f"scipy_users: {refusal}")


if __name__ == "__main__":
    main()
