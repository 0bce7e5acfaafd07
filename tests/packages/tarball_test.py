#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tarball's tools where only glibc is available: tarball_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import unittest

import empty_root
import packed

PACKAGES = BIN = pathlib.Path()


class TarballTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tarball = empty_root.only_one(PACKAGES, "pendulum-*.tar.gz")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name)
        empty_root.fill(cls.root, BIN / "fit_pendulum")
        with tarfile.open(cls.tarball) as archive:
            archive.extractall(cls.root / "of a user/who likes  blanks")
        cls.prefix = cls.root / "of a user/who likes  blanks" / cls.tarball.name.removesuffix(".tar.gz")
        cls.tools = [f"/{path.relative_to(cls.root)}" for path in sorted((cls.prefix / "bin").iterdir())]
        empty_root.link_proc_self_exe(cls.root, cls.tools[0])
        cls.libraries = sorted((cls.prefix / "lib").iterdir())

    def run_tool(self, tool, *arguments, **environment):
        done = empty_root.run(self.root, [f"/{self.prefix.relative_to(self.root)}/bin/{tool}", *arguments], **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_root_has_only_glibc_the_data_and_the_tarball(self):
        outside = [path for path in self.root.rglob("*") if path.is_file() and self.prefix not in path.parents]
        libraries = [path for path in outside if path.parent != self.root / "datasets"]
        self.assertGreaterEqual(len(libraries), 3)  # libc, libm, the loader
        for path in libraries:
            self.assertRegex(path.name, rf"\A{empty_root.GLIBC}\Z")

    def test_has_the_tools_that_were_built(self):
        names = [path.rsplit("/", 1)[1] for path in self.tools]
        self.assertEqual(set(names), packed.tool_names())
        for name in names:
            self.assertTrue((BIN / name).exists(), name)

    def test_each_tool_starts(self):
        for path in self.tools:
            name = path.rsplit("/", 1)[1]
            self.assertRegex(self.run_tool(name, "--version"), rf"\A{name} .*\d+\.\d+\.\d+")

    def test_results_equal_those_of_the_built_tool_byte_for_byte(self):
        unpacked = subprocess.run([BIN / "fit_pendulum", *empty_root.FIT], cwd=empty_root.TOP, check=True,
                                  capture_output=True, text=True).stdout
        self.assertIn('"inertia"', unpacked)
        self.assertEqual(self.run_tool("fit_pendulum", *empty_root.FIT), unpacked)

    def test_libraries_in_LD_LIBRARY_PATH_are_ignored(self):
        modules = self.prefix / "modules of others"
        modules.mkdir()
        for library in self.libraries:
            (modules / library.name).write_text("of another program\n")
        self.run_tool("fit_pendulum", *empty_root.FIT, LD_LIBRARY_PATH=f"/{modules.relative_to(self.root)}")

    def test_tools_search_libraries_only_in_their_own_lib_folder(self):
        for path in [*(self.root / tool[1:] for tool in self.tools), *self.libraries]:
            dynamic = subprocess.run(["readelf", "--wide", "--dynamic", path], check=True, capture_output=True, text=True)
            expected = [("RPATH", "$ORIGIN/../lib")] if path.parent.name == "bin" else []
            self.assertEqual(re.findall(r"\((RPATH|RUNPATH)\).*\[(.*)\]", dynamic.stdout), expected, path.name)

    def test_no_file_contains_the_build_path(self):
        for path in (path for path in self.prefix.rglob("*") if path.is_file()):
            self.assertNotIn(f"{empty_root.TOP}/".encode(), path.read_bytes(), path.name)

    def test_nothing_of_glibc_is_packed(self):
        self.assertIn("libstdc++.so.6", [path.name for path in self.libraries])
        self.assertIn("libgcc_s.so.1", [path.name for path in self.libraries])
        for library in self.libraries:
            self.assertNotRegex(library.name, rf"\A{empty_root.GLIBC}\Z")

    def test_licences_are_included(self):
        for name in ("LICENSE", "README.md"):
            self.assertEqual((self.prefix / name).read_bytes(), (empty_root.TOP / name).read_bytes())
        documents = self.prefix / "share/doc"
        self.assertLessEqual({"libcholmod3", "libstdc++6", "libprometheus-cpp-core1.0", "pendulum"},
                             {path.parent.name for path in documents.glob("*/copyright")})
        for licence in documents.glob("*/copyright"):
            for name in re.findall(r"/usr/share/common-licenses/([A-Za-z0-9]+(?:-\d+(?:\.\d+)*)?)", licence.read_text()):
                self.assertTrue((documents / "common-licenses" / name).exists(), f"{licence} refers to {name}")

    def test_the_guide_is_included_with_its_recordings(self):
        documents = self.prefix / "share/doc/pendulum"
        self.assertLessEqual({path.stem for path in (empty_root.TOP / "src/docs").glob("*.md")},
                             {path.stem for path in (documents / "html").glob("*.html")})
        for path in (empty_root.TOP / "datasets").glob("*.csv"):
            self.assertEqual((documents / "examples/datasets" / path.name).read_bytes(), path.read_bytes())

    def test_scripts_for_clusters_are_included_as_programs(self):
        scripts = empty_root.TOP / "scripts/cluster"
        for script in (path for path in scripts.rglob("*") if path.is_file() and "__pycache__" not in path.parts):
            packed = self.prefix / "share/pendulum" / script.relative_to(scripts)
            self.assertEqual(packed.read_bytes(), script.read_bytes())
            self.assertEqual(packed.stat().st_mode & 0o777, 0o644 if script.suffix == ".sh" else 0o755, script)

    def test_unpacks_into_one_folder_of_root(self):
        with tarfile.open(self.tarball) as archive:
            for member in archive:
                self.assertEqual(member.name.split("/")[0], self.prefix.name)
                self.assertEqual((member.uid, member.gid, member.mode & 0o022), (0, 0, 0), member.name)


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv.pop(2)).resolve()
    PACKAGES = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
