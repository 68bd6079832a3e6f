"""Committed figures of the paper: renewed from a folder of ``fscm-bench paper``, or compared with it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from comparisons.data.file_names import BASELINE_FOLDER, committed
from comparisons.paper.registry import paper_figures
from comparisons.runs.atomic_files import write_file

#: Folder of the committed figures, in a clone of the repository.
PAPER_BASELINE = BASELINE_FOLDER / "paper"

#: Smallest change of a number that counts, relative to the largest number of its column: a hundred times the change
#: that rounding makes in the least certain of them (finite elements, u_num of 4e-7), and invisible in a picture.
SAME = 1e-6


def has_figures(folder: Path) -> bool:
    """Return whether a folder holds a file of a figure."""
    return any(figure.files_in(folder) for figure in paper_figures())


def renew(folder: Path, target: Path = PAPER_BASELINE) -> list[Path]:
    """Replace the committed figures by those in the folder of a finished ``fscm-bench paper``; return their paths.

    Raises
    ------
    ValueError
        If the folder lacks a figure; nothing is changed then.
    """
    return replace_files({figure.name: figure.files_in(folder) for figure in paper_figures()}, folder, target)


def replace_files(sources: Mapping[str, Sequence[Path]], folder: Path, target: Path) -> list[Path]:
    """Replace the files of the folder `target` by copies of those in a finished folder; return their paths.

    Parameters
    ----------
    sources : mapping of str to sequence of Path
        Files of `folder` by the name of what they belong to.

    Raises
    ------
    ValueError
        If `folder` lacks one; nothing is changed then.
    """
    if missing := [name for name, files in sources.items() if not files or not all(path.is_file() for path in files)]:
        raise ValueError(f"{folder} lacks {', '.join(missing)}: renew the baseline from the folder of a whole command")
    target.mkdir(parents=True, exist_ok=True)
    for stale in target.iterdir():
        stale.unlink()
    copies = {target / path.name: path for files in sources.values() for path in files}
    for copy, source in copies.items():
        write_file(copy, source.read_bytes())
    return list(copies)


def changes(stored: pd.DataFrame, computed: pd.DataFrame) -> list[str]:
    """Return the differences between two tables of a figure, one sentence a column.

    Bounds (columns named u, u_... or ..._u_num) are not compared: rounding changes their digits.

    Examples
    --------
    >>> stored = pd.DataFrame({"n": [1.0, 2.0], "value": [3.0, 4.0]})
    >>> changes(stored, stored.assign(value=[3.0, 4.1]))
    ['value differs in 1 of 2 rows, the first is row 2']
    """
    if list(stored.columns) != list(computed.columns) or len(stored) != len(computed):
        return [f"{len(stored)} rows of {list(stored.columns)}, now {len(computed)} of {list(computed.columns)}"]
    different = []
    for name in stored:
        before, now = stored[name], computed[name]
        if name == "u" or name.startswith("u_") or name.endswith("_u_num"):
            continue
        differs = (before != now) & ~(before.isna() & now.isna())
        if pd.api.types.is_float_dtype(before) and pd.api.types.is_float_dtype(now):
            differs &= ~((now - before).abs() <= SAME * before.abs().max())
        if differs.any():
            first_row = int(differs.to_numpy().argmax()) + 1
            different.append(f"{name} differs in {differs.sum()} of {len(stored)} rows, the first is row {first_row}")
    return different


def check(folder: Path, target: Path | None = None) -> pd.DataFrame:
    """Return the differences between the tables of a folder of ``fscm-bench paper`` and the committed ones.

    Figures that the folder does not hold, and those whose tables follow equilibrium paths, are not compared.

    Parameters
    ----------
    folder : Path
        Of ``fscm-bench paper``.
    target : Path, optional
        Of the committed tables (`comparisons.data.file_names`).

    Returns
    -------
    DataFrame
        Columns ``figure``, ``file`` and ``difference``.

    Raises
    ------
    ValueError
        If the folder holds no table to compare, or the committed figures are not there.
    """
    target = target or committed(PAPER_BASELINE.name)
    rows, compared = [], 0
    for figure in paper_figures():
        if figure.follows_path or not figure.files_in(folder):
            continue
        tables = {path.name for of in (folder, target) for path in figure.files_in(of) if path.suffix == ".csv"}
        compared += len(tables)
        for name in sorted(tables):
            paths = [of / name for of in (target, folder)]
            missing = [f"there is no file {path}" for path in paths if not path.is_file()]
            different = missing or changes(*map(pd.read_csv, paths))
            rows += [{"figure": figure.name, "file": name, "difference": difference} for difference in different]
    if not compared:
        raise ValueError(f"{folder} has no table of a figure to compare: it is not the folder of `fscm-bench paper`")
    return pd.DataFrame(rows, columns=["figure", "file", "difference"])
