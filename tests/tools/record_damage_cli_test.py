#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""record_pendulum with bad lines, ports and loggers: record_damage_cli_test.py PATH_OF_record_pendulum."""

import random
import signal
import time
import unittest

from python_logger import DONE, OUT_OF_RANGE, UNKNOWN, WRONG_STATE, Lab, Line, Noise, PythonLogger, frame, load_in_parallel

SECONDS, SAMPLES, BLOCK = 4, 800, 8  # a run at 200 Hz with 8 samples per frame

load_tests = load_in_parallel


class Damage:
    """Damages every sixth frame except the first and the last ones: harm(random numbers, the frame's bytes)."""

    def __init__(self, harm):
        self.harm, self.hits = harm, 0

    def __call__(self, number, data):
        if number % 6 != 5 or number > 80:
            return data
        self.hits += 1
        return self.harm(random.Random(number), data)


def flipped(chance, data):
    data = bytearray(data)
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return bytes(data)


def changed(chance, data):
    """Changes several bytes, but never to the end marker of a frame."""
    data = bytearray(data)
    for at in chance.sample(range(len(data) - 1), 4):
        data[at] = chance.randrange(1, 256)
    return bytes(data)


class DamagedFrames(Lab):
    def check_sound(self, logger, out, samples=SAMPLES):
        """Checks that each row is a sample at its time and that losses are reported; returns the number of lost samples."""
        _, named, rows = self.read()
        sent = dict(self.expected(logger, logger.taken))
        self.assertEqual([row for row in rows if sent.get(row[0]) != row[1]], [])
        times = [time_s for time_s, _ in rows]
        self.assertEqual(times, sorted(set(times)))
        lost = samples - len(rows)
        self.assertEqual(named["lost_samples"], str(lost))
        self.assertIn(f"; {lost} lost" if lost else "; none lost", out)
        return lost

    def check_harm(self, harm, most=2):
        """most: number of frames that may be lost because of one damaged frame."""
        damage = Damage(harm)
        with PythonLogger(speed=2, damage=damage) as logger:
            out, _ = self.record(logger, "--seconds", SECONDS, code=1)
        lost = self.check_sound(logger, out)
        self.assertGreater(damage.hits, 10)
        self.assertGreaterEqual(lost, damage.hits * BLOCK)
        self.assertLessEqual(lost, damage.hits * BLOCK * most)
        self.assertIn(f"{lost} samples are missing; {lost} were damaged or lost on the line", out)

    def test_flipped_bits(self):
        self.check_harm(flipped)

    def test_changed_bytes(self):
        self.check_harm(changed, most=1)

    def test_zeros_in_a_frame(self):
        self.check_harm(lambda chance, data: data[:9] + b"\0" * chance.randrange(1, 4) + data[9:], most=1)

    def test_lost_bytes(self):
        self.check_harm(lambda chance, data: data[:chance.randrange(1, 12)] + data[chance.randrange(13, 27):], most=1)

    def test_inserted_bytes(self):
        self.check_harm(lambda chance, data: data[:20] + chance.randbytes(9) + data[20:], most=1)

    def test_frames_cut_at_the_end(self):
        self.check_harm(lambda chance, data: data[:chance.randrange(1, len(data))])

    def test_frames_cut_at_the_beginning(self):
        self.check_harm(lambda chance, data: data[chance.randrange(1, len(data) - 1):], most=1)

    def test_dropped_frames(self):
        self.check_harm(lambda chance, data: b"", most=1)

    def test_bursts_of_noise(self):
        self.check_harm(lambda chance, data: chance.randbytes(3000))

    def test_reordered_frames(self):
        held = []

        def swap(number, data):
            if number % 6 == 4 and 3 < number < 80:
                held.append(data)
                return b""
            return data + held[-1] if number % 6 == 5 and 3 < number < 80 else data

        with PythonLogger(speed=2, damage=swap) as logger:
            out, _ = self.record(logger, "--seconds", SECONDS, code=1)
        self.assertEqual(self.check_sound(logger, out), len(held) * BLOCK)
        self.assertIn(f"{len(held)} frames contradicted the run", out)

    def test_duplicated_frames_lose_nothing(self):
        damage = Damage(lambda chance, data: data * 2)
        with PythonLogger(speed=2, damage=damage) as logger:
            out, _ = self.record(logger, "--seconds", SECONDS)
        self.assertEqual(self.check_sound(logger, out), 0)
        self.assertIn(f"{damage.hits} frames contradicted the run", out)

    def test_the_first_frame_is_lost(self):
        with PythonLogger(speed=2, damage=lambda number, data: data if number else b"") as logger:
            out, _ = self.record(logger, "--seconds", SECONDS, code=1)
        self.check_rows(logger, logger.taken[BLOCK:][:SAMPLES])
        self.assertEqual(self.read()[1]["lost_samples"], str(BLOCK))
        self.assertIn(f"; {BLOCK} lost", out)

    def test_frames_with_impossible_content_are_ignored(self):
        """Frames with a correct CRC but impossible content are ignored."""
        events = {10: lambda logger: logger.send(logger.data_payload(logger.tick + 123, [1] * 8)),
                  12: lambda logger: logger.send(logger.data_payload(logger.tick, [500, 1024])),
                  14: lambda logger: logger.send(logger.data_payload(logger.tick, [])),
                  16: lambda logger: logger.send(logger.data_payload(logger.tick, [1] * 17)),
                  18: lambda logger: logger.send(logger.data_payload(logger.tick, [1] * 4) + b"\1"),
                  20: lambda logger: logger.send(logger.data_payload(logger.tick, [1] * 4)[:-1]),
                  22: lambda logger: logger.send(b"Z" + bytes(9)),
                  24: lambda logger: logger.send(b"AR\1"),
                  26: lambda logger: logger.send(logger.data_payload(logger.tick - 40 * logger.step, [1] * 4))}
        with PythonLogger(speed=2, events=events) as logger:
            out, _ = self.record(logger, "--seconds", SECONDS)
        self.check_rows(logger, logger.taken[:SAMPLES])
        self.assertIn("frames contradicted the run", out)

    def test_samples_that_did_not_fit_into_the_logger(self):
        events = {10: lambda logger: logger.drop(5), 30: lambda logger: logger.drop(100)}
        with PythonLogger(speed=2, events=events) as logger:
            out, _ = self.record(logger, "--seconds", SECONDS, code=1)
        self.assertEqual(self.check_sound(logger, out), 105)
        self.assertIn("105 samples are missing; 105 did not fit into the logger", out)


class Ends(Lab):
    def test_more_samples_were_sent_than_arrived(self):
        with PythonLogger() as logger:
            logger.more_sent = 8
            process = self.start(logger, "--out", "run.csv")
            self.wait_for_samples(logger, 200)
            process.send_signal(signal.SIGINT)
            out, _ = self.finish(process, code=1)
        self.check_rows(logger, logger.taken)
        self.assertEqual(self.read()[1]["lost_samples"], "8")
        self.assertIn("; 8 lost", out)

    def test_losses_after_the_requested_time_do_not_count(self):
        with PythonLogger(speed=2, damage=lambda number, data: b"" if number > 50 else data) as logger:
            stop = logger.stop
            logger.stop = lambda content: time.sleep(0.1) or stop(content)  # so that more frames arrive
            out, _ = self.record(logger, "--seconds", 2)
        self.assertGreater(len(logger.taken), 51 * BLOCK)
        self.check_rows(logger, logger.taken[:400])
        self.assertEqual(self.read()[1]["lost_samples"], "0")
        self.assertIn("none lost", out)

    def test_the_number_of_sent_samples_never_arrives(self):
        with PythonLogger(speed=2) as logger:
            logger.is_endless = True
            out, _ = self.record(logger, "--seconds", 2, code=1)
        self.check_rows(logger, logger.taken[:400])
        self.assertIn("the logger's message about the end of the run did not arrive", self.read()[0])
        self.assertIn("did not report how many samples it had sent", out)

    def lose(self, event, why, *arguments):
        """The connection is lost in mid-run; all data sent before is in the file."""
        with PythonLogger(speed=2, events={50: event}) as logger:
            out, _ = self.record(logger, *arguments, code=1)
        self.assertIn("ended too early", out)
        self.assertIn(why, out)
        self.assertGreaterEqual(len(logger.taken), 400)
        self.check_rows(logger, logger.taken)

    def test_the_port_disappears(self):
        self.lose(PythonLogger.unplug, "was disconnected", "--seconds", 10)

    def test_the_port_disappears_in_a_run_of_unlimited_length(self):
        self.lose(PythonLogger.unplug, "was disconnected")

    def test_the_logger_falls_silent(self):
        self.lose(PythonLogger.fall_silent, "stopped sending", "--until_rest")

    def test_the_logger_starts_again(self):
        self.lose(PythonLogger.restart, "the logger restarted", "--seconds", 10)

    def test_the_logger_ends_the_run_by_itself(self):
        self.lose(lambda logger: logger.stop(b""), "ended the run on its own", "--seconds", 10)

    def test_the_logger_falls_silent_and_is_interrupted(self):
        with PythonLogger(events={50: PythonLogger.fall_silent}) as logger:
            process = self.start(logger, "--out", "run.csv")
            self.wait_until(lambda: logger.is_silent, "silence")
            process.send_signal(signal.SIGINT)
            self.finish(process, code=1)
        self.check_rows(logger, logger.taken)

    def test_a_recorder_that_was_suspended_loses_nothing(self):
        with PythonLogger() as logger:
            process = self.start(logger, "--out", "run.csv", "--seconds", 6)
            self.wait_for_samples(logger, 200)
            process.send_signal(signal.SIGSTOP)
            time.sleep(4)
            process.send_signal(signal.SIGCONT)
            out, _ = self.finish(process)
        self.assertIn("none lost", out)
        self.check_rows(logger, logger.taken[:1200])

    def test_no_data_arrives(self):
        with PythonLogger(events={0: PythonLogger.fall_silent}) as logger:
            self.check_refused(logger, 4, "nothing was recorded: the logger stopped sending", "--out", "run.csv")


class BadPorts(Lab):
    def test_no_such_port(self):
        self.check_refused("/dev/ttyNone0", 3, "there is no port /dev/ttyNone0", "--out", "run.csv")
        self.check_refused("/dev/ttyNone0", 3, "there is no port /dev/ttyNone0", "--info")

    def test_a_file_instead_of_a_port(self):
        (self.folder / "port").write_text("a file")
        self.check_refused("port", 4, "port is not a serial port", "--out", "run.csv")
        self.check_refused("/dev/null", 4, "/dev/null is not a serial port", "--out", "run.csv")
        self.check_refused(".", 4, "cannot open .", "--out", "run.csv")
        self.assertEqual((self.folder / "port").read_text(), "a file")

    def test_a_port_in_use_is_left_alone(self):
        with PythonLogger() as logger:
            first = self.start(logger, "--out", "first.csv", "--seconds", 2)
            self.wait_for_samples(logger, 80)
            out, err = self.finish(self.start(logger.port, "--out", "second.csv"), code=75)
            self.assertIn(f"{logger.port} is in use by another", err)
            self.finish(first)
        self.assertFalse((self.folder / "second.csv").exists())
        self.check_rows(logger, logger.taken[:400], "first.csv")

    def test_no_logger_answers(self):
        with Line() as line:
            self.check_refused(line, 4, f"no logger answers on {line.port}", "--out", "run.csv")

    def test_random_bytes(self):
        with Noise(seed=7) as noise:
            err = self.check_refused(noise, 4, f"the device on {noise.port} is not a pendulum_logger", "--out", "run.csv")
        self.assertGreater(noise.sent, 1 << 20)
        self.assertIn("no answer", err)


class LostAnswer(PythonLogger):
    """The first answer to the start command is lost on the line."""

    def start(self, content):
        status = super().start(content)
        return None if status == DONE else status


class LostCommands(PythonLogger):
    """The first copy of each command is lost on the line."""

    def obey(self, command, content):
        if self.commands.count(command + content) > 1:
            super().obey(command, content)


class BadLoggers(Lab):
    def test_another_protocol(self):
        with PythonLogger(protocol=2) as logger:
            self.check_refused(logger, 4, "speaks version 2 of the protocol, but this record_pendulum speaks version 1", "--out",
                               "run.csv")
            self.assertNotIn(b"S", logger.commands)

    def test_another_protocol_with_another_info(self):
        with Line() as line:
            line.speak = lambda: line.waiting.extend(b"" if line.waiting else frame(b"I\x02more"))
            self.check_refused(line, 4, "speaks version 2 of the protocol", "--info")

    def test_a_logger_with_another_tick_rate(self):
        """The recorded times would be wrong by a constant factor."""
        with PythonLogger(ticks=1_000_000) as logger:
            self.check_refused(logger, 4, "1000000", "--out", "run.csv", "--seconds", 1)

    def test_a_logger_with_another_converter(self):
        """The readings would be counted as saturated, or the recording would give a wrong range."""
        with PythonLogger(bits=12) as logger:
            self.check_refused(logger, 4, "12", "--out", "run.csv", "--seconds", 1)

    def test_a_refused_rate(self):
        with PythonLogger(answers={b"R": OUT_OF_RANGE}) as logger:
            self.check_refused(logger, 4, "the logger refuses 200 Hz: a value is out of its range", "--out", "run.csv")

    def test_a_refused_start(self):
        with PythonLogger(answers={b"S": UNKNOWN}) as logger:
            self.check_refused(logger, 4, "the logger refuses to start: it does not know the command", "--out", "run.csv")

    def test_a_refused_calibration(self):
        self.write_calibration("cal.json", [-134.5, 0.2637])
        with PythonLogger(answers={b"W": WRONG_STATE}) as logger:
            self.check_refused(logger, 4, "the logger refuses the calibration: it is recording", "--store_calibration",
                               "cal.json")

    def test_a_start_that_is_never_acknowledged(self):
        with PythonLogger(answers={b"S": None}) as logger:
            err = self.check_refused(logger, 4, logger.port, "--out", "run.csv")
            self.assertGreater(logger.commands.count(b"S"), 1)
        self.assertNotIn("is not a pendulum_logger", err)  # it has identified itself

    def test_a_start_whose_answer_is_lost(self):
        with LostAnswer() as logger:
            self.record(logger, "--seconds", 2)
        self.check_rows(logger, logger.taken[:400])  # the first samples show that it has started

    def test_commands_that_are_lost_are_repeated(self):
        with LostCommands(speed=2) as logger:
            self.record(logger, "--seconds", 2)
        self.check_rows(logger, logger.taken[:400])

    def test_a_failed_start_is_followed_by_a_stop(self):
        """The start may have succeeded with only the answers lost, so the host must stop the logger."""
        with PythonLogger(answers={b"S": None}) as logger:
            self.check_refused(logger, 4, "", "--out", "run.csv")
        self.assertEqual(logger.commands[-1], b"X")

    def test_a_board_that_sends_boot_messages_before_it_answers(self):
        with PythonLogger(speed=2) as logger:
            logger.is_silent = True
            process = self.start(logger, "--out", "run.csv", "--seconds", 1)
            logger.waiting += b"\x14\x10boot loader\r\n"
            time.sleep(2)
            logger.is_silent = False
            logger.say_info()
            self.finish(process)
        self.check_rows(logger, logger.taken[:200])

    def test_a_logger_that_is_slow_to_answer(self):
        """The logger answers each repeated command; the late answers arrive among the following frames."""
        with PythonLogger(speed=2) as logger:
            obey = logger.obey
            late = []
            logger.obey = lambda command, content: late.append((time.monotonic() + 0.7, command, content))
            speak = logger.speak

            def answer_and_speak():
                while late and late[0][0] < time.monotonic():
                    obey(*late.pop(0)[1:])
                speak()

            logger.speak = answer_and_speak
            self.record(logger, "--seconds", 2)
        self.check_rows(logger, logger.taken[:400])


if __name__ == "__main__":
    unittest.main()
