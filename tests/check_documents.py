#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of README.md and of the user guide in src/docs, and compares their output with the documents.

Usage: check_documents.py BIN_DIR [--update] [FILE.md...]. --update writes the output into the documents instead.

In a ```console block a line that begins with "$ " is a command, lines that begin with "> " continue it, the rest is its
output. The commands of a document run in one shell, in a temporary folder with links to the files of the project.
build/release/bin there is BIN_DIR, which is on the PATH too. A command that fails is an error.
Comments in front of a block change how it is handled:

    <!-- shown: sed -n 1,5p -->    The document shows the output after this filter.
    <!-- not run: REASON -->       The block is not run. Every ```sh block needs this comment.
    <!-- output: COMMAND -->       The lines up to <!-- end --> are the output of COMMAND, such as a table.

In README.md and the lab guide, commands have no filter, and the result of a fit with one law has at most 20 lines of 80
columns. Relative links must lead to a file of the project. The tables of warnings in the reference have each code once: the
guide makes it an anchor, to which reports link.
"""
import concurrent.futures
import difflib
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parent.parent
RUN = [TOP / "README.md", *sorted((TOP / "src/docs").glob("*.md"))]
LINKED = [TOP / "CONTRIBUTING.md", *sorted(TOP.glob("*/README.md")), *sorted(TOP.glob("src/*/README.md")),
          TOP / "datasets/ACTIVITY.md"]
ITEM = re.compile(
    r"(?P<head><!-- output: (?P<made_by>[^\n]*) -->\n)(?P<made>.*?)(?P<tail><!-- end -->)"
    r"|(?:<!-- (?P<note>shown|not run): (?P<words>[^\n]*) -->\n)?^```(?P<language>\w*)[^\n]*\n(?P<block>.*?)^```$",
    re.DOTALL | re.MULTILINE)
SHORT = [TOP / "README.md", TOP / "datasets/ACTIVITY.md"]
MOST_LINES, MOST_COLUMNS = 20, 80
COMMAND = re.compile(r"^\$ .*(?:\n> .*)*", re.MULTILINE)
WARNINGS = TOP / "include/pendulum/base/warning.h"
EXPLAINED = TOP / "src/docs/reference.md"
END = "\x1e"  # between the outputs of two commands
PORT = "8080"  # of the service in the guide; here any free port stands for it
TIME = 600  # s


class Broken(Exception):
    """A document that cannot be checked, or a command of it that fails."""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


def is_run(item):
    return item["language"] == "console" and item["note"] != "not run"


def commands_of(text):
    """(command, filter) of every command of a document, in its order."""
    for item in ITEM.finditer(text):
        if item["made_by"]:
            yield item["made_by"], "cat"
        elif is_run(item):
            for command in COMMAND.findall(item["block"]):
                yield re.sub(r"^(\$|>) ", "", command, flags=re.MULTILINE), item["words"] or "cat"
        elif item["language"] == "sh" and not item["words"]:
            raise Broken(f"a block of sh is not run and gives no reason:\n{item['block']}")


def fill(folder, bin_dir):
    """Links to the project's files, and to the tools in build/release/bin, as a reader of the documents has them."""
    for entry in TOP.iterdir():
        if entry.name not in (".git", "build"):
            (folder / entry.name).symlink_to(entry)
    (folder / "build/release").mkdir(parents=True)
    (folder / "build/release/bin").symlink_to(bin_dir)


def run(commands, bin_dir):
    """The standard output of each command, after its filter."""
    port = free_port() if any(PORT in command for command, _ in commands) else PORT
    script = "".join(
        f"{{ {command.replace(PORT, port)}\n}} > .output; code=$?\n{{ {shown}\n}} < .output\nprintf '{END}%s{END}' $code\n"
        for command, shown in commands) + "kill $(jobs -p) 2> /dev/null; wait\n"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        fill(folder, bin_dir)
        environment = {**os.environ, "PATH": f"{bin_dir}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}
        done = subprocess.run(["bash", "-uc", script], cwd=folder, env=environment, capture_output=True, text=True, timeout=TIME)
    outputs = done.stdout.split(END)
    for (command, _), code in zip(commands, outputs[1::2]):
        if code != "0":
            raise Broken(f"exit code {code} of: {command}\n{done.stderr}")
    if len(outputs) != 2 * len(commands) + 1:
        raise Broken(f"the shell ended early:\n{done.stderr}")
    return [re.sub(rf"(?<=:){port}\b", PORT, output) for output in outputs[0:-1:2]]


def executed(text, bin_dir):
    """The document with the output of its commands as it is now."""
    outputs = iter(run(list(commands_of(text)), bin_dir))

    def item_now(item):
        if item["made_by"]:
            return item["head"] + next(outputs) + item["tail"]
        if not is_run(item):
            return item[0]
        block = "".join(command + "\n" + next(outputs) for command in COMMAND.findall(item["block"]))
        start = item.start("block") - item.start()
        return item[0][:start] + block + "```"

    return ITEM.sub(item_now, text)


def broken_links(document, text):
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", re.sub(r"`[^`]*`", "", ITEM.sub("", text))):
        if "://" not in target and not (document.parent / target).exists():
            yield f"the link to {target} leads nowhere"


def unexplained(codes, text):
    """Codes of warnings that are not in the first column of exactly one row of the tables of warnings, and others there."""
    tables = re.findall(r"^\| code \| meaning \|\n\|---\|---\|\n((?:\|.*\n)+)", text, re.MULTILINE)
    rows = re.findall(r"^\| ((?:`[a-z_]+`(?:, )?)+) \|", "".join(tables), re.MULTILINE)
    explained = re.findall(r"`(\w+)`", " ".join(rows))
    for code in sorted({*codes, *explained}):
        if (codes.count(code), explained.count(code)) != (1, 1):
            yield f"the warning {code} is {codes.count(code)} times in {WARNINGS.name}, {explained.count(code)} times in the tables"


def long_results(text):
    """What a reader of a short document would need a filter for."""
    for item in ITEM.finditer(text):
        if item["note"] == "shown":
            yield f"the output is filtered by {item['words']}"
        if item["language"] != "console":
            continue
        commands, outputs = COMMAND.findall(item["block"]), COMMAND.split(item["block"])[1:]
        for command, output in zip(commands, outputs):
            if re.search(r"\|\s*(sed|awk|head|tail|grep|cut)\b", command):
                yield f"a filter: {command}"
            fit = output.split("[[")[-1] if "fit_pendulum" in command or "--fit" in command else ""
            if len(fit.splitlines()) > MOST_LINES and not re.search(r"--models?[ =](all|\w+,)", command):
                yield f"the result has {len(fit.splitlines())} lines, more than {MOST_LINES}: {command}"
            if max(map(len, output.splitlines()), default=0) > MOST_COLUMNS:
                yield f"an output is wider than {MOST_COLUMNS} columns: {command}"


def check(document, bin_dir, update):
    """The errors in a document, as text; empty if there are none."""
    text = document.read_text()
    name = str(document.relative_to(TOP))
    faults = [f"{name}: {fault}\n" for fault in broken_links(document, text)]
    faults += [f"{name}: {fault}\n" for fault in (long_results(text) if document in SHORT else ())]
    if document == EXPLAINED:
        codes = re.findall(r'WarningKind\{"(\w+)"', WARNINGS.read_text())
        faults += [f"{name}: {fault}\n" for fault in unexplained(codes, text)]
    try:
        now = executed(text, bin_dir) if document in RUN else text
    except Broken as broken:
        return "".join(faults) + f"{name}: {broken}\n"
    if update:
        document.write_text(now)
    elif now != text:
        faults += difflib.unified_diff(text.splitlines(True), now.splitlines(True), name, "now")
    return "".join(faults)


def self_test():
    """Checks that each kind of block is handled as described at the top of this file."""
    def now(text):
        return executed(text, pathlib.Path("/usr/bin"))

    assert now("```console\n$ x=5\n$ echo $((x + 1)); ls README.md\nold\n```\n") == (
        "```console\n$ x=5\n$ echo $((x + 1)); ls README.md\n6\nREADME.md\n```\n")
    assert now("<!-- shown: tail -n 1 -->\n```console\n$ printf 'a\\n%s\\n' \\\n>   b\n```") == (
        "<!-- shown: tail -n 1 -->\n```console\n$ printf 'a\\n%s\\n' \\\n>   b\nb\n```")
    assert now("<!-- output: echo '```cpp' -->\nold\n<!-- end -->") == "<!-- output: echo '```cpp' -->\n```cpp\n<!-- end -->"
    for same in ("<!-- not run: it fails -->\n```sh\nfalse\n```", "<!-- not run: it fails -->\n```console\n$ false\nold\n```",
                 "```csv\n$ false\n```", "```console\n$ sleep 100 > log.txt &\n$ echo localhost:8080\nlocalhost:8080\n```"):
        assert now(same) == same, same
    for broken in ("```console\n$ false\n```", "```sh\ntrue\n```", "```console\n$ exit 0\n```"):
        try:
            now(broken)
        except Broken:
            continue
        raise AssertionError(broken)
    assert list(broken_links(TOP / "README.md", "[a](MODEL.md) [b](none.md) [c](https://none.example) `[d](none)`")) == [
        "the link to none.md leads nowhere"]
    table = "| code | meaning |\n|---|---|\n| `a`, `b_b` | x `d` |\n| `c` | y |\n"
    assert not list(unexplained(["a", "b_b", "c"], table))
    assert len(list(unexplained(["a", "d"], table + "\n" + table))) == 4
    line = "x" * MOST_COLUMNS + "\n"
    fits = "```console\n$ fit_pendulum run.csv{}\n[[run.csv]]\n{}```\n"
    for short in (fits.format("", (MOST_LINES - 1) * line), fits.format(" --model all", MOST_LINES * line), "```csv\nx" + line + "```\n"):
        assert not list(long_results(short)), short
    for long in (fits.format("", MOST_LINES * line), fits.format(" | head -n 3", ""), fits.format("", "x" + line),
                 "<!-- shown: cat -->\n" + fits.format("", "")):
        assert len(list(long_results(long))) == 1, long


def main():
    if "--self_test" in sys.argv:
        self_test()
        return
    arguments = [argument for argument in sys.argv[1:] if argument != "--update"]
    bin_dir = pathlib.Path(arguments[0]).resolve()
    documents = [pathlib.Path(name).resolve() for name in arguments[1:]] or RUN + LINKED
    with concurrent.futures.ThreadPoolExecutor() as pool:
        faults = "".join(pool.map(lambda document: check(document, bin_dir, "--update" in sys.argv), documents))
    sys.exit(faults or None)


main()
