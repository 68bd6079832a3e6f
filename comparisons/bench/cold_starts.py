"""CPU time of commands from a cold start: a new interpreter for each."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.part import Item, Numbers, Part, Settings
from comparisons.external.template import write_template
from comparisons.output.style import COLOURS, styled

__all__ = ["COLD_STARTS", "draw", "items", "measure", "summary", "table"]

BARE = "python -c pass"
#: The command -> its arguments, whether they are those of fscm-bench, and the seconds of all its repetitions.
_SOLVE = "solve --model jkr --n 2 --k 0.4 --mu 1 --quantity pull_off_force"
_OWN_MODEL = "run --model my.py:My"
_COMMANDS = {BARE: 0.5, "--help": 2.0, "list models": 5.0, _SOLVE: 6.0, _OWN_MODEL: 25.0}

#: A command is called once so that its files are in memory, then so often; the least CPU time counts.
_REPEATS = 3
#: A command that takes so many seconds of CPU is not called again.
_LONG = 5.0

#: Exit statuses of a finished command: 1 and 3 are a gate that fails or is inconclusive, as with the stand-in model.
_FINISHED = {0, 1, 3}

#: Folder of the results of `run`.
_OUT = "out"


class _Used(NamedTuple):
    """What a command and the processes it waited for used."""

    cpu_seconds: float
    seconds: float
    status: int


def items(full: bool) -> list[Item]:
    """Return the commands."""
    return [Item({"command": command}, seconds) for command, seconds in _COMMANDS.items()]


def measure(settings: Settings) -> Numbers:
    """Return the CPU time of a command, that of its own processes included, and its wall-clock time.

    Raises
    ------
    RuntimeError
        If the command fails.
    """
    command = settings["command"]
    with tempfile.TemporaryDirectory() as folder:
        arguments = _arguments(command, Path(folder))
        used = [_call(arguments, Path(folder))]
        while len(used) <= _REPEATS and used[-1].cpu_seconds < _LONG:
            used.append(_call(arguments, Path(folder)))
    counted = used[1:] or used
    return {
        "cpu_seconds": min(one.cpu_seconds for one in counted),
        "seconds": min(one.seconds for one in counted),
        "exit_status": used[0].status,
    }


def _arguments(command: str, folder: Path) -> list[str]:
    """Arguments of an interpreter; the model of the user is that of ``fscm-bench new-model``."""
    if command == BARE:
        return ["-c", "pass"]
    words = command.split()
    if command == _OWN_MODEL:
        _, spec = write_template(folder / "my")
        words = [*words[:-1], spec, "--out", str(folder / _OUT)]
    return ["-m", "comparisons", *words]


def _call(arguments: list[str], folder: Path) -> _Used:
    """Call a command; the results of the call before it are removed."""
    shutil.rmtree(folder / _OUT, ignore_errors=True)
    with tempfile.TemporaryFile() as messages:
        begin = time.perf_counter()
        process = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.DEVNULL, stderr=messages)
        try:
            _, status, used = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            raise
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.perf_counter() - begin
        if process.returncode not in _FINISHED:
            messages.seek(0)
            last = messages.read().decode(errors="replace").strip().splitlines()[-1:]
            raise RuntimeError(f"exit status {process.returncode}: {' '.join(last)}")
    return _Used(used.ru_utime + used.ru_stime, seconds, process.returncode)


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the CPU time over that of an interpreter that does nothing."""
    rows = rows.copy()
    if "cpu_seconds" in rows:
        bare = rows.loc[(rows["command"] == BARE) & (rows["status"] == "ok"), "cpu_seconds"]
        rows["ratio"] = rows["cpu_seconds"] / (bare.iloc[0] if len(bare) else np.nan)
    return rows


def draw(table: pd.DataFrame) -> Figure:
    """Draw the CPU times as bars."""
    rows = table[table["status"] == "ok"].iloc[::-1]
    with styled():
        figure = Figure(figsize=(7.4, 2.6), layout="constrained")
        axes = figure.subplots()
        axes.barh(rows["command"], rows["cpu_seconds"], 0.6, color=COLOURS[1])
        axes.set_xscale("log")
        for place, seconds in enumerate(rows["cpu_seconds"]):
            axes.annotate(f"{seconds:.2g} s", (seconds, place), xytext=(4, 0), textcoords="offset points", va="center")
        axes.set_yticks(range(len(rows)), [_short(command) for command in rows["command"]])
        axes.set_xlim(rows["cpu_seconds"].min() / 2.0, 3.0 * rows["cpu_seconds"].max())
        axes.set_xlabel("CPU time from a cold start (s)")
        axes.set_title("Commands in a new interpreter", fontsize=10)
    return figure


def _short(command: str) -> str:
    """The command without the parameters of the case."""
    return command.partition(" --n")[0]


def summary(table: pd.DataFrame) -> list[str]:
    """Return the CPU time of each command over that of an interpreter that does nothing."""
    lines = [f"{'CPU time / that of a bare interpreter:':50}{'ratio':>7}{'CPU (s)':>9}{'wall (s)':>9}"]
    for row in table[(table["status"] == "ok") & (table["command"] != BARE)].to_dict("records"):
        lines.append(
            f"  {_short(row['command']):48}{row['ratio']:>7.0f}{row['cpu_seconds']:>9.2f}{row['seconds']:>9.2f}"
        )
    return lines


COLD_STARTS = Part(
    "cold-starts",
    "CPU time of --help, list models, solve and run from a cold start",
    items,
    measure,
    table,
    draw,
    summary,
    own_process=False,
)
