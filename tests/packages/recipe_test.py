#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the Apptainer recipe, as far as possible without Apptainer, and the errors of scripts/package:
recipe_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import empty_root

PACKAGES = BIN = pathlib.Path()
RECIPE = empty_root.TOP / "scripts/pendulum.def"
# apptainer.org/docs/user/main/definition_files.html
SECTIONS = {"setup", "files", "environment", "startscript", "runscript", "post", "test", "labels", "help", "arguments"}
SCRIPTS = {"setup", "environment", "startscript", "runscript", "post", "test"}


def stages():
    """The recipe's stages: each a header, key -> value, and sections, "name argument..." -> lines."""
    found = []
    for line in RECIPE.read_text().splitlines():
        key = re.match(r"(\w+):\s*(.*)", line)
        if line.startswith("#"):
            continue
        if key:
            if key[1] == "Bootstrap":
                found.append(({}, {}))
            found[-1][0][key[1]] = key[2]
        elif line.startswith("%"):
            found[-1][1][line[1:]] = []
        elif line.strip():
            list(found[-1][1].values())[-1].append(line)
    return found


class RecipeTest(unittest.TestCase):
    def setUp(self):
        (self.build, self.build_sections), (self.final, self.final_sections) = stages()

    def scripts(self):
        for sections in (self.build_sections, self.final_sections):
            yield from ((name, "\n".join(lines)) for name, lines in sections.items() if name in SCRIPTS)

    def test_stages_and_sections_are_known_to_apptainer(self):
        self.assertEqual(self.build, {"Bootstrap": "docker", "From": "debian:12", "Stage": "build"})
        self.assertEqual(self.final, {"Bootstrap": "docker", "From": "debian:12-slim", "Stage": "final"})
        for sections in (self.build_sections, self.final_sections):
            for section, lines in sections.items():
                self.assertIn(section.split()[0], SECTIONS)
                self.assertTrue(lines, section)
        self.assertEqual(list(self.final_sections),
                         ["files from build", "environment", "runscript", "test", "labels", "help"])

    def test_files_exist_in_the_sources(self):
        for line in self.build_sections["files"]:
            source, target = line.split()
            self.assertTrue((empty_root.TOP / source).exists(), source)
            self.assertEqual(target, "/source/")

    def test_labels_have_a_name_and_a_value(self):
        for line in self.final_sections["labels"]:
            self.assertRegex(line.strip(), r"\A[a-z.]+ \S.*\Z")

    def test_scripts_are_valid_shell(self):
        for name, script in self.scripts():
            done = subprocess.run(["sh", "-n"], input=script, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""), name)

    def run_post(self, folder):
        """Runs %post on the files of %files, in a folder instead of /, with packages that are already built."""
        source = folder / "source"
        for line in self.build_sections["files"]:
            target = source / line.split()[0]
            target.parent.mkdir(exist_ok=True)
            target.symlink_to(empty_root.TOP / line.split()[0])
        (source / "scripts").unlink()
        (source / "scripts").mkdir()
        (source / "scripts/package").write_text(f"#!/bin/sh\nmkdir '{source}/build'\nln -s '{PACKAGES}' '{source}/build/packages'\n")
        (source / "scripts/package").chmod(0o755)
        script = re.sub(r"(?<![\w*])/(source|opt)\b", rf"{folder}/\1", "\n".join(self.build_sections["post"]))
        done = subprocess.run(["sh", "-ex"], input=script, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def make_image(self, folder):
        """Assembles the final stage, with no more of Debian than glibc and sh."""
        (folder / "stage").mkdir()
        self.run_post(folder / "stage")
        image = folder / "image"
        for line in self.final_sections["files from build"]:
            source, target = line.split()
            (image / target[1:]).mkdir(parents=True)
            shutil.copytree(folder / "stage" / source[1:], image / target[1:] / pathlib.Path(source).name)
        empty_root.fill(image, BIN / "fit_pendulum")
        empty_root.link_proc_self_exe(image, "/opt/pendulum/bin/fit_pendulum")
        (image / "bin").mkdir(exist_ok=True)
        shutil.copy("/bin/sh", image / "bin/sh")
        return image

    def run_section(self, image, section, *arguments):
        script = "\n".join(self.final_sections["environment"] + self.final_sections[section])
        return empty_root.run(image, ["/bin/sh", "-c", script, section, *arguments], PATH="/bin")

    def test_image_passes_its_test_and_runs_the_tools(self):
        with tempfile.TemporaryDirectory() as folder:
            image = self.make_image(pathlib.Path(folder))
            tested = self.run_section(image, "test")
            self.assertEqual(tested.returncode, 0, tested.stderr)
            self.assertRegex(tested.stdout, "The law coulomb describes the readings")
            for tool in (image / "opt/pendulum/bin").iterdir():
                self.assertIn(f"{tool.name} ", self.run_section(image, "runscript", tool.name, "--version").stdout)
            fitted = self.run_section(image, "runscript", *empty_root.FIT)
            self.assertEqual((fitted.returncode, fitted.stdout[:1]), (0, "{"), fitted.stderr)
            refused = self.run_section(image, "runscript", "--no_such_flag")
            self.assertEqual(refused.returncode, 2, refused.stderr)

    def test_package_refuses_options(self):
        done = subprocess.run([empty_root.TOP / "scripts/package", "--fast"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertEqual(done.stderr, "package: there is no option '--fast'; there are none.\n")


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv.pop(2)).resolve()
    PACKAGES = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
