# SPDX-License-Identifier: Apache-2.0
"""What a sanitizer changes for a test of a tool: the tool is ten times as slow, and its memory has no bound."""

import functools
import pathlib
import resource


@functools.cache
def is_sanitized(tool):
    program = pathlib.Path(tool).read_bytes()
    return b"__asan_init" in program or b"__tsan_init" in program


def memory_limit(tool, limit):
    """For preexec_fn: so many bytes of data; None where the sanitizer, which reserves more, would not even begin."""
    return None if is_sanitized(tool) else lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
