"""Verdicts of a gates file by the name of gate, model and case: those to expect before a run, and those of the run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from filelock import FileLock
from threadpoolctl import threadpool_limits

from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.judging.selection import cases_of, key_of, relevant
from comparisons.numerics.number_text import exact
from comparisons.output.junit import numbers_text
from comparisons.output.verdicts import command
from comparisons.pipeline.inputs import load_cases, read_gates
from comparisons.pipeline.run import run
from comparisons.problem import PARAMETERS
from comparisons.registry import identify
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.case_columns import keys_in, with_problem
from comparisons.runs.rows import Key

__all__ = ["OTHERS", "expected_verdicts", "verdicts_of_run"]

#: The name of the verdicts on a gate or a model as a whole, such as too few cases with a value.
OTHERS = "other verdicts"

_LOCK = ".pytest.lock"


def expected_verdicts(gates: Path, models: Sequence[str], cases: str | Path = "quick") -> dict[str, str]:
    """Return the names of each gate for each model in each case, and of `OTHERS`, with the requirements.

    They are in the order of the judge; nothing is computed.

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
    expected = {
        _name(gate.id, key_of(gate, "candidate", case)): gate.requirement
        for gate in relevant(read_gates(gates, loaded, names).gates, loaded.grids, names)
        for case in cases_of(gate, loaded.grids, names)
    }
    return expected | {OTHERS: ""}


def verdicts_of_run(
    gates: Path, models: Sequence[str], cases: str | Path, folder: Path, jobs: int = 1
) -> dict[str, tuple[str, str]]:
    """Run and judge; return the verdict of each name with a text: the reason, the numbers and the command.

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
    expected = expected_verdicts(gates, models, cases)
    verdicts: dict[str, tuple[str, str]] = {}
    others = []
    keys = keys_in(with_problem(judgement.verdicts).rename(columns={"candidate": "model"}))
    for key, (_, row) in zip(keys, judgement.verdicts.iterrows(), strict=True):
        name, verdict = _name(row["gate"], key), Verdict(row["verdict"])
        numbers = "" if pd.isna(row["error"]) else numbers_text(row)
        repeat = f"computed again by: {command(row, judgement.inputs.specs)}"
        if name in expected:
            verdicts[name] = str(verdict), "\n".join(filter(None, [row["reason"], numbers, repeat]))
        elif verdict.rank <= Verdict.INCONCLUSIVE.rank:
            sentence = f"{row['gate']} of {row['candidate']}: {row['reason']}"
            others.append("\n".join(filter(None, [sentence, numbers, repeat])))
    return verdicts | {OTHERS: ("FAIL" if others else "PASS", "\n".join(others))}


def _name(gate: str, key: Key) -> str:
    model, _, *numbers, problem = key
    values = (f"{name}={exact(value)}" for name, value in zip(PARAMETERS, numbers, strict=True) if value is not None)
    return f"{gate}[{model} {problem or ' '.join(values)}]"
