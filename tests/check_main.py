# SPDX-License-Identifier: Apache-2.0
"""The command line shared by the project's checks."""

import argparse
import pathlib


def parse_arguments(description):
    """Parses `root`, the folder of a project, and `self_test`, whether to test the check itself."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self_test", action="store_true")
    arguments = parser.parse_args()
    if not (arguments.root / "src").is_dir():
        parser.error(f"there is no folder {arguments.root / 'src'}.")
    return arguments


def finish(complaints):
    """Prints the complaints, or ok, and returns the exit code."""
    print("\n".join(complaints) if complaints else "ok")
    return 1 if complaints else 0
