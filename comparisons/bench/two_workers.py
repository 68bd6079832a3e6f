"""A sweep of small cases with one and with two worker processes."""

from __future__ import annotations

import time

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.part import Item, Numbers, Part, Settings
from comparisons.bench.timed_tasks import Timed, exponent, idle_seconds, sweep, timed
from comparisons.output.style import COLOURS, styled
from comparisons.runs.workers import each

__all__ = ["WORKERS", "draw", "items", "measure", "summary", "table"]

CASES = 200
#: Share of a core that a worker has at least on an idle machine; the rest is the transfer of tasks and results.
_IDLE = 0.9


def items(full: bool) -> list[Item]:
    """Return the sweep with one and with two workers."""
    return [Item({"model": "fscm", "cases": CASES, "workers": workers}, 40.0 / workers) for workers in (1, 2)]


def measure(settings: Settings) -> Numbers:
    """Return the time of a sweep from the start of the command, and from the begin of its first task.

    ``idle_seconds`` is the time, on average, in which a process had no task after the first began.

    Raises
    ------
    RuntimeError
        If a case fails.
    """
    tasks = sweep(settings["model"], settings["cases"])
    begin = time.time()
    done = list(each(timed, tasks, settings["workers"], lost=_lost, alike=exponent))
    if failed := [one.status for one in done if one.status != "ok"]:
        raise RuntimeError(f"{len(failed)} of {len(done)} cases have no value")
    last = max(one.end for one in done)
    return {
        "seconds": last - begin,
        "seconds_of_tasks": last - min(one.begin for one in done),
        "cpu_seconds": sum(one.cpu_seconds for one in done),
        "idle_seconds": float(np.mean(list(idle_seconds(done).values()))),
    }


def _lost(task: object) -> Timed:
    return Timed(0, 0.0, 0.0, 0.0, "lost")


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the time with one worker over the time with so many, with and without the start of the processes."""
    rows = rows.copy()
    if "seconds" not in rows:
        return rows
    one = rows[(rows["workers"] == 1) & (rows["status"] == "ok")].set_index("cases")
    for name, column in (("ratio", "seconds_of_tasks"), ("ratio_with_start", "seconds")):
        rows[name] = rows["cases"].map(one[column]) / rows[column]
    return rows


def draw(table: pd.DataFrame) -> Figure:
    """Draw the time of the sweep as bars."""
    rows = table[table["status"] == "ok"].sort_values("workers")
    with styled():
        figure = Figure(figsize=(4.6, 3.4), layout="constrained")
        axes = figure.subplots()
        places = np.arange(len(rows))
        start = rows["seconds"] - rows["seconds_of_tasks"]
        axes.bar(places, rows["seconds_of_tasks"], 0.55, color=COLOURS[1], label="tasks")
        axes.bar(places, start, 0.55, bottom=rows["seconds_of_tasks"], color=COLOURS[5], label="start of the processes")
        for place, (seconds, ratio) in enumerate(zip(rows["seconds"], rows["ratio"], strict=True)):
            axes.annotate(f"{ratio:.2f} x", (place, seconds), xytext=(0, 3), textcoords="offset points", ha="center")
        axes.set_xticks(places, [f"{workers:.0f} worker{'s' * (workers > 1)}" for workers in rows["workers"]])
        axes.set_ylabel("wall-clock time (s)")
        axes.set_ylim(0.0, 1.3 * rows["seconds"].max())
        axes.legend(loc="upper right", ncols=2)
        axes.set_title(f"Sweep of {rows['cases'].max():.0f} pull-off forces by fscm", fontsize=10)
    return figure


def summary(table: pd.DataFrame) -> list[str]:
    """Return the speed of two workers over that of one, and whether the machine was busy with other work."""
    ok = table[table["status"] == "ok"]
    lines = [
        f"{row['workers']:.0f} workers / 1 on {row['cases']:.0f} cases: {row['ratio']:.2f} times as fast "
        f"({row['ratio_with_start']:.2f} with their start)"
        for row in ok[ok["workers"] > 1].to_dict("records")
    ]
    share = float((ok["cpu_seconds"] / ok["seconds_of_tasks"] / ok["workers"]).min())
    if share < _IDLE:
        lines.append(f"  (the machine was busy: a worker had {share:.2f} of a core; repeat on an idle machine)")
    return lines


WORKERS = Part(
    "workers",
    "a sweep of small cases with one and two worker processes",
    items,
    measure,
    table,
    draw,
    summary,
)
