"""CPU time of commands from a cold start: a new interpreter for each."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd

from comparisons.bench.part import Numbers, Part
from comparisons.external.template import write_template

#: An interpreter that does nothing, to which the others are compared.
BARE = "python -c pass"
_OWN_MODEL = "run --model my.py:My"
_COMMANDS = (
    BARE,
    "--help",
    "list models",
    "solve --model jkr --n 2 --k 0 --mu 1 --quantity pull_off_force",
    _OWN_MODEL,
)

#: A command is called once so that its files are in memory, then so often; the least CPU time counts.
_REPEATS = 3
#: A command that takes so many seconds of CPU is not called again.
_LONG = 5.0

#: Exit statuses of a finished command: 1 and 3 are a gate that fails or is inconclusive, as with the stand-in model.
_FINISHED = {0, 1, 3}


def plan(full: bool) -> list[Numbers]:
    """Return the commands.

    Raises
    ------
    ValueError
        If the system cannot tell their CPU time, before anything is measured.
    """
    _cpu_of_children()
    return [{"command": command} for command in _COMMANDS]


def cold_start(command: str) -> Numbers:
    """Return the CPU time of a command, that of its own processes included, and its wall-clock time.

    Raises
    ------
    RuntimeError
        If the command fails.
    """
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["-c", "pass"] if command == BARE else ["-m", "comparisons", *command.split()]
        if command == _OWN_MODEL:
            # The model of the user is that of `fscm-bench new-model`.
            _, spec = write_template(Path(folder, "my"))
            arguments[-1:] = [spec, "--out", str(Path(folder, "out"))]
        used = [_call(arguments, Path(folder))]
        while len(used) <= _REPEATS and used[-1]["cpu_seconds"] < _LONG:
            used.append(_call(arguments, Path(folder)))
    return min(used[1:] or used, key=lambda numbers: numbers["cpu_seconds"])


def _call(arguments: list[str], folder: Path) -> Numbers:
    """Call a command; the results of the call before it are removed."""
    shutil.rmtree(folder / "out", ignore_errors=True)
    before, begin = _cpu_of_children(), time.perf_counter()
    done = subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    seconds, after = time.perf_counter() - begin, _cpu_of_children()
    if done.returncode not in _FINISHED:
        said = done.stderr.decode(errors="replace").splitlines()
        raise RuntimeError(f"exit status {done.returncode}: {' '.join(said[-1:])}")
    return {"cpu_seconds": after - before, "seconds": seconds, "exit_status": done.returncode}


def _cpu_of_children() -> float:
    """Return the CPU time of the processes that this one has started and that have ended, and of theirs."""
    if sys.platform == "win32":
        raise ValueError("Windows does not tell the CPU time of a command with its processes: --only work-precision")
    import resource

    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the CPU time over that of an interpreter that does nothing."""
    bare = rows.loc[rows["command"] == BARE, "cpu_seconds"]
    return rows.assign(ratio=rows["cpu_seconds"] / bare.min())


def summary(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the CPU time of each command, and that over the time of an interpreter that does nothing."""
    return rows[["command", "ratio", "cpu_seconds"]].rename(columns={"cpu_seconds": "CPU (s)"})


COLD_STARTS = Part("cold-starts", "CPU time of commands from a cold start", plan, cold_start, ratios, summary)
