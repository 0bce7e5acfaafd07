#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""calibrate_sensor as a process: table, plan, files, exit codes. calibrate_sensor_cli_test.py PATH_OF_calibrate_sensor.

simulate_pendulum and fit_pendulum are taken from the same folder.
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

BINARY = pathlib.Path()
COUNTS = [19, 97, 177, 261, 324, 396, 475]
ANGLES = [-45, -30, -15, 0, 15, 30, 45]
TABLE = "counts,angle_deg\n" + "".join(f"{counts},{angle}\n" for counts, angle in zip(COUNTS, ANGLES))


def straight_line(x, y):
    """Offset, slope, their standard errors and their covariance, from the textbook's sums."""
    n, mean_x, mean_y = len(x), sum(x) / len(x), sum(y) / len(y)
    sxx = sum((a - mean_x) ** 2 for a in x)
    slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sxx
    offset = mean_y - slope * mean_x
    variance = sum((b - offset - slope * a) ** 2 for a, b in zip(x, y)) / (n - 2)
    return (offset, slope, math.sqrt(variance * (1 / n + mean_x**2 / sxx)), math.sqrt(variance / sxx),
            -mean_x * variance / sxx)


class CalibrateSensorTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "table.csv").write_text(TABLE, encoding="utf-8")

    def run_tool(self, *arguments, tool="calibrate_sensor", **options):
        binary = BINARY if tool == "calibrate_sensor" else BINARY.parent / tool
        return subprocess.run([binary, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=60,
                              **options)

    def check_done(self, *arguments, **options):
        done = self.run_tool(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def check_refused(self, code, message, *arguments, **options):
        done = self.run_tool(*arguments, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertEqual(done.stdout, "")

    def check_bad_table(self, message, text, *arguments):
        """Checks that a wrong table is refused with the line of the error, and that no output is written."""
        (self.folder / "bad.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
        self.check_refused(4, message, "--data", "bad.csv", "--json", "bad.json", *arguments)
        self.assertFalse((self.folder / "bad.json").exists())

    def test_finds_the_published_line_and_its_errors(self):
        done = self.check_done("table.csv", "--json", "cal.json")
        words = " ".join(done.stdout.split())
        self.assertIn("angle = -49.6077 + 0.198544 x deg, x in counts", words)
        self.assertIn("c1 0.1985 ± 0.0030 deg/count", words)
        self.assertIn("up to 2.21 deg at 261 counts (line 5), are an order of magnitude above it (11 counts)", words)
        self.assertEqual(done.stderr, "")
        calibration = json.loads((self.folder / "cal.json").read_text())
        offset, slope, offset_error, slope_error, covariance = straight_line(COUNTS, ANGLES)
        self.assertAlmostEqual(calibration["coefficients"][0], offset, delta=1e-10)
        self.assertAlmostEqual(calibration["coefficients"][1], slope, delta=1e-12)
        matrix = calibration["covariance"]
        self.assertAlmostEqual(math.sqrt(matrix[0][0]), offset_error, delta=1e-10)
        self.assertAlmostEqual(math.sqrt(matrix[1][1]), slope_error, delta=1e-12)
        self.assertAlmostEqual(matrix[0][1], covariance, delta=1e-12)
        self.assertEqual(matrix[0][1], matrix[1][0])
        self.assertAlmostEqual(calibration["residual_std_dev"], 1.194658111, delta=1e-8)
        self.assertIsNone(calibration["input_range"])

    def test_reads_standard_input_and_writes_standard_output(self):
        done = self.check_done("--data", "-", "--json", "-", "--bits", "10", input=TABLE)
        calibration = json.loads(done.stdout)
        self.assertEqual(calibration["input_range"], [0, 1023])
        self.assertEqual((calibration["input"], calibration["angle_unit"]), ("counts", "deg"))
        self.assertEqual(len(json.loads(self.check_done("--data", "-", "--json", "-", "--order", "3",
                                                        input=TABLE).stdout)["coefficients"]), 4)

    def simulate_counts(self):
        """A swing about the sensor's zero, simulated in deg and converted to counts with the published line."""
        offset, slope, *_ = straight_line(COUNTS, ANGLES)
        self.check_done("--model", "coulomb", "--duration", "20", "--rate", "100", "--noise", "0.1", "--seed", "3",
                        "--set", "inertia=0.044,viscous=0.0017,coulomb=0.0006,initial_angle=0.4,initial_rate=0,"
                        "zero_angle=0.02", "--out", "swing.csv", tool="simulate_pendulum")
        with (self.folder / "swing.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        with (self.folder / "counts.csv").open("w", encoding="utf-8") as file:
            file.write("time_s,adc_counts\n")
            for row in rows:
                file.write(f"{row['time_s']},{round((float(row['angle_deg']) - offset) / slope)}\n")

    def test_fit_pendulum_reads_the_calibration_and_its_covariance(self):
        self.simulate_counts()
        self.check_done("--data", "table.csv", "--json", "cal.json", "--bits", "10")
        self.check_done("--data", "counts.csv", "--calibration", "cal.json", "--json", "fit.json", "--model", "coulomb",
                        tool="fit_pendulum")
        result = json.loads((self.folder / "fit.json").read_text())
        calibration = json.loads((self.folder / "cal.json").read_text())
        (recording,) = result["recordings"]
        self.assertEqual(recording["calibration"], calibration)
        self.assertAlmostEqual(result["fits"][0]["parameters"]["inertia"]["estimate"], 0.044, delta=1e-4)
        angle = recording["fits"][0]["parameters"]["initial_angle"]
        self.assertAlmostEqual(angle["estimate"], 0.4, delta=0.004)
        # An angle of 0.4 rad has the relative error of the slope, 0.00299 / 0.1985 = 1.5 %.
        self.assertAlmostEqual(angle["systematic_std_error"], 0.4 * 0.01506, delta=1e-3)

    def test_plot_is_svg_with_both_panels(self):
        self.check_done("--data", "table.csv", "--plot", "cal.svg")
        root = xml.etree.ElementTree.parse(self.folder / "cal.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        words = "".join(root.itertext())
        for label in ["angle [deg]", "residual [deg]", "reading [counts]", "measured", "curve"]:
            self.assertIn(label, words)
        self.assertEqual(self.check_done("--data", "table.csv", "--plot", "-").stdout,
                         (self.folder / "cal.svg").read_text())

    def test_a_missing_gnuplot_exits_73_before_the_work(self):
        self.check_refused(73, "plot needs gnuplot; install gnuplot-nox", "--data", "none.csv", "--plot", "cal.svg",
                           env={**os.environ, "PATH": str(self.folder)})

    def test_plans_a_rig_for_several_references(self):
        done = self.check_done("--plan", "--bits", "10", "--reference_voltage", "5,3.3,1.1", "--supply_voltage", "5",
                               "--potentiometer_range_deg", "270")
        rows = [line.split() for line in done.stdout.splitlines()[4:7]]
        self.assertEqual([row[0] for row in rows], ["5", "3.3", "1.1"])
        for row, reference in zip(rows, [5, 3.3, 1.1]):
            self.assertAlmostEqual(float(row[1]), 270 * reference / (1024 * 5), delta=5e-5)
            self.assertAlmostEqual(float(row[2]), 1024 * 5 / (270 * reference), delta=5e-3)
        self.assertIn("all angles above 43.2 deg", " ".join(done.stdout.split()))

    def test_bad_tables_exit_4_with_their_place(self):
        self.check_bad_table("bad.csv:3: points found: 2; a curve of order 2 has 3 coefficients",
                             "counts,angle_deg\n1,0\n2,1\n", "--order", "2")
        self.check_bad_table("bad.csv:4: the reading 97 counts (line 3) is repeated with another angle",
                             "counts,angle_deg\n19,-45\n97,-30\n97,-15\n")
        self.check_bad_table("bad.csv:4: the reading 97 counts (line 3) is repeated with the same angle",
                             "counts,angle_deg\n19,-45\n97,-30\n97,-30\n")
        self.check_bad_table("bad.csv:4: the angle is -40 deg at 177 counts", TABLE.replace("177,-15", "177,-40"))
        self.check_bad_table("bad.csv:1:1: no column's name shows that it is the angle",
                             TABLE.replace("angle_deg", "angle"))
        self.check_bad_table("bad.csv:1:1: no column's name shows that it is the reading",
                             TABLE.replace("counts", "reading"))
        self.check_bad_table("bad.csv:5: the curve of order 2 turns at about",
                             "volts,angle_deg\n0,0\n1,0\n2,0\n3,30\n", "--order", "2")

    def test_hostile_tables_exit_4_with_a_sentence(self):
        self.check_bad_table("bad.csv:1:1: the file is empty", "")
        self.check_bad_table("there is a NUL byte", bytes(range(256)) * 10)
        self.check_bad_table('columns "counts" and "counts" could both be the reading',
                             "counts,counts,angle_deg\n1,2,3\n")
        self.check_bad_table('bad.csv:3:1: column "counts" holds "nan"', "counts,angle_deg\n1,0\nnan,1\n2,2\n")
        self.check_bad_table('bad.csv:3:3: column "angle_deg" holds "inf"', "counts,angle_deg\n1,0\n2,inf\n3,2\n")
        self.check_bad_table("which is outside the range of numbers", "counts,angle_deg\n1,0\n1e400,1\n")
        self.check_bad_table("too large, too small or too similar", "volts,angle_deg\n0,0\n1,1e300\n2,2e300\n3,4e300\n")
        self.check_bad_table("bad.csv:10002:1: there are more than 10000 rows",
                             "counts,angle_deg\n" + "".join(f"{i},{i}\n" for i in range(1_000_000)))
        self.check_bad_table("this line is longer than 1 MiB", "x" * 3_000_000)

    def test_the_longest_table_is_calibrated_in_time(self):
        table = "volts,angle_rad\n" + "".join(f"{i / 1000},{math.sin(i / 1e4)}\n" for i in range(10_000))
        done = self.check_done("--data", "-", "--order", "5", "--details", "--plot", "cal.svg", input=table)
        self.assertIn("(the 50 with the largest residuals)", done.stdout)

    def test_missing_files_exit_3_and_outputs_73(self):
        self.check_refused(3, "none.csv: there is no such file", "--data", "none.csv")
        self.check_refused(73, "cannot write none/cal.json", "--data", "table.csv", "--json", "none/cal.json")
        self.check_refused(73, "it is a directory", "--data", "table.csv", "--plot", ".")
        self.check_refused(4, "this is a directory", "--data", ".")

    def test_wrong_flags_exit_2(self):
        self.check_refused(2, "no table was given: a file with counts or volts and angles, as in calibrate_sensor table.csv")
        self.check_refused(2, "did you mean --order?", "--data", "table.csv", "--oder", "2")
        self.check_refused(2, "--order is 6; it must be 1 to 5", "--data", "table.csv", "--order", "6")
        self.check_refused(2, "--order is '1.5'; it must be an integer", "--data", "table.csv", "--order", "1.5")
        self.check_refused(2, "--json table.csv would overwrite the input", "--data", "table.csv", "--json",
                           "table.csv")
        self.check_refused(2, "--json x is the output of --plot too", "--data", "table.csv", "--json", "x", "--plot",
                           "x")
        self.check_refused(2, "table.csv:5: the reading 261 counts is outside the sensor's range, 0 to 255",
                           "--data", "table.csv", "--bits", "8")
        self.check_refused(2, "--bits defines the range of counts", "--data", "-", "--bits", "8",
                           input=TABLE.replace("counts", "volts"))
        self.check_refused(2, "--divider is 2", "--plan", "--divider", "2")
        self.check_refused(2, "'stray' does not belong to a flag", "--data", "table.csv", "stray")

    def test_help_and_version_succeed_on_stdout(self):
        self.assertIn("--reference_voltage", self.check_done("--help").stdout)
        self.assertRegex(self.check_done("--version").stdout, r"^calibrate_sensor \d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
