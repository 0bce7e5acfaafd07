# SPDX-License-Identifier: Apache-2.0
"""The contents of the packages, for their tests: files of the Debian packages, names of the tools, output of the tools."""

import pathlib
import re
import subprocess
import tempfile
import unittest

import empty_root


def output(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


def tool_names():
    """The names of all tools: each has a src/tools/NAME_main.cc."""
    return {path.name.removesuffix("_main.cc") for path in (empty_root.TOP / "src/tools").glob("*_main.cc")}


def flags(tool):
    """Name -> description of each flag, from --help, with single blanks."""
    text = output(tool, "--help")
    found = re.findall(r"^  --(\w+)  +(.*(?:\n {4,}.*)*)", text[text.index("\n  --"):], re.MULTILINE)
    return {name: " ".join(description.split()) for name, description in found}


def default_numbers(tool):
    """Flag -> default, for flags whose description gives a number."""
    found = ((name, re.search(r"\b[Dd]efault (\d+)\b", description)) for name, description in flags(tool).items())
    return {name: int(default[1]) for name, default in found if default}


class DebianFilesTest(unittest.TestCase):
    """Tests of the files below `root` of the tools' Debian package."""

    packages = pathlib.Path()

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.package = empty_root.only_one(cls.packages, "pendulum_*.deb")
        cls.folder = pathlib.Path(folder.name)
        cls.root = cls.folder / "root"
        output("dpkg-deb", "--extract", cls.package, cls.root)
