"""The results that are committed, numbers as CSV with 17 digits, so that a change shows.

``python -m comparisons.baseline FOLDER`` takes them from the folder of a finished ``fscm-bench run`` or, with its
pictures, of ``fscm-bench paper``.  Of a run of the quick tier these are the results, the curves, the largest errors and
their pictures; of one of the full tier how far both references are apart, of which the quick tier has a few cases only.
``python -m comparisons.baseline --check FOLDER`` changes nothing and lists the results of a run that are not those
committed.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from comparisons.console.exit_status import guarded
from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA_FIGURE, LARGEST_KAPPA, REFERENCES, RESULTS
from comparisons.paper.registry import paper_figures
from comparisons.runs.atomic_files import atomic
from comparisons.runs.csv_format import csv_text, plain_text
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import check_files, read_record
from comparisons.runs.tables import read_table

__all__ = [
    "BASELINE",
    "PAPER_BASELINE",
    "changes",
    "check",
    "drift",
    "publish",
    "read_baseline",
    "renew_paper_baseline",
]

#: Where they are, in a clone of the repository.
BASELINE = Path("results", "baseline")
PAPER_BASELINE = BASELINE / "paper"

_KEY = ["model", "quantity", "n", "k", "mu", "nu"]
# What depends on the machine or on the work done (seconds, iterations, residual) is left out.
_TABLES = {
    "quick.csv": (f"{RESULTS}.parquet", [*_KEY, "value", "u_num", "status", "reason"]),
    "curves.csv": (f"{CURVES}.parquet", [*_KEY, "point", "x", "y", "u_distance", "status", "reason"]),
}
#: What is taken as it is, by tier: the committed name, and that in the folder of the run.
_COPIES = {
    "quick": {
        name: name
        for name in (f"{LARGEST_KAPPA}.csv", f"{KAPPA_FIGURE}.png", f"{KAPPA_FIGURE}.pdf", f"{REFERENCES}.png")
    },
    "full": {f"references_agreement.{suffix}": f"{AGREEMENT}.{suffix}" for suffix in ("csv", "png")},
}
_TEXTS = ("model", "quantity", "status", "reason")

#: Change of a number in a figure that counts, relative to the largest of its column: a hundred times what rounding
#: moves the least certain of them (finite elements, u_num of 4e-7), and far below what a picture shows.
SAME = 1e-6


def publish(folder: Path, target: Path = BASELINE) -> list[Path]:
    """Replace the committed files by those of a run, as far as its tier makes them; return their paths.

    Raises
    ------
    ValueError
        If it is no finished run, lacks a file, was changed, or has other models or cases than the standing ones;
        nothing is changed then.
    """
    record = read_record(RunFolder(folder).record)
    check_files(record, folder)
    tier = _tier(record, folder)
    models = record["arguments"]["model"]
    if models is not None:
        raise ValueError(f"{folder} has the models {', '.join(models)} only: publish a run without --model")
    tables = _TABLES if tier == "quick" else {}
    texts = {name: csv_text(read_table(folder / source)[columns]) for name, (source, columns) in tables.items()}
    contents = {name: text.encode() for name, text in texts.items()}
    for name, source in _COPIES[tier].items():
        if not (folder / source).exists():
            raise ValueError(f"{folder} lacks {source}: publish the folder of a finished run")
        contents[name] = (folder / source).read_bytes()
    target.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        with atomic(target / name) as file:
            file.write(content)
    return [target / name for name in contents]


def _tier(record: dict[str, Any], folder: Path) -> str:
    """Return the tier of a run."""
    tier = record["arguments"].get("tier")
    if tier is None:
        raise ValueError(f"{folder} is not the folder of a run of the standing cases: give one of `fscm-bench run`")
    return str(tier)


def renew_paper_baseline(folder: Path, target: Path = PAPER_BASELINE) -> list[Path]:
    """Replace the committed figures by those in the folder of a finished ``fscm-bench paper``; return their paths.

    Raises
    ------
    ValueError
        If the folder lacks one; nothing is changed then.
    """
    found = {figure.name: sorted(folder.glob(f"{figure.stem}[._]*")) for figure in paper_figures()}
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
    """Return what differs between two tables of a figure, one sentence a column.

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
        if _is_real(before) and _is_real(now):
            apart = (now - before).abs()
            if (before.isna() != now.isna()).any():
                found.append(f"{name}: a number where there was none, or none where there was")
            elif apart.max() > SAME * before.abs().max():
                found.append(f"{name}: up to {apart.max():.2g} apart")
        elif not np.array_equal(before.fillna("").astype(str), now.fillna("").astype(str)):
            found.append(f"{name}: other texts")
    return found


def _is_real(column: pd.Series) -> bool:
    return pd.api.types.is_numeric_dtype(column) and not pd.api.types.is_bool_dtype(column)


def read_baseline(target: Path = BASELINE) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the committed results and curves as tables fit for `comparisons.judging.judge.judge`.

    Raises
    ------
    ValueError
        If they are not there, as where the working folder is not the root of a clone.
    """
    if missing := [name for name in _TABLES if not (target / name).is_file()]:
        raise ValueError(
            f"there is no file {target / missing[0]}: the committed results are in a clone of the repository only; "
            "call this in its root folder"
        )
    rows, curves = (_read(target / name) for name in _TABLES)
    return rows, curves


def _read(path: Path) -> pd.DataFrame:
    """Read a table with every digit: each number goes through Python's own, exact conversion."""
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    numbers = {
        name: table[name].map(lambda text: float(text) if text else math.nan).astype(float)
        for name in table.columns.difference(list(_TEXTS))
    }
    texts = {name: table[name].map(plain_text) for name in table.columns.intersection(list(_TEXTS))}
    return table.assign(**numbers, **texts)


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


def check(folder: Path) -> pd.DataFrame:
    """Return the results of a run of the quick tier that are not those committed, as `drift` does.

    Raises
    ------
    ValueError
        If it is no finished run of that tier, or a file of it was changed.
    """
    record = read_record(RunFolder(folder).record)
    check_files(record, folder)
    tier = _tier(record, folder)
    if tier != "quick":
        raise ValueError(f"{folder} is a run of the {tier} tier; the results that are committed are of the quick one")
    return drift(read_baseline()[0], read_table(RunFolder(folder).parquet(RunFolder(folder).results)))


def main(arguments: Sequence[str]) -> int:
    """Publish what the folder that is given holds, or check it.

    Returns
    -------
    int
        0 if all is well, 1 if results have drifted, 2 if the folder or the working folder is a wrong one, 4 if
        something cannot be written.
    """
    return guarded(lambda: _task(arguments), "python -m comparisons.baseline")


def _task(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m comparisons.baseline", description=__doc__)
    parser.add_argument("--check", action="store_true", help="change nothing, and list the results that have drifted")
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="of a finished run, or of the paper")
    args = parser.parse_args(arguments)
    if args.check:
        drifted = check(args.folder)
        print(f"{args.folder} is what is committed" if drifted.empty else csv_text(drifted))
        return 0 if drifted.empty else 1
    record = RunFolder(args.folder).record
    if record.exists() and read_record(record)["command_name"] != "paper":
        gave = ", ".join(map(str, publish(args.folder)))
    else:
        gave = f"{len(renew_paper_baseline(args.folder))} files of {PAPER_BASELINE}"
    print(f"{args.folder} gave {gave}; nothing else was changed.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
