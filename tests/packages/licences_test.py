#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the packages include the licences of all their contents, and nothing that only tests need:
licences_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import functools
import json
import pathlib
import re
import subprocess
import sys
import tarfile
import unittest

import empty_root
import packed

SOURCES = empty_root.TOP / "src"
PLACES = [pathlib.Path("/usr/include" + folder) for folder in ("", "/eigen3", "/hdf5/serial")]
# Parts of the compiler that every program contains. Their licences need no notice (GCC Runtime Library Exception).
COMPILERS = {"gcc-12", "glibc", "linux"}
# Shared libraries that the static library Ceres needs. The copyright file names them in a sentence. They are separate
# packages with their own licences, which the tarball includes.
CERES = {"suitesparse", "lapack", "atlas", "openblas"}


@functools.cache
def debian_source(package):
    """The source package; a library and its headers are two packages of it."""
    return packed.output("dpkg-query", "--show", "--showformat", "${source:Package}\n", package).splitlines()[0]


def owners(paths):
    """The packages of files, by the files' names now or before /lib became a link to /usr/lib. A single call looks all of
    them up, because dpkg-query reads its whole data base each time."""
    names = {str(path) for path in paths}
    names |= {re.sub(r"^/usr/lib/", "/lib/", name) for name in names}
    lines = subprocess.run(["dpkg-query", "--search", *sorted(names)], capture_output=True, text=True).stdout.splitlines()
    package_of = {name: package.split(":")[0] for package, name in (line.split(": ", 1) for line in lines)}
    found = {path: package_of.get(str(path)) or package_of.get(re.sub(r"^/usr/lib/", "/lib/", str(path))) for path in paths}
    ownerless = [path for path, package in found.items() if package is None]
    if ownerless:
        raise FileNotFoundError(f"{ownerless} are of no package")
    return found


def libraries(program):
    """Paths of the shared libraries that a program names directly."""
    needed = re.findall(r"\(NEEDED\).*\[(.*)\]", packed.output("readelf", "--wide", "--dynamic", program))
    resolved = dict(re.findall(r"(\S+) => (\S+)", packed.output("ldd", program)))
    return {pathlib.Path(resolved[name]).resolve() for name in needed}


@functools.cache
def packages_of_headers():
    """The packages of third-party headers that our sources include."""
    sources = [path for folder in (SOURCES, empty_root.TOP / "include", empty_root.TOP / "firmware/pendulum_logger")
               for path in folder.rglob("*.[ch]*") if "node_modules" not in path.parts]
    names = {name for path in sources for name in re.findall(r"^#include <([^>]+)>", path.read_text(errors="replace"), re.MULTILINE)}
    found = {place / name for name in names for place in PLACES if (place / name).is_file()}
    return set(owners({path.resolve() for path in found}).values())


# Named by a text in src/packages/licences, not by that of a Debian package.
OWN_TEXTS = {"boost", "uplot", "uqr"}


class LicencesTest(packed.DebianFilesTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.text = (cls.root / "usr/share/doc/pendulum/copyright").read_text()
        cls.named = set(re.findall(r"^=+\n(\S+)\n=+$", cls.text, re.MULTILINE))
        # Texts in src/packages/licences also represent packages: boost is built by Debian from the source package
        # boost1.74.
        cls.sources = {debian_source(name) for name in cls.named - OWN_TEXTS} | {"boost1.74"}

    def test_every_linked_library_is_named(self):
        linked = {tool.name: libraries(tool) for tool in (self.root / "usr/bin").iterdir()}
        package_of = owners(set().union(*linked.values()))
        for tool, paths in linked.items():
            for path in paths:
                self.assertIn(debian_source(package_of[path]), self.sources | COMPILERS | CERES, f"{tool} is linked with {path}")

    def test_the_package_of_every_included_header_is_named(self):
        packages = packages_of_headers()
        self.assertGreaterEqual(len(packages), 8)
        sources = {debian_source(package) for package in packages}
        self.assertEqual(sources - COMPILERS - self.sources, set())

    def test_only_packed_software_is_named(self):
        sources = {debian_source(package) for package in packages_of_headers()}
        self.assertEqual(self.sources - sources, set())

    def test_the_sources_of_the_pages_are_named(self):
        page = json.loads((SOURCES / "web/package.json").read_text())
        self.assertEqual(set(page["dependencies"]), {"uplot", "uqr"})
        for name, owner in (("uplot", "Copyright (c) 2022 Leon Sorokin"), ("uqr", "Copyright (c) Project Nayuki")):
            self.assertIn(name, self.named)
            self.assertIn(owner, self.text)

    def test_licence_texts_are_complete(self):
        for name in self.named - OWN_TEXTS:
            self.assertIn(pathlib.Path(f"/usr/share/doc/{name}/copyright").read_text(), self.text, name)
        self.assertIn("Boost Software License - Version 1.0", self.text)
        self.assertTrue(self.text.startswith("pendulum: "))

    def test_libraries_package_and_tarball_have_the_same_licences(self):
        folder = self.folder / "development"
        packed.output("dpkg-deb", "--extract", empty_root.only_one(self.packages, "libpendulum-dev_*.deb"), folder)
        self.assertEqual((folder / "usr/share/doc/libpendulum-dev/copyright").read_text(), self.text)
        with tarfile.open(empty_root.only_one(self.packages, "pendulum-*.tar.gz")) as archive:
            names = [name for name in archive.getnames() if name.endswith("/share/doc/pendulum/copyright")]
            self.assertEqual([archive.extractfile(name).read().decode() for name in names], [self.text])

    def test_nothing_that_only_tests_need_is_packed(self):
        """The board's simulator is under the GPL, and users do not need a simulated logger."""
        with tarfile.open(empty_root.only_one(self.packages, "pendulum-*.tar.gz")) as archive:
            archive.extractall(self.folder / "tarball")
        for folder in (self.root, self.folder / "tarball"):
            for path in (path for path in folder.rglob("*") if path.is_file()):
                self.assertNotRegex(path.name, "simulated|simavr|_test|benchmark|fuzz")
                if path.parent.name in ("bin", "lib"):
                    self.assertNotIn(b"simavr", path.read_bytes(), path)


if __name__ == "__main__":
    sys.argv.pop(2)
    LicencesTest.packages = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
