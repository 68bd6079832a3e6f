"""The results that are committed: the quick tier as CSV, 17 digits, sorted, so that a change shows.

``python -m comparisons.publish results/runs/TIME`` takes them from the folder of a finished run.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from comparisons.store import atomic, csv_text, read_table

__all__ = ["PUBLISHED", "drift", "publish", "read_published"]

#: Where they are, in a clone of the repository.
PUBLISHED = Path("results", "published")

_KEY = ["model", "quantity", "n", "k", "mu", "nu"]
# What depends on the machine or on the work done (seconds, iterations, residual) is left out.
_FILES = {
    "quick.csv": ("results.parquet", [*_KEY, "value", "u_num", "status", "reason"]),
    "curves.csv": ("curves.parquet", [*_KEY, "point", "x", "y", "u_distance", "status", "reason"]),
}
_TEXTS = ("model", "quantity", "status", "reason")


def publish(folder: Path, target: Path = PUBLISHED) -> list[Path]:
    """Write the committed files from those of a run; return their paths."""
    target.mkdir(parents=True, exist_ok=True)
    written = []
    for name, (source, columns) in _FILES.items():
        with atomic(target / name) as file:
            file.write(csv_text(read_table(folder / source)[columns]).encode())
        written.append(target / name)
    return written


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
    """Publish the run in the folder that is given."""
    if len(arguments) != 1:
        print("usage: python -m comparisons.publish results/runs/TIME", file=sys.stderr)
        return 2
    for path in publish(Path(arguments[0])):
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
