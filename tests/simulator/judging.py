# SPDX-License-Identifier: Apache-2.0
"""Compares the result of fit_pendulum with the true values of a simulated recording."""

import collections.abc
import dataclasses
import json
import math
import pathlib
import re
import subprocess

WRONG = 5.0  # total errors
# What a user knows of the start without a fit. An estimate of it that is wrong is counted apart from inertia and friction.
START = {"release_angle", "release_time", "initial_angle", "initial_rate", "zero_angle", "rate_bias"}
# Warnings that tell the user to doubt the answer without naming a cause.
DOUBTS = {"lack_of_fit", "not_constant", "prior_conflict", "inertia_differs_from_rig", "frequency_differs_from_rig",
          "another_minimum", "not_a_pendulum", "closed_forms_differ"}
# Warnings that name a cause, beside those of suspicions.
CAUSE_CODES = {"zero_drift", "offset_unsteady", "offset_jumps", "lost_counts", "presliding", "hold_left_out", "hold_disagrees",
               "vibration", "clock_implausible", "rig_implausible"}
QUANTILE = 1.959964  # of a 95 % interval, in errors
TIMEOUT = 120  # s, on a machine that is busy with other things
# What a fit that begins in motion has instead of the release.
IN_MOTION = {"release_angle": "initial_angle", "release_time": "initial_rate"}
# What a user states if sensor and clock are exactly what they are said to be.
EXACT_SENSOR = {"kind": "ideal", "clock": 0}


@dataclasses.dataclass(frozen=True)
class Judged:
    """One estimate: (estimate - true value) / total error, whether the total interval contains the true value, and the
    total error over the true value. The total error is that of the half of the total 95 % interval on the side of the
    true value if this is wider."""

    z: float
    is_covered: bool
    relative_error: float
    z_unseen: float = 0.0  # over the total error together with what other friction could hide


@dataclasses.dataclass
class Outcome:
    """One fit. `causes` are the suspicions that are significant, `codes` those of all warnings, and `ambiguities` the words
    of what the report says that no free swing can tell."""

    exit_code: int
    expected: int  # number of parameters to judge
    judged: dict[str, Judged] = dataclasses.field(default_factory=dict)
    causes: list[str] = dataclasses.field(default_factory=list)
    codes: list[str] = dataclasses.field(default_factory=list)
    ambiguities: list[str] = dataclasses.field(default_factory=list)
    is_constancy_tested: bool = False
    message: str = ""

    @property
    def is_wrong(self) -> bool:
        """Whether the fit converged to an inertia or friction that its total error does not explain."""
        return self._worst(lambda name, each: name not in START and each.z) > WRONG

    @property
    def is_start_wrong(self) -> bool:
        """Whether the fit converged to a release or a zero that its total error does not explain."""
        return self._worst(lambda name, each: name in START and each.z) > WRONG

    @property
    def is_unseen(self) -> bool:
        """Whether the size of friction that the result calls unseen explains the errors of inertia and friction."""
        return bool(self.judged) and self._worst(lambda name, each: name not in START and each.z_unseen) <= WRONG

    def _worst(self, z) -> float:
        return max((abs(z(name, each)) for name, each in self.judged.items()), default=0.0)

    @property
    def all_causes(self) -> set[str]:
        """The causes that suspicions and warnings name."""
        return set(self.causes) | CAUSE_CODES.intersection(self.codes)

    def is_named(self, names: collections.abc.Set[str]) -> bool:
        """Whether a suspicion or a warning names one of these causes."""
        return not names.isdisjoint({*self.causes, *self.codes})

    def is_misnamed(self, names: collections.abc.Set[str]) -> bool:
        """Whether causes are named, and none of these. Where nothing is wrong there is none, so each is a false alarm."""
        return bool(self.all_causes) and not self.is_named(names)

    @property
    def is_doubted(self) -> bool:
        """Whether the tool has no result, or says that something does not agree."""
        return self.exit_code == 1 or not DOUBTS.isdisjoint(self.codes)

    def is_remarked(self, names: collections.abc.Set[str]) -> bool:
        """Whether the report lists one of these words among what no free swing can tell. It lists them for every swing."""
        return any(word in names for word in self.ambiguities)


def judge(parameter: dict, low: float, high: float) -> Judged | None:
    """Compares one parameter of the JSON with the nearest of its true values; None if it has neither an error nor an
    interval."""
    estimate, error, interval = parameter["estimate"], parameter["std_error"], parameter["interval95"]
    if estimate is None or parameter["fixed"]:
        return None
    truth = float(min(max(estimate, low), high))
    systematic = parameter["systematic_std_error"] or 0.0
    below = truth < estimate
    end = interval[0 if below else 1] if interval else None
    if end is None and error is None:
        return None
    half = QUANTILE * error if end is None else abs(end - estimate)
    total_half = math.hypot(half, QUANTILE * systematic)
    stated = 0.0 if error is None else parameter.get("total_std_error") or math.hypot(error, systematic)
    total = max(stated, total_half / QUANTILE)
    deviation = estimate - truth
    if total <= 0:  # the estimate is its bound, and the true value is beyond
        return Judged(0.0 if deviation == 0 else math.inf, deviation == 0, 0.0)
    unseen = math.hypot(total, parameter.get("unseen_friction_std_error") or 0.0)
    relative = total / abs(truth) if truth else math.inf
    return Judged(deviation / total, abs(deviation) <= total_half, relative, deviation / unseen)


def own_fit(result: dict) -> dict:
    """The recording's part of the first fit; empty if there is no fit."""
    return result["recordings"][0]["fits"][0] if result["fits"] else {}


def significant_causes(result: dict) -> list[str]:
    """Names of the suspicions of the first fit. One that says that it is not significant does not count."""
    suspicions = own_fit(result).get("suspicions", [])
    return sorted({each["name"] for each in suspicions if each.get("significant", True)})


def ambiguous_words(result: dict) -> list[str]:
    """The words of the causes that the first fit says it cannot tell apart."""
    ambiguities = result["fits"][0].get("ambiguities", []) if result["fits"] else []
    return sorted({word for each in ambiguities for word in re.findall(r"[a-z]+", each["cause"].lower())})


def is_constancy_tested(result: dict) -> bool:
    """Whether the first fit compares halves of the recording, or windows along it."""
    constancy = own_fit(result).get("constancy")
    return bool(constancy) and (constancy["halves"]["p"] is not None or
                                any(trend["p"] is not None for trend in constancy["amplitude"]["trends"]))


def judge_result(exit_code: int, result: dict, recording, parameters: tuple[str, ...], message: str = "",
                 optional: tuple[str, ...] = ()) -> Outcome:
    """Judges the first fit of a result, recording.true_range(name, first_stamp) being the truth. An optional parameter is
    judged only if the fit gives it an error."""
    outcome = Outcome(exit_code, len(parameters), causes=significant_causes(result),
                      codes=sorted({warning["code"] for warning in result["warnings"]}),
                      ambiguities=ambiguous_words(result), is_constancy_tested=is_constancy_tested(result),
                      message=message)
    if exit_code != 0 or not result["fits"]:
        return outcome
    fitted = {**result["fits"][0]["parameters"], **own_fit(result)["parameters"]}
    begin = result["recordings"][0]["window_s"][0]
    for name in (*parameters, *(name for name in optional if has_error(fitted.get(name)))):
        name = name if name in fitted else IN_MOTION.get(name, name)
        truth = recording.true_range(name, begin)
        judged = judge(fitted[name], *truth) if name in fitted and truth else None
        if judged:
            outcome.judged[name] = judged
    return outcome


def has_error(parameter: dict | None) -> bool:
    """Whether the fit says how far its estimate may be off."""
    return parameter is not None and (parameter["std_error"] is not None or parameter["interval95"] is not None)


def run_tool(tool: pathlib.Path, folder: pathlib.Path, recording, model: str, sensor: dict | None = None
             ) -> tuple[int, dict | None, str]:
    """Fits a recording in a folder as a user would. `sensor` is what the user states of it. Returns the exit code, the result,
    None if there is none, and the message."""
    (folder / "run.csv").write_text(recording.text, encoding="utf-8")
    (folder / "rig.json").write_text(json.dumps(recording.rig), encoding="utf-8")
    command = [str(tool), "--data", "run.csv", "--rig", "rig.json", "--model", model, "--json", "fit.json"]
    if sensor is not None:
        (folder / "sensor.json").write_text(json.dumps(sensor), encoding="utf-8")
        command += ["--sensor", "sensor.json"]
    output = folder / "fit.json"
    output.unlink(missing_ok=True)
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired:
        return -1, None, f"no end after {TIMEOUT} s"
    result = json.loads(output.read_text(encoding="utf-8")) if output.exists() else None
    return done.returncode, result, done.stderr.strip()


def fit(tool: pathlib.Path, folder: pathlib.Path, recording, model: str, parameters: tuple[str, ...],
        sensor: dict | None = None, optional: tuple[str, ...] = ()) -> Outcome:
    """Fits a recording with run_tool, and judges the result."""
    exit_code, result, message = run_tool(tool, folder, recording, model, sensor)
    if result is None:
        return Outcome(exit_code, len(parameters), message=message)
    return judge_result(exit_code, result, recording, parameters, message, optional)
