# SPDX-License-Identifier: Apache-2.0
"""C++ sources as text, for the project's checks."""

import re

SUFFIXES = {".h", ".cc"}

# Numbers come before character literals, because of 2'000'000.
_TOKENS = re.compile(
    r"""(?P<number>\b\d(?:'?[\w.])*)
      | (?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<raw>R"(?P<mark>[^()\s]*)\(.*?\)(?P=mark)")
      | (?P<literal>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')""",
    re.VERBOSE | re.DOTALL)


def sources(folder):
    """The C++ files below a folder, in order."""
    return sorted(path for path in folder.rglob("*") if path.suffix in SUFFIXES)


def without_comments(text):
    """The text with comments blanked out; every character stays on its line."""
    return _TOKENS.sub(lambda token: _blank(token.group()) if token["comment"] else token.group(), text)


def code_only(text):
    """The text with comments and literals blanked out; every character stays on its line."""
    return _TOKENS.sub(lambda token: token.group() if token["number"] else _blank(token.group()), text)


def _blank(text):
    return re.sub(r"[^\n]", " ", text)
