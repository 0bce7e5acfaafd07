#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds source files that do not include what they use, either directly or through the project's headers.

  check_includes.py [ROOT]       prints one line for each name without its header, "path:line: name needs <header>"; exit 1 if any
  check_includes.py --self_test  shows on a small tree that a missing header is found

Several files are compiled in one unit, where one file's includes serve the next, so the compiler does not find a missing
include. The check covers names of the project, of the standard library and, by namespace or macro, of some others.
"""

import functools
import pathlib
import re
import sys
import tempfile

import check_main
import cpp_text

# Headers of the standard library, and the names they provide. For a name with several headers, any one suffices.
STANDARD = {
    "algorithm": "adjacent_find all_of any_of binary_search clamp copy copy_if copy_n count count_if equal equal_range fill "
                 "fill_n find find_if find_if_not for_each generate inplace_merge is_sorted lower_bound max max_element merge "
                 "min min_element minmax minmax_element mismatch none_of nth_element partial_sort stable_partition partition partition_point pop_heap "
                 "push_heap remove remove_if replace replace_if reverse rotate shuffle sort stable_sort transform unique "
                 "upper_bound",
    "array": "array get size to_array",
    "atomic": "atomic atomic_flag",
    "bit": "bit_cast bit_ceil countr_zero endian popcount",
    "cctype": "isalnum tolower",
    "charconv": "chars_format from_chars from_chars_result to_chars",
    "chrono": "chrono",
    "cmath": "abs acos asin atan atan2 atanh cbrt ceil comp_ellint_1 copysign cos cosh erf erfc exp exp2 expm1 fabs floor fma "
             "fmod frexp hypot isfinite isinf isnan ldexp lgamma llround log log10 log1p log2 lround nan nextafter nexttoward "
             "pow remainder round signbit sin sinh sqrt tan tanh tgamma trunc",
    "complex": "arg complex norm polar",
    "concepts": "convertible_to derived_from floating_point integral invocable same_as",
    "condition_variable": "condition_variable condition_variable_any",
    "csignal": "raise sig_atomic_t signal",
    "cstdint": "int16_t int32_t int64_t int8_t uint16_t uint32_t uint64_t uint8_t uintmax_t uintptr_t",
    "cstdio": "fclose fflush fgets FILE fopen fputs fread fseek fwrite printf putchar puts rename snprintf sscanf tmpfile",
    "cstdlib": "_Exit abort abs aligned_alloc atexit atoi exit free getenv malloc strtod",
    "cstring": "memchr memcmp memcpy memmove memset strchr strerror strlen",
    "ctime": "strftime time time_t tm",
    "deque": "deque erase erase_if",
    "exception": "current_exception exception exception_ptr rethrow_exception terminate",
    "filesystem": "filesystem",
    "fstream": "fstream ifstream ofstream",
    "functional": "bind_front cref equal_to function greater greater_equal hash identity invoke less less_equal minus "
                  "multiplies not_fn plus ref reference_wrapper",
    "future": "async future promise",
    "initializer_list": "initializer_list",
    "iomanip": "setfill setprecision setw",
    "ios": "hex ios scientific streamoff streamsize",
    "iostream": "cerr cin clog cout",
    "istream": "istream ws",
    "iterator": "back_inserter distance istreambuf_iterator make_move_iterator next prev size ssize",
    "barrier": "barrier",
    "latch": "latch",
    "limits": "numeric_limits",
    "list": "erase erase_if list",
    "map": "erase_if map multimap",
    "memory": "enable_shared_from_this make_shared make_unique make_unique_for_overwrite shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock unique_lock",
    "new": "align_val_t bad_alloc",
    "numbers": "numbers",
    "numeric": "accumulate adjacent_difference gcd inner_product iota lcm midpoint partial_sum reduce transform_reduce",
    "optional": "make_optional nullopt nullopt_t optional",
    "ostream": "endl flush ostream",
    "queue": "priority_queue queue",
    "random": "bernoulli_distribution exponential_distribution generate_canonical mt19937 mt19937_64 normal_distribution "
              "poisson_distribution random_device seed_seq student_t_distribution uniform_int_distribution "
              "uniform_real_distribution",
    "ranges": "views",
    "regex": "regex regex_match regex_replace regex_search smatch",
    "set": "erase_if multiset set",
    "shared_mutex": "shared_lock shared_mutex",
    "source_location": "source_location",
    "span": "as_bytes size span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "domain_error logic_error overflow_error runtime_error",
    "stop_token": "stop_callback stop_source stop_token",
    "string": "erase erase_if getline size stod stoi stol stoll stoul string string_literals to_string",
    "string_view": "size string_view string_view_literals",
    "system_error": "errc error_code generic_category make_error_code system_error",
    "thread": "jthread this_thread thread",
    "tuple": "apply forward_as_tuple get make_tuple tie tuple",
    "type_traits": "conditional_t decay_t enable_if_t is_base_of_v is_same_v is_trivially_copyable_v remove_cvref_t "
                   "remove_pointer_t type_identity_t",
    "unordered_map": "erase_if unordered_map",
    "unordered_set": "erase_if unordered_set",
    "utility": "as_const declval exchange forward get in_place integer_sequence make_integer_sequence make_pair move pair "
               "swap unreachable",
    "variant": "get get_if holds_alternative monostate variant visit",
    "vector": "erase erase_if size ssize vector",
}
# Names of other libraries, and the beginnings of the headers that provide them.
LIBRARIES = [(re.compile(name), header) for name, header in (
    (r"\b(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(", "gtest/ gmock/"), (r"\b(?:EXPECT|ASSERT)_THAT\(", "gmock/"),
    (r"\bboost::", "boost/"), (r"\bbenchmark::", "benchmark/"), (r"\bDEFINE_(?:bool|double|int32|string)\(", "gflags/"),
    (r"\bceres::", "ceres/"), (r"\bnlohmann::", "nlohmann/"), (r"\btl::", "tl/"), (r"\bEigen::", "Eigen/"),
    (r"\bEigen::LD?LT\b|\.ld?lt\(", "Eigen/Cholesky"), (r"\bEigen::\w*EigenSolver\b", "Eigen/Eigenvalues"),
    (r"\bEigen::\w*QR\b|\.\w*[hH]ouseholderQr\(|\.completeOrthogonalDecomposition\(", "Eigen/QR"),
    (r"\bEigen::\w+SVD\b|\.(?:bdc|jacobi)Svd\(", "Eigen/SVD"))]
# The headers that a header provides too: by the standard, or because g++'s, clang's or Eigen's header includes them.
BRINGS = {
    "algorithm": {"utility"}, "charconv": {"system_error"}, "cstring": {"string.h"}, "ios": {"string"}, "iostream": {"ios", "istream", "ostream"},
    "map": {"utility"}, "string": {"string_view"}, "thread": {"stop_token"}, "tuple": {"utility"}, "unordered_map": {"utility"},
    "fstream": {"ios", "istream", "ostream"}, "sstream": {"ios", "istream", "ostream"}, "array": {"utility"},
    "memory": {"utility"}, "functional": {"utility"}, "optional": {"utility"}, "ranges": {"span"}, "filesystem": {"system_error", "string"},
    "future": {"thread"}, "variant": {"utility"}, "shared_mutex": {"mutex"}, "condition_variable": {"mutex"}, "iterator": {"utility"},
    "Eigen/Dense": {"Eigen/Cholesky", "Eigen/Eigenvalues", "Eigen/QR", "Eigen/SVD"},
}
HEADERS_OF = {}
for _header, _names in STANDARD.items():
    for _name in _names.split():
        HEADERS_OF.setdefault(_name, set()).add(_header)

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)', re.MULTILINE)
_EVERYWHERE = {"nullptr_t", "ptrdiff_t", "size_t"}  # all headers of g++'s and clang's library provide them
_STD_NAME = re.compile(r"(?<![\w:])std::(?:ranges::)?(\w+)")
# Types, aliases, constants and functions that a header declares outside of classes: at the left edge of a line.
_DECLARED = re.compile(
    r"^(?:(?:template <[^\n]*>\n)?(?:struct|class|enum class) (?:\[\[[^\]]*\]\] )?([A-Z]\w+)(?= (?:final )?[{:]|$)"
    r"|(?:template <[^\n]*>\n)?using ([A-Z]\w+) ="
    r"|(?:inline |extern )?const(?:expr)? [^\n=({]*?\b(k[A-Z]\w+)(?: =|\{|;)"
    r"|(?!(?:return|using|namespace|template|static|TEST|struct|class|enum)\b)[\w:<>,&*\[\] ]*?[\w>&*] ([A-Z]\w+)\()", re.MULTILINE)
# Everything that looks like a declaration, including members, locals and enumerators: such a name needs no header.
_ANY_DECLARED = re.compile(
    r"\b(?:struct|class|enum class|using|typename|concept) (?:\[\[[^\]]*\]\] )?(\w+)|(?<!\breturn)(?<!\bco_return)(?:[\w>&*\]]|decltype\(auto\)) [&*]?([A-Z]\w+)\("
    r"|\b(k[A-Z]\w+)(?= =|\{|,|;|\))|^  (k[A-Z]\w+)$|\b(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+), \w+|[\w>&*] (k?[A-Z]\w+)(?:;|\[|\{| =)", re.MULTILINE)
_QUALIFIED = re.compile(r"(?:\w::(?:template )?|\b(?:typename|class|auto|int|bool)(?:\.\.\.)? )(\w+)")
_USED = re.compile(r"(?<![\w.:>~])(?<!\btemplate )(?:pendulum::)?(k?[A-Z]\w+)\b")


def own_header(root, path, name):
    """The file that this include name means in `path`, or None if it does not belong to the project."""
    for folder in (path.parent, root / "include", root / "src", root, root / "firmware"):
        if (folder / name).is_file():
            return (folder / name).resolve()
    return None


class Tree:
    """The sources below a folder and what they include."""

    def __init__(self, root):
        self.root = root.resolve()
        self.paths = [path.resolve() for top in ("include", "src", "tests") for path in cpp_text.sources(self.root / top)]
        self.text = functools.lru_cache(None)(lambda path: path.read_text())
        self.code = functools.lru_cache(None)(lambda path: cpp_text.code_only(self.text(path)))
        self.declaring = {}
        for path in self.paths:
            if self.stands_alone(path) and path.suffix == ".h":
                for name in self.declared(path):
                    self.declaring.setdefault(name, set()).add(path)

    def stands_alone(self, path):
        """Whether a file stands alone; it is false for a fragment that another file includes in its middle."""
        return path.suffix == ".cc" or "#pragma once" in self.text(path)

    def declared(self, path):
        return {next(filter(None, match.groups())) for match in _DECLARED.finditer(self.code(path))}

    @functools.lru_cache(None)
    def any_declared(self, path):
        code = self.code(path)
        return {name for groups in _ANY_DECLARED.findall(code) for name in groups if name} | set(_QUALIFIED.findall(code))

    @functools.lru_cache(None)
    def includes(self, path):
        """(own headers, others) that a file names."""
        own, others = set(), set()
        for _, name in _INCLUDE.findall(cpp_text.without_comments(self.text(path))):
            header = own_header(self.root, path, name)
            (own if header else others).add(header or name)
        return own, others

    def reached(self, path):
        """All files that a file includes, through own headers: (own, others)."""
        own, others, waiting = {path}, set(), [path]
        while waiting:
            more, named = self.includes(waiting.pop())
            others |= named
            waiting += more - own
            own |= more
        return own, others.union(*(BRINGS.get(header, set()) for header in others))

    def complaints(self, path):
        """The first use of each name whose header is not included."""
        own, others = self.reached(path)
        code, seen = self.code(path), set(_EVERYWHERE)
        for match in _STD_NAME.finditer(code):
            needs = HEADERS_OF.get(match[1])
            if match[1] in seen or needs and needs & others:
                continue
            seen.add(match[1])
            if needs:
                yield match, f"std::{match[1]} needs <{sorted(needs)[0]}>"
            else:
                yield match, f"std::{match[1]} is in no header that tests/check_includes.py knows: correct it, or add it to STANDARD"
        for name, header in LIBRARIES:
            match = name.search(code)
            if match and not any(each.startswith(tuple(header.split())) for each in others):
                header = header.split()[0]
                yield match, f"{match[0]} needs <{header}...>" if header.endswith("/") else f"{match[0]} needs <{header}>"
        known = set().union(*map(self.any_declared, own))
        for match in _USED.finditer(code):
            needs = self.declaring.get(match[1], set())
            if needs and not needs & own and match[1] not in seen and match[1] not in known:
                seen.add(match[1])
                yield match, f"{match[1]} needs {sorted(str(header.relative_to(self.root)) for header in needs)[0]}"


def complaints(root):
    tree = Tree(root)
    for path in filter(tree.stands_alone, tree.paths):
        for match, what in tree.complaints(path):
            line = tree.code(path).count("\n", 0, match.start()) + 1
            yield f"{path.relative_to(tree.root)}:{line}: {what}"


def self_test():
    """Expected complaints about a small tree that are missing, and unexpected ones."""
    files = {
        "include/pendulum/a/x.h": "#pragma once\n#include <vector>\nstruct Point {\n  std::vector<double> at;\n};\nPoint MakePoint(int n);\n",
        "src/a/good.cc": '#include <cmath>\n#include "pendulum/a/x.h"\nstd::vector<double> F() { return MakePoint(1).at; }\n'
                         "double G() { return std::sqrt(2); }  // std::sort\n",
        "src/a/bad.cc": "int F() {\n  Point p = MakePoint(2);\n  std::sort(p.at.begin(), p.at.end());\n  return std::nothing(ceres::kInfinity);\n}\n",
    }
    expected = ["src/a/bad.cc:2: MakePoint needs include/pendulum/a/x.h", "src/a/bad.cc:2: Point needs include/pendulum/a/x.h",
                "src/a/bad.cc:3: std::sort needs <algorithm>", "src/a/bad.cc:4: ceres:: needs <ceres/...>",
                "src/a/bad.cc:4: std::nothing is in no header that tests/check_includes.py knows: correct it, or add it to STANDARD"]
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        found = sorted(complaints(pathlib.Path(folder)))
    return [] if found == expected else [f"expected {expected}, got {found}"]


def main():
    arguments = check_main.parse_arguments(__doc__)
    return check_main.finish(self_test() if arguments.self_test else list(complaints(arguments.root)))


if __name__ == "__main__":
    sys.exit(main())
