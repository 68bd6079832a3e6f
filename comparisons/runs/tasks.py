"""The computations of a run: which questions are asked, and asking them on every core.

A `Task` is one question to one model; `answer` turns it into a stored `Row` whatever happens, so that a model
which fails costs its own rows and nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Generator, Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import groupby
from traceback import extract_tb

from comparisons.curve_quantities import SHAPES, Points
from comparisons.external.identity import contradiction
from comparisons.model import ComputationFailed, Model, NotApplicable, Result
from comparisons.quantities import QUANTITIES
from comparisons.registry import ExternalIdentity, create, knows_poisson
from comparisons.runs.cases import Case, Grid
from comparisons.runs.rows import Row
from comparisons.runs.workers import each

__all__ = ["Task", "answer", "case_for", "compute", "evaluate", "plan"]


@dataclass(frozen=True, slots=True)
class Task:
    """One question to one model, by names only: cheap to send to another process."""

    model: str
    quantity: str
    case: Case
    outside: ExternalIdentity | None = None

    @property
    def key(self) -> tuple[str, str, float, float, float, float | None]:
        """The key of the row that answers it."""
        return self.model, self.quantity, self.case.n, self.case.k, self.case.mu, self.case.nu


def case_for(model: str, case: Case) -> Case:
    """Return the case as a model is asked: without Poisson's ratio if that makes no difference to it.

    Examples
    --------
    >>> case_for("jkr", Case(2, 0, 1, nu=0.25)).label
    'n = 2, k = 0, mu = 1'
    """
    return case if knows_poisson(model) else replace(case, nu=None)


def plan(
    grids: Iterable[Grid], models: list[str] | None = None, outside: Mapping[str, ExternalIdentity] | None = None
) -> list[Task]:
    """Return every question once: the reference and the candidates of each grid, in all its cases.

    Parameters
    ----------
    grids : iterable of Grid
        What to compute.
    models : list of str, optional
        Names of candidates that take the place of those each grid names; the reference is always computed.
    outside : dict of str to ExternalIdentity, optional
        Those of them that are not ours (see `comparisons.registry.identify`).

    Returns
    -------
    list of Task
        Largest Tabor numbers first: they take longest, and a core that starts one last would finish alone.
    """
    tasks = {
        Task(model, quantity, case_for(model, case), (outside or {}).get(model))
        for grid in grids
        for model in {grid.reference, *(models or grid.models)}
        for quantity in grid.quantities
        for case in grid.cases
    }
    return sorted(tasks, key=lambda task: (-task.case.mu, task.case.n, task.case.k, task.model, task.quantity))


def evaluate(model: Model, quantity: str, case: Case) -> Row:
    """Ask a model and return its row.

    Raises
    ------
    ValueError
        If the model refuses the case as inadmissible; any other failure is a row with status and reason.

    Examples
    --------
    >>> evaluate(create("bradley"), "pull_off_force", Case(2, 0, 1)).status
    'ok'
    """
    started = time.perf_counter()
    try:
        result = _evaluate(model, quantity, case)
    except NotApplicable as refusal:
        return _row(model, quantity, case, started, status="not-applicable", reason=str(refusal))
    except ComputationFailed as failure:
        return _row(model, quantity, case, started, status="failed", reason=str(failure))
    except ValueError:
        raise
    except Exception as error:
        # A defect of the model: its row says where, the other models go on.
        place = extract_tb(error.__traceback__)[-1].name
        return _row(
            model,
            quantity,
            case,
            started,
            status="failed",
            reason=f"{type(error).__name__} in {place}: {error}",
        )
    return _row(model, quantity, case, started, status="ok", result=result)


def _evaluate(model: Model, quantity: str, case: Case) -> Result | Points:
    if quantity in SHAPES:
        return SHAPES[quantity].ask(model, case.problem())
    return model.evaluate(case.problem(), quantity)


def _row(
    model: Model | ExternalIdentity,
    quantity: str,
    case: Case,
    started: float,
    *,
    status: str,
    reason: str = "",
    result: Result | Points | None = None,
) -> Row:
    points = result if isinstance(result, Points) else None
    number = result if isinstance(result, Result) else None
    return Row(
        model=model.name,
        model_version=model.version,
        quantity=quantity,
        n=case.n,
        k=case.k,
        mu=case.mu,
        nu=case.nu,
        value=number.value if number else None,
        u_num=number.u_num if number else None,
        unit=(QUANTITIES | SHAPES)[quantity].unit,
        status=status,
        reason=reason,
        size=number.size if number else None,
        iterations=number.iterations if number else None,
        residual=number.residual if number else None,
        seconds=(number and number.seconds) or time.perf_counter() - started,
        observed_order=number.observed_order if number else None,
        points=(points.x, points.y, points.u_distance) if points else None,
    )


def answer(task: Task) -> Row:
    """Answer a task, whatever happens: among many cases, one that its model refuses is a failed row."""
    started = time.perf_counter()
    model = task.outside or create(task.model, task.case.nu)
    try:
        if isinstance(model, ExternalIdentity):
            return _ask_outside(model, task)
        return evaluate(model, task.quantity, task.case)
    except ValueError as refusal:
        return _row(model, task.quantity, task.case, started, status="failed", reason=str(refusal))


def _ask_outside(first: ExternalIdentity, task: Task) -> Row:
    """Ask a model from outside; if it is not what it was when the run opened it, the row says so and is that one's."""
    started = time.perf_counter()
    model = create(first.spec, task.case.nu)
    if (model.name, model.version) != (first.name, first.version):
        reason = contradiction((first.name, first.version), (model.name, model.version))
        return _row(first, task.quantity, task.case, started, status="failed", reason=reason)
    return evaluate(model, task.quantity, task.case)


def _batches(tasks: list[Task]) -> list[list[Task]]:
    """Questions about one case to one model go to one process, where the solver finds its meshes again."""
    return [list(batch) for _, batch in groupby(tasks, key=lambda task: (task.model, task.case))]


def _answer_all(batch: list[Task]) -> list[Row]:
    return [answer(task) for task in batch]


def compute(tasks: list[Task], jobs: int) -> Generator[Row]:
    """Answer tasks on `jobs` processes and yield each row as it is finished.

    Closing the iterator (`contextlib.closing`) before its end drops what has not begun.

    Raises
    ------
    RuntimeError
        If a worker process dies (`concurrent.futures.BrokenExecutor`), as one short of memory does.
    """
    with closing(each(_answer_all, _batches(tasks), jobs)) as answers:
        for rows in answers:
            yield from rows
