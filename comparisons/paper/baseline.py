"""Committed figures of the paper: renewed from a folder of ``fscm-bench paper``, or compared with it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from comparisons.data.file_names import BASELINE_FOLDER
from comparisons.paper.registry import paper_figures
from comparisons.runs.atomic_files import atomic
from comparisons.runs.committed import committed

__all__ = ["PAPER_BASELINE", "SHIPPED_STATEMENTS", "changes", "check", "has_figures", "renew"]

#: Folder of the committed figures, in a clone of the repository.
PAPER_BASELINE = BASELINE_FOLDER / "paper"

#: Copy of the verdicts on the statements of the paper that is in every installation.
SHIPPED_STATEMENTS = Path("comparisons", "data", "paper_statements.csv")

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
    found = {figure.name: figure.files_in(folder) for figure in paper_figures()}
    missing = [name for name, sources in found.items() if not sources]
    if missing:
        raise ValueError(
            f"{folder} lacks {', '.join(missing)}: renew the baseline from the folder of a whole `fscm-bench paper`"
        )
    target.mkdir(parents=True, exist_ok=True)
    for stale in target.iterdir():
        stale.unlink()
    written = []
    for source in (path for sources in found.values() for path in sources):
        with atomic(target / source.name) as file:
            file.write(source.read_bytes())
        written.append(target / source.name)
    if target == PAPER_BASELINE:
        # The report of an installation has no clone to read them from.
        with atomic(SHIPPED_STATEMENTS) as file:
            file.write((target / SHIPPED_STATEMENTS.name).read_bytes())
        written.append(SHIPPED_STATEMENTS)
    return written


def changes(stored: pd.DataFrame, computed: pd.DataFrame) -> list[str]:
    """Return the differences between two tables of a figure, one sentence a column.

    Bounds (columns named u, u_... or ..._u_num) are not compared: rounding changes their digits.

    Examples
    --------
    >>> stored = pd.DataFrame({"n": [1.0, 2.0], "value": [3.0, 4.0]})
    >>> changes(stored, stored.assign(value=[3.0, 4.1]))
    ['value: up to 0.1 apart']
    """
    if list(stored.columns) != list(computed.columns) or len(stored) != len(computed):
        return [f"{len(stored)} rows of {list(stored.columns)}, now {len(computed)} of {list(computed.columns)}"]
    found = []
    for name in (name for name in stored.columns if not _is_bound(name)):
        before, now = stored[name], computed[name]
        if _is_real(before) and _is_real(now):
            apart = (now - before).abs()
            if (before.isna() != now.isna()).any():
                found.append(f"{name}: a number where there was none, or none where there was")
            elif apart.max() > SAME * before.abs().max():
                found.append(f"{name}: up to {apart.max():.2g} apart")
        elif not np.array_equal(before.fillna("").astype(str), now.fillna("").astype(str)):
            found.append(f"{name}: other texts")
    return found


def _is_bound(name: str) -> bool:
    return name == "u" or name.startswith("u_") or name.endswith("_u_num")


def _is_real(column: pd.Series) -> bool:
    return pd.api.types.is_numeric_dtype(column) and not pd.api.types.is_bool_dtype(column)


def check(folder: Path, target: Path | None = None) -> pd.DataFrame:
    """Return the differences between the tables of a folder of ``fscm-bench paper`` and the committed ones.

    Figures that the folder does not hold, and those whose tables follow equilibrium paths, are not compared.

    Parameters
    ----------
    folder : Path
        Of ``fscm-bench paper``.
    target : Path, optional
        Of the committed tables (`comparisons.runs.committed`).

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
        found = figure.files_in(folder)
        if figure.follows_path or not found:
            continue
        tables = {path.name for path in (*found, *figure.files_in(target)) if path.suffix == ".csv"}
        compared += len(tables)
        rows += [
            {"figure": figure.name, "file": name, "difference": difference}
            for name in sorted(tables)
            for difference in _file_changes(target / name, folder / name)
        ]
    if not compared:
        raise ValueError(f"{folder} has no table of a figure to compare: it is not the folder of `fscm-bench paper`")
    return pd.DataFrame(rows, columns=["figure", "file", "difference"])


def _file_changes(stored: Path, computed: Path) -> list[str]:
    for path in (stored, computed):
        if not path.is_file():
            return [f"there is no file {path}"]
    return changes(pd.read_csv(stored), pd.read_csv(computed))
