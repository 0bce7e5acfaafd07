# SPDX-License-Identifier: Apache-2.0
"""Compares the result of fit_pendulum with the true values of a simulated recording."""

import collections.abc
import dataclasses
import functools
import json
import math
import pathlib
import re
import subprocess

WRONG = 5.0  # total errors
QUANTILE = 1.959964  # of a 95 % interval, in errors
TIMEOUT = 120  # s, on a machine that is busy with other things
# What a fit that begins in motion has instead of the release.
IN_MOTION = {"release_angle": "initial_angle", "release_time": "initial_rate"}
# What a user states if sensor and clock are exactly what they are said to be, if fit_pendulum has the flag --sensor.
EXACT_SENSOR = {"kind": "ideal", "clock": 0}


@dataclasses.dataclass(frozen=True)
class Judged:
    """One estimate: (estimate - true value) / total error, whether the total interval contains the true value, and the
    total error over the true value."""

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
    message: str = ""

    @property
    def worst(self) -> float:
        """The largest |z|."""
        return max((abs(each.z) for each in self.judged.values()), default=0.0)

    @property
    def is_wrong(self) -> bool:
        """Whether the fit converged to an estimate that its total error does not explain."""
        return self.exit_code == 0 and self.worst > WRONG

    @property
    def is_unseen(self) -> bool:
        """Whether the size of friction that the result calls unseen explains every error."""
        return max((abs(each.z_unseen) for each in self.judged.values()), default=0.0) <= WRONG

    def is_named(self, names: collections.abc.Set[str]) -> bool:
        """Whether a suspicion or a warning has one of these names; a warning's code may have more words."""
        return any(cause in names for cause in self.causes) or any(
            f"_{name}_" in f"_{code}_" for name in names for code in self.codes)

    def is_ambiguous(self, names: collections.abc.Set[str]) -> bool:
        """Whether the report says that no free swing can tell one of these."""
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
    total = total_half / QUANTILE if error is None else parameter.get("total_std_error") or math.hypot(error, systematic)
    deviation = estimate - truth
    if total <= 0:  # the estimate is its bound, and the true value is beyond
        return Judged(0.0 if deviation == 0 else math.inf, deviation == 0, 0.0)
    unseen = math.hypot(total, parameter.get("unseen_friction_std_error") or 0.0)
    relative = total / abs(truth) if truth else math.inf
    return Judged(deviation / total, abs(deviation) <= total_half, relative, deviation / unseen)


def significant_causes(result: dict) -> list[str]:
    """Names of the suspicions of the first fit. One that says that it is not significant does not count."""
    suspicions = result["fits"][0].get("suspicions", []) if result["fits"] else []
    return sorted({each["name"] for each in suspicions if each.get("significant", True)})


def ambiguous_words(result: dict) -> list[str]:
    """The words of the causes that the first fit says it cannot tell apart."""
    ambiguities = result["fits"][0].get("ambiguities", []) if result["fits"] else []
    return sorted({word for each in ambiguities for word in re.findall(r"[a-z]+", each["cause"].lower())})


@functools.cache
def has_flag(tool: pathlib.Path, flag: str) -> bool:
    """Whether a tool has this flag."""
    return f"--{flag} " in subprocess.run([tool, "--help"], capture_output=True, text=True, check=True).stdout


def judge_result(exit_code: int, result: dict, recording, parameters: tuple[str, ...], message: str = "",
                 optional: tuple[str, ...] = ()) -> Outcome:
    """Judges the first fit of a result, recording.true_range(name, first_stamp) being the truth. An optional parameter is
    judged only if the fit gives it an error."""
    outcome = Outcome(exit_code, len(parameters), causes=significant_causes(result),
                      codes=sorted({warning["code"] for warning in result["warnings"]}),
                      ambiguities=ambiguous_words(result), message=message)
    if exit_code != 0 or not result["fits"]:
        return outcome
    fitted, begin = result["fits"][0]["parameters"], result["data"]["window_s"][0]
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


def fit(tool: pathlib.Path, folder: pathlib.Path, recording, model: str, parameters: tuple[str, ...],
        is_exact: bool = False, optional: tuple[str, ...] = ()) -> Outcome:
    """Fits a recording in a folder as a user would, and judges the result."""
    (folder / "run.csv").write_text(recording.text, encoding="utf-8")
    (folder / "rig.json").write_text(json.dumps(recording.rig), encoding="utf-8")
    command = [str(tool), "--data", "run.csv", "--rig", "rig.json", "--model", model, "--json", "fit.json"]
    if is_exact and has_flag(tool, "sensor"):
        (folder / "sensor.json").write_text(json.dumps(EXACT_SENSOR), encoding="utf-8")
        command += ["--sensor", "sensor.json"]
    output = folder / "fit.json"
    output.unlink(missing_ok=True)
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired:
        return Outcome(-1, len(parameters), message=f"no end after {TIMEOUT} s")
    if not output.exists():
        return Outcome(done.returncode, len(parameters), message=done.stderr.strip())
    result = json.loads(output.read_text(encoding="utf-8"))
    return judge_result(done.returncode, result, recording, parameters, done.stderr.strip(), optional)
