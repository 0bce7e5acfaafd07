#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares what the packages of two builds hold: the same build gives the same files.

    compare_packages.py FIRST_FOLDER SECOND_FOLDER

Prints each file that only one has, or whose kind, mode or content differs, and ends with 1 if there is one.
"""

import hashlib
import io
import pathlib
import subprocess
import sys
import tarfile


def archives(package):
    """The tar archives of a package, by name: the files, and of a Debian package also its control files."""
    if package.suffix != ".deb":
        return {"files": package.read_bytes()}
    return {part: subprocess.run(["dpkg-deb", option, package], check=True, capture_output=True).stdout
            for part, option in (("files", "--fsys-tarfile"), ("control", "--ctrl-tarfile"))}


def contents(folder):
    """(package, part, file) -> kind, mode, target of a link, digest of the content."""
    found = {}
    for package in sorted(path for path in folder.iterdir() if path.suffix in (".deb", ".gz", ".xz", ".zst")):
        for part, archive in archives(package).items():
            with tarfile.open(fileobj=io.BytesIO(archive)) as files:
                for member in files:
                    data = files.extractfile(member).read() if member.isreg() else b""
                    digest = hashlib.sha256(data).hexdigest()
                    found[package.name, part, member.name] = (member.type, member.mode, member.linkname, digest)
    return found


def main(first, second):
    a, b = contents(pathlib.Path(first)), contents(pathlib.Path(second))
    if not a:
        sys.exit(f"compare_packages: {first} has no packages.")
    differing = sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
    for name in differing:
        print("compare_packages:", *name, "differs" if name in a and name in b else "is in one build only", file=sys.stderr)
    print(f"compare_packages: {len(a)} files, {len(differing)} differ")
    return 1 if differing else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("compare_packages: usage: compare_packages.py FIRST_FOLDER SECOND_FOLDER")
    sys.exit(main(*sys.argv[1:]))
