"""Every path of a folder on Linux: a file system that is mounted twice, or a part of it, has its files twice.

A container often has a folder of its host in two places.
"""

from __future__ import annotations

import os
import re
from pathlib import PurePath
from typing import NamedTuple

_MOUNTS = "/proc/self/mountinfo"


class _Mount(NamedTuple):
    """A line of the table of mounts: its number, its device, and a folder of that device with its place."""

    number: str
    device: str
    root: PurePath
    point: PurePath


def every_path(path: str) -> list[str]:
    """Return the absolute paths of a folder, which need not exist yet; `path` alone where the system has no table.

    Examples
    --------
    >>> "/no/such/folder" in every_path("/no/such/folder")
    True
    """
    existing = PurePath(path)
    while not os.path.exists(existing) and existing != existing.parent:
        existing = existing.parent
    below = PurePath(path).relative_to(existing)
    try:
        descriptor = os.open(existing, os.O_PATH | os.O_CLOEXEC)
        try:
            status = os.fstat(descriptor)
            number = re.search(r"^mnt_id:\s*(\d+)", _text(f"/proc/self/fdinfo/{descriptor}"), re.MULTILINE)
        finally:
            os.close(descriptor)
        mounts = [_mount(line) for line in _text(_MOUNTS).splitlines()]
    except OSError:
        return [path]
    own = next((mount for mount in mounts if number and mount.number == number[1]), None)
    if own is None or not existing.is_relative_to(own.point):
        return [path]
    of_device = own.root / existing.relative_to(own.point)
    whole = of_device / below
    paths = [path]
    for mount in mounts:
        if mount.device != own.device:
            continue
        if mount.root != whole and mount.root.is_relative_to(whole):
            # A part of the folder is mounted there.
            paths.append(str(mount.point))
        elif of_device.is_relative_to(mount.root):
            place = mount.point / of_device.relative_to(mount.root)
            # Another mount may cover it.
            if os.path.exists(place) and os.path.samestat(os.stat(place), status):
                paths.append(str(place / below))
    return sorted(set(paths))


def _text(path: str) -> str:
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        return file.read()


def _mount(line: str) -> _Mount:
    number, _, device, root, point, *_ = line.split(" ")
    return _Mount(number, device, PurePath(_unescaped(root)), PurePath(_unescaped(point)))


def _unescaped(text: str) -> str:
    """Return a path, of which the table has blanks and backslashes by their octal numbers."""
    return re.sub(r"\\([0-7]{3})", lambda match: chr(int(match[1], 8)), text)
