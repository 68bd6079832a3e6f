"""SHA-256 of the files that the results of a model can depend on, with a list of them in words.

A small folder is hashed as a whole: tables, binaries and modules that are imported late count too.  Of a large one,
and of one that has other uses, only what is imported or declared does.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path

from comparisons.data.file_names import JOURNAL, RECORD
from comparisons.external.cleaner import PREFIX
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

__all__ = ["MOST_BYTES", "MOST_FILES", "fingerprint", "imported_files", "roots_of"]

#: A folder is small, and hashed as a whole, up to these.
MOST_FILES, MOST_BYTES = 200, 20_000_000
#: What a model declares may be larger; it is read again for every process of the model.
_MOST_DECLARED, _MOST_DECLARED_BYTES = 10_000, 2_000_000_000

#: A folder with one of them holds the results of a run, which change during a run.
_OF_A_RUN = (RECORD, JOURNAL)
_SITES = ("site-packages", "dist-packages")
_NOT_ENTERED = ("__pycache__", "results", "node_modules", *_SITES)
_NOT_ENTERED_ENDINGS = (".egg-info", ".dist-info")
_NOT_READ_ENDINGS = (".pyc", ".log", "~")
_STANDARD_LIBRARY = Path(os.__file__).resolve().parent
#: This program has a fingerprint of its own.
_OURS = [Path(__file__).resolve().parents[2] / name for name in ("comparisons", "fscm", "fem_reference")]


def fingerprint(
    roots: Mapping[Path, Path],
    declared: object = (),
    *,
    installed: Collection[Path] = (),
    imported: Collection[Path] = (),
    skip: Collection[Iterable[int]] = (),
) -> tuple[str, str]:
    """Return the digest of a model's files in hexadecimal digits, and what was hashed in words.

    Parameters
    ----------
    roots : mapping of Path to Path
        Folders of the model, and the file that was loaded in each.
    declared : tuple of str, optional
        Files and folders that the model names, relative to the first of its folders.
    installed : collection of Path, optional
        Files that were installed with the model.
    imported : collection of Path, optional
        Modules that were imported when the model was loaded.
    skip : collection of (device, inode), optional
        Files that are written during a run, such as one that takes standard output.

    Raises
    ------
    comparisons.model.ComputationFailed
        If what is declared is not a tuple of names, does not exist or is too large.
    """
    files: dict[str, Path] = {}
    parts: list[str] = []
    skipped = {tuple(file) for file in skip}
    for number, (root, file) in enumerate(roots.items()):
        beside, words = _of_root(root, installed, imported, skipped)
        files |= {f"{number}/{path.relative_to(root).as_posix()}": path for path in {file, *beside}}
        parts.append(words)
    named = _declared(declared, next(iter(roots), Path()))
    if named:
        parts.append(f"{len(named)} declared file{'s' * (len(named) > 1)}")
    digest, size = _digest(files | named)
    words = " and ".join(parts) or "nothing: the model has no file"
    return digest, one_line(f"{words}; {len(files | named)} files, {size} bytes")


def roots_of(modules: Iterable[str]) -> dict[Path, Path]:
    """Return the folders of loaded modules or of their packages, and the file of the module in each."""
    roots: dict[Path, Path] = {}
    for name in modules:
        for file in _files_of([sys.modules.get(name)]):
            package = getattr(sys.modules.get(name.partition(".")[0]), "__path__", ())
            # A namespace package has several folders, and only one is this model's.
            parents = (Path(folder).resolve() for folder in package)
            roots.setdefault(next((one for one in parents if file.is_relative_to(one)), file.parent), file)
    return roots


def imported_files() -> set[Path]:
    """Return the files of all modules that are neither of Python itself nor of this program."""
    return set(_files_of(list(sys.modules.values())))


def _files_of(modules: Iterable[object]) -> Iterator[Path]:
    for module in modules:
        name = getattr(module, "__file__", None)
        if isinstance(name, str) and name.startswith(os.sep):
            file = Path(name).resolve()
            python = file.is_relative_to(_STANDARD_LIBRARY) and not any(part in _SITES for part in file.parts)
            if not python and not any(file.is_relative_to(folder) for folder in _OURS):
                yield file


def _digest(files: Mapping[str, Path]) -> tuple[str, int]:
    digest, size = hashlib.sha256(), 0
    for label, path in sorted(files.items()):
        content = b"unreadable"
        try:
            with path.open("rb") as file:
                content = hashlib.file_digest(file, "sha256").digest()
                size += file.tell()
        except OSError:
            pass
        digest.update(label.encode(errors="surrogateescape") + b"\0" + content)
    return digest.hexdigest(), size


def _of_root(
    root: Path, installed: Collection[Path], imported: Collection[Path], skip: Collection[tuple[int, ...]]
) -> tuple[list[Path], str]:
    if root.name in _SITES or any(root.glob("*.dist-info")):
        # Several packages share it: the module that was loaded, and what was installed with it.
        return _counted(installed, root), "the installed files of the model"
    shown, why = one_line(root.name, 60), "other uses"
    if not _is_shared(root):
        if (whole := _whole(root, skip)) is not None:
            return whole, f"all files in {shown}"
        why = f"over {MOST_FILES} files or {MOST_BYTES // 1_000_000} MB"
    return _counted(imported, root), f"the imported modules in {shown} (not the folder, which has {why})"


def _is_shared(root: Path) -> bool:
    """Whether a folder has other uses than the model: home, root, temporary files, results."""
    import pwd  # Not on Windows, where no model that is code is loaded.

    home = Path(pwd.getpwuid(os.getuid()).pw_dir).resolve()
    return root in (home, root.parent) or bool(root.stat().st_mode & stat.S_ISVTX) or _has(root, _OF_A_RUN)


def _has(folder: Path, names: Iterable[str]) -> bool:
    return any((folder / name).exists() for name in names)


def _whole(root: Path, skip: Collection[tuple[int, ...]]) -> list[Path] | None:
    """Return the files of a folder; None if they are too many or too large."""
    found: list[Path] = []
    size = 0
    for path in _paths(root):
        try:
            status = path.stat()
        except OSError:
            continue
        # A pipe or a device would never end.
        if stat.S_ISREG(status.st_mode) and (status.st_dev, status.st_ino) not in skip:
            found.append(path)
            size += status.st_size
            if len(found) > MOST_FILES or size > MOST_BYTES:
                return None
    return found


def _paths(root: Path) -> Iterator[Path]:
    for folder, inner, names in os.walk(root):
        here = Path(folder)
        inner[:] = [name for name in inner if _is_entered(name) and not _has(here / name, (*_OF_A_RUN, "pyvenv.cfg"))]
        yield from (here / name for name in names if _is_read(name))


def _is_entered(name: str) -> bool:
    return not (name in _NOT_ENTERED or name.startswith((".", PREFIX)) or name.endswith(_NOT_ENTERED_ENDINGS))


def _is_read(name: str) -> bool:
    return not (name.startswith(".") or name.endswith(_NOT_READ_ENDINGS))


def _counted(paths: Iterable[Path], root: Path) -> list[Path]:
    """Return the files in a folder that have no part that is hidden, of a cache or of an environment."""
    parts = ((path, path.relative_to(root).parts) for path in paths if path.is_relative_to(root) and path.is_file())
    return [path for path, (*folders, name) in parts if all(map(_is_entered, folders)) and _is_read(name)]


def _declared(declared: object, base: Path) -> dict[str, Path]:
    if not isinstance(declared, tuple | list) or not all(isinstance(name, str) for name in declared):
        raise ComputationFailed(
            f'files = {one_line(repr(declared), 80)} is not a tuple of texts such as ("table.csv", "data/"): '
            "it names the files that the model reads"
        )
    files: dict[str, Path] = {}
    for name in declared:
        shown, path = one_line(repr(name), 80), base / name
        if os.path.isabs(name):
            raise ComputationFailed(f"files has {shown}, but the names are relative to the folder of the model")
        if not os.path.isfile(path) and not os.path.isdir(path):
            raise ComputationFailed(f"files has {shown}, but there is no such file or folder beside the model")
        # Labels have the declared name: two names may lead to one file.
        below = (Path(folder, one) for folder, _, names in os.walk(path) for one in names)
        for entry in [path] if os.path.isfile(path) else filter(Path.is_file, below):
            files[f"files/{name}/{entry.relative_to(path).as_posix()}"] = entry
            if len(files) > _MOST_DECLARED:
                raise ComputationFailed(f"files names more than {_MOST_DECLARED} files: they are read at every start")
    if sum(path.stat().st_size for path in files.values()) > _MOST_DECLARED_BYTES:
        raise ComputationFailed(f"files names more than {_MOST_DECLARED_BYTES} bytes: they are read at every start")
    return files
