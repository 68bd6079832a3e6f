"""CPU time of commands from a cold start: a new interpreter for each."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd

from comparisons.bench.bead import BEAD, bead, record
from comparisons.bench.floor import floor_seconds
from comparisons.bench.part import Numbers, Part
from comparisons.external.template import write_template
from comparisons.problem import Problem
from comparisons.runs.tasks import evaluate

#: An interpreter that does nothing, to which the others are compared.
BARE = "python -c pass"
_OWN_MODEL = "run --model my.py:My"
_SOLVE = "solve --model {} --n 2 --k {} --mu 1 --quantity pull_off_force"
_FSCM, _FEM = _SOLVE.format("fscm", 0.4), _SOLVE.format("fem", 0.4)

#: Commands, and the imports of the least interpreter that could do each; None where no least is known.
_COMMANDS = {
    BARE: None,
    "--help": "argparse",
    "list models": "argparse",
    "cite": "argparse",
    _SOLVE.format("jkr", 0): "argparse",
    _FSCM: "argparse, numpy",
    _FEM: "argparse, numpy, scipy.sparse.linalg",
    "describe bead.toml": None,
    "describe coating.toml": None,
    "fit record.csv --problem bead.toml --free solid.E": None,
    _OWN_MODEL: None,
}
#: Of these the floor of the value is a part: the model.
_SOLVED = {_FSCM: "fscm", _FEM: "fem"}

#: A bead on rubber, and a film of 20 nm under a tip.
_FILES = {
    "bead.toml": BEAD,
    "coating.toml": """
[solid]
kind = "coating"
E_coating = "1 GPa"
E_substrate = "3 GPa"
thickness = "20 nm"
transition = "5 nm"
nu_coating = 0.42
nu_substrate = 0.36

[punch]
kind = "sphere"
R = "0.5 um"

[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "50 mJ/m^2"
z0 = "0.4 nm"
""",
}
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
    """Return the CPU time of a command, that of its own processes included, its wall-clock time, and its floor.

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
        _write_inputs(Path(folder))
        return {**_least(arguments, Path(folder)), "floor_seconds": _floor(command, Path(folder))}


def _least(arguments: list[str], folder: Path) -> Numbers:
    """Return the least CPU time of some calls after a first one."""
    used = [_call(arguments, folder)]
    while len(used) <= _REPEATS and used[-1]["cpu_seconds"] < _LONG:
        used.append(_call(arguments, folder))
    return min(used[1:] or used, key=lambda numbers: numbers["cpu_seconds"])


def _floor(command: str, folder: Path) -> float | None:
    """Return the CPU time of an interpreter with the least imports, with the floor of the value of a command."""
    imports = _COMMANDS.get(command)
    if imports is None:
        return None
    seconds = float(_least(["-c", f"import {imports}"], folder)["cpu_seconds"])
    if command in _SOLVED:
        model = _SOLVED[command]
        row = evaluate(model, "pull_off_force", Problem.dimensionless(n=2.0, k=0.4, mu=1.0))
        seconds += floor_seconds(model, row.size, row.iterations) or 0.0
    return seconds


def _write_inputs(folder: Path) -> None:
    """Write the problem files, and a record of the bead."""
    for name, text in _FILES.items():
        folder.joinpath(name).write_text(text.lstrip(), encoding="utf-8")
    measured = record(bead())
    lines = ["branch,displacement [nm],load [nN]"]
    for is_approach, u, P in zip(measured.approach, measured.displacement, measured.load, strict=True):
        lines.append(f"{'approach' if is_approach else 'retreat'},{1e9 * u:.6g},{1e9 * P:.6g}")
    folder.joinpath("record.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _call(arguments: list[str], folder: Path) -> Numbers:
    """Call a command; the results of the call before it are removed."""
    for results in ("out", "results"):
        shutil.rmtree(folder / results, ignore_errors=True)
    before, begin = _cpu_of_children(), time.perf_counter()
    done = subprocess.run([sys.executable, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
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
    # The quantity of all is the pull-off force; a line has 80 columns.
    commands = rows["command"].str.removesuffix(" --quantity pull_off_force")
    return rows.assign(command=commands)[["command", "ratio", "cpu_seconds"]].rename(columns={"cpu_seconds": "CPU (s)"})


COLD_STARTS = Part("cold-starts", "CPU time of commands from a cold start", plan, cold_start, ratios, summary)
