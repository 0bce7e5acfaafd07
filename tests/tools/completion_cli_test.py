#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Completes command lines in bash, and in zsh and fish if they are installed: completion_cli_test.py PATH/TO/fit_pendulum"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TOOL = ""  # path of the binary, from the command line


class CompletionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "a run.csv").touch()
        (self.folder / "rig.json").touch()
        self.scripts = self.folder / "scripts"
        self.scripts.mkdir()

    def script(self, shell, name):
        done = subprocess.run([TOOL, "--completion", shell], capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")
        path = self.scripts / name
        path.write_text(done.stdout)
        return path

    def run_shell(self, *command, **options):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60, check=False, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.splitlines())


class Bash(CompletionTest):
    def complete(self, *words):
        """Completes the last word as bash does, which splits words at equals signs."""
        script = self.script("bash", "fit_pendulum")
        return self.run_shell("bash", "--norc", "-c",
                              'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _fit_pendulum; '
                              '((${#COMPREPLY[@]} == 0)) || printf "%s\\n" "${COMPREPLY[@]}"',
                              "bash", script, "fit_pendulum", *words)

    def test_flags(self):
        self.assertEqual(self.complete("--mod"), {"--model"})
        self.assertLessEqual({"--data", "--bob_mass", "--help"}, self.complete("--"))

    def test_values_that_are_words(self):
        self.assertEqual(self.complete("--noise", "g"), {"gaussian"})
        self.assertEqual(self.complete("--noise", "=", "g"), {"gaussian"})
        self.assertLessEqual({"viscous", "coulomb", "all"}, self.complete("--model", ""))
        self.assertEqual(self.complete("--model", "viscous,coul"), {"viscous,coulomb"})

    def test_files(self):
        self.assertEqual(self.complete("a"), {"a run.csv"})
        self.assertEqual(self.complete("--rig", "r"), {"rig.json"})
        self.assertEqual(self.complete("--rig", "=", "r"), {"rig.json"})

    def test_values_that_cannot_be_completed(self):
        self.assertEqual(self.complete("--from", ""), set())

    def test_is_registered(self):
        script = self.script("bash", "fit_pendulum")
        self.assertEqual(self.run_shell("bash", "--norc", "-c", 'source "$1"; complete -p fit_pendulum', "bash", script),
                         {"complete -F _fit_pendulum fit_pendulum"})


@unittest.skipUnless(shutil.which("fish"), "needs fish")
class Fish(CompletionTest):
    def complete(self, line):
        script = self.script("fish", "fit_pendulum.fish")
        found = self.run_shell("fish", "--no-config", "-c", f"source '{script}'; complete -C '{line}'")
        return {each.split("\t")[0] for each in found}

    def test_flags_values_and_files(self):
        self.assertEqual(self.complete("fit_pendulum --mod"), {"--model"})
        self.assertEqual(self.complete("fit_pendulum --noise g"), {"gaussian"})
        self.assertEqual(self.complete("fit_pendulum --rig r"), {"rig.json"})
        self.assertEqual(self.complete("fit_pendulum a"), {"a run.csv"})


@unittest.skipUnless(shutil.which("zsh"), "needs zsh")
class Zsh(CompletionTest):
    def complete(self, line):
        """The command line after the key TAB, in an interactive zsh in a pseudo-terminal."""
        self.script("zsh", "_fit_pendulum")
        started = (f"cd {self.folder}; PS1=; unsetopt zle_bracketed_paste; fpath=({self.scripts} $fpath); "
                   f"autoload -Uz compinit; compinit -u -d {self.folder}/dump; zstyle \":completion:*\" menu no; "
                   "bindkey \"^T\" expand-or-complete; show() { print -r -- \"<$BUFFER>\"; zle send-break }; "
                   "zle -N show; bindkey \"^X\" show; print ready")
        program = ("zmodload zsh/zpty; zpty shell zsh -f -i; "
                   f"zpty -w shell '{started}'; zpty -r -m shell text '*ready'$'\\r'; "
                   f"zpty -w -n shell '{line}'$'\\x14\\x18'; zpty -r -m shell text '*<fit*>*'; print -r -- \"$text\"")
        done = subprocess.run(["zsh", "-f", "-c", program], cwd=self.folder, capture_output=True, text=True, timeout=60,
                              check=False)
        return done.stdout[done.stdout.rindex("<fit") + 1:done.stdout.rindex(">")]

    def test_flags_values_and_files(self):
        self.assertEqual(self.complete("fit_pendulum --time_col").strip(), "fit_pendulum --time_column=")
        self.assertEqual(self.complete("fit_pendulum --noise g").strip(), "fit_pendulum --noise gaussian")
        self.assertEqual(self.complete("fit_pendulum --noise=g").strip(), "fit_pendulum --noise=gaussian")
        self.assertEqual(self.complete("fit_pendulum --rig r").strip(), "fit_pendulum --rig rig.json")
        self.assertEqual(self.complete("fit_pendulum a").strip(), "fit_pendulum a\\ run.csv")


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
