#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that no recording fault leads to a confident wrong result.

  corruption_battery.py [FOLDER_OF_THE_TOOLS] [--count 100] [--hazard gaps,knock] [--seed 1] [--jobs 2] [--keep FOLDER]

For each hazard at each strength, `count` recordings are simulated, corrupted and fitted as a user would. A run ends in
one of

  fits            exit 0 and every parameter within 4 of its error bars of the true value
  beyond 4        exit 0 and a parameter between 4 and 5, which may be chance
  warned          exit 0 and a parameter beyond 4, but with a warning that covers it
  not converged   exit 1
  refused         exit 4 or 5 with a sentence
  WRONG           exit 0 and a parameter beyond 5 without such a warning
  DEFECT          a crash, a timeout, another exit code, no sentence, no result

For motions that are not a free swing a run ends in `expected`, `unexpected`, or WRONG if it fits without any warning.
The exit code is 0 if no run is WRONG or DEFECT and at most 0.1 % of the parameters without a covering warning lie
beyond 4; otherwise it is 1. The files of failed runs are kept, with run.csv, truth.json and the command.
"""

import argparse
import collections
import collections.abc
import concurrent.futures
import dataclasses
import functools
import json
import math
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import hazards_of_motion  # noqa: F401, because the import registers hazards
from hazards import HAZARDS
from simulated_lab import Lab, Recording
from swing import parameters_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = ["viscous", "coulomb", "drag"]
TIMEOUT = 20  # s
BEYOND, WRONG = 4, 5  # error bars
MOST_BEYOND = 1e-3  # share of the judged parameters

# A warning counts if it tells the user not to trust the error bars. Warnings that only report a repair or the choice of
# the window do not count: the result should still be right.
COUNTING_WARNINGS = {
    "another_minimum", "at_bound", "correlated_residuals", "event_driven", "lack_of_fit",
    "larger_motion_outside", "many_spikes", "noise_below_resolution", "not_a_pendulum", "saturated",
    "stale_values", "time_bursts", "time_rounded", "trajectory_accuracy", "uncertain_stop", "unit_questioned", "zero_drift",
}

KINDS = ["fits", "beyond 4", "warned", "not converged", "refused", "expected", "unexpected", "WRONG", "DEFECT"]
KEPT_KINDS = {"beyond 4", "unexpected", "WRONG", "DEFECT"}


@dataclasses.dataclass(frozen=True)
class Job:
    """One run of one hazard at one strength."""

    tools: pathlib.Path
    folder: pathlib.Path
    seed: int
    hazard: str
    strength: str
    run: int
    keep: bool


@dataclasses.dataclass
class Verdict:
    """The outcome of a job."""

    job: Job
    kind: str
    detail: str = ""
    z: dict[str, float] = dataclasses.field(default_factory=dict)
    codes: list[str] = dataclasses.field(default_factory=list)

    @property
    def excused(self) -> bool:
        """Whether a warning told the user not to trust the error bars."""
        return not COUNTING_WARNINGS.isdisjoint(self.codes)

    @property
    def judged(self) -> list[float]:
        """The z values that must follow a normal distribution."""
        return [] if self.excused or self.kind not in ("fits", "beyond 4", "WRONG") else list(self.z.values())


@dataclasses.dataclass
class Fit:
    """The outcome of fit_pendulum."""

    exit_code: int
    stderr: str
    result: dict | None  # its JSON output


def run_fit(command: list[str], folder: pathlib.Path) -> Fit:
    """Runs the command in the folder; a timeout is exit code -99."""
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired:
        return Fit(-99, f"no end after {TIMEOUT} s", None)
    (folder / "report.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    try:
        return Fit(done.returncode, done.stderr, json.loads((folder / "fit.json").read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return Fit(done.returncode, done.stderr, None)


def deviation(name: str, estimate: float, true: float, recording: Recording) -> float:
    """Estimate minus true value; for angles modulo whole turns."""
    if name == "zero_angle":
        off = math.remainder(estimate - true, 2 * math.pi)
        return math.copysign(max(0, abs(off) - recording.zero_span), off)
    if name == "release_angle":
        return math.remainder(estimate - true, 2 * math.pi)
    if name == "release_time" and recording.clock_turn:
        return math.remainder(estimate - true, recording.clock_turn)
    return estimate - true


def release_to_compare(result: dict, recording: Recording) -> dict[str, float]:
    """The release that the fit refers to, if its window contains one."""
    (read,) = result["recordings"]
    window = read["window_s"]
    if read["start"] != "release":
        return {}
    if recording.clock_turn:
        candidates = recording.releases
    else:
        candidates = [release for release in recording.releases if window[0] <= release[0] <= window[1]]
    if not candidates:
        return {}
    claimed = read["fits"][0]["parameters"]["release_time"]["estimate"]
    time, angle = min(candidates, key=lambda release: abs(release[0] - claimed))
    return {"release_angle": angle, "release_time": time}


def z_scores(result: dict, recording: Recording) -> dict[str, float]:
    """(Estimate - true value) / error for each parameter with an error bar; a parameter at a bound has none."""
    truth = {**recording.truth, **release_to_compare(result, recording)}
    scores = {}
    for name, parameter in parameters_of(result).items():
        if name in truth and parameter["std_error"] is not None:
            error = math.hypot(parameter["std_error"], parameter["systematic_std_error"] or 0)
            scores[name] = deviation(name, parameter["estimate"], truth[name], recording) / error
    return scores


def defect(fit: Fit) -> str:
    """Describes a failure that no recording may cause; empty if there is none."""
    if fit.exit_code not in (0, 1, 4, 5):
        return f"exit code {fit.exit_code}: {fit.stderr.strip()}"
    if fit.exit_code != 0 and not re.search(r"^fit_pendulum: \S+ \S+ \S+.*$", fit.stderr, re.MULTILINE):
        return f"exit code {fit.exit_code} without a sentence"
    if fit.exit_code == 4 and not re.search(r":\d+(:\d+)?: ", fit.stderr):
        return f"exit code 4 without a line: {fit.stderr.strip()}"
    if fit.exit_code in (0, 1) and fit.result is None:
        return f"exit code {fit.exit_code} without a result"
    if fit.exit_code == 0 and fit.result["fits"][0]["status"] != "converged":
        return "exit code 0 without convergence"
    return ""


def judge_free_swing(job: Job, fit: Fit, recording: Recording, codes: list[str]) -> Verdict:
    """Compares the result with the true values."""
    if fit.exit_code != 0:
        return Verdict(job, "not converged" if fit.exit_code == 1 else "refused", fit.stderr.strip(), codes=codes)
    z = z_scores(fit.result, recording)
    verdict = Verdict(job, "fits", ", ".join(f"{name} {value:+.1f}" for name, value in z.items()), z, codes)
    worst = max(map(abs, z.values()), default=0)
    if worst > BEYOND:
        verdict.kind = "warned" if verdict.excused else "WRONG" if worst > WRONG else "beyond 4"
    return verdict


def judge_other_motion(job: Job, fit: Fit, codes: list[str]) -> Verdict:
    """Checks whether the recording was recognized as not a free swing."""
    hazard = HAZARDS[job.hazard]
    detail = f"exit code {fit.exit_code}, {'+'.join(codes) or 'no warning'} {fit.stderr.strip()}"
    if fit.exit_code == hazard.exit_code and (not hazard.warning or hazard.warning in codes):
        return Verdict(job, "expected", detail, codes=codes)
    return Verdict(job, "WRONG" if fit.exit_code == 0 and not codes else "unexpected", detail, codes=codes)


def make_recording(job: Job, folder: pathlib.Path) -> tuple[Recording, str]:
    """The corrupted recording and the model that generated it. All strengths of a hazard use the same pendulums."""
    model = MODELS[job.run % len(MODELS)]
    lab = Lab(job.tools / "simulate_pendulum", folder, random.Random(f"{job.seed}/{job.hazard}/{job.run}"), model)
    lab.rng = random.Random(f"{job.seed}/{job.hazard}/{job.strength}/{job.run}")
    hazard = HAZARDS[job.hazard]
    return hazard.inject(lab, hazard.strengths[job.strength]), model


def work(job: Job) -> Verdict:
    """Simulates, corrupts, fits and judges; keeps the folder of a failed run."""
    name = re.sub(r"-(?=\d)", "minus ", f"{job.hazard} {job.strength} {job.run}")
    folder = job.folder / re.sub(r"[^\w.]+", "_", name)
    folder.mkdir(parents=True)
    try:
        recording, model = make_recording(job, folder)
    except subprocess.CalledProcessError as error:
        raise RuntimeError(f"{job.hazard}, {job.strength}, run {job.run}: {error.stderr}") from error
    (folder / "run.csv").write_text(recording.text(), encoding="utf-8")
    truth = {**recording.truth, "releases": recording.releases}
    (folder / "truth.json").write_text(json.dumps(truth, indent=2), encoding="utf-8")
    command = [str(job.tools / "fit_pendulum"), "--data", "run.csv", "--json", "fit.json"]
    if recording.model_given:
        command += ["--model", model]
    fit = run_fit(command, folder)
    codes = sorted({warning["code"] for warning in fit.result["warnings"]}) if fit.result else []
    if fault := defect(fit):
        verdict = Verdict(job, "DEFECT", fault, codes=codes)
    elif HAZARDS[job.hazard].exit_code:
        verdict = judge_other_motion(job, fit, codes)
    else:
        verdict = judge_free_swing(job, fit, recording, codes)
    if verdict.kind in KEPT_KINDS:
        verdict.detail += f"\n    cd {folder} && {shlex.join(command)}"
    elif not job.keep:
        shutil.rmtree(folder)
    return verdict


def row(label: str, verdicts: collections.abc.Sequence[Verdict]) -> str:
    """One row of the table."""
    counts = collections.Counter(verdict.kind for verdict in verdicts)
    judged = [z for verdict in verdicts for z in verdict.judged]
    beyond = f"{sum(abs(z) > BEYOND for z in judged)} / {len(judged)}"
    cells = [f"{counts[kind] or '.':>{len(kind)}}" for kind in KINDS]
    return f"{label:<40}" + "  ".join(cells) + f"  {beyond:>10}"


def print_codes(title: str, groups: collections.abc.Iterable[list[str]]) -> None:
    """Prints how often each group of warning codes occurs."""
    counts = collections.Counter("+".join(group) for group in groups if group)
    if counts:
        print(title, ", ".join(f"{codes} {count}" for codes, count in counts.most_common()))


def print_table(verdicts: list[Verdict]) -> None:
    """Prints counts by hazard and strength, and the warnings that counted and those that did not."""
    print(f"{'hazard':<40}" + "  ".join(KINDS) + f"  {'|z| > 4':>10}")
    by_cell = collections.defaultdict(list)
    for verdict in verdicts:
        by_cell[verdict.job.hazard, verdict.job.strength].append(verdict)
    for (hazard, strength), members in by_cell.items():
        print(row(f"{hazard}, {strength}", members))
    print(row("all", verdicts))
    print_codes("warnings of the warned:", ([code for code in verdict.codes if code in COUNTING_WARNINGS]
                                            for verdict in verdicts if verdict.kind == "warned"))
    print_codes("warnings that never count:", ([code] for verdict in verdicts for code in verdict.codes
                                               if code not in COUNTING_WARNINGS))


def print_offenders(verdicts: list[Verdict]) -> None:
    """Prints each run that needs inspection."""
    for verdict in verdicts:
        if verdict.kind in KEPT_KINDS:
            job = verdict.job
            print(f"{verdict.kind}: {job.hazard}, {job.strength}, run {job.run}: {verdict.detail}")


def passed(verdicts: list[Verdict]) -> bool:
    """Whether the tool passed."""
    judged = [z for verdict in verdicts for z in verdict.judged]
    few_beyond = sum(abs(z) > BEYOND for z in judged) <= MOST_BEYOND * len(judged)
    return few_beyond and not any(verdict.kind in ("WRONG", "DEFECT") for verdict in verdicts)


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tools", nargs="?", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--count", type=int, default=100, help="recordings of each hazard and strength")
    parser.add_argument("--hazard", default="", help="only these hazards, separated by commas")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="an empty folder in which the files of every run stay")
    arguments = parser.parse_args()
    known = HAZARDS
    arguments.names = arguments.hazard.split(",") if arguments.hazard else list(known)
    if unknown := [name for name in arguments.names if name not in known]:
        parser.error(f"no hazard {unknown[0]!r}; there are: {'; '.join(known)}")
    return arguments


def main() -> int:
    arguments = parse_arguments()
    folder = (arguments.keep or pathlib.Path(tempfile.mkdtemp(prefix="corruption_battery_"))).resolve()
    make_job = functools.partial(Job, arguments.tools.resolve(), folder, arguments.seed)
    jobs = [make_job(name, strength, run, arguments.keep is not None) for name in arguments.names
            for strength in HAZARDS[name].strengths for run in range(arguments.count)]
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        verdicts = list(pool.map(work, jobs, chunksize=4))
    print_table(verdicts)
    print_offenders(verdicts)
    if not any(folder.iterdir()):
        folder.rmdir()
    return 0 if passed(verdicts) else 1


if __name__ == "__main__":
    sys.exit(main())
