#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws each friction law for the guide: how the amplitude falls, and the friction torque over the rate.

Usage: law_pictures.py [--update]. The tools, and for --update gnuplot, are on the PATH.

The laws and their parameters are those of `fit_pendulum --model all`. Each swings once with the textbook's rig, without
noise; amplitude and torque are computed from the recorded angle and rate, so they are what the tool simulates.
--update writes src/docs/law_NAME.svg, which has the numbers that it shows in a comment. Without it, prints the pictures as
Markdown for friction_laws.md, and fails if the numbers of a picture are not those of the tool.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[3]
RIG = TOP / "datasets/textbook_rig.json"
GRAVITY_TORQUE = 9.81 * 0.43 * (0.380 + 0.095 / 2)  # N m, of this rig
INERTIA = 0.079  # kg m^2, the textbook's
START = math.radians(80)
SECONDS, RATE = 30, 2000  # s, Hz
# Values that show what is special in a law, SI. A parameter that is not here has its estimate from datasets/to_rest.csv.
VALUES = {"viscous": 0.004, "coulomb": 0.02, "drag": 0.0015, "stiction": 0.06, "stribeck_rate": 0.4, "asymmetry": 0.5,
          "presliding_angle": 0.1, "load_friction": 0.012}
DIGITS = 4  # of the numbers in a picture
POINTS = 300  # of the curve of a torque
CLOSE = 2e-3  # of the largest number: a rounding, or another processor
SCRIPT = """
set terminal svg size 640,800 background rgb 'white' font 'sans-serif,22'
set encoding utf8
set minussign
set lmargin at screen 0.19
set rmargin at screen 0.96
set grid lt 1 lc rgb '#dddddd'
set tics nomirror
unset key
set multiplot layout 2,1
set xlabel 'time [s]'
set ylabel 'amplitude [deg]'
set xrange [0:{seconds}]
set yrange [0:90]
set xtics 10
set ytics 30
plot '{amplitude}' with linespoints pt 7 ps 0.5 lw 2 lc rgb '#0b5cad'
set xlabel 'rate [rad/s]'
set ylabel 'friction torque [mN m]'
set xrange [-7:7]
set yrange [-100:100]
set xtics 2
set ytics 50
plot '{torque}' with lines lw 3 lc rgb '#b3401a'
"""


def laws():
    """(name, {parameter: value}) of each law with G sin(theta), as the tool lists them when it fits all."""
    done = subprocess.run(["fit_pendulum", TOP / "datasets/to_rest.csv", "--rig", RIG, "--model", "all", "--json", "-"],
                          capture_output=True, text=True, check=True)
    fits = json.loads(done.stdout)["fits"]
    for fit in fits:
        fitted = {name: estimate["estimate"] for name, estimate in fit["parameters"].items() if name != "inertia"}
        yield fit["model"], {name: VALUES.get(name, value) for name, value in fitted.items()}


def recorded(law, values, unit):
    """A simulated recording without noise: the angle (rad) or the rate (rad_s) of each sample."""
    settings = {"inertia": INERTIA, "release_angle": START, "release_time": 0, **values}
    done = subprocess.run(
        ["simulate_pendulum", "--model", law, "--rig", RIG, "--set", ",".join(f"{name}={value}" for name, value in settings.items()),
         "--unit", unit, "--duration", str(SECONDS), "--rate", str(RATE), "--out", "-"], capture_output=True, text=True, check=True)
    return [float(line.split(",")[1]) for line in done.stdout.splitlines() if line[0].isdigit()]


def amplitudes(angles):
    """[s, deg] of the release and of each turning point."""
    turns = [i for i in range(1, len(angles) - 1) if abs(angles[i]) > max(abs(angles[i - 1]), abs(angles[i + 1]))]
    return [[0, math.degrees(START)], *([i / RATE, abs(math.degrees(angles[i]))] for i in turns)]


def torques(angles, rates):
    """[rad/s, mN m] of the first period, by the equation of motion: T = -(I dw/dt + G sin(theta)). Not where the rate changes sign."""
    turns = [i for i in range(1, len(rates) - 1) if rates[i] * rates[i + 1] < 0]
    points = []
    for i in range(1, turns[1], max(1, turns[1] // POINTS)):
        if rates[i - 1] * rates[i + 1] > 0:
            acceleration = (rates[i + 1] - rates[i - 1]) * RATE / 2
            points.append([rates[i], -1000 * (INERTIA * acceleration + GRAVITY_TORQUE * math.sin(angles[i]))])
    return points


def curves(law, values):
    angles = recorded(law, values, "rad")
    made = {"amplitude": amplitudes(angles), "torque": torques(angles, recorded(law, values, "rad_s"))}
    return {name: [[float(f"{x:.{DIGITS}g}") for x in point] for point in points] for name, points in made.items()}


def draw(law, numbers, path):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for curve, points in numbers.items():
            (folder / curve).write_text("".join(f"{x} {y}\n" for x, y in points))
        script = SCRIPT.format(seconds=SECONDS, amplitude=folder / "amplitude", torque=folder / "torque")
        svg = subprocess.run(["gnuplot"], input=script, capture_output=True, text=True, check=True).stdout
    path.write_text(svg.rstrip() + f"\n<!-- numbers of {law}: {json.dumps(numbers)} -->\n")


def is_current(path, numbers):
    """Whether the picture shows these numbers, but for rounding."""
    found = re.search(r"<!-- numbers of \w+: (.*) -->", path.read_text()) if path.exists() else None
    drawn = json.loads(found[1]) if found else {}
    if {name: len(points) for name, points in drawn.items()} != {name: len(points) for name, points in numbers.items()}:
        return False
    for name, points in numbers.items():
        for axis in (0, 1):
            scale = max(abs(point[axis]) for point in points)
            if any(abs(a[axis] - b[axis]) > CLOSE * scale for a, b in zip(points, drawn[name])):
                return False
    return True


def alternative(law, numbers):
    """What a reader who does not see the picture learns from it."""
    (_, first), (end, last) = numbers["amplitude"][0], numbers["amplitude"][-1]
    rates = max(numbers["torque"]), min(numbers["torque"])
    ends = " and ".join(f"{torque:.0f} mN m at {rate:.1f} rad/s" for rate, torque in rates)
    return f"{law}: the amplitude falls from {first:.0f} deg to {last:.1f} deg in {end:.0f} s. The friction torque is {ends}."


def main():
    stale = []
    for law, values in laws():
        path, numbers = TOP / f"src/docs/law_{law}.svg", curves(law, values)
        if "--update" in sys.argv:
            draw(law, numbers, path)
        elif not is_current(path, numbers):
            stale.append(path.name)
        stated = ", ".join(f"{name} {value:g}" for name, value in values.items())
        print(f"`{law}` with {stated}:\n\n![{alternative(law, numbers)}]({path.name})\n")
    if stale:
        sys.exit(f"law_pictures: the tool gives other numbers than {', '.join(stale)}; run scripts/docs --update")


main()
