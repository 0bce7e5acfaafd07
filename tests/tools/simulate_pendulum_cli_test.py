#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""simulate_pendulum as a process: files, exit codes and messages. simulate_pendulum_cli_test.py PATH_OF_simulate_pendulum."""

import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

BINARY = pathlib.Path()
START = "release_angle=0.4,release_time=0.5"
MOTION = f"inertia=0.04,viscous=0.001,{START}"
SHORT = ["--duration", "1"]
SENSOR = '{"kind": "ideal", "clock": 0.0001}'  # so that noise and rig are not hidden
NOISY = ["--set", MOTION, "--noise", "0.2", "--resolution", "0.1985"]


class SimulatePendulumTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def run_tool(self, *arguments):
        return subprocess.run([BINARY, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=60)

    def check_refused(self, code, message, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(list(self.folder.glob("*.csv")), [])

    def check_made(self, *arguments):
        done = self.run_tool(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def write_rig(self, text):
        (self.folder / "rig.json").write_text(text)

    def test_writes_recording_and_truth(self):
        self.write_rig('{"gravity_torque": 1.8}')
        self.check_made(*NOISY, "--rig", "rig.json", "--out", "run.csv", "--truth", "truth.json", "--duration", "2")
        lines = (self.folder / "run.csv").read_text().splitlines()
        self.assertEqual(lines[1:4], ["# resolution: 0.1985", '# sensor: {"kind":"ideal"}', "time_s,angle_deg"])
        self.assertEqual(len(lines), 4 + 200)
        truth = json.loads((self.folder / "truth.json").read_text())
        self.assertEqual(list(truth), ["inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle",
                                       "sigma_rad", "resolution_rad", "seed"])
        self.assertEqual(truth["inertia"], 0.04)

    def test_rig_turns_si_into_the_same_motion(self):
        self.write_rig('{"gravity_torque": 2}')
        with_rig = self.check_made("--set", MOTION, "--rig", "rig.json", "--out", "-")
        without = self.check_made("--set", f"inertia=0.02,viscous=0.0005,{START}", "--out", "-")
        self.assertEqual(with_rig, without)

    def test_same_seed_gives_the_same_bytes_and_another_seed_others(self):
        once = self.check_made(*NOISY, "--out", "-", "--seed", "5", "--jitter", "0.001")
        again = self.check_made(*NOISY, "--out", "-", "--seed", "5", "--jitter", "0.001")
        other = self.check_made(*NOISY, "--out", "-", "--seed", "6", "--jitter", "0.001")
        self.assertEqual(once, again)
        self.assertNotEqual(once.splitlines()[5:], other.splitlines()[5:])

    def test_noise_may_be_correlated_or_have_heavy_tails(self):
        white = self.check_made(*NOISY, "--out", "-")
        correlated = self.check_made(*NOISY, "--out", "-", "--noise_correlation", "0.9")
        heavy = self.check_made(*NOISY, "--out", "-", "--noise_freedom", "3")
        self.assertEqual(len({white, correlated, heavy}), 3)
        self.check_refused(2, "--noise_correlation is 2", *NOISY, "--noise_correlation", "2", "--out", "run.csv")
        self.check_refused(2, "--noise_freedom is 1", *NOISY, "--noise_freedom", "1", "--out", "run.csv")

    def test_count_numbers_the_files_and_increments_the_seeds(self):
        self.check_made(*NOISY, "--out", "run.csv", "--truth", "truth.json", "--count", "3", "--seed", "5")
        names = sorted(path.name for path in self.folder.iterdir())
        self.assertEqual(names, [f"run_00{i}.csv" for i in (1, 2, 3)] + [f"truth_00{i}.json" for i in (1, 2, 3)])
        alone = self.check_made(*NOISY, "--out", "-", "--seed", "7")
        self.assertEqual((self.folder / "run_003.csv").read_text(), alone)
        self.assertEqual(json.loads((self.folder / "truth_003.json").read_text())["seed"], 7)

    def truths(self, pattern="truth_*.json"):
        return [json.loads(path.read_text()) for path in sorted(self.folder.glob(pattern))]

    def test_spread_scatters_the_truth_about_the_given_values(self):
        count = 400
        self.check_made("--set", MOTION, *SHORT, "--spread", "inertia=0.001,release_angle=0.02", "--count", str(count),
                        "--out", "run.csv", "--truth", "truth.json")
        truths = self.truths()
        for name, mean, std_dev in (("inertia", 0.04, 0.001), ("release_angle", 0.4, 0.02)):
            values = [truth[name] for truth in truths]
            # Four standard errors of the mean and of the standard deviation of `count` normal values.
            self.assertLess(abs(statistics.mean(values) - mean), 4 * std_dev / math.sqrt(count))
            self.assertLess(abs(statistics.stdev(values) - std_dev), 4 * std_dev / math.sqrt(2 * count))
        self.assertEqual({truth["viscous"] for truth in truths}, {0.001})
        self.assertEqual([truth["seed"] for truth in truths], list(range(1, count + 1)))

    def test_spread_changes_the_motion_but_not_the_noise(self):
        def values(text):
            return [math.radians(float(line.split(",")[1])) for line in text.splitlines()[3:]]

        arguments = ["--set", MOTION, *SHORT, "--noise", "0.2", "--out", "-", "--seed", "5"]
        plain = values(self.check_made(*arguments))
        self.check_made(*arguments[:-4], "--seed", "5", "--out", "x", "--truth", "truth.json", "--spread", "zero_angle=0.1")
        moved = values((self.folder / "x").read_text())
        zero = self.truths("truth.json")[0]["zero_angle"]
        self.assertNotEqual(zero, 0)
        for before, after in zip(plain, moved, strict=True):
            self.assertAlmostEqual(after - before, zero, places=12)

    def test_threads_make_no_difference(self):
        for threads in ("1", "2"):
            (self.folder / threads).mkdir()
            self.check_made(*NOISY, *SHORT, "--spread", "inertia=0.001", "--count", "50", "--threads", threads,
                            "--out", f"{threads}/run.csv", "--truth", f"{threads}/truth.json", "--manifest",
                            f"{threads}/runs.csv")
        files = [{path.name: path.read_bytes() for path in (self.folder / threads).iterdir()} for threads in "12"]
        self.assertEqual(len(files[0]), 101)
        self.assertEqual(files[0], files[1])

    def test_manifest_lists_the_recordings_with_their_truth(self):
        self.write_rig('{"gravity_torque": 2}')
        for name in ('runs, "all"', "lists"):
            (self.folder / name).mkdir()
        self.check_made(*NOISY, *SHORT, "--spread", "inertia=0.001,viscous=0.01,zero_angle=1e-7", "--rig", "rig.json",
                        "--count", "1005", "--seed", "7", "--out", 'runs, "all"/run.csv', "--truth", "truth.json",
                        "--manifest", "lists/runs.csv")
        with open(self.folder / "lists/runs.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file, strict=True))
        truths = self.truths()
        self.assertEqual(len(rows), 1005)
        parameters = ["inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle"]
        self.assertEqual(list(rows[0]), ["path", "id", "rig", "seed", *(f"true_{name}" for name in parameters)])
        for row, truth in zip(rows, truths, strict=True):
            self.assertEqual({name: float(row[f"true_{name}"]) for name in parameters},
                             {name: truth[name] for name in parameters})
            self.assertEqual(int(row["seed"]), truth["seed"])
            self.assertTrue((self.folder / "lists" / row["path"]).samefile(
                self.folder / 'runs, "all"' / f"{row['id']}.csv"))
            self.assertEqual(row["rig"], "../rig.json")
        self.assertGreater(min(truth["viscous"] for truth in truths), 0)  # its spread is ten times its value

    def test_manifest_may_go_to_standard_output(self):
        text = self.check_made(*NOISY, *SHORT, "--out", "run.csv", "--manifest", "-")
        self.assertEqual([line.split(",")[:4] for line in text.splitlines()],
                         [["path", "id", "seed", "true_inertia"], ["run.csv", "run", "1", "0.04"]])

    def test_manifest_is_checked_as_an_output(self):
        made = [*NOISY, *SHORT, "--count", "3", "--out", "run.csv"]
        self.check_refused(2, "--out run_002.csv is the output of --manifest too", *made, "--manifest", "run_002.csv")
        self.check_refused(2, "--manifest lists files", "--set", MOTION, "--out", "-", "--manifest", "runs.csv")
        self.check_refused(2, "--truth - is the output of --manifest too", *NOISY, "--out", "run.csv", "--truth", "-",
                           "--manifest", "-")
        self.check_refused(73, "cannot write none/runs.csv", *made, "--manifest", "none/runs.csv")
        (self.folder / "truth_002.json").mkdir()
        self.check_refused(73, "cannot write truth_002.json: it is a directory", *made, "--truth", "truth.json")

    def test_spread_and_threads_are_checked(self):
        made = ["--set", MOTION, "--out", "run.csv"]
        self.check_refused(2, "--spread: model coulomb has no parameter 'drag'", *made, "--spread", "drag=1")
        self.check_refused(2, "--spread: inertia is -1; it must be at least 0", *made, "--spread", "inertia=-1")
        self.check_refused(2, "initial_angle belongs to a start other than that of --set", *made, "--spread", "initial_angle=1")
        self.check_refused(2, "--spread contradicts --plan", *NOISY, "--plan", "--spread", "inertia=0.001")
        self.check_refused(2, "--threads is 1025; it must be 0 to 1024", *made, "--threads", "1025")

    def test_clock_starts_at_the_given_time_and_stamps_increase(self):
        text = self.check_made("--set", MOTION, "--out", "-", "--start_time", "100", "--jitter", "0.02")
        times = [float(line.split(",")[0]) for line in text.splitlines()[3:]]
        self.assertEqual(times[0], 100)
        self.assertTrue(all(before < after for before, after in zip(times, times[1:])))

    def test_units_name_the_column(self):
        for unit, column in (("deg", "angle_deg"), ("rad", "angle_rad"), ("deg_s", "gyro_deg_s"), ("rad_s", "gyro_rad_s")):
            text = self.check_made("--set", MOTION, "--out", "-", "--unit", unit)
            self.assertEqual(text.splitlines()[2], f"time_s,{column}")

    def test_an_existing_recording_is_replaced_and_survives_a_failure(self):
        run = self.folder / "run.csv"
        run.write_text("old")
        self.assertEqual(self.run_tool("--set", MOTION, "--out", "run.csv", "--truth", "none/t.json").returncode, 73)
        self.assertEqual(run.read_text(), "old")
        self.check_made("--set", MOTION, "--out", "run.csv")
        self.assertTrue(run.read_text().startswith("# simulate_pendulum "))

    def test_help_and_version_succeed_on_stdout(self):
        self.assertIn("viscous, coulomb, drag", self.check_made("--help"))
        self.assertRegex(self.check_made("--version"), r"^simulate_pendulum \d+\.\d+\.\d+\n$")

    def test_wrong_flags_exit_2(self):
        self.check_refused(2, "did you mean --noise?", "--niose", "1", "--set", MOTION, "--out", "run.csv")
        self.check_refused(2, "abc", "--rate", "abc", "--set", MOTION, "--out", "run.csv")
        self.check_refused(2, "--out is missing", "--set", MOTION)
        self.check_refused(2, "'stray' does not belong to a flag", "stray", "--set", MOTION, "--out", "run.csv")
        self.check_refused(2, "model coulomb has no parameter 'drag'; its parameters are inertia, viscous, coulomb, release_angle",
                           "--set", f"drag=1,{MOTION}", "--out", "run.csv")
        self.check_refused(2, "is the output of --truth too", "--set", MOTION, "--out", "run.csv", "--truth", "run.csv")

    def test_plan_predicts_on_stdout_and_makes_no_file(self):
        self.write_rig('{"gravity_torque": 2}')
        with_rig = self.check_made(*NOISY, "--plan", "--details", "--rig", "rig.json", "--sensor", SENSOR)
        self.assertRegex(with_rig, r"\n    inertia +0\.0400\d* +± 0\.000\d+ +kg m\^2 +1 +0\.\d+ +rig\n")
        self.assertRegex(with_rig, r"\n    duration +80 s +\d")
        without = self.check_made("--set", f"inertia=0.02,viscous=0.0005,{START}", *NOISY[2:], "--plan", "--details",
                                  "--sensor", SENSOR)
        self.assertRegex(without, r"\n    inertia +0\.0200\d* +± 0\.000\d+ +s\^2 +0\.\d+ +0\.\d+ +\w")
        rows = [[line for line in text.splitlines() if line.startswith("    resolution")] for text in (with_rig, without)]
        self.assertEqual(len(rows[0]), 6)
        of_noise = [[row.split()[:7] for row in of_text[3:]] for of_text in rows]
        self.assertEqual(of_noise[0], of_noise[1])  # % of inertia
        self.assertEqual([path.name for path in self.folder.iterdir()], ["rig.json"])

    def test_plan_has_the_errors_of_the_sensor_that_is_stated(self):
        sensor = '{"kind": "ideal", "clock": 0.003}'
        (self.folder / "sensor.json").write_text(sensor, encoding="utf-8")
        for stated in (sensor, "sensor.json"):
            text = self.check_made(*NOISY, "--plan", "--sensor", stated)
            self.assertRegex(text, r"\n    inertia .* 0\.6 +0\.\d+ +clock\n")
            self.assertIn("Improve first: clock; compare the recorder's clock with a watch", text)
            self.assertNotIn("Assumed", text)
        assumed = self.check_made(*NOISY, "--plan").replace("\n    ", " ")
        self.assertIn("Assumed: an angle sensor (--sensor); clock ±1 % for times on an exact grid (--sensor).", assumed)

    def test_plan_refuses_outputs_and_what_it_cannot_predict(self):
        self.check_refused(2, "--out contradicts --plan", *NOISY, "--plan", "--out", "run.csv")
        self.check_refused(2, "--count contradicts --plan", *NOISY, "--plan", "--count", "2")
        self.check_refused(2, "--plan needs --noise or --resolution", "--set", MOTION, "--plan")
        self.check_refused(2, "--sensor belongs to a plan", *NOISY, "--out", "run.csv", "--sensor", "ideal")
        self.check_refused(3, "--sensor takes a file or a kind", *NOISY, "--plan", "--sensor", "ideel")
        self.check_refused(5, "never moves", "--plan", "--noise", "1", "--set", f"inertia=0.04,coulomb=0.5,{START}")

    def test_missing_rig_exits_3_and_a_bad_one_4(self):
        self.check_refused(3, "rig.json", "--rig", "rig.json", "--set", MOTION, "--out", "run.csv")
        self.write_rig('{"gravity_torque": -1}')
        self.check_refused(4, "gravity_torque", "--rig", "rig.json", "--set", MOTION, "--out", "run.csv")

    def test_the_rig_is_not_overwritten(self):
        self.write_rig('{"gravity_torque": 1}')
        self.check_refused(2, "--rig", "--rig", "rig.json", "--set", MOTION, "--out", "rig.json")
        self.assertEqual((self.folder / "rig.json").read_text(), '{"gravity_torque": 1}')

    def test_a_pendulum_that_never_moves_exits_5(self):
        self.check_refused(5, "never moves", "--set", f"inertia=0.04,coulomb=0.5,{START}", "--out", "run.csv")
        self.check_refused(5, "comes after the last sample", "--set", "inertia=1,release_angle=1,release_time=99",
                           "--out", "run.csv")

    def test_an_output_that_cannot_be_written_exits_73(self):
        self.check_refused(73, "cannot write", "--set", MOTION, "--out", "none/run.csv")
        self.check_refused(73, "cannot write", "--set", MOTION, "--out", ".")


if __name__ == "__main__":
    BINARY = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
