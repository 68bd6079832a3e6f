"""SHA-256 of the files that the results of a model can depend on, with a list of them in words.

A small folder is hashed as a whole: tables, binaries and modules that are imported late count too. Of a large one,
and of one that has other uses, only what is loaded or declared does.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from shutil import ignore_patterns

from comparisons.data.file_names import RECORD, STORE
from comparisons.data.folder_entries import TooMany, entries_below
from comparisons.data.input_files import regular_file
from comparisons.external.cleaner import PREFIX
from comparisons.external.text_rules import one_line

#: A folder is small, and hashed as a whole, up to these.
MOST_FILES, MOST_BYTES = 200, 20_000_000
#: What a model declares may be larger; it is read again for every process of the model.
_MOST_DECLARED, _MOST_DECLARED_BYTES = 10_000, 2_000_000_000
#: Most entries of any kind that are read in a folder of the model: a small one has few beside its files.
_MOST_ENTRIES = 10_000

#: Bytes that are read at a time.
_CHUNK = 1 << 20

#: Folders of installed packages.
SITES = ("site-packages", "dist-packages")
#: A folder with one of them holds the results of a run, or is an environment, and is no part of a model.
_OF_OTHERS = (RECORD, STORE, "pyvenv.cfg")
#: What is no part of a model: names of files and folders, and of folders alone, also of scratch folders of models.
_ignored = ignore_patterns(".*", "*~", "*.pyc", "*.log", "*.egg-info", "*.dist-info")
_not_entered = ignore_patterns("__pycache__", "results", "node_modules", *SITES, PREFIX + 8 * "[a-z0-9_]")


def fingerprint(
    roots: Mapping[Path, Path],
    declared: Collection[str] = (),
    loaded: Collection[Path] = (),
    within: Path | None = None,
) -> tuple[str, str]:
    """Return the digest of a model's files in hexadecimal digits, and what was hashed in words.

    Regular files are read up to the size that the system states, and nothing else.

    Parameters
    ----------
    roots : mapping of Path to Path
        Folders of the model, and the file that was loaded in each.
    declared : collection of str, optional
        Files and folders that the model names, relative to the first of its folders.
    loaded : collection of Path, optional
        Modules that were imported with the model, and files that were installed with it.
    within : Path, optional
        A folder that what is declared must not lead out of.

    Raises
    ------
    ValueError
        If what is declared does not exist, leads out of the folder or is too large.
    """
    files = dict(_declared(declared, next(iter(roots), Path()), within))
    words = [f"{len(files)} declared file{'s' * (len(files) > 1)}"] if files else []
    for number, (root, file) in enumerate(roots.items()):
        beside, text = _of_root(root, loaded)
        files |= {f"{number}/{path.relative_to(root).as_posix()}": path for path in {file, *beside} if _is_file(path)}
        words.insert(number, text)
    digest, size = hashlib.sha256(), 0
    for label, path in sorted(files.items()):
        content, length = _content(path)
        size += length
        digest.update(label.encode(errors="surrogateescape") + b"\0" + content)
    text = " and ".join(words) or "nothing: the model has no file"
    return digest.hexdigest(), one_line(f"{text}; {len(files)} files, {size} bytes")


def _content(path: Path) -> tuple[bytes, int]:
    """Return the digest of a file and its size."""
    digest, left = hashlib.sha256(), 0
    try:
        with regular_file(path, _MOST_DECLARED_BYTES) as (file, size):
            left = size
            while left and (chunk := file.read(min(left, _CHUNK))):
                digest.update(chunk)
                left -= len(chunk)
            return digest.digest(), size - left
    except (OSError, ValueError):
        return b"unreadable", 0


def _is_file(path: Path) -> bool:
    """Whether a path leads to a regular file; one that the system refuses, as a name of 300 characters, does not."""
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (OSError, ValueError):
        return False


def _of_root(root: Path, loaded: Collection[Path]) -> tuple[Collection[Path], str]:
    """Return the files of a folder that count, and which they are in words."""
    inside = [path for path in loaded if path.is_relative_to(root) and _is_file(path)]
    used = []
    for path in inside:
        *folders, _ = parts = path.relative_to(root).parts
        if not _ignored("", list(parts)) and not _not_entered("", folders):
            used.append(path)
    name = one_line(root.name, 60)
    if root.name in SITES or _has_installed(root):
        return used, "the installed files of the model"
    if not _is_shared(root) and (files := _every_file(root)) is not None:
        return files, f"all files in {name}"
    large = f"over {MOST_FILES} files or {MOST_BYTES // 1_000_000} MB"
    return used, f"the imported modules in {name} (not the folder, which has {large}, or other uses)"


def _is_shared(root: Path) -> bool:
    """Whether a folder has other uses than the model: home, root, temporary files, results."""
    is_temporary = bool(root.stat().st_mode & stat.S_ISVTX)
    return root in (Path.home().resolve(), root.parent) or is_temporary or _is_of_others(root)


def _is_of_others(folder: Path) -> bool:
    return any((folder / name).exists() for name in _OF_OTHERS)


def _has_installed(root: Path) -> bool:
    with contextlib.suppress(TooMany):
        return any(entry.name.endswith(".dist-info") for entry in entries_below(root, _MOST_ENTRIES, lambda _: False))
    return False


def _every_file(root: Path) -> list[Path] | None:
    """Return the files of a folder; None if they are too many or too large."""
    files: list[Path] = []
    size = 0
    try:
        for entry in entries_below(root, _MOST_ENTRIES, _is_entered):
            if _ignored("", [entry.name]) or entry.is_dir(follow_symlinks=False):
                continue
            with contextlib.suppress(OSError):
                status = entry.stat()
                # A pipe or a device would never end.
                if stat.S_ISREG(status.st_mode) and not _takes_output(status):
                    files.append(Path(entry.path))
                    size += status.st_size
            if len(files) > MOST_FILES or size > MOST_BYTES:
                return None
    except TooMany:
        return None
    return files


def _is_entered(folder: os.DirEntry[str]) -> bool:
    names = [folder.name]
    return not (_ignored("", names) or _not_entered("", names) or _is_of_others(Path(folder.path)))


def _takes_output(status: os.stat_result) -> bool:
    """Whether a file takes our output and so grows: ``fscm-bench run > output.txt``."""
    for descriptor in (1, 2):
        with contextlib.suppress(OSError):
            if os.path.samestat(os.fstat(descriptor), status):
                return True
    return False


def _declared(names: Iterable[str], base: Path, within: Path | None) -> Iterator[tuple[str, Path]]:
    count = size = 0
    limits = f"{_MOST_DECLARED} files or {_MOST_DECLARED_BYTES} bytes"
    too_many = f"files names more than {limits}: they are read at every start"
    for name in names:
        quoted, path = one_line(ascii(name), 80), base / name
        if os.path.isabs(name):
            raise ValueError(f"files has {quoted}, but the names are relative to the folder of the model")
        if not _is_file(path) and not os.path.isdir(path):
            raise ValueError(f"files has {quoted}, but there is no such file or folder beside the model")
        if within is not None and not _is_within(within, path):
            raise ValueError(f"files has {quoted}, which leads out of the folder of the submission")
        try:
            below = [] if _is_file(path) else [Path(entry.path) for entry in entries_below(path, _MOST_DECLARED)]
        except TooMany:
            raise ValueError(too_many) from None
        for entry in [path] if _is_file(path) else filter(_is_file, below):
            count, size = count + 1, size + entry.stat().st_size
            if count > _MOST_DECLARED or size > _MOST_DECLARED_BYTES:
                raise ValueError(too_many)
            # The declared name: two names may lead to one file.
            yield f"files/{name}/{entry.relative_to(path).as_posix()}", entry


def _is_within(folder: Path, path: Path) -> bool:
    """Whether a path is in a folder, where its links lead, too; ``..`` in it may stay inside."""
    root = os.path.realpath(folder)
    return os.path.commonpath([root, os.path.realpath(path)]) == root
