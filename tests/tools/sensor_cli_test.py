#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs fit_pendulum with what is stated and what is assumed about a sensor.

  sensor_cli_test.py PATH/TO/fit_pendulum
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import swing

TOOL = ""  # path of the binary, from the command line

EFFECTS = ["gain", "cubic", "eccentric_sine", "eccentric_cosine", "lag", "backlash", "drift", "clock"]


class SensorTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("run.csv", swing.angle_csv())

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def run_tool(self, *flags):
        return subprocess.run([TOOL, *flags], cwd=self.folder, capture_output=True, text=True, encoding="utf-8",
                              timeout=60, check=False)

    def fit(self, *flags):
        """The sensor of the result of a fit, and the codes of its warnings."""
        run = self.run_tool(*flags, "--json", "fit.json", "--checks", "none")
        self.assertEqual(run.returncode, 0, run.stderr)
        result = json.loads((self.folder / "fit.json").read_text(encoding="utf-8"))
        sensor = result["recordings"][0]["sensor"]
        self.assertEqual(list(sensor), ["kind", *EFFECTS])
        return sensor, [warning["code"] for warning in result["warnings"]]

    def assert_refused(self, code, sentence, *flags):
        run = self.run_tool("run.csv", *flags)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertIn(sentence, run.stderr)

    def test_assumes_the_errors_of_a_kind(self):
        sensor, codes = self.fit("run.csv")
        self.assertEqual(sensor["kind"], "angle sensor")
        self.assertEqual(sensor["gain"], {"std_dev": 0.01, "unit": "1", "source": "assumed for an angle sensor"})
        self.assertEqual(sensor["clock"], {"std_dev": 0.01, "unit": "1", "source": "assumed for times on an exact grid"})
        self.assertEqual(sensor["lag"]["unit"], "s")
        self.assertEqual(sensor["eccentric_sine"]["unit"], "rad")
        self.assertAlmostEqual(sensor["eccentric_sine"]["std_dev"], math.radians(0.25), places=12)
        # 1 % of half the range, which is a little below the amplitude at the release because of friction
        self.assertAlmostEqual(sensor["cubic"]["std_dev"] / (0.01 * swing.TRUTH["release_angle"]), 1, delta=0.05)
        self.assertNotIn("sensor_replaced", codes)
        potentiometer, _ = self.fit("run.csv", "--sensor", "potentiometer")
        self.assertEqual(potentiometer["gain"]["source"], "assumed for a potentiometer")

    def test_reads_a_file_or_json(self):
        text = '{"kind": "encoder", "nonlinearity": 0.001, "clock": 0}'
        self.write("sensor.json", text)
        sensor, _ = self.fit("run.csv", "--sensor", "sensor.json")
        self.assertEqual(sensor, self.fit("run.csv", "--sensor", text)[0])
        self.assertEqual(sensor["kind"], "encoder")
        for name in ("cubic", "eccentric_sine", "eccentric_cosine"):
            self.assertEqual(sensor[name], {"std_dev": 0.001, "unit": "rad", "source": "given by --sensor"})
        self.assertEqual(sensor["clock"], {"std_dev": 0, "unit": "1", "source": "given by --sensor"})
        self.assertEqual(sensor["backlash"]["source"], "assumed for an encoder")

    def test_reads_the_recording_and_prefers_the_flag(self):
        self.write("run.csv", "# sensor: ideal\n" + swing.angle_csv())
        sensor, codes = self.fit("run.csv")
        self.assertEqual(sensor["kind"], "ideal")
        self.assertEqual([sensor[name]["std_dev"] for name in EFFECTS], [0] * len(EFFECTS))
        self.assertEqual(sensor["gain"]["source"], "stated in the file")
        self.assertNotIn("sensor_replaced", codes)
        sensor, codes = self.fit("run.csv", "--sensor", "gyro")
        self.assertEqual(sensor["kind"], "gyro")
        self.assertIn("sensor_replaced", codes)

    def test_takes_the_name_of_a_chip_as_a_comment(self):
        self.write("run.csv", "# sensor: AS5600\n" + swing.angle_csv())
        sensor, codes = self.fit("run.csv")
        self.assertEqual(sensor["kind"], "angle sensor")
        self.assertIn("sensor_unknown", codes)

    def test_leaves_a_stated_clock_to_its_own_error(self):
        self.write("run.csv", "# clock_scale_std_dev: 1e-5\n" + swing.angle_csv())
        sensor, _ = self.fit("run.csv")
        self.assertEqual(sensor["clock"], {"std_dev": 0, "unit": "1", "source": "stated with the clock"})

    def test_refuses_what_it_cannot_use(self):
        self.assert_refused(3, "--sensor takes a file or a kind of sensor: potentiometer, encoder, gyro", "--sensor", "sonar")
        self.assert_refused(2, '--sensor: "gain" is 11; it must be a standard deviation', "--sensor", '{"gain": 11}')
        self.write("sensor.json", '{"gian": 0.01}')
        self.assert_refused(4, 'sensor.json: "gian" is not a key of a sensor; the keys are kind, gain, nonlinearity, lag, '
                            "backlash, drift, clock", "--sensor", "sensor.json")
        self.write("run.csv", '# sensor: {"kind": "sonar"}\n' + swing.angle_csv())
        self.assert_refused(4, 'run.csv:1: # sensor: "kind" is "sonar"; it must be one of potentiometer')

    def test_does_not_write_onto_its_own_input(self):
        self.write("sensor.json", '{"kind": "gyro"}')
        self.assert_refused(2, "sensor.json", "--sensor", "sensor.json", "--json", "sensor.json")
        self.assertEqual((self.folder / "sensor.json").read_text(encoding="utf-8"), '{"kind": "gyro"}')


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
