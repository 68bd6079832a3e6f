"""Submissions to the board: folders with a ``submission.toml`` beside the files of a model."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any

from comparisons.data.contained_paths import path_inside
from comparisons.data.input_files import read_text
from comparisons.data.toml_text import parse
from comparisons.data.validation import validated
from comparisons.output.report.board import Submission
from comparisons.registry import MODELS

#: Describes a submission.
MANIFEST = "submission.toml"


def submission_folders(root: Path) -> Iterator[Path]:
    """Yield the folders of submissions: `root` if it is one, else each folder in it, or the versions in that.

    Raises
    ------
    ValueError
        If there is none.
    """
    if (root / MANIFEST).is_file():
        yield root
        return
    folders = _folders_in(root) if root.is_dir() else []
    if not folders:
        raise ValueError(f"{root} has no folder with a {MANIFEST}: a board is made of submissions")
    for folder in folders:
        versions = [] if (folder / MANIFEST).is_file() else _folders_in(folder)
        yield from versions or [folder]


def _folders_in(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.is_dir() and not path.is_symlink() and path.name[0] != ".")


def read_submission(folder: Path) -> Submission:
    """Read the description of a submission; the model is not loaded.

    Raises
    ------
    ValueError
        If it cannot be read or is not admissible; one sentence says why.
    """
    path = path_inside(folder, MANIFEST)
    described: dict[str, Any] = parse(read_text(path, "the description of the submission"), MANIFEST)
    if isinstance(described.get("date"), date):
        described["date"] = described["date"].isoformat()
    validated(described, "submission", MANIFEST)
    authors, model = tuple(described.pop("authors")), described.pop("model")
    return Submission(**described, authors=authors, spec=_spec(folder, model))


def _spec(folder: Path, model: str) -> str:
    """Return the SPEC of a registered model, or of a file in the folder; nothing else that is installed is run."""
    if model in MODELS:
        return model
    name, colon, attribute = model.rpartition(":") if ".py:" in model else (model, "", "")
    path = path_inside(folder, name)
    if not path.is_file():
        raise ValueError(f"{MANIFEST}: model = {model!a:.80} is not a model of fscm-bench, and no file beside it")
    # With a separator it is not a name of an installed model.
    return f"{path if path.is_absolute() else f'./{path}'}{colon}{attribute}"
