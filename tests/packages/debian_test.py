#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks metadata and contents of the Debian packages: debian_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import empty_root
from packed import output, tool_names

PACKAGES = BIN = pathlib.Path()


class DebianTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tools = empty_root.only_one(PACKAGES, "pendulum_*.deb")
        cls.development = empty_root.only_one(PACKAGES, "libpendulum-dev_*.deb")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = pathlib.Path(folder.name)
        for package in (cls.tools, cls.development):
            output("dpkg-deb", "--extract", package, cls.root)

    def check_fields(self, package, **expected):
        project = (empty_root.TOP / "CMakeLists.txt").read_text()
        architecture = output("dpkg", "--print-architecture").strip()
        expected |= {"Version": re.search(r"VERSION (\S+)", project[project.index("project("):])[1],
                     "Architecture": architecture, "Priority": "optional"}
        for field, value in expected.items():
            self.assertEqual(output("dpkg-deb", "--field", package, field).strip(), value)
        self.assertEqual(package.name, "{Package}_{Version}_{Architecture}.deb".format(**expected))
        self.assertRegex(output("dpkg-deb", "--field", package, "Maintainer"), r"\A\S.* <\S+@\S+>\n\Z")
        self.assertIn("Description: Moment of inertia", output("dpkg-deb", "--info", package))

    def check_contents(self, package, patterns):
        """Each file matches one of the patterns, and only root can write it, as --contents lists them."""
        for line in output("dpkg-deb", "--contents", package).splitlines():
            mode, owner, _, _, _, path = line.split(maxsplit=5)
            self.assertEqual(owner, "root/root", line)
            self.assertRegex(mode, r"\A(?:d|-).{4}-..-.\Z")
            if mode.startswith("-"):
                self.assertTrue(any(re.fullmatch(pattern, path) for pattern in patterns), line)

    def check_dependencies(self, package, expected):
        """Each dependency is installed here in a sufficient version: the package was built with it."""
        names = []
        for alternatives in output("dpkg-deb", "--field", package, "Depends").strip().split(", "):
            name, _, version = re.fullmatch(r"([a-z0-9.+-]+)( \(>= (.*)\))?", alternatives.split(" | ")[0]).groups()
            here = output("dpkg-query", "--show", "--showformat", "${Version}\n", name).splitlines()[0]
            output("dpkg", "--compare-versions", here, "ge", version or "0")
            names.append(name)
        self.assertLessEqual(expected, set(names))

    def test_package_of_the_tools(self):
        self.check_fields(self.tools, Package="pendulum", Section="science")
        self.check_contents(self.tools, [r"\./usr/bin/[a-z_]+", r"\./usr/share/man/man1/[a-z_]+\.1\.gz", r"\./usr/share/pendulum/.*",
                                         r"\./usr/share/doc/pendulum/(?:changelog\.gz|copyright|examples/nginx\.conf|README\.md)",
                                         r"\./usr/share/doc/pendulum/examples/datasets/\w+\.(?:csv|json|txt)",
                                         r"\./usr/share/doc/pendulum/html/\w+\.(?:css|html|js|png|svg)", r"\./usr/share/doc-base/pendulum",
                                         r"\./usr/share/bash-completion/completions/[a-z_]+",
                                         r"\./usr/share/zsh/vendor-completions/_[a-z_]+",
                                         r"\./usr/share/fish/vendor_completions\.d/[a-z_]+\.fish",
                                         r"\./etc/default/serve_pendulum", r"\./lib/systemd/system/serve_pendulum\.service"])
        self.check_dependencies(self.tools, {"libc6", "libgoogle-glog0v6", "libprometheus-cpp-core1.0", "libssl3", "libstdc++6"})
        self.assertEqual({path.name for path in (self.root / "usr/bin").iterdir()}, tool_names())

    def test_the_guide_is_where_the_service_looks_for_it(self):
        pages = {path.stem for path in (self.root / "usr/share/doc/pendulum/html").glob("*.html")}
        self.assertLessEqual({path.stem for path in (empty_root.TOP / "src/docs").glob("*.md")}, pages)

    def test_each_tool_has_completions(self):
        share = self.root / "usr/share"
        for folder, pattern in (("bash-completion/completions", "{}"), ("zsh/vendor-completions", "_{}"),
                                ("fish/vendor_completions.d", "{}.fish")):
            files = {path.name: path for path in (share / folder).iterdir()}
            self.assertEqual(set(files), {pattern.format(name) for name in tool_names()})
            for path in files.values():
                self.assertIn("--completion", path.read_text())

    def test_configuration_files_are_conffiles(self):
        self.assertEqual(output("dpkg-deb", "--info", self.tools, "conffiles"), "/etc/default/serve_pendulum\n")

    def test_changelog_has_this_version(self):
        log = empty_root.TOP / "src/packages/debian/changelog"
        self.assertEqual(output("dpkg-parsechangelog", "--file", log, "--show-field", "Version"),
                         output("dpkg-deb", "--field", self.tools, "Version"))

    def test_lintian_finds_no_error_and_no_warning(self):
        root = ["--allow-root"] if os.geteuid() == 0 else []
        done = subprocess.run(["lintian", *root, "--fail-on", "error,warning", self.tools, self.development],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)

    def test_package_of_the_libraries(self):
        self.check_fields(self.development, Package="libpendulum-dev", Section="libdevel")
        self.check_contents(self.development, [r"\./usr/include/pendulum/.*\.(?:h|json)",
                                              r"\./usr/include/pendulum_logger/frame\.h", r"\./usr/lib/libpendulum_\w+\.a",
                                               r"\./usr/lib/cmake/pendulum/pendulum\w+(?:-\w+)?\.cmake",
                                               r"\./usr/share/doc/libpendulum-dev/(?:changelog\.gz|copyright)"])
        self.check_dependencies(self.development, {"libceres-dev", "libeigen3-dev"})

    def test_development_package_has_every_header(self):
        ours = {path.relative_to(empty_root.TOP) for path in (empty_root.TOP / "include").rglob("*.h")}
        ours.add(pathlib.Path("include/pendulum_logger/frame.h"))  # from firmware/
        packed = {path.relative_to(self.root / "usr") for path in (self.root / "usr/include").rglob("*.h")}
        self.assertEqual(packed, ours)

    def test_cmake_finds_the_installed_package(self):
        with tempfile.TemporaryDirectory() as folder:
            output("cmake", "-S", empty_root.TOP / "tests/consumer", "-B", folder, "-D", f"CMAKE_PREFIX_PATH={self.root}/usr")
            cache = (pathlib.Path(folder) / "CMakeCache.txt").read_text()
        self.assertIn(f"pendulum_DIR:PATH={self.root}/usr/lib/cmake/pendulum\n", cache)

    def test_tools_run_with_the_libraries_of_the_system(self):
        installed = self.root / "usr/bin"
        for tool in sorted(installed.iterdir()):
            self.assertIn(tool.name, output(tool, "--version"))
            self.assertNotRegex(output("readelf", "--wide", "--dynamic", tool), r"\((?:RPATH|RUNPATH)\)")
        self.assertEqual(output(installed / "fit_pendulum", *empty_root.FIT, cwd=empty_root.TOP),
                         output(BIN / "fit_pendulum", *empty_root.FIT, cwd=empty_root.TOP))


if __name__ == "__main__":
    BIN = pathlib.Path(sys.argv.pop(2)).resolve()
    PACKAGES = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
