#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lists the time of builds and tests: times.py BUILD_FOLDER... [--most 20]

For each folder: what ninja built since the folder was created (.ninja_log) and what ctest ran last (tests.xml, which
scripts/test requests), the longest first. Times are wall clock; several jobs run at once, so their sum exceeds the
waiting time.
"""

import argparse
import pathlib
import xml.etree.ElementTree


def built(folder):
    """(seconds, output) of each edge in ninja's log; only the last build of an output counts."""
    seconds = {}
    for line in (folder / ".ninja_log").read_text().splitlines():
        if line.count("\t") == 4:  # neither the header nor the incomplete line of a killed ninja
            start, end, _, output, _ = line.split("\t")
            seconds[output] = (int(end) - int(start)) / 1000
    return [(time, output) for output, time in seconds.items()]


def tested(folder):
    """(seconds, test) of the last run of ctest."""
    cases = xml.etree.ElementTree.parse(folder / "tests.xml").getroot().iter("testcase")
    return [(float(case.get("time")), case.get("name")) for case in cases]


def print_table(title, rows, most):
    print(f"\n{title}: {len(rows)}, {sum(time for time, _ in rows):.0f} s in all, one after the other")
    for time, name in sorted(rows, reverse=True)[:most]:
        print(f"{time:8.1f} s  {name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--most", type=int, default=20)
    arguments = parser.parse_args()
    for folder in arguments.folders:
        if not (folder / ".ninja_log").exists() and not (folder / "tests.xml").exists():
            parser.error(f"{folder} has neither .ninja_log nor tests.xml: build and test it first.")
        for what, name, rows in (("built", ".ninja_log", built), ("tested", "tests.xml", tested)):
            if (folder / name).exists():
                print_table(f"{folder}, {what}", rows(folder), arguments.most)


if __name__ == "__main__":
    main()
