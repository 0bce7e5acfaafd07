#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the equations of MODEL.md: their numbers, their citations and the functions that implement them.

  check_equations.py [ROOT]       prints one line for each error, "path:line: what is wrong"; exit code 1 if there is one
  check_equations.py --self_test  shows on a small tree that each kind of error is found

Equations are numbered by section, in order: \\tag{2.1}, \\tag{2.2}. Sources cite them as "MODEL.md eq. (2.1)", several as
"eq. (2.1), (2.3)" or "eq. (2.1) to (2.3)". The table at the end of MODEL.md has a row for each equation: `path`:
`Function`, `Function`; `path`: `Function`, or "none:" and the reason.
"""

import pathlib
import re
import sys
import tempfile

import check_main
import cpp_text

# Blanks, or the end of a line and the beginning of the next comment line.
_GAP = r"(?:[ \t]|\n[ \t]*(?:///?<?|\*|#)?)+"
_ITEM = r"\(\d+(?:\.\d+)?\)"
_CITATION = re.compile(rf"\b[Ee]qs?\.{_GAP}{_ITEM}(?:(?:,(?:{_GAP}and)?|{_GAP}and|{_GAP}to){_GAP}{_ITEM})*")
_RANGE = re.compile(rf"\((\d+)\.(\d+)\){_GAP}to{_GAP}\((\d+)\.(\d+)\)")
_SECTION = re.compile(rf"\bMODEL\.md\)?{_GAP}section{_GAP}(\d+)")
_SUFFIXES = {".h", ".cc", ".ino", ".py", ".ts"}
_GENERATED = {"dist", "node_modules"}


def line_at(text, position):
    return text.count("\n", 0, position) + 1


def check_numbers(model):
    """Sections and equations count up from one."""
    section, number = 0, 0
    for match in re.finditer(r"^## (\d+)\. |\\tag\{(\d+)\.(\d+)\}", model, re.MULTILINE):
        if match[1]:
            if int(match[1]) != section + 1:
                yield f"MODEL.md:{line_at(model, match.start())}: section {match[1]} follows section {section}"
            section, number = int(match[1]), 0
            continue
        if (int(match[2]), int(match[3])) != (section, number + 1):
            expected = f"({section}.{number + 1})"
            yield f"MODEL.md:{line_at(model, match.start())}: ({match[2]}.{match[3]}) stands where {expected} is expected"
        number = int(match[3])


def declares(code, name):
    """Whether C++ code without comments declares a function or a type of this name."""
    before = (r"(?:\b(?:struct|class|enum class|union|using|concept) (?:\[\[[^\]]*\]\] )?"
              r"|[\w>&*\]](?<!\breturn)(?<!\belse)\s+[&*]?|\w::)")
    return re.search(rf"{before}{name}\b(?=\s*(?:[(<{{:;=]|final\b|$))", code, re.MULTILINE) is not None


def check_table(root, model, equations):
    """Each equation has one row, and the files and functions named in the row exist."""
    rows = {}
    for match in re.finditer(r"^\| \((\d+\.\d+)\) \| (.*) \|$", model, re.MULTILINE):
        place = f"MODEL.md:{line_at(model, match.start())}"
        if match[1] in rows:
            yield f"{place}: ({match[1]}) has a second row of functions"
        if match[1] not in equations:
            yield f"{place}: there is no equation ({match[1]})"
        rows[match[1]] = match[2]
        if re.match(r"none: \w", match[2]):
            continue
        groups = re.findall(r"`([^`]+)`: (`\w+`(?:, `\w+`)*)", match[2])
        if not groups:
            yield f"{place}: the row of ({match[1]}) names no function and no reason"
        for path, functions in groups:
            if not (root / path).is_file():
                yield f"{place}: there is no file {path}"
                continue
            code = cpp_text.code_only((root / path).read_text())
            for function in re.findall(r"\w+", functions):
                if not declares(code, function):
                    yield f"{place}: {path} declares no {function}"
    for number, line in equations.items():
        if number not in rows:
            yield f"MODEL.md:{line}: ({number}) has no row in the table of functions"


def sources(root):
    """The files that may cite equations."""
    for top in ("include", "src", "tests", "firmware"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in _SUFFIXES and path.is_file() and not _GENERATED & set(path.relative_to(root).parts):
                yield path
    yield from (path for path in sorted(root.glob("*.md")) if path.name != "MODEL.md")


def cited(citation):
    """The numbers of a citation, with those within its ranges."""
    numbers = re.findall(r"\((\d+(?:\.\d+)?)\)", citation)
    for match in _RANGE.finditer(citation):
        if match[1] == match[3]:
            numbers += [f"{match[1]}.{n}" for n in range(int(match[2]) + 1, int(match[4]))]
        else:
            numbers.append(f"{match[1]}.{match[2]}-{match[3]}.{match[4]}")  # a range across sections
    return numbers


def check_citations(root, model, equations):
    """Equations and sections that sources or MODEL.md itself cite exist."""
    for match in re.finditer(r"\((\d+\.\d+)\)", model):
        if match[1] not in equations:
            yield f"MODEL.md:{line_at(model, match.start())}: there is no equation ({match[1]})"
    sections = set(re.findall(r"^## (\d+)\. ", model, re.MULTILINE))
    for path in sources(root):
        if path.resolve() == pathlib.Path(__file__).resolve():
            continue  # this file, whose examples are wrong on purpose
        text, name = path.read_text(), path.relative_to(root)
        for match in _CITATION.finditer(text):
            for number in cited(match[0]):
                if number not in equations:
                    yield f"{name}:{line_at(text, match.start())}: MODEL.md has no equation ({number})"
        for match in _SECTION.finditer(text):
            if match[1] not in sections:
                yield f"{name}:{line_at(text, match.start())}: MODEL.md has no section {match[1]}"


def complaints(root):
    model = (root / "MODEL.md").read_text()
    equations = {match[1]: line_at(model, match.start()) for match in re.finditer(r"\\tag\{(\d+\.\d+)\}", model)}
    found = [*check_numbers(model), *check_table(root, model, equations), *check_citations(root, model, equations)]
    return list(dict.fromkeys(found))


# A tree with each kind of error, and with correct text that looks like an error: file -> content.
BAD_TREE = {
    "MODEL.md": "## 1. A\n$$a \\tag{1.1}$$\n$$b \\tag{1.3}$$\n## 3. C\n$$c \\tag{3.1}$$\n"
                "see (1.1), (4.7)\n$$d \\tag{3.2}$$\n"
                "| (1.1) | `src/a/x.cc`: `F`, `Kind`, `Called`; `src/a/none.cc`: `F` |\n| (3.1) | none: a definition |\n"
                "| (3.2) | nothing |\n| (9.9) | `src/a/x.cc`: `Method` |\n",
    "src/a/x.cc": "/// MODEL.md eq. (1.1), (3.1) to\n/// (3.2); section 9.\nint F() { return Called(); }\n"
                  "struct Kind {\n  double Method();\n};\n"
                  "// MODEL.md eq. (12), eqs. (1.1) to (1.3), eq.\n// (3.3)\n",
    "src/a/dist/y.ts": "// eq. (99)\n",
    "src/a/z.ts": "/** MODEL.md section 3, MODEL.md section 2 */\n",
}
EXPECTED = [
    "MODEL.md:3: (1.3) stands where (1.2) is expected", "MODEL.md:4: section 3 follows section 1",
    "MODEL.md:6: there is no equation (4.7)", "MODEL.md:8: src/a/x.cc declares no Called", "MODEL.md:8: there is no file src/a/none.cc",
    "MODEL.md:10: the row of (3.2) names no function and no reason", "MODEL.md:11: there is no equation (9.9)",
    "MODEL.md:3: (1.3) has no row in the table of functions", "src/a/x.cc:7: MODEL.md has no equation (12)",
    "src/a/x.cc:7: MODEL.md has no equation (1.2)", "src/a/x.cc:7: MODEL.md has no equation (3.3)",
    "src/a/z.ts:1: MODEL.md has no section 2",
]


def self_test():
    """Expected errors in BAD_TREE that are not found, and others that are found."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, content in BAD_TREE.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(content)
        found = complaints(root)
    return ([f"expected: {line}" for line in EXPECTED if line not in found] +
            [f"unexpected: {line}" for line in found if line not in EXPECTED])


def main():
    arguments = check_main.parse_arguments(__doc__)
    return check_main.finish(self_test() if arguments.self_test else complaints(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
