"""Fits of many curves in one folder: table, JSON, pictures; what the folder has is not computed again."""

from __future__ import annotations

import json
import math
import os
import re
from collections import Counter
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path, PurePath
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.data.input_files import LARGEST_TABLE, read_bytes
from comparisons.fitting.fit import Fit, checked_keys, fit_record
from comparisons.fitting.reading import records_or_refusals
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.numerics.number_text import short
from comparisons.output.latex import latex
from comparisons.output.style import COLOURS, new_figure, save, styled
from comparisons.output.table import Column, Record, Table
from comparisons.problem import Problem
from comparisons.problem.units import prefixed_unit, si_text
from comparisons.runs.atomic_files import prepare_folder, write_file
from comparisons.runs.csv_format import csv_text
from comparisons.runs.folder_lock import locked
from comparisons.runs.store import Form, Store
from comparisons.runs.workers import LOST, each

#: A smaller change in percent is that of rounding.
_NOTHING = 1e-3

#: What is stored of a file: its name and the digest of all that determines its fits, and these or why there are none.
_FORM: Form[dict[str, Any]] = Form("fits", key=lambda item: [item["file"], item["digest"]], read=dict, write=dict)


@dataclass(frozen=True)
class _Task:
    path: Path
    name: str
    picture: Path | None
    problem: Problem
    free: Sequence[str]
    options: Mapping[str, Any]

    @cached_property
    def key(self) -> tuple[str, str]:
        """Name, and digest of the curve, the problem and the options; without the curve if it cannot be read."""
        try:
            content = read_bytes(self.path, LARGEST_TABLE)
        except (OSError, ValueError):
            content = b""
        text = json.dumps([self.problem.digest, list(self.free), dict(self.options)], default=repr)
        return self.name, sha256(content + text.encode()).hexdigest()


class _Outcome(NamedTuple):
    """What is stored of a file, and the sentence that refuses it, which is not stored: empty where it can be used."""

    item: dict[str, Any]
    refusal: str = ""


def fit_files(
    paths: Sequence[Path],
    problem: Problem,
    free: Sequence[str],
    folder: Path | None,
    jobs: int = 1,
    **options: Any,
) -> list[dict[str, Any]]:
    """Fit every curve of some files, in parallel.

    Parameters
    ----------
    paths : sequence of Path
    problem, free
        As of `comparisons.fitting.fit.fit`.
    folder : Path, optional
        Which keeps each fit with its picture as soon as it exists, and gets fits.json, fits.csv and fits.tex.
    jobs : int
        Number of processes.
    **options
        Of `fit`.

    Returns
    -------
    list of dict
        For each file ``file``, ``fits`` as of `Fit.as_json`, and ``failure``, empty where each curve has a fit.

    Raises
    ------
    ValueError
        If a key or an option cannot be used, none of the curves can, or another process computes into the folder.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    checked_keys(problem, free, options.get("model"))
    names = names_by_path(paths)
    pictures = dict.fromkeys(names) if folder is None else _pictures(names, folder)
    tasks = {
        task.key: task
        for name, path in names.items()
        for task in [_Task(path, name, pictures[name], problem, free, options)]
    }
    # One file is fitted sooner than a process has started.
    jobs = min(jobs, len(tasks))
    refusals: list[_Outcome] = []
    if folder is None:
        items = list(_sound(each(_fitted, [*tasks.values()], jobs, lost=_lost), refusals))
        return _sorted(items, refusals)
    with locked(prepare_folder(folder)):
        with Store(folder, _FORM) as store:
            stored = {(item["file"], item["digest"]) for item in store.items}
            missing = [task for key, task in tasks.items() if key not in stored]
            store.complete("fits", len(missing), _sound(each(_fitted, missing, jobs, lost=_lost), refusals))
            items = [item for item in store.items if (item["file"], item["digest"]) in tasks]
        items = _sorted(items, refusals)
        _write(folder, items)
    return items


def names_by_path(paths: Sequence[Path]) -> dict[str, Path]:
    """Return files by the shortest ends of their paths that differ where files have one name, each file once.

    Examples
    --------
    >>> list(names_by_path([Path("a/c.csv"), Path("b/c.csv"), Path("a/d.csv"), Path("a/d.csv")]))
    ['a/c.csv', 'b/c.csv', 'd.csv']
    """
    parts = {PurePath(os.path.abspath(path)).parts[1:]: path for path in paths}
    names: dict[tuple[str, ...], str] = {}
    for count in range(1, max(map(len, parts), default=0) + 1):
        # The names of two files differ by more than the case of their letters, which some disks ignore.
        ends = {own: "/".join(own[-count:]) for own in parts}
        users = Counter(end.casefold() for end in ends.values())
        for own, end in ends.items():
            if own not in names and (users[end.casefold()] == 1 or count >= len(own)):
                names[own] = end
    return {names[own]: path for own, path in parts.items()}


def _pictures(names: Iterable[str], folder: Path) -> dict[str, Path]:
    """Return the picture of each file without its ending: that of its name if no other file has the same."""
    stems = {name: PurePath(name).with_suffix("").as_posix() for name in names}
    users = Counter(stem.casefold() for stem in stems.values())
    # The pictures of several curves of a file end in a number, as a name may.
    without_number = {stem: re.sub(r"-\d+$", "", stem) for stem in users}
    shared = {name for stem, name in without_number.items() if stem != name and name in users}
    alone = {stem for stem in users if users[stem] == 1 and without_number[stem] not in shared}
    return {name: folder / (stem if stem.casefold() in alone else name) for name, stem in stems.items()}


def _sound(outcomes: Generator[_Outcome], refusals: list[_Outcome]) -> Generator[dict[str, Any]]:
    """Yield what is stored, and keep the others."""
    with closing(outcomes):
        for outcome in outcomes:
            if outcome.refusal:
                refusals.append(outcome)
            else:
                yield outcome.item


def _sorted(items: Sequence[dict[str, Any]], refusals: Sequence[_Outcome]) -> list[dict[str, Any]]:
    """Return all items; `ValueError` if no file can be used."""
    if refusals and not items:
        others = f"; none of the {len(refusals)} files can be used" if len(refusals) > 1 else ""
        raise ValueError(refusals[0].refusal + others)
    return sorted([*items, *(refused.item for refused in refusals)], key=lambda item: str(item["file"]))


def _item(task: _Task, failure: str, fits: Sequence[Fit] = ()) -> dict[str, Any]:
    """Return what is stored of a file."""
    name, digest = task.key
    return {"file": name, "digest": digest, "fits": [fitted.as_json() for fitted in fits], "failure": failure}


def _lost(task: _Task) -> _Outcome:
    return _Outcome(_item(task, LOST))


def _fitted(task: _Task) -> _Outcome:
    """Fit the curves of a file; one that cannot be used costs its own fit alone."""
    options = dict(task.options)
    instrument = {name: options.pop(name, None) for name in ("stiffness", "sensitivity")}
    try:
        records = records_or_refusals(task.path, task.name, **instrument)
    except ValueError as refusal:
        return _Outcome(_item(task, _without_path(refusal, task)), str(refusal))
    keys = checked_keys(task.problem, task.free, options.get("model"))
    fits, failures, refusals = [], [], []
    for number, (name, record) in enumerate(records.items(), start=1):
        of_several = name if len(records) > 1 else ""
        try:
            if isinstance(record, ValueError):
                raise record
            fitted = fit_record(record, task.problem, keys, **options)
        except (ComputationFailed, NotApplicable, ValueError) as failure:
            failures.append(": ".join(filter(None, [of_several, _without_path(failure, task)])))
            if isinstance(failure, ValueError):
                refusals.append(str(failure))
            continue
        fits.append(fitted)
        if task.picture is not None:
            picture = f"{task.picture}-{number}.png" if of_several else f"{task.picture}.png"
            Path(picture).parent.mkdir(parents=True, exist_ok=True)
            save(draw(fitted), Path(picture))
    is_refused = len(refusals) == len(records)
    return _Outcome(_item(task, "; ".join(failures), fits), refusals[0] if is_refused else "")


def _without_path(error: Exception, task: _Task) -> str:
    """Return a sentence without the path of the file, which stands before it already."""
    return str(error).removeprefix(str(task.path)).lstrip(":, ")


def fit_table(items: Sequence[Mapping[str, Any]]) -> Table:
    """Return one row for each value of each curve, and one with the reason for each file that has curves without."""
    rows = [
        {"curve": of_curve["curve"], "model": of_curve["model"], "mu": of_curve["mu"], "key": key}
        | {**row, "u": np.nan if row["u"] is None else row["u"], "reason": ""}
        for item in items
        for of_curve in item["fits"]
        for key, row in of_curve["parameters"].items()
    ]
    rows += [{**_NO_FIT, "curve": item["file"], "reason": item["failure"]} for item in items if item["failure"]]

    def shift(name: str, row: Record) -> str:
        if row["reason"]:
            return ""
        size = row[f"shift_by_{name}"]
        share = math.nan if size is None else 100.0 * size / row["value"]
        return "unknown" if math.isnan(share) else f"{share:+.2g}" if abs(share) > _NOTHING else "+0"

    columns = [
        *([Column("curve", lambda row: str(row["curve"]))] if len({row["curve"] for row in rows}) > 1 else []),
        Column("model", lambda row: str(row["model"])),
        Column("mu", lambda row: "" if row["mu"] is None or np.isnan(row["mu"]) else f"{row['mu']:.3g}", "mu"),
        Column("key", lambda row: str(row["key"])),
        Column("value", _value_text, "value"),
        Column("by model", lambda row: shift("model", row), "shift_by_model"),
        Column("assumed", lambda row: shift("assumptions", row), "shift_by_assumptions"),
    ]
    return Table(
        "fits", "Fitted values, and changes by the errors of model and assumptions (%)", columns, pd.DataFrame(rows)
    )


#: The row of a file without a fit, but its name and the reason.
_NO_FIT = {
    **dict.fromkeys(("model", "key", "unit"), ""),
    **dict.fromkeys(("mu", "value", "u", "shift_by_model", "shift_by_assumptions"), np.nan),
    "determined": False,
}


def _value_text(row: Record) -> str:
    if row["reason"]:
        return "no fit"
    text = si_text(row["value"], row["u"], row["unit"]) if row["determined"] else "not determined"
    return text.replace("^2", "²")


def _write(folder: Path, items: Sequence[Mapping[str, Any]]) -> None:
    """Write fits.json, fits.csv and fits.tex."""
    table = fit_table(items)
    texts = {
        "fits.json": json.dumps(list(items), indent=1) + "\n",
        "fits.csv": csv_text(table.stored),
        "fits.tex": latex(table.texts, table.caption, table.id),
    }
    for name, text in texts.items():
        write_file(folder / name, text)


def draw(fitted: Fit) -> Figure:
    """Draw a record, the fitted loads and the residuals."""
    record = fitted.record
    load = record.load - fitted.baseline
    (x_power, x_unit), (y_power, y_unit) = (
        prefixed_unit(float(np.abs(values).max()), unit) for values, unit in ((fitted.position, "m"), (load, "N"))
    )
    with styled():
        figure = new_figure(6.0, 5.0)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        for branch, mask in _of_branches(record.approach):
            x, colour = fitted.position[mask] * 10.0**-x_power, COLOURS[0 if branch == "approach" else 1]
            upper.plot(x, load[mask] * 10.0**-y_power, ".", color=colour, ms=2, alpha=0.4, label=branch)
            upper.plot(x, fitted.load[mask] * 10.0**-y_power, color=colour, label=f"{branch}, {fitted.model}")
            lower.plot(x, (load - fitted.load)[mask] * 10.0**-y_power, ".", color=colour, ms=2)
        upper.set(ylabel=f"load ({y_unit})", title=_title(fitted))
        position = "displacement" if np.isinf(record.stiffness) else "position of the cantilever"
        lower.set(xlabel=f"{position} ({x_unit})", ylabel="residual")
        upper.legend()
    return figure


def _of_branches(approach: Any) -> Iterator[tuple[str, Any]]:
    for branch, mask in (("approach", approach), ("retreat", ~approach)):
        if mask.any():
            yield branch, mask


def _title(fitted: Fit) -> str:
    values = (
        f"{key} = {si_text(row.value, row.u, row.unit)}" for key, row in fitted.parameters.items() if row.determined
    )
    return ", ".join(values) or f"{fitted.record.name}: {short(fitted.residual, 0.0)} N"
