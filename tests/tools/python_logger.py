# SPDX-License-Identifier: Apache-2.0
"""A logger simulated in Python over a pseudo terminal, and a folder for its recordings.

It implements "The protocol" in src/docs/hardware.md and shares no code with the C++ of firmware or host. A logger
stores for the tests: its samples of all runs (`taken`), the received commands (`commands`), and received bytes that
were not a frame (`garbage`).
"""

import binascii
import collections
import concurrent.futures
import fcntl
import json
import math
import os
import pathlib
import random
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import time
import tty
import unittest

TOOL = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path("record_pendulum")
TIMEOUT_S = 120  # a sanitizer makes everything ten times as slow
TICKS_PER_S = 2_000_000
DONE, UNKNOWN, OUT_OF_RANGE, WRONG_STATE = range(4)  # status of an answer

Sample = collections.namedtuple("Sample", "tick sum frame")  # tick since the logger's reset, not modulo 2^32


def crc16(payload):
    """CRC-16/IBM-3740, bit by bit."""
    crc = 0xFFFF
    for byte in payload:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


assert crc16(b"123456789") == binascii.crc_hqx(b"123456789", 0xFFFF) == 0x29B1


def cobs_encode(data):
    """Groups of bytes without a 0, each after its length + 1; a 0 ends each group except the last (fewer than 254 bytes)."""
    return b"".join(bytes([len(group) + 1]) + group for group in data.split(b"\0"))


def cobs_decode(encoded):
    groups = []
    while encoded:
        if not 0 < encoded[0] <= len(encoded):
            return None
        groups.append(encoded[1:encoded[0]])
        encoded = encoded[encoded[0]:]
    return b"\0".join(groups)


def frame(payload):
    return cobs_encode(payload + struct.pack("<H", crc16(payload))) + b"\0"


def payload_of(encoded):
    """The payload of a frame without its 0; None if the frame is invalid."""
    data = cobs_decode(encoded)
    if data is None or len(data) < 3 or struct.pack("<H", crc16(data[:-2])) != data[-2:]:
        return None
    return data[:-2]


def swing(decay_s=20.0, period_s=1.0, amplitude=300.0):
    """Counts of a decaying swing about the middle of the range, as a function of time in s."""

    def counts(seconds):
        return round(512 + amplitude * math.exp(-seconds / decay_s) * math.cos(2 * math.pi * seconds / period_s))

    return counts


class Line:
    """The far end of a pseudo terminal at `port`: it reads and sends nothing. Subclasses send in `speak`."""

    def __init__(self):
        self.master, self.slave = os.openpty()  # the slave stays open, so programs can open and close it
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.port = os.ttyname(self.slave)
        self.waiting = bytearray()  # still to be sent
        self.closing = self.is_unplugged = False
        self.trouble = None  # an exception of the thread
        self.thread = threading.Thread(target=self.run, daemon=True)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.closing = True
        self.thread.join()
        for descriptor in [self.slave] if self.is_unplugged else [self.slave, self.master]:
            os.close(descriptor)
        if self.trouble:
            raise self.trouble

    def release(self):
        """Lets the next program open the port, as after closing a real port; a pseudo terminal would keep TIOCEXCL."""
        fcntl.ioctl(self.slave, termios.TIOCNXCL)

    def run(self):
        try:
            while not self.closing and not self.is_unplugged:
                self.turn()
        except Exception as trouble:  # reported by __exit__
            self.trouble = trouble

    def turn(self):
        readable, writable, _ = select.select([self.master], [self.master] if self.waiting else [], [], 0.005)
        if readable:
            self.hear(os.read(self.master, 4096))
        self.speak()
        if writable and not self.is_unplugged:
            del self.waiting[:os.write(self.master, self.waiting[:4096])]

    def hear(self, data):
        pass

    def speak(self):
        pass

    def unplug(self):
        """Removes the port, after the host had time to read the sent data."""
        os.set_blocking(self.master, True)
        os.write(self.master, self.waiting)
        time.sleep(0.5)
        os.close(self.master)
        self.is_unplugged = True


class Noise(Line):
    """Random bytes, as many as the line accepts."""

    def __init__(self, seed):
        super().__init__()
        self.random = random.Random(seed)
        self.sent = 0

    def speak(self):
        if len(self.waiting) < 4096:
            self.waiting += self.random.randbytes(1 << 16)
            self.sent += 1 << 16


class PythonLogger(Line):
    """A logger that runs `speed` times as fast as the clock.

    damage: function of (number of a frame, its bytes) that returns the bytes to send instead. events: actions on the
    logger before a frame is sent, by frame number. answers: status by command, None for no answer. info: fields that
    differ.
    """

    def __init__(self, speed=1.0, swing=swing(), first_tick=0, damage=None, events=None, answers=None, **info):
        super().__init__()
        self.speed, self.swing, self.first_tick = speed, swing, first_tick
        self.damage = damage or (lambda number, data: data)
        self.events, self.answers = events or {}, answers or {}
        self.info = {"protocol": 1, "firmware": 0x0100, "board": 1, "reference": 1, "bits": 10, "ticks": TICKS_PER_S,
                     "baud": 115200, "runs": 0, "is_calibrated": 0, "calibration": (0.0,) * 5, **info}
        self.period, self.oversample = 10000, 1
        self.is_running = self.is_silent = self.is_endless = False
        self.taken, self.commands, self.garbage = [], [], []
        self.dropped = self.more_sent = 0  # samples: dropped by the logger; excess of the End frame's count
        self.raw = self.heard = b""  # all received bytes; the bytes of an incomplete frame

    # Input from the host.

    def hear(self, data):
        self.raw += data
        *pieces, self.heard = (self.heard + data).split(b"\0")
        for piece in filter(None, pieces):
            payload = payload_of(piece)
            (self.garbage if payload is None else self.commands).append(piece if payload is None else payload)
            if payload is not None and not self.is_silent:
                self.obey(payload[:1], payload[1:])

    def obey(self, command, content):
        if command == b"I" and not content:
            return self.say_info()
        status = self.answers.get(command, DONE)
        if status == DONE:
            status = {b"S": self.start, b"X": self.stop, b"R": self.set_rate, b"W": self.store}.get(
                command, lambda _: UNKNOWN)(content)
        if status is not None:
            self.send(b"A" + command + bytes([status]))
        return None

    def start(self, content):
        if content or self.is_running:
            return WRONG_STATE if self.is_running else UNKNOWN
        self.is_running, self.frames, self.begun, self.dropped = True, 0, time.monotonic(), 0
        self.run_begin, self.tick = len(self.taken), self.first_tick
        self.info["runs"] += 1
        return DONE

    def stop(self, content):
        if content:
            return UNKNOWN
        if self.is_running:
            self.send_block(min(self.samples_due(), 16))
            self.is_running = False
            sent = len(self.taken) - self.run_begin + self.more_sent
            if not self.is_endless:
                self.send(b"E" + struct.pack("<3I", sent, self.dropped, 0))
        return DONE

    def set_rate(self, content):
        if len(content) != 3 or self.is_running:
            return WRONG_STATE if self.is_running else UNKNOWN
        period, oversample = struct.unpack("<HB", content)
        if not (250 <= period <= 62500 and 1 <= oversample <= 64):
            return OUT_OF_RANGE
        self.period, self.oversample = period, oversample
        return DONE

    def store(self, content):
        if len(content) != 20 or self.is_running:
            return WRONG_STATE if self.is_running else UNKNOWN
        self.info.update(is_calibrated=1, calibration=struct.unpack("<5f", content))
        return DONE

    # Output to the host.

    def send(self, payload):
        self.waiting += frame(payload)

    def say_info(self):
        i = self.info
        self.send(b"I" + struct.pack("<BHBBBIIHBBHB5f", i["protocol"], i["firmware"], i["board"], i["reference"], i["bits"],
                                     i["ticks"], i["baud"], self.period, self.oversample, self.is_running, i["runs"],
                                     i["is_calibrated"], *i["calibration"]))

    @property
    def step(self):
        return self.period * self.oversample

    def samples_due(self):
        elapsed = (time.monotonic() - self.begun) * self.speed * TICKS_PER_S
        return max(0, int((elapsed - (self.tick - self.first_tick)) / self.step))

    def speak(self):
        block = min(16, max(1, TICKS_PER_S // 25 // self.step))
        while self.is_running and not self.is_unplugged and self.samples_due() >= block and len(self.waiting) < 1 << 16:
            event = self.events.get(self.frames)
            if event:
                event(self)
            if self.is_running and not self.is_unplugged:
                self.send_block(block)

    def send_block(self, count):
        """Sends the next samples as one frame."""
        if count == 0:
            return
        sums = [self.next_sum(self.tick + i * self.step) for i in range(count)]
        self.taken += [Sample(self.tick + i * self.step, each, self.frames) for i, each in enumerate(sums)]
        self.waiting += self.damage(self.frames, frame(self.data_payload(self.tick, sums)))
        self.frames += 1
        self.tick += count * self.step

    def data_payload(self, tick, sums):
        return b"D" + struct.pack(f"<HIHHB{len(sums)}H", self.frames % 2**16, tick % 2**32, self.dropped, 0, len(sums), *sums)

    def next_sum(self, tick):
        """The sum of the conversions of a sample."""
        ticks = (tick - self.first_tick + i * self.period for i in range(self.oversample))
        return sum(self.swing(each / TICKS_PER_S) for each in ticks)

    # Events.

    def drop(self, samples):
        """Drops samples as if the ring buffer was full."""
        self.dropped += samples
        self.tick += samples * self.step

    def fall_silent(self):
        self.is_running, self.is_silent = False, True

    def restart(self):
        self.is_running = False
        self.say_info()


class Lab(unittest.TestCase):
    """A separate folder for each test, and functions to read recordings."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="record_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def start(self, line, *arguments, **options):
        """Starts the tool. `line`: a Line, or the path of a port."""
        if isinstance(line, Line):
            line.release()
        port = line.port if isinstance(line, Line) else line
        process = subprocess.Popen([TOOL, "--port", port, *map(str, arguments)], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        process.kill()
        with process:
            pass

    def finish(self, process, code=0):
        """The process's standard output and standard error."""
        out, err = process.communicate(timeout=TIMEOUT_S)
        self.assertEqual(process.returncode, code, f"{process.args}\n{out}{err}")
        return " ".join(out.split()), err

    def run_tool(self, line, *arguments, code=0):
        return self.finish(self.start(line, *arguments), code)

    def record(self, line, *arguments, code=0):
        out, err = self.run_tool(line, "--out", "run.csv", *arguments, code=code)
        self.assertFalse((self.folder / "run.csv.part").exists())
        return out, err

    def check_refused(self, line, code, message, *arguments):
        """Checks that one sentence gives the reason and that no file is left."""
        before = sorted(self.folder.iterdir())
        out, err = self.run_tool(line, *arguments, code=code)
        self.assertIn(message, err)
        self.assertRegex(err, r"\Arecord_pendulum: [^\n]+\n\Z")
        self.assertEqual(out, "")
        self.assertEqual(sorted(self.folder.iterdir()), before)
        return err

    def wait_until(self, condition, what):
        end = time.monotonic() + TIMEOUT_S
        while not condition():
            self.assertLess(time.monotonic(), end, f"never: {what}")
            time.sleep(0.005)

    def wait_for_samples(self, logger, count):
        self.wait_until(lambda: len(logger.taken) >= count, f"{count} samples")

    def read(self, name="run.csv"):
        """Comments, named comments and rows of a recording."""
        lines = (self.folder / name).read_text(encoding="utf-8").splitlines()
        remarks = [line[2:] for line in lines if line.startswith("# ")]
        self.assertEqual(lines[len(remarks)], "time_s,adc_counts")
        rows = [tuple(map(float, line.split(","))) for line in lines[len(remarks) + 1:]]
        return remarks, dict(remark.split(": ", 1) for remark in remarks if ": " in remark), rows

    def expected(self, logger, samples):
        """Expected rows for these samples, with times since the first one."""
        return [((each.tick - samples[0].tick) / TICKS_PER_S, each.sum / logger.oversample) for each in samples]

    def check_rows(self, logger, samples, name="run.csv"):
        rows = self.read(name)[2]
        self.assertEqual(len(rows), len(samples))
        self.assertEqual(rows, self.expected(logger, samples))

    def write_calibration(self, name, coefficients, covariance=None, unit="counts"):
        content = {"schema_version": 1, "input": unit, "angle_unit": "deg", "coefficients": coefficients}
        if covariance:
            content["covariance"] = covariance
        (self.folder / name).write_text(json.dumps(content), encoding="utf-8")


class ParallelSuite(unittest.TestSuite):
    """Runs its tests in parallel, because they wait most of the time."""

    def run(self, result, debug=False):
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda test: test(result), each_test(self)))
        return result


def each_test(suite):
    for test in suite:
        yield from each_test(test) if isinstance(test, unittest.TestSuite) else [test]


def load_in_parallel(_loader, tests, _pattern):
    """A module assigns this function to load_tests, so that its tests run in parallel."""
    return ParallelSuite(tests)
