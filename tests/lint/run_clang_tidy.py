#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on source files of the libraries and the tools, each compiled separately, for scripts/lint.

  run_clang_tidy.py --all        all of them
  run_clang_tidy.py BASE         those that differ from a revision of git, or include a header that differs, directly or
                                 through others; all of them if the checks or the build differ
  run_clang_tidy.py --self_test  tests on a small tree what the cache remembers

A file without findings is remembered in ~/.cache/pendulum_lint (or XDG_CACHE_HOME). It is not checked again until the
file, a header that it includes, the checks, its compile command or a Debian package with headers changes. Needs the
preset lint.
Exit 0: no finding. Exit 1: a finding. Exit 2: it could not be run.
"""

import argparse
import concurrent.futures
import contextlib
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "lint"
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache", "pendulum_lint")
DAYS_IN_CACHE = 30
# A change of one of these files may change the findings in every file.
CONCERNS_ALL = re.compile(r"(^|/)(\.clang-tidy|CMakeLists\.txt|CMakePresets\.json)$|^tests/lint/|^scripts/lint$")
# Options for the precompiled header and for files without a compile command.
COMPILE_OPTIONS = ["-std=c++20", "-DGFLAGS_IS_A_DLL=0", "-isystem", "/usr/include/eigen3"]
sys.path.insert(0, str(ROOT / "tests"))

import check_includes  # noqa: E402


def fail(sentence):
    print(f"run_clang_tidy: {sentence}", file=sys.stderr)
    sys.exit(2)


def output(*command):
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        fail(f"{' '.join(map(str, command))}: {run.stderr.strip()}")
    return run.stdout


def changed_since(base):
    """The paths that differ from a revision, relative to the top folder; includes files that git does not track yet."""
    names = output("git", "diff", "--name-only", "--relative", "-z", base, "--")
    return (names + output("git", "ls-files", "--others", "--exclude-standard", "-z")).split("\0")


def shared_digest():
    """Digest of all inputs other than the sources: checks, this program, third-party headers."""
    digest = hashlib.sha256(output("dpkg-query", "--show", "clang-tidy-19", "*-dev").encode())
    checks = output("git", "ls-files", "--cached", "--others", "--exclude-standard", "-z", "*.clang-tidy", "tests/lint")
    for name in sorted(filter(None, checks.split("\0"))):
        digest.update(f"{name}\n{(ROOT / name).read_text()}".encode())
    return digest.hexdigest()


def build_once(path, *command):
    """Runs a command to create a file that does not exist. Two runs at the same time do no harm."""
    if not path.exists():
        part = path.with_name(f"{path.name}.{os.getpid()}")
        output(*command, "-o", part)
        for old in path.parent.glob(f"{path.stem.rpartition('_')[0]}_*{path.suffix}"):
            old.unlink(missing_ok=True)
        part.rename(path)
    return path


def tidy_command(digest):
    """The clang-tidy command with its plugin and the precompiled header, which are built if missing."""
    include = output("llvm-config-19", "--includedir").strip()
    plugin = build_once(BUILD / f"skip_system_headers_{digest[:16]}.so", "clang++-19", "-std=c++17", "-fPIC", "-shared", "-fno-rtti",
                        f"-I{include}", "tests/lint/skip_system_headers.cc")
    # The precompiled header contains the instantiated templates, which halves the time per file.
    header = build_once(BUILD / f"precompiled_{digest[:16]}.pch", "clang++-19", "-fpch-instantiate-templates",
                        *COMPILE_OPTIONS, "-x", "c++-header", "tests/lint/precompiled.h")
    return ["clang-tidy-19", "-p", BUILD, "--quiet", "--warnings-as-errors=*", f"--load={plugin}", "--extra-arg=-Xclang",
            "--extra-arg=-fno-validate-pch", "--extra-arg=-include-pch", f"--extra-arg={header}"]


def compile_commands():
    """{source file: its compile command, identical in every checkout}"""
    commands = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        root = str(pathlib.Path(entry["directory"]).parent.parent)  # as passed to cmake, with or without links
        commands[pathlib.Path(entry["file"]).resolve()] = entry["command"].replace(root, "")
    return commands


class Lint:
    """The files of a tree, and which are known to be clean. `command` with a path prints the findings in that file."""

    def __init__(self, tree, commands, digest, command, cache):
        self.tree, self.commands, self.digest, self.command, self.cache = tree, commands, digest, command, cache
        cache.mkdir(parents=True, exist_ok=True)

    def mark(self, path, text):
        """The cache file that exists if `path` is clean with the present text of its includes."""
        digest = hashlib.sha256((self.digest + self.commands[path]).encode())
        for file in sorted(self.tree.reached(path)[0]):
            digest.update(f"{file.relative_to(self.tree.root)}\n{text(file)}".encode())
        return self.cache / digest.hexdigest()

    def is_clean(self, path):
        with contextlib.suppress(FileNotFoundError):
            os.utime(self.mark(path, self.tree.text))
            return True
        return False

    def check(self, path):
        """clang-tidy's findings in a file, or None. A clean file is remembered unless it has changed meanwhile."""
        run = subprocess.run([*self.command, path], cwd=ROOT, capture_output=True, text=True)
        if run.returncode != 0:
            return (run.stdout + run.stderr) or f"run_clang_tidy: {self.command[0]} ended with {run.returncode} on {path}."
        mark = self.mark(path, self.tree.text)
        if mark == self.mark(path, pathlib.Path.read_text):
            mark.touch()
        return None

    def forget_old(self):
        for mark in self.cache.iterdir():
            with contextlib.suppress(FileNotFoundError):
                if mark.stat().st_mtime < time.time() - DAYS_IN_CACHE * 86400:
                    mark.unlink()


def finds_planted_errors(command):
    """Whether clang-tidy reports a C array in a source file and another in a header that it includes."""
    with tempfile.TemporaryDirectory(dir=BUILD) as folder:
        source, header = pathlib.Path(folder, "src/planted.cc"), pathlib.Path(folder, "src/planted.h")
        source.parent.mkdir()
        header.write_text("#pragma once\n\ninline int in_header[3] = {};\n")
        source.write_text('#include "planted.h"\n\nint in_source[3] = {};\n')
        run = subprocess.run([*command, source, "--", *COMPILE_OPTIONS], cwd=ROOT, capture_output=True, text=True)
    found = re.findall(r"planted\.(\w+):3:.*\[modernize-avoid-c-arrays", run.stdout)
    return sorted(set(found)) == ["cc", "h"]


def sources_to_check(tree, commands, base):
    """The source files to check; all of them if there is no base."""
    sources = [path for path in tree.paths if path.suffix == ".cc" and path.is_relative_to(tree.root / "src")]
    for path in sources:
        if path not in commands:
            fail(f"{path.relative_to(tree.root)} is not compiled: it is in the folder of no floor and of no tool.")
    changed = [] if base is None else changed_since(base)
    if base is None or any(CONCERNS_ALL.search(name) for name in changed):
        return sources
    changed = {tree.root / name for name in changed}
    return [path for path in sources if tree.reached(path)[0] & changed]


def run(base):
    digest = shared_digest()
    tree, commands = check_includes.Tree(ROOT), compile_commands()
    sources = sources_to_check(tree, commands, base)
    lint = Lint(tree, commands, digest, tidy_command(digest), CACHE)
    unknown = [path for path in sources if not lint.is_clean(path)]
    print(f"lint: clang-tidy on {len(unknown)} files; {len(sources) - len(unknown)} are known to be clean", flush=True)
    if unknown and not finds_planted_errors(lint.command):
        fail("clang-tidy does not find the C arrays that were planted for it: its plugin or its checks are at fault.")
    findings = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for finding in filter(None, pool.map(lint.check, unknown)):
            findings += 1
            print(finding, flush=True)
    lint.forget_old()
    return 1 if findings else 0


def self_test():
    """Errors in the cache's memory of a small tree."""
    failures = []

    def lint(command=("true",), digest="checks", how="c++ x.cc"):
        return Lint(check_includes.Tree(root), {source: how}, digest, command, cache)

    def expect(is_clean, why, **changed):
        if lint(**changed).is_clean(source) != is_clean:
            failures.append(why)

    def check(*command):
        return lint(command).check(source)

    with tempfile.TemporaryDirectory() as folder:
        root, cache = pathlib.Path(folder).resolve(), pathlib.Path(folder, "cache")
        files = {"src/a/x.cc": '#include "pendulum/a/x.h"\n', "include/pendulum/a/x.h": '#pragma once\n#include "pendulum/a/y.h"\n',
                 "include/pendulum/a/y.h": "#pragma once\n", "include/pendulum/a/other.h": "#pragma once\n"}
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        source = root / "src/a/x.cc"
        expect(False, "a file that was never checked counts as clean")
        if check("sh", "-c", "echo wrong; exit 1") != "wrong\n":
            failures.append("a finding is not printed")
        if check("sh", "-c", "kill -9 $$") is None:
            failures.append("a killed program counts as no finding")
        expect(False, "a file with a finding is remembered as clean")
        check("sh", "-c", f"echo >> {root}/include/pendulum/a/x.h")
        expect(False, "a file whose header changed during the check is remembered as clean")
        check("true")
        expect(True, "a clean file is not remembered")
        (root / "include/pendulum/a/other.h").write_text("int i;\n")
        expect(True, "a changed header that is not included makes the file unknown")
        expect(False, "the file still counts as clean with other checks", digest="other checks")
        expect(False, "the file still counts as clean with another compile command", how="c++ -O2 x.cc")
        (root / "include/pendulum/a/y.h").write_text("#pragma once\nint i;\n")
        expect(False, "a change of an indirectly included header is not noticed")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("base", nargs="?")
    what.add_argument("--all", action="store_true")
    what.add_argument("--self_test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        failures = self_test()
        print("\n".join(failures) or "ok")
        return 1 if failures else 0
    return run(arguments.base)


if __name__ == "__main__":
    sys.exit(main())
