#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reports the sizes of functions and files, the share of comments in public headers, and the lines of tests per line of code.

  check_sizes.py [ROOT]       prints the figures and the largest functions and files, for a reader to judge
  check_sizes.py --self_test  shows on small texts that functions are found and measured; exit code 1 if not

It rejects nothing: a limit makes people split a single thought, and delete sentences that a reader needs.

A function's length is the number of lines from its opening to its closing brace.
"""

import math
import re
import sys

import check_main
import cpp_text

LARGEST = 20

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
    """The kind of block that a brace after this text opens, outside of functions."""
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
    """Share of lines with a comment among nonblank lines; the licence line is not counted at all."""
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
    """Number of nonblank lines in all texts."""
    return sum(bool(line.strip()) for text in texts for line in text.splitlines())


def report(root):
    """The lines of the report."""
    texts = {path.relative_to(root): path.read_text()
             for top in ("include", "src", "tests") for path in cpp_text.sources(root / top)}
    headers = [text for path, text in texts.items() if path.parts[0] == "include"]
    product = {path: text for path, text in texts.items() if path.parts[0] != "tests"}
    tests = [text for path, text in texts.items() if path.name.endswith("_test.cc")]
    found = sorted(((length, f"{path}:{line}", name) for path, text in product.items()
                    for name, line, length in functions(text)), reverse=True)
    lengths = [length for length, *_ in found]
    test_share = lines_not_blank(tests) / max(lines_not_blank(product.values()), 1)
    yield (f"{len(texts)} files; {len(lengths)} functions, median {quantile(lengths, 0.5)}, p90 {quantile(lengths, 0.9)}, "
           f"max {max(lengths, default=0)} lines; comments in headers {comment_share(headers):.0%}; "
           f"tests : code {test_share:.2f}")
    yield f"The {LARGEST} largest functions, in lines:"
    yield from (f"{length:5} {place} {name}" for length, place, name in found[:LARGEST])
    yield f"The {LARGEST} largest files, in lines:"
    sizes = sorted(((len(text.splitlines()), str(path)) for path, text in texts.items()), reverse=True)
    yield from (f"{lines:5} {path}" for lines, path in sizes[:LARGEST])


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
    """The wrong results for SELF_TEST."""
    wrong = [f"expected {expected}, got {functions(text)} in\n{text}"
             for text, expected in SELF_TEST if functions(text) != expected]
    share = comment_share(["// SPDX-License-Identifier: x\n\n/// a\nint b;  // c\nint d;\nconst char* e = \"//\";\n"])
    if share != 0.5:
        wrong.append(f"expected a comment share of 0.5, got {share}")
    return wrong


def main():
    arguments = check_main.parse_arguments(__doc__)
    if not arguments.self_test:
        print("\n".join(report(arguments.root)))
        return 0
    return check_main.finish(self_test())


if __name__ == "__main__":
    sys.exit(main())
