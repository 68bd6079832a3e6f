"""The results that are committed: the quick tier and the paper's plates as CSV, 17 digits, so that a change shows.

``python -m comparisons.publish FOLDER`` takes them from the folder of a finished ``fscm-bench run`` or, with its
pictures, of ``fscm-bench paper``.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from comparisons.paper.catalogue import plates
from comparisons.store import atomic, csv_text, read_table

__all__ = ["PLATES", "PUBLISHED", "changes", "drift", "publish", "publish_plates", "read_published"]

#: Where they are, in a clone of the repository.
PUBLISHED = Path("results", "published")
PLATES = PUBLISHED / "paper"

_KEY = ["model", "quantity", "n", "k", "mu", "nu"]
# What depends on the machine or on the work done (seconds, iterations, residual) is left out.
_FILES = {
    "quick.csv": ("results.parquet", [*_KEY, "value", "u_num", "status", "reason"]),
    "curves.csv": ("curves.parquet", [*_KEY, "point", "x", "y", "u_distance", "status", "reason"]),
}
_TEXTS = ("model", "quantity", "status", "reason")

#: Change of a number in a plate that counts, relative to the largest of its column: a hundred times what rounding
#: moves the least certain of them (finite elements, u_num of 4e-7), and far below what a picture shows.
SAME = 1e-6


def publish(folder: Path, target: Path = PUBLISHED) -> list[Path]:
    """Write the committed files from those of a run; return their paths."""
    target.mkdir(parents=True, exist_ok=True)
    written = []
    for name, (source, columns) in _FILES.items():
        with atomic(target / name) as file:
            file.write(csv_text(read_table(folder / source)[columns]).encode())
        written.append(target / name)
    return written


def publish_plates(folder: Path, target: Path = PLATES) -> list[Path]:
    """Replace the committed plates by those in the folder of a finished ``fscm-bench paper``; return their paths.

    Raises
    ------
    ValueError
        If the folder lacks one; nothing is changed then.
    """
    found = {plate.name: sorted(folder.glob(f"{plate.stem}[._]*")) for plate in plates()}
    missing = [name for name, files in found.items() if not files]
    if missing:
        raise ValueError(f"{folder} lacks {', '.join(missing)}: publish the folder of a whole `fscm-bench paper`")
    target.mkdir(parents=True, exist_ok=True)
    for stale in target.iterdir():
        stale.unlink()
    written = []
    for source in (file for files in found.values() for file in files):
        with atomic(target / source.name) as file:
            file.write(source.read_bytes())
        written.append(target / source.name)
    return written


def changes(stored: pd.DataFrame, computed: pd.DataFrame) -> list[str]:
    """Return what differs between two tables of a plate, one sentence a column.

    The uncertainties (columns that start with u) are left out: they are bounds, and rounding moves them freely.

    Examples
    --------
    >>> stored = pd.DataFrame({"n": [1.0, 2.0], "value": [3.0, 4.0]})
    >>> changes(stored, stored.assign(value=[3.0, 4.1]))
    ['value: up to 0.1 apart']
    """
    if list(stored.columns) != list(computed.columns) or len(stored) != len(computed):
        return [f"{len(stored)} rows of {list(stored.columns)}, now {len(computed)} of {list(computed.columns)}"]
    found = []
    for name in (name for name in stored.columns if not (name == "u" or name.startswith("u_"))):
        before, now = stored[name], computed[name]
        if pd.api.types.is_numeric_dtype(before) and pd.api.types.is_numeric_dtype(now):
            apart = (now - before).abs()
            if (before.isna() != now.isna()).any():
                found.append(f"{name}: a number where there was none, or none where there was")
            elif apart.max() > SAME * before.abs().max():
                found.append(f"{name}: up to {apart.max():.2g} apart")
        elif not np.array_equal(before.fillna("").astype(str), now.fillna("").astype(str)):
            found.append(f"{name}: other texts")
    return found


def read_published(target: Path = PUBLISHED) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the committed results and curves as tables fit for `comparisons.judge.judge`."""
    rows, curves = (_read(target / name) for name in _FILES)
    return rows, curves


def _read(path: Path) -> pd.DataFrame:
    """Read a table with every digit: each number goes through Python's own, exact conversion."""
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    numbers = {
        name: table[name].map(lambda text: float(text) if text else math.nan).astype(float)
        for name in table.columns.difference(list(_TEXTS))
    }
    return table.assign(**numbers)


def drift(stored: pd.DataFrame, computed: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of `computed` that are not those stored, within the uncertainties both state.

    Parameters
    ----------
    stored, computed : DataFrame
        Results; what is stored but was not computed does not matter.

    Returns
    -------
    DataFrame
        The key, both values and both statuses of every row that has drifted or is not stored.
    """
    both = computed.merge(stored, on=_KEY, how="left", suffixes=("", "_stored"), validate="one_to_one")
    apart = (both["value"] - both["value_stored"]).abs() > both["u_num"] + both["u_num_stored"]
    drifted = apart | (both["status"] != both["status_stored"])
    return both.loc[drifted, [*_KEY, "value", "value_stored", "u_num", "u_num_stored", "status", "status_stored"]]


def main(arguments: Sequence[str]) -> int:
    """Publish what the folder that is given holds."""
    if len(arguments) != 1:
        print("usage: python -m comparisons.publish FOLDER", file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    try:
        written = publish(folder) if (folder / "run.json").exists() else publish_plates(folder)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    for path in written:
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
