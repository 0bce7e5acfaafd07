#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares each tool's manual page with its --help: man_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import os
import pathlib
import re
import subprocess
import sys
import tarfile
import unittest

import empty_root
import packed

SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS"]  # man-pages(7), in its order


class ManTest(packed.DebianFilesTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.pages = {path.name.removesuffix(".1.gz"): path for path in (cls.root / "usr/share/man/man1").iterdir()}

    def render(self, page, *options):
        """The page as text, one paragraph per line, and the errors found in it."""
        environment = os.environ | {"LC_ALL": "C.UTF-8", "MANWIDTH": "5000", "MAN_KEEP_FORMATTING": "", "MANROFFOPT": ""}
        done = subprocess.run(["man", *options, "--no-hyphenation", "--no-justification", "--local-file", page],
                              capture_output=True, text=True, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, done.stderr

    def test_each_tool_has_a_page(self):
        self.assertEqual(set(self.pages), packed.tool_names())

    def test_the_tarball_has_each_page(self):
        with tarfile.open(empty_root.only_one(self.packages, "pendulum-*.tar.gz")) as archive:
            members = {pathlib.PurePath(name).name for name in archive.getnames() if "/share/man/man1/" in name}
            self.assertEqual(members, {path.name for path in self.pages.values()})

    def test_groff_and_mandoc_find_nothing_wrong(self):
        for name, page in self.pages.items():
            self.assertEqual(self.render(page, "--warnings")[1], "", name)
            linted = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", page], capture_output=True, text=True)
            # Help2man gives a month only.
            lines = [line for line in linted.stdout.splitlines() if "cannot parse date" not in line]
            self.assertEqual(lines, [], name)

    def test_whatis_finds_the_name(self):
        for name, page in self.pages.items():
            self.assertRegex(packed.output("lexgrog", page), rf': "{name} - [a-z].{{20,80}}"\n\Z')

    def test_sections_are_in_the_usual_order(self):
        for name, page in self.pages.items():
            headings = re.findall(r"^[A-Z][A-Z ]+[A-Z]$", self.render(page)[0], re.MULTILINE)
            self.assertEqual(headings[:len(SECTIONS)], SECTIONS, name)
            self.assertEqual(headings[-1], "SEE ALSO", name)

    def test_every_flag_has_the_description_of_help(self):
        for name, page in self.pages.items():
            text = " ".join(self.render(page)[0].split())
            said = packed.flags(self.root / "usr/bin" / name)
            self.assertLessEqual({"help", "version"}, set(said))
            for flag, description in said.items():
                self.assertIn(f" --{flag} {description}", text, name)

    def test_exit_codes_equal_those_of_help(self):
        for name, page in self.pages.items():
            text = self.render(page)[0]
            section = text[text.index("\nEXIT STATUS\n"):].split("\n\n")
            listed = [int(number) for number in re.findall(r"^ +(\d+) +[A-Z]", "\n".join(section), re.MULTILINE)]
            said = packed.output(self.root / "usr/bin" / name, "--help")
            paragraph = " ".join(said[said.index("Exit codes:"):].split("\n\n")[0].split())
            codes = re.findall(r"(?:Exit codes:|[,.]) (\d+) [a-z]", paragraph)
            self.assertEqual(listed, [int(code) for code in codes], name)
            self.assertLessEqual({0, 2, 70}, set(listed), name)

    def test_pages_in_see_also_exist(self):
        # Pages of the system, and of packages that our package suggests.
        others = {"curl", "gnuplot", "nginx", "sqlite3", "systemctl"}
        for name, page in self.pages.items():
            section = self.render(page)[0].partition("\nSEE ALSO\n")[2]
            for reference in re.findall(r"\b(\w+)\(\d\)", section):
                self.assertIn(reference.lower(), packed.tool_names() | others, name)


if __name__ == "__main__":
    sys.argv.pop(2)
    ManTest.packages = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
