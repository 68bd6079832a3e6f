"""Landlock of Linux: no writing and no signals beyond one folder, and hidden folders, for a process and its children.

Kernel documentation: userspace-api/landlock.  It needs no privileges and holds for a superuser too.  It binds
the calling thread and what that thread starts later, so it must be called before any other thread exists.
Rights are numbered as in linux/landlock.h; those a kernel does not know yet are left out.  A process that is bound can
neither mount nor trace a process that is not: the memory and the open files of others are closed to it as well.
"""

from __future__ import annotations

import ctypes
import os
import platform
import sys
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path, PurePath

from comparisons.external.mounts import every_path

#: The numbers of the system calls are the same on every architecture but Alpha.
_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_VERSION_FLAG, _RULE_PATH_BENEATH, _NO_NEW_PRIVILEGES = 1, 1, 38

#: Rights of files: writing, reading, moving to another folder, truncation.
_WRITE_FILE, _READ_FILE, _REFER, _TRUNCATE = 1 << 1, 1 << 2, 1 << 13, 1 << 14
#: Write, remove folder and file, make device, folder, file, socket, fifo, block device and link.
_CHANGES = _WRITE_FILE | sum(1 << bit for bit in range(4, 13))
#: Abstract sockets and signals to other processes.
_SCOPES = 0b11


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("network", ctypes.c_uint64), ("scopes", ctypes.c_uint64))


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _fields_ = (("allowed", ctypes.c_uint64), ("descriptor", ctypes.c_int32))


def confine(folder: Path | str, hidden: Collection[str] = ()) -> bool:
    """Restrict writing to the tree below `folder` and to /dev/null, and forbid reading of files in hidden folders.

    Parameters
    ----------
    folder : Path or str
        That is written in.
    hidden : collection of str
        Absolute paths of folders, which need not exist yet.  A file that appears later beside a folder on the way to
        one of them cannot be read either.

    Returns
    -------
    bool
        Whether the system did it; it holds then for this thread and all it starts, for good.
    """
    if sys.platform != "linux" or platform.machine().startswith("alpha"):
        return False
    libc = ctypes.CDLL(None, use_errno=True)
    version = libc.syscall(_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint32(_VERSION_FLAG))
    if version < 1:
        return False
    changes = _CHANGES | (_REFER if version >= 2 else 0) | (_TRUNCATE if version >= 3 else 0)
    files = changes | (_READ_FILE if hidden else 0)
    rules = _Ruleset(files, 0, _SCOPES if version >= 6 else 0)
    size = ctypes.sizeof(rules) if version >= 6 else 8
    ruleset = libc.syscall(_CREATE_RULESET, ctypes.byref(rules), ctypes.c_size_t(size), ctypes.c_uint32(0))
    if ruleset < 0:
        return False
    try:
        for path in _beside({path for name in hidden for path in every_path(name)}):
            # What is gone since it was listed needs no right.
            with suppress(OSError):
                _allow(libc, ruleset, path, _READ_FILE)
        return (
            _allow(libc, ruleset, folder, files)
            and _allow(libc, ruleset, os.devnull, files & (_WRITE_FILE | _READ_FILE | _TRUNCATE))
            and libc.prctl(_NO_NEW_PRIVILEGES, 1, 0, 0, 0) == 0
            and libc.syscall(_RESTRICT_SELF, ruleset, ctypes.c_uint32(0)) == 0
        )
    finally:
        os.close(ruleset)


def _beside(hidden: Collection[str]) -> Iterator[str]:
    """Yield the trees that have every file outside of the hidden ones: rights are given, not taken away."""
    above = {str(parent) for path in hidden for parent in PurePath(path).parents}
    for folder in above:
        if any(PurePath(folder).is_relative_to(path) for path in hidden):
            continue
        with suppress(OSError), os.scandir(folder) as entries:
            # A link has no rights of its own; its target has those of its place.
            yield from (
                entry.path
                for entry in entries
                if entry.path not in hidden and entry.path not in above and not entry.is_symlink()
            )


def _allow(libc: ctypes.CDLL, ruleset: int, path: Path | str, rights: int) -> bool:
    # A link that has taken the place of a folder is not followed.
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC | os.O_NOFOLLOW)
    try:
        rule = _PathBeneath(rights, descriptor)
        added = libc.syscall(_ADD_RULE, ruleset, _RULE_PATH_BENEATH, ctypes.byref(rule), ctypes.c_uint32(0))
        return bool(added == 0)
    finally:
        os.close(descriptor)
