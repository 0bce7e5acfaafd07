#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of fit_pendulum with files from other sources: files that it reads, and files that it refuses with an exit code
and a sentence.

  read_cli_test.py PATH/TO/fit_pendulum
"""

import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import swing
from sanitizers import memory_limit

TOOL = ""  # path of the binary, from the command line
ROWS = [line.split(",") for line in swing.angle_csv().splitlines()[1:]]  # time [s], angle [deg]
CALIBRATION = {"input": "counts", "angle_unit": "deg", "coefficients": [-49.6077, 0.1985], "input_range": [0, 1023]}


def table(header, row, rows=None):
    """A file of the swing; `row` converts time [s] and angle [deg] to the text of a row."""
    return header + "".join(row(float(t), float(a)) + "\n" for t, a in rows or ROWS)


def counts(angle_deg):
    return round((angle_deg + 49.6077) / 0.1985)


class ReadTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("run.csv", swing.angle_csv())
        self.write("rig.json", json.dumps(swing.RIG))
        self.write("cal.json", json.dumps(CALIBRATION))

    def write(self, name, content):
        content = content if isinstance(content, bytes) else content.encode("utf-8")
        (self.folder / name).write_bytes(content)
        return name

    def run_tool(self, *flags, **options):
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, **options}
        return subprocess.run([TOOL, *flags], cwd=self.folder, stderr=subprocess.PIPE, text=True, encoding="utf-8",
                              timeout=120, check=False, **options)

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())

    def assert_refused(self, code, sentence, *flags, **options):
        """Checks that the tool exits with the code and one sentence, perhaps a command to try, and writes nothing."""
        before = self.names()
        run = self.run_tool(*flags, "--json", "fit.json", "--residuals", "res.csv", **options)
        self.assertEqual(re.sub(r"try: [^\n]+\n\Z", "", run.stderr), f"fit_pendulum: {sentence}\n")
        self.assertEqual(run.returncode, code)
        self.assertEqual(run.stdout, "")
        self.assertEqual(self.names(), before)

    def assert_data_refused(self, code, sentence, content, *flags):
        self.assert_refused(code, sentence, "--data", self.write("bad.csv", content), *flags)

    def assert_finds_the_truth(self, *flags, **options):
        """Checks that the fit converges to the true values of the swing; returns the codes of its warnings."""
        run = self.run_tool("--rig", "rig.json", "--json", "-", *flags, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        result = json.loads(run.stdout)
        for name in ("inertia", "coulomb"):
            parameter = result["fits"][0]["parameters"][name]
            self.assertLess(abs(parameter["estimate"] - swing.TRUTH[name]), 5 * parameter["std_error"], name)
        return [warning["code"] for warning in result["warnings"]]


class AcceptedFiles(ReadTest):
    def test_counts_through_a_calibration(self):
        self.write("counts.csv", table("time_s,adc_counts\n", lambda t, a: f"{t},{counts(a)}"))
        self.assert_finds_the_truth("--data", "counts.csv", "--calibration", "cal.json")

    def test_counts_with_calibration_and_rig_in_the_file(self):
        head = f"# calibration: {json.dumps(CALIBRATION)}\n# rig: {json.dumps(swing.RIG)}\n# sample_rate_hz: 100\n"
        self.write("counts.csv", table(head + "adc_counts\n", lambda t, a: str(counts(a))))
        run = self.run_tool("--data", "counts.csv", "--json", "-")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertAlmostEqual(json.loads(run.stdout)["fits"][0]["parameters"]["inertia"]["estimate"], 0.079, places=3)

    def test_a_spreadsheets_export(self):
        rows = table("Time (s);Angle [deg]\n", lambda t, a: f"{t};{a}".replace(".", ","))
        self.write("excel.csv", "\ufeffsep=;\r\n" + rows.replace("\n", "\r\n"))
        self.assertEqual(self.assert_finds_the_truth("--data", "excel.csv"), ["rig_errors_assumed"])

    def test_a_paste_of_a_serial_monitor(self):
        stamp = lambda t: f"14:03:{22 + t:06.3f} -> " if t < 38 else ""
        rows = table("", lambda t, a: f"{stamp(t)}{round(1000 * t) + 7},{counts(a)}")
        codes = self.assert_finds_the_truth("--data", self.write("paste.txt", rows[9:-2]), "--time_column", "1:ms",
                                            "--unit", "counts", "--calibration", "cal.json")
        self.assertNotIn("time_repeated", codes)

    def test_a_paste_with_lines_between_its_rows(self):
        lines = ("", "Temp: 23 C\r\n", "09:14:09 -> # battery 7.4V\r\n", "4711\r\n")
        between = lambda t: lines[round(10 * t) % 4] if round(100 * t) % 300 == 10 * (round(10 * t) % 4) else ""
        rows = table("Ready v1\r\nmillis\tADC\r\n", lambda t, a: f"{between(t)}{round(1000 * t)}\t{counts(a)}\r")
        codes = self.assert_finds_the_truth("--data", self.write("paste.txt", rows), "--calibration", "cal.json")
        self.assertEqual([code for code in codes if "column" in code or "lines" in code], ["stray_lines"])

    def assert_finds_the_truth_with_its_proposal(self, sentence, data):
        """Checks that the tool asks with this sentence, and that the flags it proposes lead to the true values."""
        run = self.run_tool("--data", data)
        self.assertEqual(run.returncode, 4, run.stdout)
        self.assertIn(sentence, run.stderr)
        flags = re.search(rf"{data} (.*)\n", run.stderr.split("try: ")[1])[1].split()
        self.assert_finds_the_truth("--data", data, *flags)

    def test_points_without_names(self):
        point = lambda t, a: f"{t:.3f}\t{430 * math.sin(math.radians(a)):.2f}\t{-430 * math.cos(math.radians(a)):.2f}\r"
        codes = self.assert_finds_the_truth("--data", self.write("points.txt", table("", point)))
        self.assertIn("value_column_assumed", codes)
        self.assert_finds_the_truth("--data", "points.txt", "--value_column", "2,3", "--unit", "mm")

    def test_accelerations_in_milli_g_without_names(self):
        noise, radius = random.Random(3), 0.15  # m
        rows = []
        for time, angle, rate in swing.swing(20.0):
            friction = swing.TRUTH["viscous"] * rate + swing.TRUTH["coulomb"] * math.tanh(rate / 1e-3)
            turn = -(swing.GRAVITY_TORQUE * math.sin(angle) + friction) / swing.TRUTH["inertia"]  # rad/s^2
            is_held = time < swing.TRUTH["release_time"]
            along = 9.80665 * math.cos(angle) + radius * rate**2
            across = 9.80665 * math.sin(angle) + (0 if is_held else radius * turn)
            readings = (round(1000 * each / 9.80665 + noise.gauss(0, 4)) for each in (along, across))
            rows.append("\t".join(map(str, (round(1000 * time), *readings))))
        self.write("microbit.txt", "\n".join(rows) + "\n")
        self.assert_finds_the_truth_with_its_proposal("have the size of gravity in mg", "microbit.txt")

    def test_a_paste_a_calibration_table_and_masses_in_grams_are_one_command(self):
        stamp = lambda t: f"14:03:{22 + t:06.3f} -> " if t < 38 else ""
        self.write("paste.txt", table("", lambda t, a: f"{stamp(t)}{round(1000 * t) + 7},{counts(a)}")[9:-2])
        points = "".join(f"{counts(angle)},{angle}\n" for angle in range(-45, 50, 15))
        self.write("points.csv", "counts,angle_deg\n" + points)
        run = self.run_tool("paste.txt", "--calibration", "points.csv", "--bob_mass", "380g", "--rod_mass", "95 g",
                            "--rod_length", "43cm", "--g", "9.81", "--json", "fit.json")
        self.assertEqual(run.returncode, 0, run.stderr)
        inertia = json.loads((self.folder / "fit.json").read_text())["fits"][0]["parameters"]["inertia"]
        self.assertEqual(inertia["unit"], "kg m^2")
        self.assertLess(abs(inertia["estimate"] - swing.TRUTH["inertia"]), 4 * inertia["total_std_error"])
        self.assertLess(inertia["total_std_error"], 0.01 * swing.TRUTH["inertia"])
        lines = run.stdout.splitlines()
        self.assertLessEqual(len(lines), 20)
        self.assertLessEqual(max(map(len, lines)), 80)

    def test_columns_by_number(self):
        self.write("plain.txt", table("", lambda t, a: f"x {t} {a}".replace("x", "7")))
        self.assert_finds_the_truth("--data", "plain.txt", "--time_column", "2:s", "--value_column", "3", "--unit", "deg")

    def test_a_single_column_with_a_sample_rate(self):
        self.write("plain.txt", table("", lambda t, a: f"{a}"))
        self.assert_finds_the_truth("--data", "plain.txt", "--unit", "deg", "--sample_rate_hz", "100")

    def test_a_counter_that_wraps_and_rows_that_repeat(self):
        start = 2**32 - 5_000_000
        rows = table("time_us,angle_deg\n", lambda t, a: f"{(start + round(1e6 * t)) % 2**32},{a}").splitlines()
        rows.insert(300, rows[299])
        codes = self.assert_finds_the_truth("--data", self.write("wrap.csv", "\n".join(rows) + "\n"))
        self.assertEqual(codes[:2], ["time_wrapped", "time_repeated"])

    def test_standard_input(self):
        with open(self.folder / "run.csv", encoding="utf-8") as data:
            self.assert_finds_the_truth("--data", "-", stdin=data)

    def test_a_fifo_that_is_written_slowly(self):
        os.mkfifo(self.folder / "fifo")
        text = swing.angle_csv().encode()

        def write():
            with open(self.folder / "fifo", "wb", buffering=0) as fifo:
                for begin in range(0, len(text), 3000):
                    fifo.write(text[begin:begin + 3000])
                    time.sleep(0.01)

        writer = threading.Thread(target=write)
        writer.start()
        self.assert_finds_the_truth("--data", "fifo")
        writer.join()


class RefusedFiles(ReadTest):
    def test_two_columns_that_could_be_the_quantity(self):
        text = table("time_s,upper_deg,lower_deg\n", lambda t, a: f"{t},{a},{ROWS[-1 - int(100 * t)][1]}")
        self.assert_data_refused(
            4, 'bad.csv:1:1: no single column carries the swing: "lower_deg" 50 % and "upper_deg" 50 %; choose one with '
            "--value_column", text)

    def test_a_unit_in_a_cell(self):
        self.assert_data_refused(
            4, 'bad.csv:3:5: column "angle_deg" holds "12 deg", a number followed by " deg"; correct the field or delete '
            "the row", "time_s,angle_deg\n0,1\n0.1,12 deg\n0.2,3\n")

    def test_a_header_with_two_units(self):
        self.assert_data_refused(
            4, 'bad.csv:1:8: column "angle_deg [rad]" names two units, deg and rad; keep the unit of its values',
            "time_s,angle_deg [rad]\n0,1\n")

    def test_times_that_go_back(self):
        text = table("time_s,angle_deg\n", lambda t, a: f"{t},{a}")
        self.assert_data_refused(
            4, f"bad.csv:{len(ROWS) + 2}: time 0 s follows 12 s, so the clock was set back: these are two recordings in "
            "one file; split it before this line", text + text.split("\n", 1)[1])

    def test_binary_files(self):
        nul = "there is a NUL byte, so this is not CSV text; delete the damaged part, or save UTF-16 as UTF-8"
        self.assert_data_refused(4, f"bad.csv:2:4: {nul}", b"time_s,angle_deg\n0,1\0\n")
        self.assert_data_refused(4, "bad.csv: this is a picture, not a recording; give the file with the numbers", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")

    def test_utf_16(self):
        self.assert_data_refused(5, "bad.csv:1:1: rows of data found: 0; at least 8 are needed: record for longer", "time_s,angle_deg\n".encode("utf-16"))

    def test_an_endless_line_from_standard_input(self):
        """2 GB of the letter a are refused after the first line's first bytes, with little memory."""
        producer = subprocess.Popen("head -c 2000000000 /dev/zero | tr '\\0' a", shell=True, stdout=subprocess.PIPE,
                                    stderr=subprocess.DEVNULL)
        self.addCleanup(producer.wait)
        self.addCleanup(producer.stdout.close)
        began = time.monotonic()
        self.assert_refused(4, 'standard input:1:1: the first line is longer than 64 kB and begins with "' + 40 * "a" +
                            '...": shorten it to the names of the columns, or name a CSV file', "--data", "-", stdin=producer.stdout,
                            preexec_fn=memory_limit(TOOL, 100_000_000))
        self.assertLess(time.monotonic() - began, 30)  # Reading everything would take as long as the producer needs.

    def test_a_calibration_of_another_sensor(self):
        self.write("cal.json", json.dumps({**CALIBRATION, "input": "volts"}))
        self.assert_data_refused(
            4, 'bad.csv:1:1: column "adc_counts" is in counts, but the calibration is for volts; give the '
               'calibration of this sensor', table("time_s,adc_counts\n", lambda t, a: f"{t},{counts(a)}"), "--calibration", "cal.json")

    def test_a_calibration_of_an_angle(self):
        self.assert_refused(
            4, 'run.csv:1:1: column "angle_deg" is in deg, but the calibration is for counts; leave --calibration out',
            "--data", "run.csv", "--calibration", "cal.json")

    def test_files_without_a_valid_calibration(self):
        self.write("bad.json", json.dumps({**CALIBRATION, "coefficients": [1, 0]}))
        self.assert_refused(4, 'bad.json: "coefficients" has no slope, so that every reading would be the same angle; '
                            "give [offset, slope]", "--data", "run.csv", "--calibration", "bad.json")
        self.assert_refused(3, "no.json: there is no such file; check the path", "--data", "run.csv", "--calibration",
                            "no.json")

    def test_contradictory_flags(self):
        for sentence, flags in (
                ("--time_column and --sample_rate_hz both say what the times are; leave one of them out",
                 ("--time_column", "1", "--sample_rate_hz", "100")),
                ("--calibration turns counts or volts into an angle, and --unit says that the values are in deg; leave "
                 "one of them out", ("--calibration", "cal.json", "--unit", "deg")),
                ('run.csv:1:1: column "time_s" holds the times, so --sample_rate_hz 100 contradicts it; leave the flag '
                 "out, or add --time_column none to ignore the column", ("--sample_rate_hz", "100")),
                ('run.csv:1:1: --value_column is "x", which is none of the 2 columns "time_s", "angle_deg"; give a name, '
                 "or a number from 1 on", ("--value_column", "x"))):
            with self.subTest(flags=flags):
                self.assert_refused(2, sentence, "--data", "run.csv", *flags)

    def test_an_invalid_rig_in_the_file(self):
        text = '# rig: {"bob_mass": -1}\n' + swing.angle_csv()
        run = self.run_tool("--data", self.write("bad.csv", text))
        self.assertEqual(run.returncode, 4)
        self.assertIn("fit_pendulum: bad.csv: # rig: ", run.stderr)

    def test_a_closed_standard_input(self):
        run = subprocess.run(f'"{TOOL}" --data - <&-', shell=True, capture_output=True, text=True, check=False)
        self.assertEqual((run.returncode, run.stderr), (4, "fit_pendulum: standard input: the file cannot be read; check "
                                                           "its permissions\n"))


class OutputsThatFail(ReadTest):
    def test_a_closed_standard_output(self):
        run = subprocess.run(f'"{TOOL}" --data run.csv >&-', shell=True, cwd=self.folder, stderr=subprocess.PIPE, text=True,
                             check=False)
        self.assertEqual(run.returncode, 73)
        self.assertEqual(run.stderr, "fit_pendulum: cannot write standard output: Bad file descriptor\n")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_a_full_device(self):
        run = self.run_tool("--data", "run.csv", "--json", "/dev/full")
        self.assertEqual(run.returncode, 73)
        self.assertEqual(run.stderr, "fit_pendulum: cannot write /dev/full: No space left on device\n")

    def assert_old_result_stays(self, folder, **options):
        (self.folder / folder).mkdir(exist_ok=True)
        old = self.folder / folder / "fit.json"
        old.write_text("old", encoding="utf-8")
        run = self.run_tool("--data", "run.csv", "--json", f"{folder}/fit.json", "--residuals", f"{folder}/res.csv",
                            **options)
        self.assertEqual(run.returncode, 73, run.stderr)
        self.assertRegex(run.stderr, rf"\Afit_pendulum: cannot write {folder}/(fit.json|res.csv): [^\n]+\n\Z")
        self.assertEqual(list(old.parent.iterdir()), [old])
        self.assertEqual(old.read_text(encoding="utf-8"), "old")

    def test_a_limit_to_the_size_of_files(self):
        self.assert_old_result_stays("out", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)))

    def test_a_full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(disk)]
        if shutil.which("mount") is None or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("mounting is not allowed")
        self.addCleanup(subprocess.run, ["umount", str(disk)], check=True)
        self.assert_old_result_stays("disk")


if __name__ == "__main__":
    TOOL = os.path.abspath(sys.argv.pop(1))
    unittest.main()
