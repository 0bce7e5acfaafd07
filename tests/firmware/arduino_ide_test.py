#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the sketch with the engine of the Arduino IDE, for both boards: arduino_ide_test.py. The engine is in Debian's
package arduino-builder; without it the test is skipped with 77, or fails if PENDULUM_CI is set."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SKETCH = pathlib.Path(__file__).resolve().parents[2] / "firmware/pendulum_logger/pendulum_logger.ino"
ARDUINO = pathlib.Path("/usr/share/arduino/hardware/arduino")
BUILDER = pathlib.Path("/usr/share/arduino-builder")
# Without this, Debian's core does not compile with Debian's compiler: src/docs/hardware.md.
DECIMAL_DIG = "compiler.cpp.extra_flags=-DDECIMAL_DIG=__DECIMAL_DIG__"


class ArduinoIdeTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.hardware = self.folder / "hardware"
        self.hardware.mkdir()
        (self.hardware / "arduino").symlink_to(ARDUINO)
        for file in BUILDER.glob("platform*.txt"):
            shutil.copy(file, self.hardware)

    def check_board(self, board):
        build = self.folder / board.replace(":", "_").replace("=", "_")
        build.mkdir()
        done = subprocess.run(
            ["arduino-builder", "-compile", "-hardware", self.hardware, "-tools", "/usr/bin", "-fqbn", board,
             "-build-path", build, "-prefs", DECIMAL_DIG, "-warnings", "none", SKETCH],
            capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreater((build / "pendulum_logger.ino.hex").stat().st_size, 0)

    def test_uno(self):
        self.check_board("arduino:avr:uno")

    def test_mega(self):
        self.check_board("arduino:avr:mega:cpu=atmega2560")


if __name__ == "__main__":
    if shutil.which("arduino-builder") is None:
        print("skipped: there is no arduino-builder; run scripts/install_dependencies --firmware")
        sys.exit(1 if "PENDULUM_CI" in os.environ else 77)
    unittest.main()
