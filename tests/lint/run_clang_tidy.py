#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on source files of the libraries and the tools, each compiled by itself, for scripts/lint.

  run_clang_tidy.py --all   all of them
  run_clang_tidy.py BASE    those that differ from a revision of git, or include a header that does, through others too

A file that clang-tidy had nothing to say about is not looked at again until its text, a header that it reaches, the
checks, how it is compiled or a package changes. What is known is kept in ~/.cache/pendulum_lint (XDG_CACHE_HOME).
Exit 1 if there is a finding.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "lint"
MEMORY = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache", "pendulum_lint")
DAYS_IN_MEMORY = 30
sys.path.insert(0, str(ROOT / "tests"))

import check_includes  # noqa: E402


def output(*command):
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"run_clang_tidy: {' '.join(command)}: {run.stderr.strip()}")
    return run.stdout


def differing(base):
    """The files that differ from a revision, those that git does not know yet too."""
    names = output("git", "diff", "--name-only", base) + output("git", "ls-files", "--others", "--exclude-standard")
    return {ROOT / name for name in names.splitlines()}


def what_all_share():
    """A digest of what each finding hangs on besides the sources: checks, their program and other people's headers."""
    digest = hashlib.sha256(output("dpkg-query", "--show", "clang-tidy-19", "*-dev").encode())
    for path in [ROOT / ".clang-tidy", *sorted(pathlib.Path(__file__).parent.glob("*.*"))]:
        digest.update(path.read_bytes())
    return digest.digest()


def look(path):
    """What clang-tidy says about a file, empty if nothing."""
    run = subprocess.run(
        ["clang-tidy-19", "-p", BUILD, "--quiet", "--warnings-as-errors=*", f"--load={BUILD}/skip_system_headers.so",
         "--extra-arg=-Xclang", "--extra-arg=-fno-validate-pch", "--extra-arg=-include-pch",
         f"--extra-arg={BUILD}/precompiled.pch", path],
        cwd=ROOT, capture_output=True, text=True)
    return "" if run.returncode == 0 else run.stdout + run.stderr


def main():
    if len(sys.argv) != 2:
        sys.exit("run_clang_tidy: usage: run_clang_tidy.py --all | BASE")
    tree = check_includes.Tree(ROOT)
    commands = {pathlib.Path(entry["file"]): entry["command"].replace(str(ROOT), "")
                for entry in json.loads((BUILD / "compile_commands.json").read_text())}
    reached = {path: tree.reached(path)[0] for path in tree.paths if path in commands}  # not what the build writes
    if sys.argv[1] != "--all":
        changed = differing(sys.argv[1])
        reached = {path: headers for path, headers in reached.items() if headers & changed}

    shared = what_all_share()

    def mark(path):
        digest = hashlib.sha256(shared + commands[path].encode())
        for header in sorted(reached[path]):
            digest.update(f"{header.relative_to(ROOT)}\n{tree.text(header)}".encode())
        return MEMORY / digest.hexdigest()

    MEMORY.mkdir(parents=True, exist_ok=True)
    marks = {path: mark(path) for path in reached}
    new = [path for path in reached if not marks[path].exists()]
    print(f"lint: clang-tidy on {len(new)} files; {len(reached) - len(new)} have not changed since it found nothing", flush=True)
    findings = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, said in zip(new, pool.map(look, new)):
            if said:
                findings += 1
                print(said, flush=True)
            else:
                marks[path].touch()
    for path in set(reached) - set(new):
        marks[path].touch()
    for path in MEMORY.iterdir():
        if path.stat().st_mtime < time.time() - DAYS_IN_MEMORY * 86400:
            path.unlink(missing_ok=True)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
