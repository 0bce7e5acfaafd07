#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the lab guide datasets/ACTIVITY.md, command by command, on a simulated board with a virtual clock.

activity_test.py BUILD_FOLDER            runs the guide. The output must be that of the guide; the recordings must be those
                                         of datasets/, and the fits must give the true values
activity_test.py BUILD_FOLDER --update   writes the output into the guide, and the recordings into datasets/
"""

import difflib
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
    environment = os.environ | {"PORT": str(port), "PATH": f"{build}/tests/virtual_clock:{build}/bin:{os.environ['PATH']}"}
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


def differences(shown, now):
    return difflib.unified_diff(shown.splitlines(), now.splitlines(), "shown", "now", lineterm="", n=1)


def lines_of(path):
    """The lines of a file; the only thing that differs from run to run is the date in a recording."""
    return re.sub(r"begun \S+$", "begun", path.read_text(), flags=re.MULTILINE).splitlines()


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
    """Compares the files with those of datasets/: the simulated board gives the same each time."""
    for made, kept in (("run_1.csv", "recorded.csv"), ("run_2.csv", "recorded_2.csv"), ("calibration.csv", "recorded_calibration.csv"),
                       ("rig.json", "recorded_rig.json"), ("truth.json", "recorded_truth.json")):
        was, now = lines_of(TOP / "datasets" / kept), lines_of(folder / made)
        if not is_update:
            yield from difflib.unified_diff(was, now, f"datasets/{kept}", made, lineterm="", n=0)
        elif was != now:
            shutil.copyfile(folder / made, TOP / "datasets" / kept)


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
