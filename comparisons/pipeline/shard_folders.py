"""Folders of the shards of a sweep that are merged: their records, and the rows that are taken of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from comparisons.data.validation import known_name
from comparisons.registry import MODELS
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import read_record
from comparisons.runs.reevaluation import same
from comparisons.runs.rows import Row
from comparisons.runs.store import Store, rows_in

__all__ = ["checked_records", "take_rows"]


def checked_records(
    folders: Sequence[Path],
    out: Path,
    common: Callable[[Mapping[str, Any]], Mapping[str, Any]],
) -> dict[Path, dict[str, Any]]:
    """Return the records of the folders of one sweep, each folder once.

    Parameters
    ----------
    folders : sequence of Path
    out : Path
        For the merged rows; none of `folders`.
    common : callable
        Entries of a record that all shards of a sweep have in common, each by its name in words.

    Raises
    ------
    ValueError
        One sentence: a folder is not that of a finished sweep, it has no store, it is `out`, or it is of another
        sweep than the first.
    """
    records: dict[Path, dict[str, Any]] = {}
    first: Path | None = None
    for folder in dict.fromkeys(folders):
        files = RunFolder(folder)
        record = read_record(files.record)
        first = first or folder
        found = record["command_name"]
        if found != "sweep":
            raise ValueError(f"{folder} is the folder of fscm-bench {found}; only sweeps are merged")
        if not files.store.exists():
            raise ValueError(f"{files.store} does not exist: only folders with their store are merged")
        if folder.resolve() == out.resolve():
            raise ValueError(f"{out} is one of the folders that are merged; choose another folder with --out")
        _check_models(record, files.record)
        records[folder] = record
        expected, own = common(records[first]), common(record)
        different = [words for words in expected if own[words] != expected[words]]
        if different:
            raise ValueError(f"{folder} and {first} are not shards of one sweep: they differ in their {different[0]}")
    return records


def _check_models(record: Mapping[str, Any], path: Path) -> None:
    """Refuse a model that is not ours and that the record does not describe: it would be loaded, and its code run."""
    arguments, described = record["arguments"], record["models"]
    for name in arguments["external"]:
        known_name("model", name, described, str(path))
    for name in arguments["model"] or ():
        known_name("model", name, {*MODELS, *arguments["external"]}, str(path))
        known_name("model", name, described, str(path))


def take_rows(folder: Path, store: Store[Row], usable: Callable[[Iterable[Row]], list[Row]]) -> None:
    """Add the rows of a folder that a store does not have, or has as failures only.

    Parameters
    ----------
    folder : Path
        Of a shard.
    store : Store of Row
        To which the rows are added.
    usable : callable
        The rows that belong to the sweep.

    Raises
    ------
    ValueError
        If a row has another result than one of the store.
    """
    with rows_in(folder) as given:
        stored = {row.key: row for row in usable(store.items)}
        taken = set()
        for row in usable(given.items):
            known = stored.get(row.key)
            if known is None or (known.status == "failed" and row.status != "failed"):
                taken.add(row.key)
            elif row.status != "failed" and not same(known, row):
                raise ValueError(
                    f"{folder} has another result than a folder before it for {_place(row)}: they differ by more than "
                    "both uncertainties"
                )
        store.drop(lambda row: row.key in taken)
        chosen = {id(row) for row in usable(given.items) if row.key in taken}
        store.take(given, lambda row: id(row) in chosen)


def _place(row: Row) -> str:
    return f"{row.quantity} of {row.model} at {row.label}"
