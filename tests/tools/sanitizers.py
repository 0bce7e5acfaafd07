# SPDX-License-Identifier: Apache-2.0
"""The effect of a sanitizer on a tool's test: the tool is ten times as slow, and its memory cannot be limited."""

import functools
import pathlib
import resource


@functools.cache
def is_sanitized(tool):
    program = pathlib.Path(tool).read_bytes()
    return b"__asan_init" in program or b"__tsan_init" in program


def memory_limit(tool, limit):
    """For preexec_fn: limits the data to so many bytes; None with a sanitizer, which reserves more and could not start."""
    return None if is_sanitized(tool) else lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
