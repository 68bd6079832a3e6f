"""Tasks of a run: which evaluations it needs, and the row of each.

A `Task` is one evaluation of one model.  `evaluate_task` returns its `Row` whatever happens: a model that fails costs
its own rows and nothing else.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import groupby
from traceback import extract_tb
from typing import Any

from comparisons.domain import declared_domain
from comparisons.external.process_model import contradiction
from comparisons.model import ComputationFailed, Model, NotApplicable, Result
from comparisons.problem_file.evaluation import (
    SI_UNITS,
    dimensionless_value,
    model_for,
    points_of,
    units_of,
    value_in_si,
)
from comparisons.quantities import ALL_QUANTITIES, CURVES, QUANTITIES, Points
from comparisons.registry import ExternalIdentity, create, depends_on_poisson_ratio
from comparisons.runs.cases import Case, FileProblem, Grid
from comparisons.runs.rows import Key, Row, none_if_nan
from comparisons.runs.workers import LOST

__all__ = ["Task", "batches", "case_for", "evaluate", "evaluate_task", "lost_row", "plan"]


@dataclass(frozen=True, slots=True)
class Task:
    """One evaluation of one model, by names only: cheap to send to another process."""

    model: str
    quantity: str
    case: Case
    external: ExternalIdentity | None = None

    @property
    def key(self) -> Key:
        """The key of its row."""
        case = self.case
        n, k, mu = (none_if_nan(number) for number in (case.n, case.k, case.mu))
        return self.model, self.quantity, n, k, mu, case.nu, case.label_of_file

    @property
    def digest(self) -> str:
        """Of the problem of a file; empty for another case."""
        return "" if self.case.file is None else self.case.file.digest

    @property
    def problem_key(self) -> tuple[str, Case]:
        """Model and problem: its quantities are computed together, from one path."""
        return self.model, self.case

    @property
    def label(self) -> str:
        """The quantity and the problem, for a sentence."""
        return f"{self.quantity} at {self.case.label}"

    def as_json(self) -> dict[str, Any]:
        """Return its form in the record of a run."""
        case = self.case
        if case.file is not None:
            return {"quantity": self.quantity, "problem": case.label_of_file}
        return {"quantity": self.quantity, "n": case.n, "k": case.k, "mu": case.mu, "nu": case.nu}


def case_for(model: str, case: Case) -> Case:
    """Return the case as a model gets it: without Poisson's ratio if that makes no difference to it.

    Examples
    --------
    >>> case_for("jkr", Case(2, 0, 1, nu=0.25)).label
    'n = 2, k = 0, mu = 1'
    """
    return case if case.nu is None or depends_on_poisson_ratio(model) else replace(case, nu=None)


def plan(
    grids: Iterable[Grid], models: list[str] | None = None, external: Mapping[str, ExternalIdentity] | None = None
) -> list[Task]:
    """Return every task once: the reference and the candidates of each grid, in all its cases.

    Parameters
    ----------
    grids : iterable of Grid
        What to compute.
    models : list of str, optional
        Names of candidates that take the place of those each grid names; the reference is always computed.
    external : dict of str to ExternalIdentity, optional
        Those of them that are external (see `comparisons.registry.identify`).

    Returns
    -------
    list of Task
        Largest Tabor numbers first: they take longest, and one that starts last would keep one core busy alone.
    """
    tasks = {
        Task(model, quantity, case_for(model, case), (external or {}).get(model))
        for grid in grids
        for model in {grid.reference, *(models or grid.models)} - {""}
        for quantity in grid.quantities
        for case in grid.cases
    }
    return sorted(tasks, key=_costliest_first)


def _costliest_first(task: Task) -> tuple[float, float, float, float, str, str, str]:
    # Complete, so that every process plans the same order.
    case = task.case
    if case.file is not None:
        return (-math.inf, 0.0, 0.0, 0.0, case.label_of_file, task.model, task.quantity)
    return -case.mu, case.n, case.k, -1.0 if case.nu is None else case.nu, "", task.model, task.quantity


def evaluate(model: Model, quantity: str, case: Case) -> Row:
    """Evaluate a model and return the row.

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
        # A defect of the model: its row gives the place, and the other models are computed.
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
    if case.file is None:
        return ALL_QUANTITIES[quantity].evaluate(model, case.problem())
    return (points_of if quantity in CURVES else value_in_si)(case.file.content, model, quantity)


def _created(spec: str, case: Case) -> Model:
    """Return the model of a SPEC for a case: some need Poisson's ratio."""
    return create(spec, case.nu) if case.file is None else model_for(case.file.content, spec)


def _unit(quantity: str, case: Case) -> str:
    if case.file is None:
        return ALL_QUANTITIES[quantity].unit
    return "; ".join(units_of(quantity)) if quantity in CURVES else SI_UNITS[QUANTITIES[quantity].scale]


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
        n=none_if_nan(case.n),
        k=none_if_nan(case.k),
        mu=none_if_nan(case.mu),
        nu=case.nu,
        value=number.value if number else None,
        u_num=number.u_num if number else None,
        unit=_unit(quantity, case),
        status=status,
        reason=number.reason if number else reason,
        size=number.size if number else None,
        iterations=number.iterations if number else None,
        residual=number.residual if number else None,
        seconds=(number and number.seconds) or time.perf_counter() - started,
        observed_order=number.observed_order if number else None,
        points=(points.x, points.y, points.u_distance) if points else None,
        **(_of_file(case.file, quantity, number) if case.file else {}),
    )


def _of_file(problem: FileProblem, quantity: str, result: Result | None) -> dict[str, Any]:
    """Return the entries of a row that a problem of a file has besides."""
    scaled = dimensionless_value(problem.content, quantity, result) if result else None
    return {
        "problem": problem.label,
        "digest": problem.digest,
        "parameters": dict(problem.parameters),
        **({f"dimensionless_{name}": entry for name, entry in scaled.items()} if scaled else {}),
    }


def evaluate_task(task: Task) -> Row:
    """Return the row of a task, whatever happens: a case that its model refuses as inadmissible is a failed row.

    Outside the domain that a model declares it is not evaluated.

    Examples
    --------
    >>> evaluate_task(Task("bradley", "pull_off_force", Case(2, 0, 1))).value
    2.0
    """
    started = time.perf_counter()
    model = task.external or _created(task.model, task.case)
    domain = declared_domain(model)
    # A problem of a file is compared with the domain in its dimensionless form, where it has one.
    if domain is not None and task.case.file is None and not domain.contains(task.quantity, task.case.parameters):
        reason = domain.refusal(task.quantity)
        return _row(model, task.quantity, task.case, started, status="not-applicable", reason=reason)
    try:
        if isinstance(model, ExternalIdentity):
            return _evaluate_external(model, task)
        return evaluate(model, task.quantity, task.case)
    except ValueError as refusal:
        return _row(model, task.quantity, task.case, started, status="failed", reason=str(refusal))


def lost_row(task: Task) -> Row:
    """Return the row of a task that has ended its process twice.

    Examples
    --------
    >>> lost_row(Task("jkr", "pull_off_force", Case(2, 0, 1))).status
    'failed'
    """
    model = task.external or _created(task.model, task.case)
    return _row(model, task.quantity, task.case, time.perf_counter(), status="failed", reason=LOST)


def _evaluate_external(first: ExternalIdentity, task: Task) -> Row:
    """Evaluate an external model; the row has failed if the model is not what it was at the start of the run."""
    started = time.perf_counter()
    model = _created(first.spec, task.case)
    if (model.name, model.version) != (first.name, first.version):
        reason = contradiction((first.name, first.version), (model.name, model.version))
        return _row(first, task.quantity, task.case, started, status="failed", reason=reason)
    return evaluate(model, task.quantity, task.case)


def batches(tasks: Iterable[Task]) -> list[list[Task]]:
    """Return tasks of one model in one case together: in one process the solver finds its meshes again.

    Examples
    --------
    >>> of_jkr = [Task("jkr", quantity, Case(2, 0, 1)) for quantity in ("pull_off_force", "pull_off_displacement")]
    >>> [len(batch) for batch in batches([*of_jkr, Task("dmt", "pull_off_force", Case(2, 0, 1))])]
    [2, 1]
    """
    return [list(batch) for _, batch in groupby(tasks, key=lambda task: task.problem_key)]
