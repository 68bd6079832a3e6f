"""Submissions to the board: their folders, to whom a name belongs, and their descriptions.

A submission is a folder with a ``submission.toml`` beside the files of a model.  It comes from anybody: its files are
counted, and its description is read by a schema and with limits, before anything of it runs.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from comparisons.console.printable import printable
from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import SUBMISSION
from comparisons.data.folder_entries import TooMany, entries_below
from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.data.validation import validated
from comparisons.external.fingerprint import MOST_BYTES, MOST_FILES
from comparisons.external.text_rules import appearance, is_portable, one_line
from comparisons.output.report.board_page import Submission
from comparisons.registry import MODELS

#: Most bytes of a description: fifty authors of 500 characters of two bytes.
_LARGEST_DESCRIPTION = 60_000

#: Longest path of a file in its submission.
_LONGEST_PATH = 200


@dataclass(frozen=True, slots=True)
class SubmissionFolder:
    """A folder that is a submission, or is taken for one.

    Attributes
    ----------
    folder : Path
    path : str
        Below the folder of all submissions, as a page shows it.
    names : tuple of str
        The names that its model may have; empty for any.
    flaw : str
        Why it is no submission; empty if it is one.
    """

    folder: Path
    path: str
    names: tuple[str, ...] = ()
    flaw: str = ""


def submission_folders(root: Path) -> list[SubmissionFolder]:
    """Return the folders of submissions: `root` if it is one, and each folder in it, or the versions in that.

    A name belongs to the folder that has it, so that no other folder takes its row, whatever the order.  A description
    above or below that of another one is a submission of its own.

    Raises
    ------
    ValueError
        If there is none.
    """
    below = list(_below(root)) if root.is_dir() else []
    if _is_described(root):
        # Beside submissions its description hides none of them, and has the name of their folder or is refused.
        beside = below if any(_is_described(entry.folder) for entry in below) else []
        return [SubmissionFolder(root, _shown(root.name), (_name(root),) if beside else ()), *beside]
    if not below:
        raise ValueError(f"{root} has no folder with a {SUBMISSION}: a board is made of submissions")
    return below


def _below(root: Path) -> Iterator[SubmissionFolder]:
    folders = _folders_in(root)
    # The folders in that of one model are its versions.
    of_root = () if any(folder.name == _name(root) for folder in folders) else (_name(root),)
    for folder in folders:
        versions = [] if folder.is_symlink() else [entry for entry in _folders_in(folder) if _is_described(entry)]
        # A description beside those of versions is one more version, and costs them nothing.
        own = [folder] if _is_described(folder) or not versions else []
        for submission in own + versions:
            parts = submission.relative_to(root).parts
            flaw = "its folder is a symbolic link" if submission.is_symlink() else ""
            if unusual := [part for part in parts if not is_portable(part)]:
                flaw = f"{unusual[0]!a:.80} in its path is a name that not every system can hold"
            yield SubmissionFolder(submission, _shown("/".join(parts)), (parts[0], *of_root), flaw)


def _name(root: Path) -> str:
    return os.path.basename(os.path.realpath(root))


def _is_described(folder: Path) -> bool:
    return os.path.lexists(folder / SUBMISSION)


def _folders_in(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.is_dir() and path.name[0] != ".")


def _shown(path: str) -> str:
    return one_line(printable(path), 200)


def read_submission(submission: SubmissionFolder) -> Submission:
    """Read the description of a submission; the model is not loaded.

    Raises
    ------
    ValueError
        If it cannot be read or is not admissible; one sentence says why.
    """
    if submission.flaw:
        raise ValueError(submission.flaw)
    check_files(submission.folder)
    text = read_text(submission.folder / SUBMISSION, "the description of the submission", _LARGEST_DESCRIPTION)
    described: dict[str, Any] = parse(text, SUBMISSION)
    if isinstance(described.get("date"), date):
        described["date"] = described["date"].isoformat()
    validated(described, "submission", SUBMISSION)
    name = described["name"]
    if submission.names and name not in submission.names:
        raise ValueError(f"the folder of the model {name} is {name}, and this one is {submission.names[0]}")
    if name not in MODELS and appearance(name) in map(appearance, MODELS):
        raise ValueError(f"the name {name} resembles that of a model of fscm-bench; choose another name")
    authors, model = tuple(described.pop("authors")), described.pop("model")
    return Submission(**described, authors=authors, spec=_spec(submission.folder, model))


def check_files(folder: Path) -> None:
    """Refuse a folder that has other things than a few regular files with names that every system can hold.

    Folders in it that are submissions of their own are not entered.

    Raises
    ------
    ValueError
        One sentence, which names the first of them.
    """
    size, names = 0, set[str]()
    for entry in _entries(folder):
        path = os.path.relpath(entry.path, folder)
        shown = f"{path!a:.80}"
        if entry.is_symlink() or not (entry.is_file() or entry.is_dir()):
            raise ValueError(
                f"{shown} of the submission is neither a regular file nor a folder: links are not followed"
            )
        if not is_portable(entry.name) or len(path) > _LONGEST_PATH or path.lower() in names:
            raise ValueError(
                f"{shown} of the submission is a name that not every system can hold: it needs letters, digits, . _ "
                f"and -, at most {_LONGEST_PATH} characters, and no other one that differs in capitals alone"
            )
        names.add(path.lower())
        size += entry.stat(follow_symlinks=False).st_size if entry.is_file() else 0
    if len(names) > MOST_FILES or size > MOST_BYTES:
        raise ValueError(
            f"the submission has {len(names)} files and folders of {size} bytes together; it may have {MOST_FILES} of "
            f"{MOST_BYTES} bytes, which are hashed"
        )


def _is_other(folder: Path, entry: Path) -> bool:
    """Whether a folder in that of a submission is one of its own."""
    return entry.parent == folder and _is_described(entry)


def _entries(folder: Path) -> Iterator[os.DirEntry[str]]:
    try:
        yield from entries_below(folder, 2 * MOST_FILES, lambda entry: not _is_other(folder, Path(entry.path)))
    except TooMany:
        raise ValueError(f"the submission has more than {2 * MOST_FILES} files and folders") from None


def _spec(folder: Path, model: str) -> str:
    """Return the SPEC of a registered model, or of a file in the folder; nothing else that is installed is run."""
    if model in MODELS:
        return model
    name, colon, attribute = model.rpartition(":") if ".py:" in model else (model, "", "")
    path = path_inside(folder, name)
    if not path.is_file():
        raise ValueError(f"{SUBMISSION}: model = {model!a:.80} is not a model of fscm-bench, and no file beside it")
    # With a separator it is not a name of an installed model.
    return f"{path if path.is_absolute() else f'./{path}'}{colon}{attribute}"
