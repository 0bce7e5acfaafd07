#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes RESULTS.json and RESULTS.md from the measurements of scripts/benchmark.

  make_table.py --filter                the benchmarks the table needs, for --benchmark_filter
  make_table.py --benchmarks JSON --scipy JSON --instructions TSV --binary FILE --command TEXT --out FOLDER

--benchmarks is Google Benchmark's output, --scipy that of scipy_users.py. --instructions has a line for each run of
hot_paths: its name, the number of repetitions, and the instructions of the whole program. A time is the median of the
repetitions' CPU times; a ratio is the quotient of two medians. The spread of a ratio is the middle half of the ratios
of all pairs of repetitions of the two benchmarks, because repetitions run in random order and are not paired. If
something is missing or failed, the exit code is 1, each failure has a sentence, and the table shows the gap. A ratio
outside its bounds is not an error.
"""

import argparse
import collections
import json
import os
import pathlib
import platform
import re
import statistics
import sys

Row = collections.namedtuple("Row", "name reference floor", defaults=(None, None))
Group = collections.namedtuple("Group", "title text rows")
# Without a sign and a bound, a ratio is only for information.
Ratio = collections.namedtuple("Ratio", "what numerator denominator sign bound stretch offset scale",
                               defaults=(None, None, None, 0, 1))
Limit = collections.namedtuple("Limit", "what name counter sign bound")

REFERENCE = "smoothed_rk4"
TRAJECTORY = (f"{REFERENCE}/trajectory", "floor/trajectory")
COUNTERS = ("max_error_rad", "max_jacobian_error", "std_errors_from_optimum", "bytes_per_sample", "share_of_cores")
# With a permitted error of 5e-7 rad, the error on the reference run is below 1e-8 rad.
WITHIN_1E8 = "sensitivities/max_trace_error:5e-7"
SENSITIVITIES = (f"{REFERENCE}/sensitivities", "floor/sensitivities")
FIT = (f"{REFERENCE}/solve", None)
SOLVERS = (REFERENCE, "smoothed_rk4_flattened", "located_rk4", "located_rk4_flattened", "located_odeint")
SIZES = (1000, 10000, 100000, 1000000)
LEGEND = pathlib.Path(__file__).with_name("legend.md")  # the recording, the columns, and the programs compared

# In the order of the tables; * stands for any number.
TABLE = [
    Group("One trajectory, 2000 samples",
          "The sum of the squared residuals at given parameters; for code that uses Ceres, the residuals themselves.", [
        Row("trajectory/coulomb/release", *TRAJECTORY),
        *(Row(f"{solver}/trajectory", *TRAJECTORY) for solver in SOLVERS),
        Row("floor/trajectory", *TRAJECTORY)]),
    Group("One trajectory with sensitivities to 6 parameters, 2000 samples",
          "What one iteration of a fit needs: for this program, the sums of products of residuals and derivatives; for "
          "code that uses Ceres, the residuals and their Jacobian. `max_trace_error:E` has a trajectory within E rad "
          "everywhere; `coulomb/release` has the default tolerance of a fit.", [
        Row("sensitivities/coulomb/release", *SENSITIVITIES),
        Row("sensitivities/max_trace_error:*", *SENSITIVITIES),
        *(Row(f"{solver}/sensitivities", *SENSITIVITIES) for solver in SOLVERS),
        Row("cvodes/rtol:1e-6/sensitivities", *SENSITIVITIES),
        Row("cvodes/rtol:1e-8/sensitivities", *SENSITIVITIES),
        Row("floor/sensitivities", *SENSITIVITIES)]),
    Group("A fit, 2000 samples",
          "`fit` includes all steps from raw samples to error bars: the free swing, start values, solve and covariance. "
          "The other benchmarks are the solve alone. It begins at values that a user would guess from the rig and the "
          "plot, or (`from_our_start`) at the start values that `fit` finds.", [
        Row("fit", *FIT),
        *(Row(f"{solver}/{what}", *FIT) for solver in (*SOLVERS, "tiny_solver")
          for what in ("solve", "solve_from_our_start")),
        Row("cvodes/rtol:1e-6/solve", *FIT),
        Row("scipy", *FIT),
        Row("lmfit", *FIT)]),
    Group("Noise below a count",
          "The same fit to the same swing with noise of 0.5 or 0.25 counts. The readings are treated as numbers with "
          "Gaussian noise or (`quantized`) as the levels to which the noisy angle was rounded.", [
        Row(f"fit/counts:{counts}/{family}") for counts in ("0.5", "0.25") for family in ("gaussian", "quantized")]),
    Group("Parts of a fit, and steps after it",
          "`parse_csv` reads the file's text, `find_window` finds the free swing, `start_values` computes the start of "
          "the solve, `covariance` is the step after the solve, and `json` writes the report. `file_to_json` is all of "
          "these steps and the solve. `profile` finds the profile-likelihood intervals of all parameters after a fit. "
          "`bootstrap` is a fit with intervals from 999 refits, on one thread.", [
        Row(name) for name in ("parse_csv", "find_window", "start_values", "covariance", "json", "file_to_json",
                               "profile", "bootstrap")]),
    Group("Numbers of samples",
          "The same 20 s at other rates. `fit_memory` is also a fit; its bytes are the increase of the process's "
          "resident memory, at its peak during the fit.", [
        *(Row(f"{what}/samples:{size}", None, f"floor/{what}/samples:{size}")
          for what in ("trajectory", "sensitivities") for size in SIZES),
        *(Row(f"fit/samples:{size}") for size in SIZES),
        *(Row(f"floor/{what}/samples:*") for what in ("trajectory", "sensitivities")),
        Row("fit_memory/samples:1000000")]),
    Group("A batch",
          "`batch/refit` makes the result JSON of 100 files one by one on one thread, then reads, fits and stores them "
          "on all cores; the time includes both parts.", [Row("batch/refit")]),
]

INLINED = "with every call inlined ([[gnu::flatten]])"
REQUIRED = [
    Ratio("sensitivities: times faster than smoothed_rk4", "smoothed_rk4/sensitivities", WITHIN_1E8, "≥", 5),
    Ratio(f"sensitivities: times faster than smoothed_rk4 {INLINED}",
          "smoothed_rk4_flattened/sensitivities", WITHIN_1E8),
    Limit("sensitivities: largest error of the trajectory [rad]", WITHIN_1E8, "max_error_rad", "≤", 1e-8),
    Ratio("sensitivities with the tolerance of a fit: times faster than smoothed_rk4",
          "smoothed_rk4/sensitivities", "sensitivities/coulomb/release"),
    Ratio("sensitivities with the tolerance of a fit: times faster than CVODES, rtol 1e-6",
          "cvodes/rtol:1e-6/sensitivities", "sensitivities/coulomb/release", "≥", 50),
    Ratio("fit: times faster than smoothed_rk4's solve", "smoothed_rk4/solve", "fit", "≥", 6, 10),
    Ratio(f"fit: times faster than smoothed_rk4's solve {INLINED}", "smoothed_rk4_flattened/solve", "fit"),
    Ratio("file to JSON: times faster than SciPy's fit", "scipy", "file_to_json", "≥", 1000),
    Ratio("file to JSON: times faster than lmfit's fit", "lmfit", "file_to_json", "≥", 1000),
    *(Ratio(f"quantized fit: time relative to a Gaussian fit, noise of {counts} counts",
            f"fit/counts:{counts}/quantized", f"fit/counts:{counts}/gaussian", "≤", 5, 3)
      for counts in ("0.5", "0.25")),
    Ratio("bootstrap: time of one of the 999 refits, relative to a fit",
          "bootstrap", "fit", "≤", 0.5, offset=1, scale=1 / 999),
    Ratio("time per sample in a fit of 10^6 samples, relative to a fit of 10^5",
          "fit/samples:1000000", "fit/samples:100000", "≤", 1.25, scale=0.1),
    Limit("memory of a fit of 10^6 samples [bytes per sample]",
          "fit_memory/samples:1000000", "bytes_per_sample", "<", 200),
    Limit("batch: throughput including storage, relative to cores times the throughput of one thread",
          "batch/refit", "share_of_cores", "≥", 0.85),
]

HOT_PATHS = ("sensitivities/coulomb/release", "fit", "fit/counts:0.5/gaussian", "fit/counts:0.5/quantized")
MICROSECONDS = {"ns": 1e-3, "us": 1.0, "ms": 1e3, "s": 1e6}
SUFFIX = r"(/(iterations:[0-9]+|process_time|real_time))?"  # added by Google Benchmark to a name


def rows():
    return [row for group in TABLE for row in group.rows]


def regex(name):
    """A regular expression for both Python and Google Benchmark."""
    return name.replace(".", r"\.").replace("*", r"[0-9.]+(e[-+]?[0-9]+)?")


def benchmark_filter():
    names = [row.name for row in rows() if row.name not in ("scipy", "lmfit")]
    return f"^({'|'.join(map(regex, names))}){SUFFIX}$"


def benchmark_times(output):
    """For each benchmark {times: CPU times [us], counters...}, and a sentence for each that failed."""
    measured, counters, failures = {}, collections.defaultdict(list), []
    for run in output["benchmarks"]:
        name = re.sub(SUFFIX + "$", "", run["run_name"])
        if run["run_type"] != "iteration":
            continue
        if run.get("error_occurred"):
            failures.append(f"{name} failed: {run['error_message']}")
            continue
        entry = measured.setdefault(name, {"times": []})
        entry["times"].append(run["cpu_time"] * MICROSECONDS[run["time_unit"]])
        for key in COUNTERS:
            if key in run:
                counters[name, key].append(run[key])
    for (name, key), values in counters.items():
        measured[name][key] = statistics.median(values)
    return measured, list(dict.fromkeys(failures))


def python_times(output):
    """The same for scipy_users.py."""
    return {name: {"times": [1e6 * seconds for seconds in fit["seconds"]],
                   **{key: fit[key] for key in ("version", "evaluations", "estimates", "relative_errors")}}
            for name, fit in output.items()}


def instructions_each(lines):
    """For each hot path, the instructions of one more call: the slope between its first and its last run."""
    runs = collections.defaultdict(list)
    for line in lines:
        what, count, instructions = line.split("\t")
        runs[what].append((int(count), int(instructions)))
    return {what: (of[-1][1] - of[0][1]) / (of[-1][0] - of[0][0]) for what, of in runs.items() if len(of) > 1}


def quartiles(values):
    """The first and third quartile."""
    if len(values) == 1:
        return [values[0], values[0]]
    first, _, third = statistics.quantiles(values, n=4, method="inclusive")
    return [first, third]


def ratio(numerator, denominator):
    """The ratio of the medians, and the quartiles of the ratios of all pairs."""
    pairs = [above / below for above in numerator["times"] for below in denominator["times"]]
    return statistics.median(numerator["times"]) / statistics.median(denominator["times"]), quartiles(pairs)


def last_number(name):
    """Sort key for the benchmarks of one row, which come in random order."""
    return float(re.search(r"[0-9.]+(e[-+]?[0-9]+)?$", name)[0])


def expand(row, measured):
    """A row for each benchmark measured for a row that ends in *, otherwise the row itself."""
    names = sorted((name for name in measured if "*" in row.name and re.fullmatch(regex(row.name), name)),
                   key=last_number)
    return [row._replace(name=name) for name in names] or [row]


def row_result(row, measured):
    """The entry of a row in RESULTS.json; without a median if it was not measured."""
    result = {"name": row.name}
    entry = measured.get(row.name)
    if entry is None:
        return result
    result.update(median_us=statistics.median(entry["times"]), quartiles_us=quartiles(entry["times"]),
                  **{key: value for key, value in entry.items() if key != "times"})
    if row.reference in measured:
        result["times_faster_than"] = row.reference
        result["times_faster"], result["times_faster_quartiles"] = ratio(measured[row.reference], entry)
    if row.floor in measured:
        result["times_floor"] = ratio(entry, measured[row.floor])[0]
    return result


def holds(value, sign, bound):
    return {"≥": value >= bound, "≤": value <= bound, "<": value < bound}[sign]


def target(required):
    """The entry of a ratio or a limit in RESULTS.json, before its measurement."""
    return {"what": required.what, "target": f"{required.sign} {required.bound:g}" if required.sign else None}


def judged(required, value, spread):
    stretch = getattr(required, "stretch", None)
    result = {**target(required), "value": value}
    if required.sign:
        result["met"] = holds(value, required.sign, required.bound)
    if stretch is not None:
        result.update(stretch=f"{required.sign} {stretch:g}", stretch_met=holds(value, required.sign, stretch))
    if spread is not None:
        result["quartiles"] = spread
    return result


def requirement_result(required, measured):
    """A required ratio or limit, and whether it holds; without a value if it was not measured."""
    if isinstance(required, Limit):
        if required.counter in measured.get(required.name, {}):
            return judged(required, measured[required.name][required.counter], None)
    elif required.numerator in measured and required.denominator in measured:
        value, spread = ratio(measured[required.numerator], measured[required.denominator])
        value, *spread = ((x - required.offset) * required.scale for x in (value, *spread))
        return judged(required, value, spread)
    return target(required)


def compiler_of(binary):
    """The compiler's name, which compilers leave in their object files."""
    found = re.search(rb"[^\0]*clang version [^\0]+|GCC: [^\0]+", binary.read_bytes())
    return found[0].decode() if found else "unknown"


def machine(output, binary):
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return {"cpu": model[1] if model else platform.machine(), "cores": os.cpu_count(), "compiler": compiler_of(binary),
            "load_before": output["context"]["load_avg"][0] if output["context"].get("load_avg") else None}


def number(value):
    """Three digits; more only before the decimal point."""
    if value == 0 or not 1e-3 <= abs(value) < 1e7:
        return f"{value:.2g}"
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:#.3g}"


def time_text(microseconds):
    for unit, size in (("s", 1e6), ("ms", 1e3)):
        if microseconds >= size:
            return f"{number(microseconds / size)} {unit}"
    return f"{number(microseconds)} µs"


def spread_text(spread):
    return f" ({number(spread[0])} to {number(spread[1])})" if spread else ""


def accuracy_text(result):
    """The accuracy of a trajectory or of estimates."""
    parts = []
    if "max_error_rad" in result:
        parts.append(f"{result['max_error_rad']:.1e} rad")
    if "max_jacobian_error" in result:
        parts.append(f"derivatives {result['max_jacobian_error']:.1e}")
    if "std_errors_from_optimum" in result:
        parts.append(f"{result['std_errors_from_optimum']:.1e} standard errors from the optimum")
    if "bytes_per_sample" in result:
        parts.append(f"{number(result['bytes_per_sample'])} bytes per sample")
    if "relative_errors" in result:
        parts.append(f"{max(result['relative_errors'].values()):.0%} from the truth at worst")
    return ", ".join(parts)


def row_text(result):
    if "median_us" not in result:
        return f"| `{result['name']}` | missing | | | |"
    faster = number(result["times_faster"]) + spread_text(result["times_faster_quartiles"]) \
        if "times_faster" in result else ""
    floor = number(result["times_floor"]) if "times_floor" in result else ""
    return f"| `{result['name']}` | {time_text(result['median_us'])} | {faster} | {floor} | {accuracy_text(result)} |"


def group_text(group, results):
    return [f"## {group.title}", "", group.text, "",
            f"| benchmark | median | times faster than `{REFERENCE}` | times the floor | accuracy |",
            "|---|---|---|---|---|", *map(row_text, results), ""]


def requirement_text(result):
    wanted = result["target"] or "none"
    if "value" not in result:
        return f"| {result['what']} | {wanted} | missing | |"
    met = {True: "met", False: "**missed**", None: ""}[result.get("met")]
    if "stretch" in result:
        met += f"; stretch {result['stretch']} {'met' if result['stretch_met'] else 'missed'}"
    value = number(result["value"]) + spread_text(result.get("quartiles"))
    return f"| {result['what']} | {wanted} | {value} | {met} |"


def markdown(results):
    """The text of RESULTS.md."""
    at = results["machine"]
    lines = [
        "# Benchmarks", "",
        f"{at['cpu']}, {at['cores']} cores, load {at['load_before']} before; {at['compiler']}; {results['date']}; "
        "from the top folder:", "", "```sh", results["command"], "```", "", LEGEND.read_text(),
        "Written by `tests/benchmarks/make_table.py`.", "",
        "## Requirements", "",
        "Ratios of medians; in parentheses the middle half of the ratios of all pairs of repetitions. A line without a "
        "target is for information. `stretch` is a further target beyond the required one.", "",
        "| | target | measured | |", "|---|---|---|---|", *map(requirement_text, results["required"]), ""]
    for group in TABLE:
        lines += group_text(group, results["table"][group.title])
    lines += ["## Instructions", "",
              "Machine instructions of one more call of the code that the benchmark with this name times, counted by "
              "valgrind. It runs the AVX2 code, because it knows no wider instructions. The number does not depend on "
              "the load of the machine.", "", "| | instructions each |", "|---|---|",
              *(f"| `{name}` | {f'{count:,.0f}' if count else 'missing'} |"
                for name, count in results["instructions"].items())]
    return "\n".join(lines) + "\n"


def collect(measured, instructions):
    """The measured parts of RESULTS.json."""
    return {
        "required": [requirement_result(required, measured) for required in REQUIRED],
        "table": {group.title: [row_result(one, measured) for row in group.rows for one in expand(row, measured)]
                  for group in TABLE},
        "instructions": {name: instructions.get(name) for name in HOT_PATHS},
    }


def missing(results):
    """A sentence for each gap in the table."""
    sentences = [f"the benchmark {row['name']} is missing" for group in results["table"].values() for row in group
                 if "median_us" not in row]
    sentences += [f"'{one['what']}' could not be measured" for one in results["required"] if "value" not in one]
    return sentences + [f"the instructions of {name} are missing"
                        for name, count in results["instructions"].items() if count is None]


def make(options):
    """Writes both files; returns sentences about missing parts."""
    output = json.loads(options.benchmarks.read_text())
    measured, failures = benchmark_times(output)
    measured.update(python_times(json.loads(options.scipy.read_text())))
    results = {"command": options.command, "date": output["context"]["date"][:10],
               "machine": machine(output, options.binary),
               **collect(measured, instructions_each(options.instructions.read_text().splitlines()))}
    (options.out / "RESULTS.json").write_text(json.dumps(results, indent=2, ensure_ascii=False) + "\n")
    (options.out / "RESULTS.md").write_text(markdown(results))
    return failures + missing(results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--filter", action="store_true")
    for name in ("--benchmarks", "--scipy", "--instructions", "--binary", "--out"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--command")
    options = parser.parse_args()
    if options.filter:
        return print(benchmark_filter())
    absent = [name for name, value in vars(options).items() if value is None]
    if absent:
        parser.error(f"--{absent[0]} is missing")
    try:
        sentences = make(options)
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"make_table: what was measured cannot be read or the table not written: {error!r}")
    for sentence in sentences:
        print(f"make_table: {sentence}.", file=sys.stderr)
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(main())
