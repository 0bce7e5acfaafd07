# SPDX-License-Identifier: Apache-2.0
"""A root file system that holds nothing but glibc's libraries, and programs run in it.

Where neither root nor user namespaces are to be had the programs cannot be run, and tests of theirs fail."""

import os
import pathlib
import re
import shutil
import subprocess

TOP = pathlib.Path(__file__).resolve().parents[2]
GLIBC = r"(?:ld-linux[^/]*|libc|libm|libmvec|libpthread|libdl|librt|libresolv|libutil)\.so\.\d+"
DATA = ["datasets/coulomb.csv", "datasets/textbook_rig.json"]
FIT = ["--data", DATA[0], "--rig", DATA[1], "--model", "coulomb", "--json", "-"]


def glibc_of(program):
    """The paths of glibc's libraries and of the loader, as the loader resolves them for a program."""
    listing = subprocess.run(["ldd", program], check=True, capture_output=True, text=True).stdout
    return re.findall(rf"(/\S*/{GLIBC}) \(", listing)


def fill(root, program):
    """Puts into the folder what a program needs of glibc, and the data of FIT."""
    for path in glibc_of(program) + DATA:
        target = root / path.lstrip("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path if path.startswith("/") else TOP / path, target)


def tell_origin(root, tool):
    """The loader learns from /proc where the program lies that it loads, and only the folder matters to it. This link
    stands for that, which needs no right to mount: it is the same for all tools of a folder."""
    link = root / "proc/self/exe"
    link.parent.mkdir(parents=True)
    link.symlink_to(tool)


def run(root, command, **environment):
    """Runs a command whose paths are those of the root, with this environment and no other; it begins in /."""
    path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
    chroot = [shutil.which("chroot", path=path), root]
    if os.geteuid() != 0:
        chroot = [shutil.which("unshare", path=path), "--user", "--map-root-user", *chroot]
    return subprocess.run([*chroot, *command], env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)


def only_one(packages, pattern):
    """The one package of this kind."""
    found = sorted(pathlib.Path(packages).glob(pattern))
    if len(found) != 1:
        raise FileNotFoundError(f"{packages} has {len(found)} of {pattern}, not one: {found}")
    return found[0]
