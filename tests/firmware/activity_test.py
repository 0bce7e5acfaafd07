#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the lab guide datasets/ACTIVITY.md, command by command, on a simulated board in real time.

activity_test.py BUILD_FOLDER            runs the guide. The output must match the guide, numbers within 5 % plus three
                                         units of the last digit; the recordings must match datasets/, and the fits the
                                         true values
activity_test.py BUILD_FOLDER --update   writes the output into the guide, and the recordings into datasets/
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import simulated_lab

TOP = pathlib.Path(__file__).resolve().parents[2]
GUIDE = TOP / "datasets" / "ACTIVITY.md"
BLOCK = re.compile(r"```console\n(.*?)```", re.DOTALL)
# Output that depends on how accurately this computer keeps time.
OF_THE_HOST = re.compile(r"clock  .*?(?:clock_scale\s+corrects\s+for\s+it|resonator)\n|chi-square [\d.]+|\bp [\d.]+",
                         re.DOTALL)
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TRUTH = {"inertia": 0.079, "viscous": 0.002, "coulomb": 0.005}
LOGGER = ["--rig", TOP / "datasets/textbook_rig.json", "--model", "coulomb", "--set",
          "inertia=0.079,viscous=0.002,coulomb=0.005,release_angle=0.5,release_time=1.5,zero_angle=0.021",
          "--noise", "0.5", "--nonlinearity", "0.25", "--clock_ppm", "1840", "--seed", "3",
          # A protractor is read to some tenths of a degree.
          "--hold_deg=-45.2,-30.1,-14.7,0.1,14.9,30.3,44.7", "--release_angles", "0.5,0.25"]


def commands_of(block):
    """The commands of a console block."""
    return [re.sub(r"^(\$|>) ?", "", command, flags=re.MULTILINE)
            for command in re.findall(r"^\$ .*(?:\n>.*)*", block, re.MULTILINE)]


def run(command, folder, port, build):
    """A command's output on stdout; a failing command is an error. Answers every prompt with Enter."""
    environment = os.environ | {"PORT": str(port), "PATH": f"{build}/bin:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-euc", command], cwd=folder, env=environment, input="\n" * 50, capture_output=True,
                          text=True, timeout=300)
    if done.returncode != 0:
        sys.exit(f"ACTIVITY.md: exit code {done.returncode} of: {command}\n{done.stdout}{done.stderr}")
    return done.stdout.replace(str(port), "/dev/ttyACM0")


def executed(block, *place):
    """The block with the present output of its commands."""
    shown = ""
    for shell, command in zip(re.findall(r"^\$ .*(?:\n>.*)*", block, re.MULTILINE), commands_of(block)):
        shown += shell + "\n" + run(command, *place)
    return shown


def digit_of(number):
    """The value of one unit in the last digit of a number: 0.01 for 3.14."""
    mantissa, _, exponent = number.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def is_near(a, b, digit):
    return abs(a - b) <= 0.05 * max(abs(a), abs(b)) + 3 * digit


def differences(shown, now):
    """Differences between two outputs; numbers may differ by 5 %."""
    shown, now = (OF_THE_HOST.sub("", text) for text in (shown, now))
    words = [re.sub(r"\s+", " ", NUMBER.sub("#", text)) for text in (shown, now)]
    if words[0] != words[1]:
        return [f"--- shown\n{shown}\n--- now\n{now}"]
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(now))
    return [f"{a} is now {b}, where it shows\n{shown}" for a, b in pairs if not is_near(float(a), float(b), digit_of(a))]


def rows_of(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


def check_fit(folder, build):
    """Expects joint estimates of both runs within four standard errors of the truth, including systematic errors."""
    run("fit_pendulum --data run_1.csv,run_2.csv --rig rig.json --model coulomb --json fit.json", folder, "none", build)
    parameters = json.loads((folder / "fit.json").read_text())["fits"][0]["parameters"]
    for name, true in TRUTH.items():
        found = parameters[name]
        error = (found["std_error"] ** 2 + found["systematic_std_error"] ** 2) ** 0.5
        z = (found["estimate"] - true) / error
        print(f"{name} {found['estimate']:.7g} ± {error:.2g}, truth {true}, z {z:.2f}")
        if abs(z) > 4:
            yield f"{name} is {found['estimate']}, {z:.1f} standard errors from the truth"


def check_files(folder, is_update):
    """Compares the recordings with datasets/, row by row: the simulated board gives the same each time."""
    for made, kept in (("run_1.csv", "recorded.csv"), ("run_2.csv", "recorded_2.csv"), ("calibration.csv", "recorded_calibration.csv"),
                       ("rig.json", "recorded_rig.json"), ("truth.json", "recorded_truth.json")):
        if is_update:
            shutil.copyfile(folder / made, TOP / "datasets" / kept)
        elif rows_of(folder / made) != rows_of(TOP / "datasets" / kept):
            yield f"{made} differs from datasets/{kept}"


def main():
    build, is_update = pathlib.Path(sys.argv[1]).resolve(), "--update" in sys.argv
    faults = []
    text = GUIDE.read_text()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with simulated_lab.Logger(build, folder, *LOGGER, "--truth", folder / "truth.json") as logger:
            now = BLOCK.sub(lambda block: f"```console\n{executed(block[1], folder, logger.port, build)}```", text)
        for shown, seen in zip(BLOCK.findall(text), BLOCK.findall(now)):
            faults += [] if is_update else differences(shown, seen)
        faults += check_fit(folder, build)
        faults += check_files(folder, is_update)
    if is_update:
        GUIDE.write_text(now)
    if faults:
        sys.exit("\n".join(faults))


main()
