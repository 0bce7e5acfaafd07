#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of README.md's console blocks and compares their output with the text in README.md.

A line that begins with "$ " is a command, lines that begin with "> " continue it, the rest is its output. Commands run in
the top folder. build/release/bin, where README's readers have the tools, is replaced by the folder given as the argument.
Usage: check_readme.py BIN_DIR [--update]. --update writes the output into README.md instead.
"""
import difflib
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"```console\n(.*?)```", re.DOTALL)


def run(command, bin_dir):
    """The command's output on stdout; a failing command is an error."""
    done = subprocess.run(
        ["bash", "-euc", command.replace("build/release/bin", bin_dir)], cwd=TOP, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"README.md: exit code {done.returncode} of: {command}\n{done.stderr}")
    return done.stdout


def executed(block, bin_dir):
    """The block with the present output of its commands."""
    commands = re.findall(r"^\$ .*(?:\n> .*)*", block, re.MULTILINE)
    return "".join(c + "\n" + run(re.sub(r"^(\$|>) ", "", c, flags=re.MULTILINE), bin_dir) for c in commands)


def main():
    bin_dir = str(pathlib.Path(sys.argv[1]).resolve())
    readme = TOP / "README.md"
    text = readme.read_text()
    if not BLOCK.search(text):
        sys.exit("README.md has no console block to check")
    now = BLOCK.sub(lambda match: f"```console\n{executed(match.group(1), bin_dir)}```", text)
    if "--update" in sys.argv:
        readme.write_text(now)
    elif now != text:
        sys.stdout.writelines(difflib.unified_diff(text.splitlines(True), now.splitlines(True), "README.md", "now"))
        sys.exit(1)


main()
