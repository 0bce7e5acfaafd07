#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the architecture: which floor may include which, and what the libraries may not contain.

  check_floors.py [ROOT]       prints one line for each violation, "path:line: what is wrong"; exit code 1 if there is one
  check_floors.py --self_test  shows on a small tree that each rule reports its violation
"""

import pathlib
import re
import sys
import tempfile

import check_main
import cpp_text

# Each floor, and the floors directly below it. A file may include headers of its own floor and of all floors below.
STANDS_ON = {
    "base": [],
    "recording": ["base"],
    "model": ["base"],
    "trajectory": ["model", "recording"],
    "closed_form": ["recording", "model"],
    "acquisition": ["recording"],
    "fitting": ["trajectory", "closed_form"],
    "analysis": ["fitting"],
    "identify": ["analysis"],
    "report": ["identify"],
    "web": ["report"],
    "batch": ["report"],
    "request": ["batch"],
    "service": ["request", "web"],
    "tools": ["acquisition", "service"],
}

# The rooms of a floor that has several: subfolders, lowest first; "" is the floor's own folder. A file may include its
# own room and those listed before it.
ROOMS = {
    "recording": ["", "readers/columns", "readers/text", "readers/process", "readers/mat", "readers/containers", "readers", "calibration"],
    "fitting": ["likelihood", "start", "residuals", "solve", "effects", "uncertainty", "fit", "swing"],
}

# The only floors that may include a library's headers. Libraries not listed are free.
LIBRARY_FLOORS = {
    "boost": {"base", "trajectory", "closed_form", "fitting", "analysis", "service"},
    "ceres": {"fitting"},
    "csv.h": {"batch"},
    "expat.h": {"recording"},
    "gflags": {"tools"},
    "glog": {"tools"},
    "hdf5.h": {"recording"},
    "pendulum_logger": {"acquisition", "tools"},
    "matio.h": {"recording"},
    "nlohmann": {"base", "recording", "model", "identify", "report", "web", "batch", "request", "service", "tools"},
    "openssl": {"base", "recording", "service"},
    "prometheus": {"service"},
    "sqlite3.h": {"batch"},
    "zip.h": {"recording"},
    "zlib.h": {"recording"},
    "SQLiteCpp": {"batch"},
}
# Additional headers for tests: they check an implementation against an independent one, and differentiate trajectories
# as the fit does.
TEST_HEADERS = {"boost/": set(STANDS_ON), "ceres/jet.h": {"model", "trajectory"}, "nlohmann/": set(STANDS_ON)}

# Folders of tests/ that may include everything.
FREE_TEST_FOLDERS = {"benchmarks", "consumer", "firmware", "fuzz", "lint", "packages", "scripts", "simulator"}

# Words that only the floors with a user interface may use.
TALKING_FLOORS = {"tools"}
FORBIDDEN_BELOW = {
    "a stream of the process": r"\b(?:cout|cerr|clog)\b",
    "printf": r"\b(?:f|v|vf)?printf\s*\(",
    "exit": r"\b(?:_|_E|quick_)?exit\s*\(",
    "throw": r"\bthrow\b",
    "a naked new": r"\bnew\b(?!>)",  # except #include <new>
    "logging": r"\b[DPSV]*LOG(?:_[A-Z_]+)?\s*\(",
    "a flag": r"\bDEFINE_\w+|\bgflags::",
}


def reach(floor):
    """The floor and all below it."""
    return {floor}.union(*(reach(lower) for lower in STANDS_ON.get(floor, [])))


def floor_of(path):
    """The floor of include/pendulum/F/..., src/F/... or tests/F/...; files straight in tests/ belong to base."""
    parts = path.parts[2:] if path.parts[0] == "include" else path.parts[1:]
    return parts[0] if len(parts) > 1 else "base"


def room_of(floor, inner):
    """Rank of the room of a file, given by its path within the floor; None if the room is unknown."""
    room = str(pathlib.PurePath(inner).parent).removeprefix(".")
    return ROOMS[floor].index(room) if room in ROOMS[floor] else None


def check_room(path, header):
    """The error if this file includes this header of its own floor, or None."""
    floor = floor_of(path)
    top = "include/pendulum" if path.parts[0] == "include" else path.parts[0]
    if floor not in ROOMS or top == "tests":
        return None
    own = room_of(floor, path.relative_to(f"{top}/{floor}"))
    other = room_of(floor, header.removeprefix("pendulum/").removeprefix(f"{floor}/"))
    if own is None or other is None:
        return f"floor {floor} has no such room; it has {', '.join(ROOMS[floor])}"
    return f"room {ROOMS[floor][own]} is below {ROOMS[floor][other]}" if other > own else None


def check_include(root, path, header, quoted):
    """The error if this file includes this header, or None."""
    floor = floor_of(path)
    in_tests = path.parts[0] == "tests"
    if header == "pendulum/base/try.h" and path.parts[0] == "include":
        return "its macros would reach the programs that use the library"
    if in_tests and floor in FREE_TEST_FOLDERS:
        return None
    ours = re.fullmatch(r"(?:pendulum|tests)/(\w+)/.*", header)
    private = re.fullmatch(r"(\w+)/.*", header)
    if ours:
        if ours[1] not in reach(floor):
            return f"floor {floor} does not stand on {ours[1]}"
        if ours[1] == floor and header.startswith("pendulum/"):
            return check_room(path, header)
    elif quoted:
        is_own = private and private[1] == floor or in_tests and re.fullmatch(r"tests/\w+\.h", header)
        if not is_own and not (root / path.parent / header).resolve().parent == (root / path.parent).resolve():
            return f'"{header}" is neither public ("pendulum/FLOOR/x.h") nor private to {floor} ("{floor}/x.h")'
        if private and private[1] == floor:
            return check_room(path, header)
    else:
        library = header.split("/")[0]
        if in_tests and any(header.startswith(start) and floor in floors for start, floors in TEST_HEADERS.items()):
            return None
        if floor not in LIBRARY_FLOORS.get(library, {floor}):
            return f"{library} belongs to {', '.join(sorted(LIBRARY_FLOORS[library]))}, not to {floor}"
    return None


def check_includes(root, path):
    """Each file belongs to a known floor and includes only headers of this floor or lower floors."""
    floor = floor_of(path)
    if floor not in STANDS_ON and not (path.parts[0] == "tests" and floor in FREE_TEST_FOLDERS):
        yield f"{path}:1: there is no floor {floor}"
        return
    for number, line in enumerate(cpp_text.without_comments((root / path).read_text()).splitlines(), 1):
        include = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        complaint = include and check_include(root, path, include[2], include[1] == '"')
        if complaint:
            yield f"{path}:{number}: {complaint}"


def check_words(root, path):
    """Below the tools, no code prints, logs, exits, throws or uses a naked new."""
    if path.parts[0] == "tests" or floor_of(path) in TALKING_FLOORS:
        return
    for number, line in enumerate(cpp_text.code_only((root / path).read_text()).splitlines(), 1):
        for what, pattern in FORBIDDEN_BELOW.items():
            if re.search(pattern, line):
                yield f"{path}:{number}: {what} has no place in floor {floor_of(path)}"


def check_companions(root, path):
    """src/F/x.cc has include/pendulum/F/x.h, or a private src/F/x.h, and includes it first, which shows that the header
    compiles on its own. Public files and tools have tests/F/x_test.cc; other private files are tested through the
    public files and tools. src/F/x_part.cc has src/F/x.h, whose templates it instantiates."""
    if path.parts[0] != "src" or path.suffix != ".cc" or path.stem.endswith("_main"):
        return
    inner = path.relative_to("src").with_suffix("")
    whole = inner.parent / (inner.name.rpartition("_")[0] or inner.name)
    if not any((root / top / f"{inner}.h").exists() for top in ("include/pendulum", "src")) and (root / f"src/{whole}.h").exists():
        inner = whole
    is_private = (root / f"src/{inner}.h").exists()
    headers = "src" if is_private or floor_of(path) in TALKING_FLOORS else "include/pendulum"
    needs_test = not is_private or floor_of(path) in TALKING_FLOORS
    for companion in (f"{headers}/{inner}.h", *([f"tests/{inner}_test.cc"] if needs_test else [])):
        if not (root / companion).exists():
            yield f"{path}:1: {companion} is missing"
    own = f"{headers}/{inner}.h".removeprefix("include/").removeprefix("src/")
    first = re.search(r'#\s*include\s*[<"]([^>"]+)', cpp_text.without_comments((root / path).read_text()))
    if first is None or first[1] != own:
        yield f"{path}:1: {own} must be included first"


def cmake_calls(root, folder, function):
    """The arguments of each call of a function in a folder's CMakeLists.txt."""
    path = root / folder / "CMakeLists.txt"
    text = re.sub(r"#[^\n]*", "", path.read_text()) if path.exists() else ""
    return [call.split() for call in re.findall(rf"^\s*{function}\(([^)]*)\)", text, re.MULTILINE)]


def check_links(root):
    """A floor's target links only the targets of floors it stands on."""
    for name, *arguments in cmake_calls(root, "src", "pendulum_add_floor"):
        links = {argument.removeprefix("pendulum::") for argument in arguments if argument.startswith("pendulum::")}
        for link in sorted(links - reach(name)):
            yield f"src/CMakeLists.txt:1: floor {name} does not stand on {link}"


def check_listed(root, path):
    """A test in Python is named in a CMakeLists.txt, which says with what program it runs; others are found by their names."""
    if not path.name.endswith("_test.py"):
        return
    name = str(path.relative_to(path.parts[0]).with_suffix("")).removesuffix("_test")
    if path.parent == pathlib.Path("tests/packages"):
        listed, where = cmake_calls(root, path.parent, "pendulum_add_package_test"), path.parent
        name = path.stem.removesuffix("_test")
    elif floor_of(path) in STANDS_ON:
        listed, where = cmake_calls(root, "tests", "pendulum_add_process_test"), "tests"
    else:
        return
    if name not in {call[0] for call in listed}:
        yield f"{path}:1: {where}/CMakeLists.txt does not name it"


def complaints(root):
    """All violations in the tree, as "path:line: what is wrong"."""
    paths = [path.relative_to(root) for top in ("include", "src", "tests") for path in cpp_text.sources(root / top)]
    paths += [path.relative_to(root) for path in sorted((root / "tests").rglob("*_test.py"))]
    found = list(check_links(root))
    for check in (check_includes, check_words, check_companions, check_listed):
        for path in paths:
            found += check(root, path)
    return found


# A tree that breaks each rule, and also has correct code that looks like a violation: file -> (content, expected
# complaint).
BAD_TREE = {
    "include/pendulum/base/good.h": ("// cout << new\n#include <string>\n", None),
    "src/base/good.cc": ('#include "pendulum/base/good.h"\nconst char* k = "throw"; int n = 2\'000; char c[9]; '
                         'int f() { return snprintf(c, 9, "%d", n); }\n', None),
    "tests/base/good_test.cc": ('#include "pendulum/base/good.h"\n#include <boost/math/tools/roots.hpp>\n', None),
    "tests/trajectory/jet_test.cc": ("#include <ceres/jet.h>\n", None),
    "tests/benchmarks/b.cc": ('#include <ceres/ceres.h>\n#include "pendulum/report/text.h"\n', None),
    "src/base/private.h": ("", None),
    "tests/base/private_test.cc": ('#include "base/private.h"\n#include "tests/matchers.h"\n#include "good.h"\n', None),
    "src/base/private_part.cc": ('#include "base/private.h"\n', None),
    "src/base/private_late.cc": ('#include <string>\n#include "base/private.h"\n', "base/private.h must be included first"),
    "src/tools/flags.cc": ("#include <gflags/gflags.h>\n", "src/tools/flags.h is missing"),
    "src/tools/good_main.cc": ("#include <glog/logging.h>\nvoid f() { throw 1; }\n", None),
    "src/CMakeLists.txt": ("pendulum_add_floor(base LINKS pendulum::model)\n", "floor base does not stand on model"),
    "tests/CMakeLists.txt": ("pendulum_add_process_test(tools/good_cli fit_pendulum)\n"
                             "# pendulum_add_process_test(tools/unlisted fit_pendulum)\n", None),
    "tests/tools/good_cli_test.py": ("", None),
    "tests/packages/CMakeLists.txt": ("pendulum_add_package_test(good)\n", None),
    "tests/packages/good_test.py": ("", None),
    "tests/packages/unlisted_test.py": ("", "tests/packages/CMakeLists.txt does not name it"),
    "include/pendulum/attic/x.h": ("", "there is no floor attic"),
    "include/pendulum/recording/up.h": ("#include <pendulum/fitting/fit.h>\n",
                                        "floor recording does not stand on fitting"),
    "include/pendulum/model/side.h": ('#include "pendulum/recording/window.h"\n',
                                      "floor model does not stand on recording"),
    "tests/model/up.h": ('#include "pendulum/report/json.h"\n', "floor model does not stand on report"),
    "tests/support.h": ('#include "pendulum/model/rig.h"\n', "floor base does not stand on model"),
    "include/pendulum/model/around.h": ('#include "../fitting/fit.h"\n', '"../fitting/fit.h" is neither'),
    "src/model/foreign.h": ('#include "recording/csv.h"\n', '"recording/csv.h" is neither'),
    "include/pendulum/report/solver.h": ("#include <ceres/ceres.h>\n", "ceres belongs to fitting, not to report"),
    "tests/trajectory/solver.h": ("#include <ceres/ceres.h>\n", "ceres belongs to fitting, not to trajectory"),
    "tests/closed_form/jet.h": ("#include <ceres/jet.h>\n", "ceres belongs to fitting, not to closed_form"),
    "include/pendulum/fitting/fit/log.h": ("#include <glog/logging.h>\n", "glog belongs to tools"),
    "tests/fitting/flag.h": ("#include <gflags/gflags.h>\n", "gflags belongs to tools"),
    "include/pendulum/fitting/solve/down.h": ('#include "pendulum/fitting/likelihood/cost.h"\n', None),
    "include/pendulum/fitting/solve/up.h": ('#include "pendulum/fitting/fit/fit.h"\n', "room solve is below fit"),
    "src/fitting/start/up.h": ('#include "fitting/swing/private.h"\n', "room start is below swing"),
    "src/recording/room.h": ('#include "recording/readers/text/csv.h"\n', "room  is below readers/text"),
    "include/pendulum/fitting/attic/x.h": ('#include "pendulum/fitting/fit/fit.h"\n', "has no such room"),
    "include/pendulum/base/cout.h": ("auto& s = std::cout;\n", "a stream of the process has no place"),
    "include/pendulum/base/cerr.h": ("auto& s = std::cerr;\n", "a stream of the process has no place"),
    "include/pendulum/base/printf.h": ('void f() { fprintf(stderr, "x"); }\n', "printf has no place"),
    "include/pendulum/base/macros.h": ('#include "pendulum/base/try.h"\n', "its macros would reach the programs"),
    "include/pendulum/base/exit.h": ("void f() { std::exit(1); }\n", "exit has no place"),
    "include/pendulum/base/throw.h": ("void f() { throw 1; }\n", "throw has no place"),
    "include/pendulum/base/new.h": ("int* p = new int;\n", "a naked new has no place"),
    "include/pendulum/base/log.h": ("void f() { VLOG(1); }\n", "logging has no place"),
    "include/pendulum/base/flag.h": ('DEFINE_bool(x, true, "");\n', "a flag has no place"),
    "src/model/late.cc": ('#include <string>\n#include "pendulum/model/late.h"\n',
                          "pendulum/model/late.h must be included first"),
    "src/model/alone.cc": ("", "include/pendulum/model/alone.h is missing"),
    "src/model/friction/alone.cc": ("", "tests/model/friction/alone_test.cc is missing"),
    "tests/tools/unlisted_test.py": ("", "tests/CMakeLists.txt does not name it"),
}


def self_test():
    """Complaints about BAD_TREE that are missing or wrong."""
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for path, (content, _) in BAD_TREE.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(content)
        found = complaints(root)
    for path, (_, expected) in BAD_TREE.items():
        mine = [line for line in found if line.startswith(f"{path}:")]
        if expected is None and mine:
            failures.append(f"unexpected: {mine}")
        if expected is not None and not any(expected in line for line in mine):
            failures.append(f"expected of {path}: {expected!r}; got {mine}")
    return failures


def main():
    arguments = check_main.parse_arguments(__doc__)
    return check_main.finish(self_test() if arguments.self_test else complaints(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
