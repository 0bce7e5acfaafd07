# SPDX-License-Identifier: Apache-2.0
"""What the studies of many recordings have in common: their command line, one fit, and the processes that run them."""

import argparse
import collections.abc
import concurrent.futures
import contextlib
import fnmatch
import json
import pathlib
import tempfile

import judging
from lab import Lab, record


def parser_of(doc: str) -> argparse.ArgumentParser:
    """A parser of the options that every study has."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin_dir", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--json", type=pathlib.Path)
    return parser


def add_cells(parser: argparse.ArgumentParser) -> None:
    """The option that chooses cells of a study."""
    parser.add_argument("--cells", default="*", help="patterns with semicolons between them")


def cells_of(parser: argparse.ArgumentParser, arguments: argparse.Namespace, cells: collections.abc.Iterable[str]) -> list[str]:
    """The names of the chosen cells; ends the program if there are none."""
    chosen = [cell for cell in cells if any(fnmatch.fnmatch(cell, part) for part in arguments.cells.split(";"))]
    if not chosen:
        parser.error(f"no cell matches {arguments.cells}; there are {'; '.join(cells)}")
    return chosen


def tool_of(parser: argparse.ArgumentParser, arguments: argparse.Namespace) -> pathlib.Path:
    """The path of fit_pendulum; ends the program if there is none."""
    tool = arguments.bin_dir.resolve() / "fit_pendulum"
    if not tool.exists():
        parser.error(f"there is no {tool}")
    return tool


def fit(tool: pathlib.Path, lab: Lab, model: str, parameters: tuple[str, ...], sensor: dict | None = None,
        optional: tuple[str, ...] = ()) -> judging.Outcome:
    """Simulates and fits one recording. The arguments are those of judging.fit."""
    with tempfile.TemporaryDirectory() as folder:
        return judging.fit(tool, pathlib.Path(folder), record(lab), model, parameters, sensor, optional)


@contextlib.contextmanager
def runner(jobs: int):
    """Gives a function that calls run(*arguments) for each of the tuples in other processes, and returns the results in their
    order."""
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        yield lambda run, arguments: list(pool.map(run, *zip(*arguments)))


def write(path: pathlib.Path | None, found) -> None:
    """Writes what a study found as JSON, if a path is given."""
    if path:
        path.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
