"""Function for a whole run: its computation, tables, verdicts and record; and its verdicts by name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from random import SystemRandom

import pandas as pd
from threadpoolctl import threadpool_limits

from comparisons.console.progress import note
from comparisons.external.inherited import hidden_from_models
from comparisons.judging.fresh_cases import FreshCases, draw
from comparisons.numerics.number_text import exact
from comparisons.output.junit import numbers_text
from comparisons.output.verdicts import command
from comparisons.pipeline.finished_run import FinishedRun, kept_texts, write_run
from comparisons.pipeline.inputs import Cases, RunInputs, load_cases, read_gates
from comparisons.pipeline.judgement import Judgement
from comparisons.problem import PARAMETERS
from comparisons.registry import identify
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import checked_jobs, complete, folder_for, parse_shard, tasks_of_shard
from comparisons.runs.folder_lock import locked
from comparisons.runs.record import now

#: Most fresh cases for each model and gate.
_MOST_FRESH = 10_000


def run(
    cases: str | Path | Cases = "quick",
    gates: str | Path | None = None,
    models: Sequence[str] | None = None,
    folder: str | Path | None = None,
    *,
    jobs: int = 1,
    shard: str | None = None,
    random: int = 0,
    seed: int | None = None,
    pdf: bool = False,
) -> FinishedRun:
    """Compute cases, judge the results, and write tables, verdicts and the record into a folder.

    Results in the folder are not computed again, except failures.  In the standing cases with given models or
    gates, only the results that the gates need are computed, with the displacements of given models; otherwise all.

    Parameters
    ----------
    cases : str, Path or Cases
        A tier of the standing cases ("quick" or "full"), a file of [[grid]] tables without a tier, or the text of one;
        or those of a problem file (`comparisons.pipeline.inputs.cases_of_problem`).
    gates : str, Path or None
        A gates file, or the text of one; by default the standing gates for the standing cases, and no gates for others.
    models : sequence of str, optional
        Names or SPECs of the candidates, in place of those each grid names.
    folder : str or Path, optional
        For the results; by default results/runs/TIME.
    jobs : int
        Number of processes.  With more than one, a script needs the guard ``if __name__ == "__main__":``.
    shard : str, optional
        The part i/N of cases without gates, as "2/3"; `comparisons.pipeline.merge.merge` puts the N folders together.
    random : int
        Number of fresh cases drawn at random for each model and gate, in the domain that the model declares.
    seed : int, optional
        Seed of the fresh cases; by default a new one, which the record states.
    pdf : bool
        Whether the pictures of the standing cases are written as PDF beside PNG.

    Returns
    -------
    FinishedRun

    Raises
    ------
    ValueError
        If an argument is not admissible, the folder holds results of other code or files of a user, or another process
        computes into it.
    comparisons.model.ComputationFailed
        If the workers cannot compute.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> grid = '''
    ... [[grid]]
    ... id = "mine"
    ... title = "JKR beside Bradley"
    ... reference = "bradley"
    ... models = ["jkr"]
    ... quantities = ["pull_off_force"]
    ... n = [2]
    ... k = [0]
    ... mu = [1]
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     finished = run(grid, folder=Path(folder))
    >>> finished.verdict, finished.counts["ok"], finished.tables.kappa["kappa"].round(6).tolist()
    (None, 2, [-0.25])
    """
    with running(cases, gates, models, folder, jobs=jobs, shard=shard, random=random, seed=seed, pdf=pdf) as finished:
        return finished


@contextmanager
def running(
    cases: str | Path | Cases,
    gates: str | Path | None = None,
    models: Sequence[str] | None = None,
    folder: str | Path | None = None,
    *,
    jobs: int = 1,
    shard: str | None = None,
    random: int = 0,
    seed: int | None = None,
    pdf: bool = False,
) -> Iterator[FinishedRun]:
    """Give the finished run of `run` to a block that writes more into its folder, which is locked until its end.

    From the first row to the record, no other process writes into the folder, and no external model reads it.
    """
    checked_jobs(jobs)
    if shard is not None:
        parse_shard(shard)
    target = folder_for(folder)
    with hidden_from_models(target):
        # Before anything is computed or written, every model is loaded and every text is read.
        inputs = _inputs(cases, gates, models, random, seed)
        if shard is not None and inputs.gates is not None:
            raise ValueError(
                f"shard {shard} of a run cannot be judged: only cases without gates are computed in shards"
            )
        started = now()
        with locked(prepare_folder(target)):
            kept_texts(target, inputs.cases, inputs.gates)
            by_gates = inputs.cases.tier is not None and (models is not None or gates is not None)
            tasks = inputs.needed() if by_gates else inputs.plan()
            completed = complete(tasks if shard is None else tasks_of_shard(shard, tasks), target, jobs)
            yield write_run(target, inputs, completed, started, pdf=pdf, shard=shard)


def _inputs(
    cases: str | Path | Cases, gates: str | Path | None, models: Sequence[str] | None, random: int, seed: int | None
) -> RunInputs:
    identified, external = identify(models or [])
    names = None if models is None else identified
    loaded = cases if isinstance(cases, Cases) else load_cases(cases, names)
    rules = None if loaded.tier is None and gates is None else read_gates(gates, loaded, names)
    domains = {name: identity.applies_to for name, identity in external.items() if identity.applies_to is not None}
    inputs = RunInputs(loaded, rules, names, external, domains)
    return replace(inputs, fresh=_fresh(random, seed, inputs))


def _fresh(count: int, seed: int | None, inputs: RunInputs) -> FreshCases | None:
    """Return the fresh cases of a run, or refuse them where nothing could be judged in them."""
    if not 0 <= count <= _MOST_FRESH:
        raise ValueError(f"--random {count} is outside 0 to {_MOST_FRESH}: a number of fresh cases for each gate")
    if seed is not None and not 0 <= seed < 2**32:
        raise ValueError(f"--seed {seed} is outside 0 to {2**32 - 1}: random numbers follow from it")
    if count == 0:
        if seed is not None:
            raise ValueError(f"--seed {seed} is for the fresh cases of --random N, which is missing")
        return None
    if inputs.gates is None or not inputs.models:
        raise ValueError("--random needs --model: fresh cases are drawn from the domain of a given model")
    if seed is None:
        seed = SystemRandom().randrange(2**32)
    fresh = draw(inputs.gates.gates, inputs.cases.grids, inputs.models, inputs.taken, count, seed)
    if not (fresh.parts or fresh.undrawn):
        raise ValueError("--random: no gate of this run can be judged in fresh cases of a given model: leave it out")
    note(f"{sum(len(part.grid.cases) for part in fresh.parts)} fresh cases, --seed {fresh.seed}")
    return fresh


def named_verdicts(
    cases: str | Path, gates: Path, models: Sequence[str], folder: Path, jobs: int = 1
) -> list[tuple[str, str, str]]:
    """Run and judge; return name, verdict and text of each gate in each case, and of each check of a report card.

    Several processes may call it with one folder: the first computes, the others take its results.

    Raises
    ------
    ValueError, comparisons.model.ComputationFailed
        As `comparisons.pipeline.run.run`.
    """
    with locked(prepare_folder(folder), wait=True), threadpool_limits(1):
        judgement = run(cases, gates, list(models), folder, jobs=jobs).judgement
    assert judgement is not None
    if judgement.verdicts.empty:
        raise ValueError(f"{gates}: no gate was evaluated: no candidate of a gate is given")
    return _named(judgement)


def _named(judgement: Judgement) -> list[tuple[str, str, str]]:
    specs = judgement.inputs.specs
    of_gates = [(_name(row), str(row["verdict"]), _text(row, specs)) for _, row in judgement.verdicts.iterrows()]
    return of_gates + [(f"{check.line}[{check.model}]", str(check.verdict), check.reason) for check in judgement.checks]


def _name(row: pd.Series) -> str:
    numbers = (f"{name}={exact(row[name])}" for name in PARAMETERS if pd.notna(row[name]))
    problem = row.get("problem")
    case = problem if isinstance(problem, str) and problem else " ".join(numbers)
    return f"{row['gate']}[{' '.join(filter(None, [row['candidate'], case]))}]"


def _text(row: pd.Series, specs: dict[str, str]) -> str:
    has_error = pd.notna(row["error"])
    again = command(row, specs)
    lines = [row["reason"], numbers_text(row) if has_error else "", again and f"computed again by: {again}"]
    return "\n".join(filter(None, lines))
