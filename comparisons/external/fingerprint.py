"""SHA-256 of the files that the results of a model can depend on, with a list of them in words.

Run in the child process.  A small folder is hashed as a whole: tables, binaries and modules that are imported
late count too.  Of a large one, and of one that several programs share, only what is imported or declared does.
"""

from __future__ import annotations

import hashlib
import os
import pwd
import stat
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from comparisons.data.file_names import JOURNAL, RECORD
from comparisons.external.scratch import PREFIX
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed

__all__ = ["Fingerprint", "fingerprint"]

#: A folder is small, and hashed as a whole, up to these.
MOST_FILES, MOST_BYTES = 200, 20_000_000
#: What a model declares may be larger; it is read again for every process of the model.
_MOST_DECLARED, _MOST_DECLARED_BYTES = 10_000, 2_000_000_000

#: A folder with one of them holds the results of a run, which change during a run.
_OF_A_RUN = (RECORD, JOURNAL)
_SITES = ("site-packages", "dist-packages")
_NOT_ENTERED = ("__pycache__", "results", "node_modules", *_SITES)
_NOT_READ = (".pyc", ".log", "~")
_STANDARD_LIBRARY = Path(os.__file__).resolve().parent
#: This program has a fingerprint of its own.
_OURS = [Path(__file__).resolve().parents[2] / name for name in ("comparisons", "fscm", "fem_reference")]


@dataclass(frozen=True, slots=True)
class Fingerprint:
    """What identifies a state of a model's files.

    Attributes
    ----------
    digest : str
        SHA-256 in hexadecimal digits.
    hashed : str
        What was hashed, in words.
    """

    digest: str
    hashed: str


def fingerprint(
    modules: Iterable[str],
    declared: object = (),
    *,
    installed: Iterable[Path] = (),
    programs: Iterable[Path] = (),
    skip: Iterable[tuple[int, int]] = (),
) -> Fingerprint:
    """Return the fingerprint of a model.

    Parameters
    ----------
    modules : iterable of str
        Names of loaded modules: where the model was found, and where its class is defined.
    declared : tuple of str, optional
        Files and folders that the model names, relative to the folder of the first module or its package.
    installed : iterable of Path, optional
        Files that were installed with the model.
    programs : iterable of Path, optional
        Programs in place of modules.
    skip : iterable of (device, inode), optional
        Files that are written during a run, such as one that takes standard output.

    Raises
    ------
    comparisons.model.ComputationFailed
        If what is declared is not a tuple of names, does not exist or is too large.
    """
    files: dict[str, Path] = {}
    parts: list[str] = []
    roots: list[Path] = []
    for root, file in _starting_points(modules, programs):
        if root in roots:
            continue
        found, words = _of_root(root, file, set(installed), set(skip))
        files |= {f"{len(roots)}/{path.relative_to(root).as_posix()}": path for path in found}
        parts.append(words)
        roots.append(root)
    named = _declared(declared, roots[0] if roots else Path.cwd())
    if named:
        parts.append(f"{len(named)} declared files" if len(named) > 1 else "1 declared file")
    return _hashed(files | named, parts)


def _starting_points(modules: Iterable[str], programs: Iterable[Path]) -> Iterator[tuple[Path, Path]]:
    """Yield the folder and the file of each module of the model, and of each program."""
    for name in modules:
        file = getattr(sys.modules.get(name), "__file__", None)
        if file is not None and _is_of_model(Path(file).resolve()):
            yield _root(name, Path(file).resolve()), Path(file).resolve()
    for program in programs:
        yield program.resolve().parent, program.resolve()


def _hashed(files: dict[str, Path], parts: list[str]) -> Fingerprint:
    digest = hashlib.sha256()
    size = 0
    for label, path in sorted(files.items()):
        content = b"unreadable"
        try:
            with path.open("rb") as file:
                content = hashlib.file_digest(file, "sha256").digest()
                size += file.tell()
        except OSError:
            pass
        digest.update(label.encode(errors="surrogateescape") + b"\0" + content)
    words = " and ".join(parts) or "nothing: the model has no file"
    return Fingerprint(digest.hexdigest(), one_line(f"{words}; {len(files)} files, {size} bytes"))


def _root(module: str, file: Path) -> Path:
    """Return the folder of the module's package, or of its file."""
    package = getattr(sys.modules.get(module.partition(".")[0]), "__path__", None) or ()
    # A namespace package has several folders, and only one is this model's.
    return next((Path(part).resolve() for part in package if file.is_relative_to(Path(part).resolve())), file.parent)


def _of_root(root: Path, file: Path, installed: set[Path], skip: set[tuple[int, int]]) -> tuple[list[Path], str]:
    shown = one_line(root.name, 60)
    if root.name in _SITES or any(root.glob("*.dist-info")):
        # Several packages share it: this module, and what was installed with it.
        beside = {path for path in installed if path.is_relative_to(root) and _counts(path.relative_to(root))}
        found = sorted({file, *(path for path in beside if path.is_file())})
        return found, f"{len(found)} installed files of the model"
    if _is_shared(root):
        return _imported(root, file), f"the imported modules in {shown} (not the folder, which has other uses)"
    whole = _whole(root, skip)
    if whole is None:
        limits = f"{MOST_FILES} files or {MOST_BYTES // 1_000_000} MB"
        return _imported(root, file), f"the imported modules in {shown} (not the folder, which has over {limits})"
    return sorted({file, *whole}), f"all files in {shown}"


def _is_shared(root: Path) -> bool:
    """Whether a folder has other uses than the model: home, root, temporary files, results."""
    home = Path(pwd.getpwuid(os.getuid()).pw_dir).resolve()
    return (
        root == home
        or root.parent == root
        or bool(root.stat().st_mode & stat.S_ISVTX)
        or any((root / name).exists() for name in _OF_A_RUN)
    )


def _whole(root: Path, skip: set[tuple[int, int]]) -> list[Path] | None:
    found: list[Path] = []
    size = 0
    for path in _counted_paths(root):
        try:
            status = path.stat()
        except OSError:
            continue
        # A pipe or a device would never end.
        if not stat.S_ISREG(status.st_mode) or (status.st_dev, status.st_ino) in skip:
            continue
        found.append(path)
        size += status.st_size
        if len(found) > MOST_FILES or size > MOST_BYTES:
            return None
    return found


def _counted_paths(root: Path) -> Iterator[Path]:
    for folder, inner, names in os.walk(root):
        here = Path(folder)
        inner[:] = [name for name in inner if _is_entered(here / name)]
        yield from (here / name for name in names if _counts(Path(name)))


def _is_entered(folder: Path) -> bool:
    marks = (*_OF_A_RUN, "pyvenv.cfg")
    return _counts(folder.relative_to(folder.parent), folder=True) and not any((folder / m).exists() for m in marks)


def _counts(path: Path, *, folder: bool = False) -> bool:
    """Whether a path, relative to the model's folder, has no part that is hidden, of a cache or of an environment."""
    folders = path.parts if folder else path.parts[:-1]
    return not (
        any(part.startswith(".") for part in path.parts)
        or any(part in _NOT_ENTERED or part.startswith(PREFIX) for part in folders)
        or any(part.endswith((".egg-info", ".dist-info")) for part in folders)
        or (not folder and path.name.endswith(_NOT_READ))
    )


def _imported(root: Path, file: Path) -> list[Path]:
    found = {file}
    for module in list(sys.modules.values()):
        loaded = getattr(module, "__file__", None)
        if isinstance(loaded, str) and loaded.startswith(os.sep):
            path = Path(loaded).resolve()
            if path.is_relative_to(root) and _counts(path.relative_to(root)) and _is_of_model(path):
                found.add(path)
    return sorted(found)


def _is_of_model(file: Path) -> bool:
    """Whether a file is neither of Python itself nor of this program."""
    python = file.is_relative_to(_STANDARD_LIBRARY) and not any(part in _SITES for part in file.parts)
    return not python and not any(file.is_relative_to(folder) for folder in _OURS)


def _declared(declared: object, base: Path) -> dict[str, Path]:
    if not isinstance(declared, tuple | list) or not all(isinstance(name, str) for name in declared):
        raise ComputationFailed(
            f'files = {one_line(repr(declared), 80)} is not a tuple of texts such as ("table.csv", "data/"): '
            "it names the files that the model reads"
        )
    files: dict[str, Path] = {}
    for name in declared:
        shown, path = one_line(repr(name), 80), os.path.join(base, name)
        if os.path.isabs(name):
            raise ComputationFailed(f"files has {shown}, but the names are relative to the folder of the model")
        if os.path.isfile(path):
            files[f"files/{name}"] = Path(path)
            continue
        if not os.path.isdir(path):
            raise ComputationFailed(f"files has {shown}, but there is no such file or folder beside the model")
        for folder, _, names in os.walk(path):
            inside = [entry for entry in (Path(folder, one) for one in sorted(names)) if entry.is_file()]
            files |= {f"files/{name}/{entry.relative_to(path).as_posix()}": entry for entry in inside}
            if len(files) > _MOST_DECLARED:
                raise ComputationFailed(f"files names more than {_MOST_DECLARED} files: they are read at every start")
    if sum(path.stat().st_size for path in files.values()) > _MOST_DECLARED_BYTES:
        raise ComputationFailed(f"files names more than {_MOST_DECLARED_BYTES} bytes: they are read at every start")
    return files
