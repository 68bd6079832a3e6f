"""Fits of many curves in one folder: table, JSON, pictures; what the folder has is not computed again."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.data.input_files import LARGEST_TABLE, read_bytes
from comparisons.fitting.fit import Fit, fit
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.numerics.number_text import short
from comparisons.output.latex import latex
from comparisons.output.style import COLOURS, new_figure, save, styled
from comparisons.output.table import Column, Record, Table
from comparisons.problem import Problem
from comparisons.problem.units import prefixed_unit, si_text
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import csv_text
from comparisons.runs.store import Form, Store
from comparisons.runs.workers import LOST, each

#: A smaller change in percent is that of rounding.
_NOTHING = 1e-3

#: What is stored of a file: its name and the digest of all that determines its fits, and these or why there are none.
_FORM: Form[dict[str, Any]] = Form("fits", key=lambda item: [item["file"], item["digest"]], read=dict, write=dict)


@dataclass(frozen=True)
class _Task:
    path: Path
    problem: Problem
    free: Sequence[str]
    options: Mapping[str, Any]

    @property
    def digest(self) -> str:
        """Digest of the curve, the problem and the options."""
        content = read_bytes(self.path, LARGEST_TABLE)
        text = json.dumps([self.problem.digest, list(self.free), dict(self.options)])
        return sha256(content + text.encode()).hexdigest()


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
        Which keeps each fit with its picture as soon as it exists.
    jobs : int
        Number of processes.
    **options
        Of `fit`.

    Returns
    -------
    list of dict
        For each file ``file``, ``fits`` as of `Fit.as_json`, and ``failure``, empty where there are fits.
    """
    tasks = {(path.name, task.digest): task for path in paths for task in [_Task(path, problem, free, options)]}
    # One file is fitted sooner than a process has started.
    jobs = min(jobs, len(tasks))
    if folder is None:
        items = list(each(partial(_fitted, folder=None), [*tasks.values()], jobs, lost=_item))
    else:
        folder.mkdir(parents=True, exist_ok=True)
        with Store(folder, _FORM) as store:
            stored = {(item["file"], item["digest"]) for item in store.items}
            missing = [task for key, task in tasks.items() if key not in stored]
            store.complete("fits", len(missing), each(partial(_fitted, folder=folder), missing, jobs, lost=_item))
            items = [item for item in store.items if (item["file"], item["digest"]) in tasks]
    return sorted(items, key=lambda item: str(item["file"]))


def _item(task: _Task, failure: str = LOST, fits: Sequence[Fit] = ()) -> dict[str, Any]:
    """Return what is stored of a file."""
    fitted = [result.as_json() for result in fits]
    return {"file": task.path.name, "digest": task.digest, "fits": fitted, "failure": failure}


def _fitted(task: _Task, folder: Path | None) -> dict[str, Any]:
    try:
        fits = fit(task.path, task.problem, task.free, **task.options)
    except (ComputationFailed, NotApplicable) as failure:
        return _item(task, str(failure))
    for number, result in enumerate(fits):
        if folder is not None:
            stem = task.path.stem + (f"-{number + 1}" if len(fits) > 1 else "")
            save(draw(result), folder / f"{stem}.png")
    return _item(task, "", fits)


def fit_table(items: Sequence[Mapping[str, Any]]) -> Table:
    """Return one row for each value of each curve."""
    rows = [
        {"curve": of_curve["curve"], "model": of_curve["model"], "mu": of_curve["mu"], "key": key}
        | {**row, "u": np.nan if row["u"] is None else row["u"]}
        for item in items
        for of_curve in item["fits"]
        for key, row in of_curve["parameters"].items()
    ]

    def shift(name: str, row: Record) -> str:
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


def _value_text(row: Record) -> str:
    text = si_text(row["value"], row["u"], row["unit"]) if row["determined"] else "not determined"
    return text.replace("^2", "²")


def write_fits(folder: Path, items: Sequence[Mapping[str, Any]]) -> None:
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
    record, (zero, _) = fitted.record, fitted.zeros["load"]
    load = record.load - zero
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
