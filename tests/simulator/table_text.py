#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of hazards: table_text.py TABLE.json GROUP... prints the rows of these groups for the guide.

It needs no package, because check_documents.py runs it with any python3.
"""

import json
import pathlib
import re
import sys

SHOWN = (("inertia",), ("viscous",), ("coulomb", "load_friction"))  # of which z and errors are shown
COUNTS = (("silent", "silent"), ("doubted", "doubted"), ("named", "named"), ("misnamed", "other"))
HEAD = (f"{'row':<19}{'kind':<9}{'n':>3} {'wrong':>5} " + " ".join(f"{words:>7}" for _, words in COUNTS) + f" {'start':>5} "
        f"{'none':>4} {'cover':>5}  {'rms z: I, b, dry':<20} {'total error: I, b, dry':<26} over that of noise")
BLOCK = re.compile(r"(?P<head><!-- output: tests/simulator/table_text\.py \S+ (?P<groups>[^\n]*) -->\n).*?(?P<tail><!-- end -->)",
                   re.DOTALL)


def number(value: float | None) -> str:
    """Two significant digits, without an exponent."""
    if value is None:
        return "-"
    if 0 < abs(value) < 1e-4:
        return f"{value:.6f}"
    return f"{value:.0f}" if abs(value) >= 100 else f"{float(f'{value:.2g}'):g}"


def of_shown(row: dict | None, key: str) -> list[float | None]:
    """This quantity of inertia, viscous and dry friction; None where the fit does not have it."""
    z = row["z"] if row else {}
    return [next((z[name][key] for name in names if name in z), None) for names in SHOWN]


def cells(row: dict, rows: list[dict]) -> tuple[str, str, str, str]:
    """Coverage, rms z, relative total errors, and these over those of the row with the errors of noise alone."""
    errors = of_shown(row, "relative_error")
    noise = of_shown(next((each for each in rows if each["row"] == row["reference"]), None), "relative_error")
    ratios = [error / other if error is not None and other else None for error, other in zip(errors, noise)]
    return ("-" if row["coverage"] is None else f"{row['coverage']:.2f}", ", ".join(map(number, of_shown(row, "rms"))),
            ", ".join(number(error if error is None else 100 * error) for error in errors) + " %",
            ", ".join(map(number, ratios)))


def line(row: dict, rows: list[dict]) -> str:
    """A row for the terminal; `rows` has the one that it is compared with."""
    cover, z, errors, ratios = cells(row, rows)
    counts = " ".join(f"{row[key]:>7}" for key, _ in COUNTS)
    return (f"{row['row']:<19}{row['kind']:<9}{row['recordings']:>3} {row['wrong']:>5} {counts} {row['silent_start']:>5} "
            f"{row['not_converged'] + row['failed']:>4} {cover:>5}  {z:<20} {errors:<26} {ratios}"
            + (f"  FAILS: {', '.join(row['fails'])}" if row["fails"] else ""))


def markdown(table: dict, groups: list[str]) -> str:
    """The rows of these groups as a table of the guide."""
    columns = ["cause", "recordings", "silent", "doubted", "named", "another cause", "intervals cover", "rms z", "total error",
               "over noise"]
    lines = [f"| {' | '.join(columns)} |", "|---" * len(columns) + "|"]
    for row in table["rows"]:
        if row["group"] in groups:
            counts = (str(row[key]) for key in ("recordings", *(key for key, _ in COUNTS)))
            lines.append(f"| {row['cause']} | {' | '.join((*counts, *cells(row, table['rows'])))} |")
    return "\n".join(lines) + "\n"


def update(document: pathlib.Path, path: pathlib.Path) -> None:
    """Writes the tables into a document."""
    table = json.loads(path.read_text(encoding="utf-8"))
    text = BLOCK.sub(lambda block: block["head"] + markdown(table, block["groups"].split()) + block["tail"],
                     document.read_text(encoding="utf-8"))
    document.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    sys.stdout.write(markdown(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")), sys.argv[2:]))
