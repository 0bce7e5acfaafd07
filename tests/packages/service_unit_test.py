#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the service's unit as systemd reads it: service_unit_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS."""

import pathlib
import re
import shlex
import subprocess
import sys
import unittest

import packed

UNIT = "serve_pendulum.service"


class ServiceUnitTest(packed.DebianFilesTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.text = (cls.root / "lib/systemd/system" / UNIT).read_text()
        cls.tool = cls.root / "usr/bin/serve_pendulum"
        cls.unit = cls.folder / UNIT
        # systemd-analyze must find the tool in its unpacked place.
        cls.unit.write_text(cls.text.replace("/usr/bin/serve_pendulum", str(cls.tool)))

    def settings(self, name):
        return re.findall(rf"^{name}=(.*)$", self.text, re.MULTILINE)

    def default_options(self):
        """OPTIONS in /etc/default/serve_pendulum as a shell, and systemd, split it."""
        file = self.root / "etc/default/serve_pendulum"
        return shlex.split(packed.output("sh", "-c", '. "$1" && printf "%s" "$OPTIONS"', "sh", file))

    def test_systemd_finds_nothing_wrong(self):
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", self.unit], capture_output=True, text=True)
        self.assertEqual((done.returncode, [line for line in done.stderr.splitlines() if UNIT in line]), (0, []), done.stderr)

    def test_exposure_is_small_for_a_network_service(self):
        """systemd's own measure is 0 to 10. Up to 2 it reports "OK", its best verdict for a service with a network."""
        done = subprocess.run(["systemd-analyze", "security", "--offline=yes", "--threshold=15", "--no-pager", self.unit],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout[-300:])

    def test_every_given_flag_exists(self):
        command = self.settings("ExecStart")[0].replace("$OPTIONS", "").split() + self.default_options()
        given = [word.removeprefix("--").partition("=")[0] for word in command if word.startswith("--")]
        self.assertEqual(len(given), len(set(given)))
        self.assertLessEqual(set(given), set(packed.flags(self.tool)))
        self.assertLessEqual({"store", "token_file", "address"}, set(given))

    def test_flags_named_in_the_defaults_file_exist(self):
        text = (self.root / "etc/default/serve_pendulum").read_text()
        self.assertLessEqual(set(re.findall(r"--(\w+)", text)), set(packed.flags(self.tool)))

    def test_listens_only_on_this_machine_by_default(self):
        options = self.default_options()
        self.assertEqual(options[options.index("--address") + 1], "127.0.0.1")

    def test_systemd_waits_for_fits_in_progress(self):
        self.assertGreater(int(self.settings("TimeoutStopSec")[0]), packed.default_numbers(self.tool)["stop_seconds"])

    def test_descriptors_suffice_for_all_connections(self):
        self.assertGreater(int(self.settings("LimitNOFILE")[0]), 2 * packed.default_numbers(self.tool)["max_connections"])

    def test_files_are_where_packages_and_page_say(self):
        self.assertIn("--store /var/lib/pendulum/fits.sqlite ", self.settings("ExecStart")[0])
        self.assertEqual(self.settings("StateDirectory"), ["pendulum"])
        self.assertEqual(self.settings("EnvironmentFile"), ["-/etc/default/serve_pendulum"])
        self.assertEqual(self.settings("LoadCredential"), ["token:/etc/pendulum/token"])
        self.assertIn("--token_file %d/token ", self.settings("ExecStart")[0])


if __name__ == "__main__":
    sys.argv.pop(2)
    ServiceUnitTest.packages = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
