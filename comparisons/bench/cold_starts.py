"""CPU time of commands from a cold start: a new interpreter for each."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd

import fscm
from comparisons.bench.part import Numbers, Part
from comparisons.external.template import write_template
from comparisons.problem import Problem

#: An interpreter that does nothing, to which the others are compared.
BARE = "python -c pass"
_OWN_MODEL = "run --model my.py:My"
_COMMANDS = (
    BARE,
    "--help",
    "list models",
    "cite",
    "solve --model jkr --n 2 --k 0 --mu 1 --quantity pull_off_force",
    "solve --model fscm --n 2 --k 0.4 --mu 1 --quantity pull_off_force",
    "describe bead.toml",
    "describe coating.toml",
    "fit record.csv --problem bead.toml --free solid.E",
    _OWN_MODEL,
)

#: A bead on rubber, and a film of 20 nm under a tip.
_FILES = {
    "bead.toml": """
[solid]
kind = "homogeneous"
E = "1.5 MPa"
nu = 0.5

[punch]
kind = "sphere"
R = "5 um"

[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "50 mJ/m^2"
z0 = "0.4 nm"
""",
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
#: Points of each branch of a record of the bead, and its noise in the pull-off force.
_POINTS, _NOISE = 250, 0.01

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
        _write_inputs(Path(folder))
        used = [_call(arguments, Path(folder))]
        while len(used) <= _REPEATS and used[-1]["cpu_seconds"] < _LONG:
            used.append(_call(arguments, Path(folder)))
    return min(used[1:] or used, key=lambda numbers: numbers["cpu_seconds"])


def _write_inputs(folder: Path) -> None:
    """Write the problem files, and a record that a machine of prescribed displacement would make of the bead."""
    for name, text in _FILES.items():
        folder.joinpath(name).write_text(text.lstrip(), encoding="utf-8")
    problem = Problem.load(folder / "bead.toml").build(fscm)
    curve = fscm.force_curve(problem.n, problem.k, problem.mu).in_units(problem.units)
    x = np.linspace(2.0 * curve.displacement.min(), -2.0 * curve.displacement.min(), _POINTS)
    noise = np.random.default_rng(1).normal(0.0, -_NOISE * curve.load.min(), (2, _POINTS))
    lines = ["branch,displacement [nm],load [nN]"]
    for branch, places, added in (("approach", x, noise[0]), ("retreat", x[::-1], noise[1])):
        load = curve.load_at(places, branch).value + added
        lines += [f"{branch},{1e9 * u:.6g},{1e9 * P:.6g}" for u, P in zip(places, load, strict=True)]
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
