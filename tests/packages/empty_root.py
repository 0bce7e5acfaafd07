# SPDX-License-Identifier: Apache-2.0
"""A root file system that contains only glibc's libraries, and programs run in it.

Without root rights and without user namespaces the programs cannot run, and their tests fail."""

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
    """Copies the glibc files that a program needs, and the data of FIT, into the folder."""
    for path in glibc_of(program) + DATA:
        target = root / path.lstrip("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path if path.startswith("/") else TOP / path, target)


def link_proc_self_exe(root, tool):
    """Replaces /proc/self/exe by a link to the tool, because the loader reads the program's folder from it and mounting
    /proc would need root rights. All tools of a folder can use the same link."""
    link = root / "proc/self/exe"
    link.parent.mkdir(parents=True)
    link.symlink_to(tool)


def run(root, command, **environment):
    """Runs a command with paths relative to the root and only this environment; it starts in /."""
    path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
    chroot = [shutil.which("chroot", path=path), root]
    if os.geteuid() != 0:
        chroot = [shutil.which("unshare", path=path), "--user", "--map-root-user", *chroot]
    return subprocess.run([*chroot, *command], env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)


def only_one(packages, pattern):
    """The only package that matches the pattern."""
    found = sorted(pathlib.Path(packages).glob(pattern))
    if len(found) != 1:
        raise FileNotFoundError(f"{packages} has {len(found)} of {pattern}, not one: {found}")
    return found[0]
