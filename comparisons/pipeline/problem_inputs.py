"""Copies of a problem file and of its tables in the folder of a sweep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import INPUTS
from comparisons.data.input_files import LARGEST_TABLE, LARGEST_TEXT, read_bytes
from comparisons.problem_file.variation import Varied, variations
from comparisons.runs.atomic_files import atomic
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import read_record

__all__ = ["ProblemInputs", "inputs_of", "stored_inputs", "stored_problems"]


@dataclass(frozen=True)
class ProblemInputs:
    """What a sweep keeps of its problem file.

    Attributes
    ----------
    entry : dict
        For the record: path of the copy of the problem file, and of that of each table by its name in the file.
    contents : mapping of str to bytes
        By path in the folder of the sweep.
    """

    entry: dict[str, Any]
    contents: Mapping[str, bytes]

    def check(self, folder: RunFolder) -> None:
        """Refuse to replace files that are not of a sweep; `ValueError` names the first."""
        for name, content in self.contents.items():
            path = path_inside(folder.path, name)
            if path.exists() and not folder.journal.exists() and read_bytes(path, LARGEST_TABLE) != content:
                raise ValueError(
                    f"{path} was not written by a sweep, and a sweep would replace it; choose another folder with --out"
                )

    def write(self, folder: RunFolder) -> None:
        """Write the copies, and remove those of an earlier sweep of the folder."""
        for name in _written(folder) - set(self.contents):
            path_inside(folder.path, name).unlink(missing_ok=True)
        for name, content in self.contents.items():
            path = path_inside(folder.path, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            with atomic(path) as file:
                file.write(content)


def inputs_of(problem: Path, problems: Iterable[Varied]) -> ProblemInputs:
    """Return the copies of a problem file and of every table that its problems name.

    A table has the same place beside the copy as beside the file.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "pad.toml")
    ...     _ = file.write_text("# a problem")
    ...     inputs_of(file, []).entry
    {'problem': 'inputs/pad.toml', 'tables': {}}
    """
    contents = {f"{INPUTS}/{problem.name}": read_bytes(problem, LARGEST_TEXT)}
    tables: dict[str, str] = {}
    for varied in problems:
        for name in varied.problem.tables:
            if name in tables:
                continue
            tables[name] = f"{INPUTS}/{PurePath(name).as_posix()}"
            contents[tables[name]] = read_bytes(path_inside(problem.parent, name), LARGEST_TABLE)
    return ProblemInputs({"problem": next(iter(contents)), "tables": tables}, contents)


def stored_inputs(folder: Path, record: Mapping[str, Any]) -> ProblemInputs:
    """Return the copies in the folder of a finished sweep; `ValueError` if one is not there."""
    entry = dict(record["inputs"])
    try:
        contents = {name: read_bytes(path_inside(folder, name), LARGEST_TABLE) for name in _paths(entry)}
    except OSError as error:
        raise ValueError(f"{error.filename} cannot be read ({error.strerror}): run the sweep again") from None
    return ProblemInputs(entry, contents)


def stored_problems(folder: Path, record: Mapping[str, Any], vary: Sequence[str]) -> list[Varied]:
    """Return the problems of a finished sweep from the copies in its folder; `ValueError` as `variations`."""
    return variations(path_inside(folder, record["inputs"]["problem"]), vary)


def _paths(entry: Mapping[str, Any]) -> list[str]:
    return [entry["problem"], *entry["tables"].values()]


def _written(folder: RunFolder) -> set[str]:
    """The copies that an earlier sweep has written."""
    with suppress(ValueError, KeyError):
        return set(_paths(read_record(folder.record)["inputs"]))
    return set()
