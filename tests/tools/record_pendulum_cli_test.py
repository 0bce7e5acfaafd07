#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""record_pendulum as a process with a logger simulated in Python: record_pendulum_cli_test.py PATH_OF_record_pendulum.

fit_pendulum is taken from the same folder. record_damage_cli_test.py tests errors on the line.
"""

import json
import math
import os
import resource
import signal
import struct
import subprocess
import unittest

from python_logger import DONE, TIMEOUT_S, TOOL, Lab, PythonLogger, frame, load_in_parallel, swing

LINE = [-134.5, 0.2637]  # offset [deg] and slope [deg per count]
COVARIANCE = [[0.25, -0.0004], [-0.0004, 0.000002]]

load_tests = load_in_parallel


def single(values):
    """Values rounded to IEEE single precision."""
    return struct.unpack(f"<{len(values)}f", struct.pack(f"<{len(values)}f", *values))


class GoodRuns(Lab):
    def check_fit(self, *arguments, data="run.csv"):
        done = subprocess.run([TOOL.parent / "fit_pendulum", "--data", data, *arguments], cwd=self.folder, text=True,
                              capture_output=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_file_has_the_samples_and_remarks_about_the_logger(self):
        with PythonLogger(runs=6) as logger:
            out, err = self.record(logger, "--seconds", 3)
        self.check_rows(logger, logger.taken[:600])
        remarks, named, rows = self.read()
        self.assertEqual(rows[599][0], 2.995)
        self.assertEqual(remarks[0], "pendulum_logger version 1.0, Arduino Uno, reference: supply voltage (AVcc)")
        self.assertRegex(remarks[1], r"^run 7 of this logger, begun \d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertEqual({name: named[name] for name in ("sample_rate_hz", "resolution", "range", "lost_samples")},
                         {"sample_rate_hz": "200", "resolution": "1", "range": "0,1023", "lost_samples": "0"})
        self.assertEqual((named["clock_scale"], named["clock_scale_std_dev"]), ("1", "0.003"))
        self.assertNotIn("calibration", named)
        counts = [each.sum for each in logger.taken[:600]]
        self.assertIn("600 at 200 Hz, 3 s; none lost", out)
        self.assertIn(f"{min(counts)} to {max(counts)} of 0 to 1023 counts", out)
        self.assertEqual(err, "")
        self.assertIn("damping_ratio", self.check_fit("--closed_form_only"))

    def test_commands_follow_the_protocol_each_after_a_0_byte(self):
        with PythonLogger(speed=3) as logger:
            self.record(logger, "--seconds", 1)
        self.assertEqual(logger.garbage, [])
        self.assertEqual(logger.raw, b"".join(b"\0" + frame(command) for command in logger.commands))
        self.assertEqual(logger.commands, [b"X", b"I", b"R" + struct.pack("<HB", 10000, 1), b"S", b"X"])

    def test_times_increase_when_the_tick_counter_overflows(self):
        with PythonLogger(speed=2, first_tick=2**32 - 3_000_000) as logger:
            self.record(logger, "--seconds", 3)
        self.check_rows(logger, logger.taken[:600])
        self.assertLess(logger.taken[299].tick, 2**32)
        self.assertGreaterEqual(logger.taken[300].tick, 2**32)

    def test_oversampling_gives_means(self):
        with PythonLogger(speed=2) as logger:
            out, _ = self.record(logger, "--seconds", 2, "--rate_hz", 100, "--oversample", 4)
        self.assertIn(b"R" + struct.pack("<HB", 5000, 4), logger.commands)
        self.check_rows(logger, logger.taken[:200])
        self.assertTrue(any(counts % 1 for _, counts in self.read()[2]))
        remarks, named, _ = self.read()
        self.assertEqual((named["resolution"], named["sample_rate_hz"]), ("0.25", "100"))
        self.assertIn("each row is the mean of 4 conversions", remarks)
        self.assertIn("200 at 100 Hz, 2 s, each the mean of 4 conversions; none lost", out)

    def test_records_at_the_nearest_possible_rate(self):
        with PythonLogger(speed=2) as logger:
            self.record(logger, "--seconds", 1, "--rate_hz", 300)
        self.assertIn(b"R" + struct.pack("<HB", 6667, 1), logger.commands)
        self.assertEqual(float(self.read()[1]["sample_rate_hz"]), 2e6 / 6667)
        self.check_rows(logger, logger.taken[:300])

    def test_the_highest_rate_is_recorded_with_a_warning(self):
        with PythonLogger() as logger:
            _, err = self.record(logger, "--seconds", 1, "--rate_hz", 8000)
        self.assertIn("warning: 8000 samples a second are more than the", err)
        self.check_rows(logger, logger.taken[:8000])

    def test_until_rest_ends_after_the_swing_not_during_the_hold(self):
        swinging = swing(decay_s=2, amplitude=200)
        with PythonLogger(speed=10, swing=lambda seconds: 712 if seconds < 8 else swinging(seconds - 8)) as logger:
            out, _ = self.record(logger, "--until_rest")
        self.assertIn("ended at rest", out)
        rows = self.read()[2]
        self.check_rows(logger, logger.taken[:len(rows)])
        end = rows[-1][0]
        self.assertTrue(all(abs(counts - 512) <= 2 for time_s, counts in rows if time_s > end - 4.5))
        self.assertGreater(max(abs(counts - 512) for _, counts in rows[-2400:]), 2)  # in the last 12 s: not stopped too late
        self.assertGreater(end, 17)

    def test_a_swing_that_never_rests_ends_after_the_given_time(self):
        with PythonLogger(speed=2) as logger:
            out, _ = self.record(logger, "--until_rest", "--seconds", 2)
        self.assertIn("ended after the time asked for", out)
        self.check_rows(logger, logger.taken[:400])

    def test_a_run_of_less_than_a_sample_is_no_empty_recording(self):
        """It is refused or has one row."""
        with PythonLogger() as logger:
            process = self.start(logger, "--out", "run.csv", "--seconds", 0.001)
            out, _ = process.communicate(timeout=TIMEOUT_S)
        self.assertNotIn("inf", out)
        if process.returncode != 2:
            self.check_rows(logger, logger.taken[:1])

    def test_fits_the_recording(self):
        with PythonLogger(speed=2, is_calibrated=1, calibration=single(LINE + [0, 0, 0])) as logger:
            out, _ = self.record(logger, "--seconds", 4, "--fit", "--model", "linear")
        self.check_rows(logger, logger.taken[:800])
        self.assertIn("period of small swings", out.split("after the time asked for")[1])
        self.check_fit("--model", "linear", "--json", "fit.json")
        fit = json.loads((self.folder / "fit.json").read_text())["fits"][0]
        # A swing with a period of 1 s whose amplitude falls to 1 / e in 20 s.
        self.assertAlmostEqual(fit["derived"]["natural_frequency"]["estimate"], 2 * math.pi, delta=0.003)
        self.assertAlmostEqual(fit["derived"]["damping_ratio"]["estimate"], 1 / (20 * 2 * math.pi), delta=0.0002)

    def test_recording_on_standard_output_report_on_standard_error(self):
        with PythonLogger(speed=3) as logger:
            done = subprocess.run([TOOL, "--port", logger.port, "--out", "-", "--seconds", "1"], cwd=self.folder, text=True,
                                  capture_output=True, timeout=TIMEOUT_S)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertIn("200 at 200 Hz", done.stderr)
        (self.folder / "run.csv").write_text(done.stdout)
        self.check_rows(logger, logger.taken[:200])

    def test_a_logger_left_running_by_a_killed_recorder_is_restarted(self):
        with PythonLogger() as logger:
            killed = self.start(logger, "--out", "killed.csv")
            self.wait_for_samples(logger, 200)
            killed.kill()
            killed.communicate(timeout=TIMEOUT_S)
            out, _ = self.record(logger, "--seconds", 1)
        self.check_rows(logger, logger.taken[logger.run_begin:][:200])
        self.assertIn("run 2", out)


class Forgetful(PythonLogger):
    """Its EEPROM does not keep data."""

    def store(self, content):
        return DONE


class Calibrations(Lab):
    def test_info_describes_the_logger(self):
        with PythonLogger(firmware=0x0203, board=2, reference=3, runs=41) as logger:
            out, _ = self.run_tool(logger, "--info")
            for words in (logger.port, "version 2.3", "Arduino Mega 2560", "internal voltage (2.56 V)", "41 so far",
                          "no calibration"):
                self.assertIn(words, out)
            logger.info.update(firmware=0x0100, board=1, reference=0, is_calibrated=1, calibration=(1.5, -0.25, 0, 0, 0))
            out, _ = self.run_tool(logger, "--info")
        for words in ("version 1.0", "Arduino Uno", "external voltage (AREF)", "angle = 1.5 - 0.25 x deg, x in counts"):
            self.assertIn(words, out)
        self.assertNotIn(b"S", logger.commands)

    def test_counts_are_the_mean_of_a_second(self):
        with PythonLogger(speed=2) as logger:
            out, err = self.run_tool(logger, "--counts")
        self.assertAlmostEqual(float(out), sum(each.sum for each in logger.taken[:200]) / 200, delta=0.001)
        self.assertEqual(err, "")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_interrupted_counts_give_no_mean(self):
        with PythonLogger(speed=0.2) as logger:
            process = self.start(logger, "--counts")
            self.wait_for_samples(logger, 40)
            process.send_signal(signal.SIGINT)
            self.finish(process, code=130)

    def test_a_stored_calibration_is_shown_and_recorded(self):
        self.write_calibration("cal.json", LINE, COVARIANCE)
        with PythonLogger(speed=3) as logger:
            out, _ = self.run_tool(logger, "--store_calibration", "cal.json")
            self.assertIn("angle = -134.5 + 0.2637", out)
            self.assertEqual(logger.info["calibration"], single([*LINE, 0.25, -0.0004, 0.000002]))
            self.assertIn("angle = -134.5 + 0.2637 x deg, x in counts, with its covariance", self.run_tool(logger, "--info")[0])
            out, _ = self.record(logger, "--seconds", 1)
        calibration = json.loads(self.read()[1]["calibration"])
        self.assertEqual((calibration["coefficients"], calibration["covariance"]), (LINE, COVARIANCE))
        self.assertEqual((calibration["input"], calibration["angle_unit"]), ("counts", "deg"))
        counts = [each.sum for each in logger.taken[:200]]
        low, high = (f"{LINE[0] + LINE[1] * each:.4g}" for each in (min(counts), max(counts)))
        self.assertIn(f"counts, {low} to {high} deg", out)

    def test_a_given_calibration_takes_precedence(self):
        self.write_calibration("mine.json", [-100, 0.2])
        with PythonLogger(speed=3, is_calibrated=1, calibration=single(LINE + [0, 0, 0])) as logger:
            self.record(logger, "--seconds", 1, "--calibration", "mine.json")
        self.assertEqual(json.loads(self.read()[1]["calibration"])["coefficients"], [-100, 0.2])

    def test_unusable_calibrations_are_refused(self):
        self.write_calibration("volts.json", LINE, unit="volts")
        self.write_calibration("curve.json", [*LINE, 1e-5])
        with PythonLogger() as logger:
            self.check_refused(logger, 4, "volts.json is of volts", "--out", "run.csv", "--calibration", "volts.json")
            self.check_refused(logger, 4, "volts.json is of volts", "--store_calibration", "volts.json")
            self.check_refused(logger, 2, "a logger stores only straight lines", "--store_calibration", "curve.json")
            self.check_refused(logger, 3, "none.json", "--store_calibration", "none.json")
            self.check_refused(logger, 3, "none.json", "--out", "run.csv", "--fit", "--rig", "none.json")
        self.assertEqual([each for each in logger.commands if each[:1] in b"WS"], [])

    def test_a_calibration_that_the_logger_does_not_keep_is_detected(self):
        self.write_calibration("cal.json", LINE)
        with Forgetful() as logger:
            self.check_refused(logger, 4, "does not return the calibration", "--store_calibration", "cal.json")


class Files(Lab):
    def test_a_recording_is_replaced_only_when_asked(self):
        (self.folder / "run.csv").write_text("precious\n")
        with PythonLogger(speed=3) as logger:
            self.check_refused(logger, 73, "run.csv exists already", "--out", "run.csv", "--seconds", 1)
            self.assertEqual((self.folder / "run.csv").read_text(), "precious\n")
            self.assertEqual(logger.commands, [])
            self.record(logger, "--seconds", 1, "--overwrite")
        self.check_rows(logger, logger.taken[:200])

    def test_the_part_file_of_an_earlier_crash_is_kept(self):
        (self.folder / "run.csv.part").write_text("precious\n")
        with PythonLogger(speed=3) as logger:
            self.check_refused(logger, 73, "run.csv.part holds an interrupted recording", "--out", "run.csv",
                               "--seconds", 1)
            self.assertEqual((self.folder / "run.csv.part").read_text(), "precious\n")
            self.record(logger, "--seconds", 1, "--overwrite")
        self.check_rows(logger, logger.taken[:200])

    def test_an_output_that_cannot_be_written_exits_73_before_the_run(self):
        with PythonLogger() as logger:
            self.check_refused(logger, 73, "cannot write none/run.csv", "--out", "none/run.csv")
            self.check_refused(logger, 73, "it is a directory", "--out", ".")
        self.assertEqual(logger.commands, [])

    def fill_the_disk(self):
        """The message when no file can grow beyond 5000 bytes, which is more than 300 rows."""
        with PythonLogger(speed=2) as logger:
            process = self.start(logger, "--out", "run.csv", "--seconds", 6)
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (5000, 5000))
            _, err = self.finish(process, code=73)
        self.assertFalse((self.folder / "run.csv").exists())
        return logger, err

    def test_a_disk_that_fills_up_exits_73_and_leaves_no_wrong_row(self):
        logger, err = self.fill_the_disk()
        self.assertIn("cannot write run.csv: File too large", err)
        (self.folder / "whole.csv").write_text((self.folder / "run.csv.part").read_text().rsplit("\n", 1)[0])
        rows = self.read("whole.csv")[2]
        self.assertGreater(len(rows), 300)
        self.assertEqual(rows, self.expected(logger, logger.taken[:len(rows)]))

    def test_a_full_disk_message_names_the_part_file(self):
        self.assertIn("run.csv.part", self.fill_the_disk()[1])


class Signals(Lab):
    def interrupt(self, signal_number, code, *arguments):
        """Checks that the file has all sent samples, including those that were still in the logger."""
        with PythonLogger() as logger:
            process = self.start(logger, "--out", "run.csv", *arguments)
            self.wait_for_samples(logger, 250)
            process.send_signal(signal_number)
            out, _ = self.finish(process, code)
        self.assertIn("ended by hand", out)
        self.assertIn("none lost", out)
        self.assertIn(b"X", logger.commands[logger.commands.index(b"S"):])
        self.assertFalse((self.folder / "run.csv.part").exists())
        self.check_rows(logger, logger.taken)

    def test_sigint_ends_a_run_in_good_order(self):
        self.interrupt(signal.SIGINT, 0)

    def test_sigterm_ends_a_run_in_good_order(self):
        self.interrupt(signal.SIGTERM, 0)

    def test_sighup_ends_a_run_in_good_order(self):
        self.interrupt(signal.SIGHUP, 0)

    def test_sigint_before_the_time_asked_for_exits_130(self):
        self.interrupt(signal.SIGINT, 130, "--seconds", 1000)

    def test_sigterm_before_the_rest_asked_for_exits_130(self):
        self.interrupt(signal.SIGTERM, 130, "--until_rest")

    def test_sighup_before_the_time_asked_for_exits_130(self):
        self.interrupt(signal.SIGHUP, 130, "--seconds", 1000)

    def test_sigint_while_connecting_exits_130_at_once_without_a_file(self):
        with PythonLogger() as logger:
            logger.is_silent = True
            process = self.start(logger, "--out", "run.csv")
            self.wait_until(lambda: b"I" in logger.commands, "it asks")
            process.send_signal(signal.SIGINT)
            _, err = self.finish(process, code=130)
        self.assertLess(logger.commands.count(b"I"), 10)  # times that it asks before it gives up
        self.assertIn("interrupted before anything was recorded", err)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_terminal_that_is_closed_loses_nothing(self):
        terminal, its_end = os.openpty()
        with PythonLogger() as logger:
            process = subprocess.Popen([TOOL, "--port", logger.port, "--out", "run.csv"], cwd=self.folder, text=True,
                                       stdout=subprocess.PIPE, stderr=its_end, env={**os.environ, "TERM": "xterm"})
            self.addCleanup(self.end, process)
            os.close(its_end)
            self.wait_for_samples(logger, 200)
            trace = os.read(terminal, 1 << 16).decode()
            os.close(terminal)
            process.send_signal(signal.SIGHUP)
            self.finish(process)
        self.assertRegex(trace, r"counts \|")
        self.assertRegex(trace, r"\d Hz  [\d.]+ counts .* none lost")
        self.check_rows(logger, logger.taken)

    def test_sigkill_leaves_a_part_that_can_be_fitted(self):
        with PythonLogger() as logger:
            process = self.start(logger, "--out", "run.csv")
            self.wait_for_samples(logger, 1000)
            process.kill()
            process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(os.listdir(self.folder), ["run.csv.part"])
        _, named, rows = self.read("run.csv.part")
        self.assertNotIn("lost_samples", named)  # the loss was not counted
        self.assertGreaterEqual(len(rows), 600)  # 5 s; the last one or two may still have been in memory
        self.check_rows(logger, logger.taken[:len(rows)], "run.csv.part")
        self.assertEqual((named["sample_rate_hz"], named["range"]), ("200", "0,1023"))
        GoodRuns.check_fit(self, "--closed_form_only", data="run.csv.part")


class Flags(Lab):
    def check_flags(self, message, *arguments):
        return self.check_refused("/dev/none", 2, message, *arguments)

    def test_wrong_flags_exit_2(self):
        out = ["--out", "run.csv"]
        self.check_flags("--rate_hz is 10", *out, "--rate_hz", 10)
        self.check_flags("--rate_hz is 8001", *out, "--rate_hz", 8001, "--oversample", 2)
        self.check_flags("--oversample is 0; it must be 1 to 64", *out, "--oversample", 0)
        self.check_flags("--oversample is 65; it must be 1 to 64", *out, "--oversample", 65)
        for seconds in ("-1", "0", "nan", "inf", "x"):
            self.check_flags("--seconds is", *out, f"--seconds={seconds}")
        self.check_flags("--baud is 300", *out, "--baud", 300)
        self.check_flags("'stray' does not belong to a flag", *out, "stray")
        self.check_flags("did you mean --seconds?", *out, "--secnds", 3)

    def test_flags_that_do_not_belong_together_exit_2(self):
        out = ["--out", "run.csv"]
        self.check_flags("--rig belongs to a fit", *out, "--rig", "rig.json")
        self.check_flags("--model belongs to a fit", *out, "--model", "coulomb")
        self.check_flags("--fit needs a recording in a file", "--out", "-", "--fit")
        self.check_flags("give only one of", *out, "--info")
        self.check_flags("give only one of", "--list", "--info")
        self.check_flags("--seconds belongs to a recording", "--info", "--seconds", 3)
        self.check_flags("give only one of", "--counts", "--info")
        self.check_flags("--out is missing")
        self.write_calibration("cal.json", LINE)
        self.check_flags("would overwrite the input of --calibration", "--out", "cal.json", "--calibration", "cal.json",
                         "--overwrite")

    def test_help_version_and_list_succeed(self):
        for flag, pattern in (("--help", "--until_rest"), ("--version", r"^record_pendulum \d+\.\d+\.\d+$"), ("--list", ".")):
            out, err = self.run_tool("/dev/none", flag)
            self.assertRegex(out, pattern)
            self.assertEqual(err, "")


if __name__ == "__main__":
    unittest.main()
