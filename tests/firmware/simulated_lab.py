# SPDX-License-Identifier: Apache-2.0
"""A simulated logger as a process, for tests of programs that read it."""

import json
import pathlib
import subprocess
import time


PATIENCE_S = 120


class Logger:
    """Runs simulated_logger of a build until the with block ends. `port` is a file in a folder: the socket for the
    record_pendulum of tests/virtual_clock, or a pseudo terminal, where time is real."""

    def __init__(self, build, folder, *flags, board="uno", name="ttyPENDULUM", is_real_time=False):
        self.port = pathlib.Path(folder) / name
        self.command = [build / "tests/simulated_logger", "--firmware", build / f"firmware/pendulum_logger_{board}.elf",
                        "--board", board, "--link", self.port, *flags, *([] if is_real_time else ["--virtual_clock"])]
        self.process = None
        self.faults = {}

    def __enter__(self):
        self.process = subprocess.Popen([str(word) for word in self.command], stdout=subprocess.PIPE, text=True)
        end = time.monotonic() + PATIENCE_S
        while not self.port.exists():
            if self.process.poll() is not None or time.monotonic() > end:
                self.process.kill()
                raise AssertionError(f"the simulated board has no port; exit code {self.process.wait()}")
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        said = self.process.communicate(timeout=PATIENCE_S)[0]
        self.faults = json.loads(said)
        if any(self.faults.values()) or self.process.returncode != 0:
            raise AssertionError(f"the simulated board reports faults: {said}")
