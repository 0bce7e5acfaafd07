# SPDX-License-Identifier: Apache-2.0
"""Writes a result of schema version 2, of a former build, as one of version 3."""

import itertools

# The first parameters of a recording's own, after inertia and the friction law.
OWN = ("release_angle", "release_time", "initial_angle", "initial_rate", "zero_angle", "rate_bias")
# What all recordings have together, of the statistics of one.
TOGETHER = ("rms_residual", "log_likelihood", "aic", "aicc", "bic", "effective_samples")


def with_schema_3(result: dict) -> dict:
    """The result with one shape for one and for several recordings. The amplitude of a single one was not stored: it is null."""
    if result["schema_version"] != 2:
        for recording in result["recordings"]:
            recording.setdefault("left_out", None)  # the first results of version 3 lack it
        return result
    result = with_current_units(result)
    is_joint = isinstance(result["data"], list)

    def of_each(key: str) -> list:
        return result[key] if is_joint else [result[key]]

    recordings = []
    for data, calibration, forms in zip(of_each("data"), of_each("calibration"), of_each("closed_forms")):
        reason = {"reason": result["reason"]} if forms is None and "reason" in result else {}
        recordings.append({**data, "left_out": None, "calibration": calibration, "closed_forms": forms, "fits": [], **reason})
    fits = []
    for fit in result["fits"]:
        shared = fit["shared"] if is_joint else physical(fit["parameters"])
        for recording, part in zip(recordings, fit["runs"] if is_joint else [fit]):
            recording["fits"].append(recording_fit(fit, part, shared))
        fits.append(shared_fit(fit, shared))
    return {
        "schema_version": 3,
        "tool": result["tool"],
        "rig": result["rig"],
        "recordings": recordings,
        "fits": fits,
        "comparison": result["comparison"],
        "warnings": [whole_warning(warning) for warning in result["warnings"]],
    }


def physical(parameters: dict) -> list[str]:
    """The names of inertia and of the friction parameters: those before the first of the start."""
    return list(itertools.takewhile(lambda name: name not in OWN, parameters))


def recording_fit(fit: dict, part: dict, shared: list[str]) -> dict:
    """A recording's part of a fit. `part`: the entry of `runs`, or the fit itself if there is one recording."""
    new = {
        "model": fit["model"],
        "amplitude_rad": part.get("amplitude_rad"),
        "parameters": {name: value for name, value in part["parameters"].items() if name not in shared},
        "identifiability": [row for row in part["identifiability"] if row["parameter"] not in shared],
    }
    new |= {key: part[key] for key in ["covariance", "correlation", "systematic_covariance", "std_error_method"]}
    new |= {key: part[key] for key in ["noise", "statistics", "closed_form", "constancy"]}
    new |= {key: part[key] for key in ["constancy_reason", "suspicions"] if key in part}
    status = fit["status"] if fit["status"] == "converged" else f"{fit['status']}: {fit['reason']}"
    return {**new, "separate": part.get("separate", status)}


def shared_fit(fit: dict, shared: list[str]) -> dict:
    """What the recordings of a fit share."""
    new = {key: fit[key] for key in ["model", "status", "reason", "equation", "derived", "std_error_method", "interval_method", "solver"]}
    new |= {
        "shared": shared,
        "parameters": {name: value for name, value in fit["parameters"].items() if name in shared},
        "identifiability": [row for row in fit["identifiability"] if row["parameter"] in shared],
        "homogeneity": homogeneity_of(fit),
    }
    new |= {key: rows_of(fit[key], shared) for key in ["covariance", "correlation", "systematic_covariance"]}
    statistics = fit["statistics"]
    new["statistics"] = statistics and {key: value for key, value in statistics.items() if key.startswith(TOGETHER)}
    return {**new, **{key: fit[key] for key in ["rig_verdict", "ambiguities", "summary"] if key in fit}}


def homogeneity_of(fit: dict) -> dict | None:
    """Whether several recordings agree; the estimates of each had the key `runs`."""
    homogeneity = fit.get("homogeneity")
    if homogeneity is None:
        return None
    parameters = {
        name: {"recordings" if key == "runs" else key: value for key, value in parameter.items()}
        for name, parameter in homogeneity["parameters"].items()
    }
    return {**homogeneity, "parameters": parameters}


def with_current_units(value: object) -> object:
    """The unit of accelerations had another spelling in keys until shortly before version 3: sigma_m_s^2."""
    if isinstance(value, list):
        return [with_current_units(item) for item in value]
    if not isinstance(value, dict):
        return value
    return {key.replace("_m_s^2", "_m_s2"): with_current_units(item) for key, item in value.items()}


def rows_of(matrix: dict, names: list[str]) -> dict:
    """The rows and columns of these names."""
    kept = [i for i, name in enumerate(matrix["names"]) if name in names]
    return {"names": [matrix["names"][i] for i in kept], "matrix": [[matrix["matrix"][i][j] for j in kept] for i in kept]}


def whole_warning(warning: dict) -> dict:
    """Earlier results of version 2 have only code and message."""
    message = warning["message"]
    blank = {"text": message, "finding": message, "explanation": None, "advice": None, "flags": [], "assumed": None, "law": None}
    return {**blank, "recordings": [], "parameters": [], **warning}
