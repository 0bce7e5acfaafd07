#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the table of hazards: table_text.py TABLE.json GROUP... prints the rows of these groups for the guide.

It needs no package, because check_documents.py runs it with any python3.
"""

import json
import pathlib
import re
import sys

HEAD = (f"{'row':<18} {'kind':<9} {'n':>3} {'fitted':>6} {'wrong':>5} {'silent':>6} {'named':>5} {'cover':>5} "
        f"{'judged':>9}  largest |z|")
BLOCK = re.compile(r"(?P<head><!-- output: tests/simulator/table_text\.py \S+ (?P<groups>[^\n]*) -->\n).*?(?P<tail><!-- end -->)",
                   re.DOTALL)


def worst(row: dict) -> tuple[str, float]:
    """Parameter and z that are farthest from the truth."""
    name = max(row["z"], key=lambda each: abs(row["z"][each]["largest"]), default="")
    return name, row["z"][name]["largest"] if name else 0.0


def line(row: dict) -> str:
    """A row for the terminal."""
    name, z = worst(row)
    fitted = row["recordings"] - row["not_converged"] - row["failed"]
    cover = "-" if row["coverage"] is None else f"{row['coverage']:.3f}"
    return (f"{row['row']:<18} {row['kind']:<9} {row['recordings']:>3} {fitted:>6} {row['wrong']:>5} {row['silent']:>6} "
            f"{row['named']:>5} {cover:>5} {row['judged']:>4}/{row['expected']:<4}  {name} {z:+.3g}"
            + (f"  FAILS: {', '.join(row['fails'])}" if row["fails"] else ""))


def number(z: float) -> str:
    """A z with a sensible number of digits."""
    return f"{z:+.1f}" if abs(z) < 10 else f"{z:+.0f}"


def markdown(table: dict, groups: list[str]) -> str:
    """The rows of these groups as a table of the guide."""
    rows = [row for row in table["rows"] if row["group"] in groups]
    has_unseen = any(row["said"] for row in rows)
    counted = {"wrong": "wrong", "named": "cause named"} | ({"said": "within unseen friction"} if has_unseen else {}) | {
        "silent": "silently wrong"}
    lines = [f"| cause | largest error, in total errors | {' | '.join(counted.values())} | not converged | intervals cover |",
             "|---" * (len(counted) + 4) + "|"]
    for row in rows:
        name, z = worst(row)
        count = row["recordings"]
        cover = "" if row["coverage"] is None else f"{row['coverage']:.2f}"
        largest = f"`{name}` {number(z)}" if name else ""
        counts = (f"{row[key]} of {count}" for key in counted)
        stopped = row["not_converged"] + row["failed"]
        lines.append(f"| {row['cause']} | {largest} | {' | '.join(counts)} | {stopped} of {count} | {cover} |")
    return "\n".join(lines) + "\n"


def update(document: pathlib.Path, path: pathlib.Path) -> None:
    """Writes the tables into a document."""
    table = json.loads(path.read_text(encoding="utf-8"))
    text = BLOCK.sub(lambda block: block["head"] + markdown(table, block["groups"].split()) + block["tail"],
                     document.read_text(encoding="utf-8"))
    document.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    sys.stdout.write(markdown(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")), sys.argv[2:]))
