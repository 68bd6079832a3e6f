"""Verdicts of a gates file by gate, model and case: those to expect before a run, and those of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from filelock import FileLock
from threadpoolctl import threadpool_limits

from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.selection import cases_of, key_of, relevant
from comparisons.numerics.number_text import exact
from comparisons.output.junit import numbers_text
from comparisons.output.verdicts import command
from comparisons.pipeline.inputs import load_cases, read_gates
from comparisons.pipeline.run import run
from comparisons.registry import identify
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.case_columns import keys_in, with_problem
from comparisons.runs.tasks import problem_for

__all__ = ["ExpectedVerdict", "computed_verdicts", "expected_verdicts"]

#: Gate, and the key of the result of its candidate; of a whole gate its candidate and a number.
VerdictKey = tuple[Any, ...]

_LOCK = ".pytest.lock"


@dataclass(frozen=True, slots=True)
class ExpectedVerdict:
    """A gate for one model in one case: its key, its name in a list, and the requirement of the gate."""

    key: VerdictKey
    name: str
    requirement: str


def expected_verdicts(gates: Path, models: Sequence[str], cases: str | Path = "quick") -> Iterator[ExpectedVerdict]:
    """Yield each gate for each model in each case, in the order of the judge; nothing is computed.

    Parameters
    ----------
    gates : Path
        A gates file.
    models : sequence of str
        Names or SPECs.
    cases : str or Path
        A tier of the standing cases, or a file of cases.

    Raises
    ------
    ValueError
        If a model or a gate is not admissible; one sentence states which.
    """
    names, _ = identify(models)
    loaded = load_cases(cases, names)
    for gate in relevant(read_gates(gates, loaded, names).gates, loaded.grids, names):
        for case in cases_of(gate, loaded.grids, names):
            numbers = problem_for(gate.candidate, case).numbers
            key = (gate.id, *key_of(gate.candidate, gate, case))
            label = case.name or " ".join(f"{name}={exact(value)}" for name, value in numbers.items())
            yield ExpectedVerdict(key, f"{gate.id}[{gate.candidate} {label}]", gate.requirement)


def computed_verdicts(
    gates: Path, models: Sequence[str], cases: str | Path, folder: Path, jobs: int = 1
) -> dict[VerdictKey, tuple[str, str]]:
    """Run and judge; return the verdict of each key with a text: the reason, the numbers and the command.

    Several processes may call it with one folder: the first computes, the others take its results.

    Raises
    ------
    ValueError, comparisons.model.ComputationFailed
        As `comparisons.pipeline.run.run`.
    """
    prepare_folder(folder)
    with FileLock(folder / _LOCK), threadpool_limits(1):
        judgement = run(cases, gates, list(models), folder, jobs=jobs).judgement
    assert judgement is not None
    if without_card_gates(judgement.verdicts).empty:
        raise ValueError(f"{gates}: no gate was evaluated: no candidate of a gate is given")
    keys = keys_in(with_problem(judgement.verdicts).rename(columns={"candidate": "model"}))
    texts = {}
    for index, (key, (_, row)) in enumerate(zip(keys, judgement.verdicts.iterrows(), strict=True)):
        # One on a whole gate has its index, since there may be several.
        of_gate = pd.isna(row["n"]) and not key[-1]
        name = (row["gate"], row["candidate"], index) if of_gate else (row["gate"], *key)
        texts[name] = str(row["verdict"]), _text(row, command(row, judgement.inputs.specs), of_gate=of_gate)
    return texts


def _text(row: pd.Series, again: str, *, of_gate: bool) -> str:
    before = f"{row['gate']} of {row['candidate']}: " if of_gate else ""
    numbers = "" if pd.isna(row["error"]) else numbers_text(row)
    return "\n".join(filter(None, [f"{before}{row['reason']}", numbers, f"computed again by: {again}"]))
