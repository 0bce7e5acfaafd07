#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Proves that files and functions stay small, public headers are explained, and tests keep up with the code.

  check_sizes.py [ROOT]       prints the figures, then each that is out of bounds; exit code 1 if there is one
  check_sizes.py --self_test  shows on small texts that functions are found and measured

A function's length is that from its opening to its closing brace, in lines.
"""

import argparse
import math
import pathlib
import re
import sys

import cpp_text

FILE_MAX = 400
FUNCTION_P90 = 20
FUNCTION_MAX = 60
HEADER_COMMENTS = (0.25, 0.40)  # lines that carry a comment / lines that are not blank
TEST_LINES_MIN = 0.8  # lines of tests / lines of include and src, blank ones apart

_TYPE = re.compile(r"\b(?:namespace|class|struct|union|enum|extern)\b[^()=]*(?:\([^()]*\)[^()=]*)?$")
_END_OF_HEAD = re.compile(r"(?:\)|\b(?:const|noexcept|override|final|mutable)|\)\s*:.*\})\s*$", re.DOTALL)


def is_function(head):
    """Whether a brace after this text, in a namespace or class, opens a function's body."""
    if "(" not in head or head.count("(") != head.count(")"):
        return False
    before_parameters = head[:head.index("(")]
    if re.search(r"\bconcept\b", head) or re.search(r"(?<!operator)(?<!operator[=!<>])=", before_parameters):
        return False
    returns = re.search(r"\)[^()]*->[^()]*$", head)
    return bool(_END_OF_HEAD.search(head) or returns or re.search(r"\brequires\b", head))


def brace_kind(head):
    """What a brace after this text, outside of functions, opens."""
    if is_function(head):
        return "function"
    return "type" if _TYPE.search(head) else "initializer"


def functions(text):
    """(name, first line, length) of each function that is not inside another."""
    code = re.sub(r"(?m)^\s*#(?:[^\n]*\\\n)*[^\n]*", lambda line: re.sub(r"[^\n]", " ", line.group()),
                  cpp_text.code_only(text))
    found, open_braces, head_start, line = [], [], 0, 1
    for mark in re.finditer(r"[{};\n]", code):
        in_function = any(kind == "function" for kind, *_ in open_braces)
        in_initializer = bool(open_braces) and open_braces[-1][0] == "initializer"
        ends_head = not in_initializer
        if mark[0] == "\n":
            line += 1
            continue
        if mark[0] == "{":
            head = re.sub(r"\b(?:public|private|protected):", "", code[head_start:mark.start()]).strip()
            kind = "block" if in_function else brace_kind(head)
            open_braces.append((kind, head, line))
            ends_head = kind != "initializer"
        elif mark[0] == "}" and open_braces:
            kind, head, first_line = open_braces.pop()
            if kind == "function":
                name = re.search(r"(operator\s*\S+?|[~\w:]+)\s*\(", head)
                found.append((name[1] if name else head, first_line, line - first_line + 1))
        if ends_head:
            head_start = mark.end()
    return found


def comment_share(texts):
    """Lines that carry a comment over lines that are not blank; the licence line counts as neither."""
    with_comment = not_blank = 0
    for text in texts:
        for line, code in zip(text.splitlines(), cpp_text.without_comments(text).splitlines()):
            if line.strip() and "SPDX-License-Identifier" not in line:
                not_blank += 1
                with_comment += line != code
    return with_comment / max(not_blank, 1)


def quantile(values, share):
    """The smallest value that at least this share of the values does not exceed."""
    return sorted(values)[math.ceil(len(values) * share) - 1] if values else 0


def lines_not_blank(texts):
    return sum(bool(line.strip()) for text in texts for line in text.splitlines())


def complaints(root):
    """Every figure that is out of bounds; prints all figures on the way."""
    texts = {path.relative_to(root): path.read_text()
             for top in ("include", "src", "tests") for path in cpp_text.sources(root / top)}
    headers = [text for path, text in texts.items() if path.parts[0] == "include"]
    product = [text for path, text in texts.items() if path.parts[0] != "tests"]
    tests = [text for path, text in texts.items() if path.name.endswith("_test.cc")]
    product_lengths = [length for text in product for _, _, length in functions(text)]

    p90 = quantile(product_lengths, 0.9)
    comments = comment_share(headers)
    test_share = lines_not_blank(tests) / max(lines_not_blank(product), 1)
    print(f"{len(texts)} files; {len(product_lengths)} functions, median {quantile(product_lengths, 0.5)}, p90 {p90}, "
          f"max {max(product_lengths, default=0)} lines; comments in headers {comments:.0%}; tests : code {test_share:.2f}")

    for path, text in texts.items():
        length = len(text.splitlines())
        if length > FILE_MAX:
            yield f"{path}:1: {length} lines; a file has at most {FILE_MAX}"
        for name, line, length in functions(text):
            if length > FUNCTION_MAX:
                yield f"{path}:{line}: {name} has {length} lines; a function has at most {FUNCTION_MAX}"
    if p90 > FUNCTION_P90:
        yield f"one function in ten is longer than {p90 - 1} lines; nine of ten have at most {FUNCTION_P90}"
    if not HEADER_COMMENTS[0] <= comments <= HEADER_COMMENTS[1]:
        yield f"{comments:.0%} of the public headers' lines carry a comment; {HEADER_COMMENTS[0]:.0%} to " \
              f"{HEADER_COMMENTS[1]:.0%} is right"
    if test_share < TEST_LINES_MIN:
        yield f"{test_share:.2f} lines of tests for a line of code; at least {TEST_LINES_MIN} is right"


SELF_TEST = [
    ("int F() { return 1; }", [("F", 1, 1)]),
    ("namespace a {\nstatic int F(int x,\n             int y) {\n  if (x) {\n    y = 1;\n  }\n  return y;\n}\n}", [("F", 3, 6)]),
    ("struct A {\n  explicit A(int x = {}) : x_{x}, y_(x) {\n  }\n  bool operator==(const A&) const noexcept {\n"
     "    return true;\n  }\n private:\n  int x_ = 0;\n  int y_{0};\n};", [("A", 2, 2), ("operator==", 4, 3)]),
    ("template <typename F>\nconcept C = requires(F f) {\n  f();\n};\nconst int k[] = {1, 2};\nP p{f(1)};\n"
     "auto g = [](int x) {\n  return x;\n};", []),
    ("#define M(x) { \\\n x }\ntemplate <C T>\n  requires D<T>\nauto F(T x) -> int {\n  auto g = [&] {\n    return 1;\n  };"
     "\n  return g();\n}\nTEST(A, B) {\n}", [("F", 5, 6), ("TEST", 11, 2)]),
    ("struct A {\n  A() : x{1} {\n    ++x;\n  }\n  int x;\n};", [("A", 2, 3)]),
    ("enum class E { kA, kB };\nclass alignas(64) B : A {\n  void F() override {\n    // }\n    s = \"}\";\n  }\n};",
     [("F", 3, 4)]),
]


def self_test():
    """What is measured wrongly in SELF_TEST."""
    wrong = [f"expected {expected}, got {functions(text)} in\n{text}"
             for text, expected in SELF_TEST if functions(text) != expected]
    share = comment_share(["// SPDX-License-Identifier: x\n\n/// a\nint b;  // c\nint d;\nconst char* e = \"//\";\n"])
    if share != 0.5:
        wrong.append(f"expected a comment share of 0.5, got {share}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self_test", action="store_true")
    arguments = parser.parse_args()
    lines = self_test() if arguments.self_test else list(complaints(arguments.root))
    print("\n".join(lines) if lines else "ok")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
