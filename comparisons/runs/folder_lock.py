"""Lock of a folder of results: one command at a time writes into it, from its first result to its record."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from comparisons.data.contained_paths import refuse_link
from comparisons.data.file_names import LOCK


@contextmanager
def locked(folder: Path, *, wait: bool = False) -> Iterator[None]:
    """Keep other processes from writing results into a folder; a block within a block of this thread is free.

    The system ends the lock with the process, however that ends.

    Parameters
    ----------
    folder : Path
        That exists.
    wait : bool
        Whether to wait for the end of another process that has the folder.

    Raises
    ------
    ValueError
        One sentence, if another process has the folder, or the lock is a link.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder, locked(Path(folder)), locked(Path(folder)):
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['.lock']
    """
    path = folder.resolve() / LOCK
    # Early versions of filelock would empty its target.
    refuse_link(path)
    lock = FileLock(path, is_singleton=True)
    try:
        lock.acquire(timeout=-1 if wait else 0)
    except Timeout:
        raise refusal(folder) from None
    try:
        yield
    finally:
        lock.release()


def refusal(folder: Path) -> ValueError:
    """Return the error of a command for whose folder another process has the lock."""
    return ValueError(f"another process is computing into {folder}: wait for it, or choose another folder with --out")
