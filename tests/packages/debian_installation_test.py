#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs, upgrades, removes and purges the Debian package of the tools with dpkg, in a separate folder:
debian_installation_test.py FOLDER_OF_THE_PACKAGES FOLDER_OF_THE_TOOLS.

dpkg's --force-script-chrootless runs the maintainer scripts with this system's programs on the folder's files."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import empty_root
import packed

PACKAGES = pathlib.Path()
UNIT = "serve_pendulum.service"


class DebianInstallationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.whole = empty_root.only_one(PACKAGES, "pendulum_*.deb")
        cls.package, cls.later = cls.make_light("1", ""), cls.make_light("99", "# of version 99\n")

    @classmethod
    def make_light(cls, version, addition):
        """The package without the tools, to save repeated unpacking, and with an addition to its conffile."""
        files = cls.folder / version
        packed.output("dpkg-deb", "--raw-extract", cls.whole, files)
        shutil.rmtree(files / "usr/bin")
        control = files / "DEBIAN/control"
        control.write_text(re.sub(r"(?m)^Version: .*", f"Version: {version}", control.read_text()))
        with open(files / "etc/default/serve_pendulum", "a") as conffile:
            conffile.write(addition)
        packed.output("dpkg-deb", "--root-owner-group", "-Znone", "--build", files, cls.folder / f"{version}.deb")
        return cls.folder / f"{version}.deb"

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        self.addCleanup(shutil.rmtree, self.root)
        database = self.root / "var/lib/dpkg"
        for name in ("info", "updates", "triggers"):
            (database / name).mkdir(parents=True)
        (database / "status").touch()
        (database / "available").touch()
        self.empty = self.files()

    def files(self):
        """All files except dpkg's own."""
        return {str(path.relative_to(self.root)) for path in self.root.rglob("*")
                if not path.is_dir() and self.root / "var/lib/dpkg" not in path.parents}

    def dpkg(self, *arguments):
        path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
        command = [] if os.geteuid() == 0 else [shutil.which("unshare", path=path), "--user", "--map-root-user"]
        done = subprocess.run([*command, "dpkg", f"--root={self.root}", "--log=/dev/null", "--force-script-chrootless",
                               "--force-depends", "--force-confold", "--force-not-root", "--force-unsafe-io", *arguments],
                              env=os.environ | {"PATH": path, "DEBIAN_FRONTEND": "noninteractive"}, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout + done.stderr

    def systemctl(self, *arguments):
        done = subprocess.run(["systemctl", f"--root={self.root}", *arguments], capture_output=True, text=True)
        return done.stdout.strip()

    def read(self, path):
        return (self.root / path).read_text()

    def test_service_is_installed_but_neither_enabled_nor_started(self):
        self.dpkg("--install", self.whole)
        self.assertTrue((self.root / "usr/bin/serve_pendulum").exists())
        self.assertEqual(self.systemctl("is-enabled", UNIT), "disabled")
        self.assertEqual([path for path in self.files() if path.startswith("etc/systemd")], [])

    def test_token_is_secret_and_differs_between_installations(self):
        tokens = set()
        for _ in range(2):
            self.dpkg("--install", self.package)
            self.assertRegex(self.read("etc/pendulum/token"), r"\A[0-9a-f]{64}\n\Z")
            self.assertEqual((self.root / "etc/pendulum/token").stat().st_mode & 0o777, 0o600)
            tokens.add(self.read("etc/pendulum/token"))
            self.dpkg("--purge", "pendulum")
        self.assertEqual(len(tokens), 2)

    def test_upgrade_keeps_the_changes_of_the_administrator(self):
        self.dpkg("--install", self.package)
        (self.root / "etc/default/serve_pendulum").write_text('OPTIONS="--port 9000"\n')
        (self.root / "etc/pendulum/token").write_text("of the administrator\n")
        self.systemctl("enable", UNIT)
        self.dpkg("--install", self.later)
        self.assertEqual(self.read("etc/default/serve_pendulum"), 'OPTIONS="--port 9000"\n')
        self.assertIn("# of version 99", self.read("etc/default/serve_pendulum.dpkg-dist"))
        self.assertEqual(self.read("etc/pendulum/token"), "of the administrator\n")
        self.assertEqual(self.systemctl("is-enabled", UNIT), "enabled")

    def test_upgrade_replaces_an_unchanged_conffile(self):
        self.dpkg("--install", self.package)
        self.dpkg("--install", self.later)
        self.assertIn("# of version 99", self.read("etc/default/serve_pendulum"))
        self.assertEqual(self.systemctl("is-enabled", UNIT), "disabled")

    def test_removal_leaves_configuration_and_store(self):
        self.dpkg("--install", self.package)
        token = self.read("etc/pendulum/token")
        (self.root / "var/lib/pendulum").mkdir()
        (self.root / "var/lib/pendulum/fits.sqlite").write_text("fits")
        self.dpkg("--remove", "pendulum")
        left = self.files() - self.empty
        self.assertLessEqual({"etc/default/serve_pendulum", "etc/pendulum/token", "var/lib/pendulum/fits.sqlite"}, left)
        self.assertEqual([path for path in left if path.startswith(("usr/", "lib/"))], [])
        self.dpkg("--install", self.package)
        self.assertEqual(self.read("etc/pendulum/token"), token)

    def test_purge_leaves_nothing(self):
        self.dpkg("--install", self.package)
        self.systemctl("enable", UNIT)
        (self.root / "var/lib/private/pendulum").mkdir(parents=True)  # as systemd creates them
        (self.root / "var/lib/pendulum").symlink_to("private/pendulum")
        self.dpkg("--purge", "pendulum")
        self.assertEqual(self.files(), self.empty)
        self.assertFalse((self.root / "etc/pendulum").exists())
        self.assertFalse((self.root / "var/lib/private/pendulum").exists())

    def test_purge_keeps_a_store_that_is_not_empty_and_says_so(self):
        self.dpkg("--install", self.package)
        store = self.root / "var/lib/private/pendulum/fits.sqlite"
        store.parent.mkdir(parents=True)
        (self.root / "var/lib/pendulum").symlink_to("private/pendulum")
        store.write_text("fits")
        self.assertIn(f"recordings and their fits stay in {store.parent};", self.dpkg("--purge", "pendulum"))
        self.assertEqual(self.files() - self.empty, {"var/lib/private/pendulum/fits.sqlite"})
        self.assertTrue((self.root / "var/lib/pendulum").is_symlink())
        self.assertEqual(store.read_text(), "fits")

    def test_scripts_refuse_an_unknown_action(self):
        scripts = self.root / "control"
        packed.output("dpkg-deb", "--control", self.package, scripts)
        done = subprocess.run([scripts / "postinst", "destroy"], capture_output=True, text=True,
                              env=os.environ | {"DPKG_ROOT": str(self.root)})
        self.assertEqual((done.returncode, done.stderr), (1, "postinst called with unknown argument 'destroy'\n"))
        self.assertFalse((self.root / "etc/pendulum").exists())


if __name__ == "__main__":
    sys.argv.pop(2)
    PACKAGES = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
