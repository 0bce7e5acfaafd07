# SPDX-License-Identifier: Apache-2.0
"""A simulated logger as a process, for tests of programs that read it."""

import json
import pathlib
import subprocess
import time


class Logger:
    """Runs simulated_logger of a build, behind the pseudo terminal `port` in a folder, until the with block ends."""

    def __init__(self, build, folder, *flags, board="uno", name="ttyPENDULUM"):
        self.port = pathlib.Path(folder) / name
        self.command = [build / "tests/simulated_logger", "--firmware", build / f"firmware/pendulum_logger_{board}.elf",
                        "--board", board, "--link", self.port, *flags]
        self.process = None
        self.faults = {}

    def __enter__(self):
        self.process = subprocess.Popen([str(word) for word in self.command], stdout=subprocess.PIPE, text=True)
        for _ in range(500):
            if self.port.is_symlink() or self.process.poll() is not None:
                break
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        said = self.process.communicate(timeout=60)[0]
        self.faults = json.loads(said)
        if any(self.faults.values()) or self.process.returncode != 0:
            raise AssertionError(f"the simulated board reports faults: {said}")
