# SPDX-License-Identifier: Apache-2.0
"""Finds processes through /proc. Stops and continues them, so that a test can act at a defined point of their work."""

import contextlib
import os
import pathlib
import signal
import time


def read(pid, name):
    """A file of the process; empty if the process has ended or belongs to another user."""
    try:
        return pathlib.Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""


def all_pids():
    return [int(path.name) for path in pathlib.Path("/proc").iterdir() if path.name.isdigit()]


def name_of(pid):
    return read(pid, "comm").decode().strip()


def arguments_of(pid):
    return read(pid, "cmdline").split(b"\0")


def environment_of(pid):
    return read(pid, "environ").split(b"\0")


def parent_of(pid):
    after_name = read(pid, "stat").rpartition(b")")[2].split()
    return int(after_name[1]) if after_name else 0


def kill(pids, number=signal.SIGKILL):
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)


def has_signal(pid, number):
    """Whether the signal is pending for the stopped process, or the process has ended."""
    lines = read(pid, "status").decode().splitlines()
    waiting = [int(line.split()[1], 16) for line in lines if line.startswith(("SigPnd:", "ShdPnd:"))]
    return not waiting or any(mask >> (number - 1) & 1 for mask in waiting)


def wait_until(what, condition, seconds):
    """Waits until the condition is true and returns its value."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise TimeoutError(f"after {seconds} s this is still not true: {what}")


def continue_when_signalled(pids, number=signal.SIGTERM):
    """Continues stopped processes when the signal is pending for all of them."""
    wait_until(f"the signal is pending for {pids}", lambda: all(has_signal(pid, number) for pid in pids), 20)
    kill(pids, signal.SIGCONT)
