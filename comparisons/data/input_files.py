"""Reader of the files that a user names or that come from elsewhere: regular files of limited size."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

#: Most bytes of a text in TOML: ninety times the standing gates, and read in seconds.
LARGEST_TEXT = 4_000_000

#: Most bytes of a table in CSV, and of the record of a run: a million rows of fifty bytes.
LARGEST_TABLE = 50_000_000

#: Most bytes of the rows that this program has stored, as a table or as the store: six million rows of 600 bytes.
LARGEST_ROWS = 4_000_000_000

#: A pipe without a writer would wait for one.  Windows lacks the flag, and has no pipes among its files.
_AT_ONCE = getattr(os, "O_NONBLOCK", 0)

_KINDS = {stat.S_IFIFO: "a pipe", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device", stat.S_IFSOCK: "a socket"}


def read_bytes(path: Path, largest: int) -> bytes:
    """Return the content of a regular file.

    Parameters
    ----------
    path : Path
    largest : int
        Most bytes that are read.

    Raises
    ------
    OSError
        If it cannot be opened or read.
    ValueError
        One sentence, if it is not a regular file or too large.

    Examples
    --------
    >>> read_bytes(Path("/dev/zero"), LARGEST_TEXT)
    Traceback (most recent call last):
    ValueError: /dev/zero is a device, which may have no end; give a regular file
    """
    with regular_file(path, largest) as (file, size):
        content = file.read(size + 1)
    if len(content) > size:
        raise ValueError(f"{path} has more bytes than the system states; give a file that is not being written")
    return content


@contextmanager
def regular_file(path: Path, largest: int) -> Iterator[tuple[IO[bytes], int]]:
    """Open a regular file; yield it and its size, which limits what is to be read: some files of /proc have no end.

    Raises
    ------
    OSError, ValueError
        As `read_bytes`.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | _AT_ONCE)
    except ValueError as error:  # a name with a NUL
        raise OSError(errno.EINVAL, str(error), str(path)) from None
    try:
        status = os.fstat(descriptor)
        check_regular(path, status, largest)
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            yield file, status.st_size
    finally:
        os.close(descriptor)


def check_regular(path: Path, status: os.stat_result, largest: int) -> None:
    """Refuse what is not a regular file, or one that is too large, as `read_bytes`."""
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(status.st_mode):
        kind = _KINDS.get(stat.S_IFMT(status.st_mode), "no file")
        raise ValueError(f"{path} is {kind}, which may have no end; give a regular file")
    if status.st_size > largest:
        raise ValueError(f"{path} has {status.st_size} bytes, more than {largest}; give a smaller file")


def read_text(path: Path, name: str, largest: int = LARGEST_TEXT, *, or_western: bool = False) -> str:
    r"""Return the text of a file in UTF-8, with ``\n`` at the end of each line and without a byte order mark.

    Parameters
    ----------
    path : Path
    name : str
        What the file is, for the sentence that refuses it.
    largest : int
        As of `read_bytes`.
    or_western : bool
        Whether it may be UTF-16 with a byte order mark or Windows-1252, as programs of instruments write it.

    Raises
    ------
    ValueError
        One sentence, if it cannot be read, is not a regular file, is too large or is not UTF-8.

    Examples
    --------
    >>> read_text(Path("no_such_file.toml"), "the problem file")
    Traceback (most recent call last):
    ValueError: no_such_file.toml: the problem file cannot be read (No such file or directory); check the name
    """
    if str(path) == "-":
        raise ValueError(f"-: {name} is not read from the standard input; give the name of a file")
    try:
        content = read_bytes(path, largest)
    except OSError as error:
        raise ValueError(f"{path}: {name} cannot be read ({error.strerror}); check the name") from None
    if or_western and content.startswith((b"\xff\xfe", b"\xfe\xff")):
        content = content.decode("utf-16", "replace").encode()
    elif or_western and not _is_utf8(content):
        content = content.decode("cp1252", "replace").encode()
    return utf8_text(path, content)


def _is_utf8(content: bytes) -> bool:
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def utf8_text(path: Path, content: bytes) -> str:
    r"""Return the text of a file with ``\n`` at the end of each line; `ValueError` if it is not UTF-8."""
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise ValueError(
            f"{path}, line {line}: the byte 0x{content[error.start]:02x} is not UTF-8; save the file as UTF-8"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")
