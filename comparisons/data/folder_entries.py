"""Entries of a folder of others: a limited number, and no link is followed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path


class TooMany(ValueError):
    """A folder has more entries than are read."""


def entries_below(
    folder: Path,
    most: int,
    is_entered: Callable[[os.DirEntry[str]], bool] = lambda _: True,
    skipped: tuple[type[OSError], ...] = (OSError,),
) -> Iterator[os.DirEntry[str]]:
    """Yield what is in a folder and in the folders below.

    Parameters
    ----------
    folder : Path
    most : int
        Most entries that are read, of any kind.
    is_entered : callable
        Whether a folder is entered; its own entry is yielded in any case.
    skipped : tuple of types of OSError
        Reasons for which a folder that cannot be read is left out; any other one is raised.

    Raises
    ------
    TooMany
        If there are more.
    OSError
        If a folder cannot be read for another reason than those of `skipped`.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     Path(folder, "a", "b").mkdir(parents=True)
    ...     [entry.name for entry in entries_below(Path(folder), 2)]
    ['a', 'b']
    """
    count, pending = 0, [os.fspath(folder)]
    while pending:
        with suppress(*skipped), os.scandir(pending.pop()) as entries:
            for entry in entries:
                count += 1
                if count > most:
                    raise TooMany(f"{folder} has more than {most} files and folders")
                yield entry
                if entry.is_dir(follow_symlinks=False) and is_entered(entry):
                    pending.append(entry.path)
