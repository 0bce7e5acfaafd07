#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads `llvm-cov export --summary-only` from stdin. Prints the covered lines and branches by floor, then the ten files
with the smallest share of covered lines."""

import collections
import json
import os
import pathlib
import sys

WORST = 10


def floor_of(name):
    """The floor F of src/F/x.cc and include/pendulum/F/x.h."""
    parts = pathlib.Path(name).parts
    return parts[2] if parts[0] == "include" else parts[1]


def share(counts):
    return f"{100 * counts['covered'] / counts['count']:5.1f} % of {counts['count']:6}" if counts["count"] else " " * 17


def main():
    files = {}
    for file in json.load(sys.stdin)["data"][0]["files"]:
        # A header is "build/coverage/../../src/F/x.h", a source in a unity unit "build/coverage/src/F/x.cc".
        name = os.path.normpath(file["filename"]).removeprefix("build/coverage/")
        if name.startswith(("src/", "include/")):
            files[name] = file["summary"]
    floors = collections.defaultdict(lambda: {kind: collections.Counter() for kind in ("lines", "branches")})
    for name, summary in files.items():
        for floor in (floor_of(name), "all"):
            for kind in ("lines", "branches"):
                floors[floor][kind].update({key: summary[kind][key] for key in ("covered", "count")})
    print(f"{'floor':12} {'lines':>17}   {'branches':>17}")
    for floor, counts in floors.items():
        print(f"{floor:12} {share(counts['lines'])}   {share(counts['branches'])}")
    print(f"\nThe {WORST} files with the smallest share of lines:")
    for name, summary in sorted(files.items(), key=lambda file: file[1]["lines"]["percent"])[:WORST]:
        print(f"{share(summary['lines'])}   {share(summary['branches'])}  {name}")


main()
