"""Tasks of a run: which evaluations it needs, and the row of each.

A `Task` is one evaluation of one model.  `evaluate_task` returns its `Row` whatever happens: a model that fails costs
its own rows and nothing else.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from traceback import extract_tb
from typing import Any, cast

import numpy as np

from comparisons.data.validation import known_name
from comparisons.external.process_model import contradiction
from comparisons.model import EFFORT, ComputationFailed, Curve, Model, NotApplicable, Result
from comparisons.problem import Problem
from comparisons.problem.evaluation import dimensionless_result, evaluated, unit_of
from comparisons.quantities import ALL_QUANTITIES, Points
from comparisons.registry import ExternalIdentity, create, depends_on_poisson_ratio
from comparisons.runs.cases import Grid
from comparisons.runs.rows import DIMENSIONLESS, Key, Row
from comparisons.runs.workers import LOST


@dataclass(frozen=True, slots=True)
class Task:
    """One evaluation of one model, by names only: cheap to send to another process."""

    model: str
    quantity: str
    problem: Problem
    external: ExternalIdentity | None = None

    @property
    def key(self) -> Key:
        """The key of its row."""
        return self.model, self.quantity, *self.problem.key

    @property
    def problem_key(self) -> tuple[str, Problem]:
        """Model and problem: its quantities are computed together, from one path."""
        return self.model, self.problem


def problem_for(model: str, problem: Problem) -> Problem:
    """Return the problem as a model gets it: without Poisson's ratio if that makes no difference to it.

    Examples
    --------
    >>> problem_for("jkr", Problem.dimensionless(2, 0, 1, nu=0.25)).label
    'n = 2, k = 0, mu = 1'
    """
    return problem if depends_on_poisson_ratio(model) else problem.without_nu()


def plan(
    grids: Iterable[Grid], models: Sequence[str] | None = None, external: Mapping[str, ExternalIdentity] | None = None
) -> list[Task]:
    """Return every task once: the reference and the candidates of each grid, in all its cases.

    Parameters
    ----------
    grids : iterable of Grid
        What to compute.
    models : sequence of str, optional
        Names of candidates that take the place of those each grid names; the reference is always computed.
    external : dict of str to ExternalIdentity, optional
        Those of them that are external (see `comparisons.registry.identify`).

    Returns
    -------
    list of Task
        Those of problem files first, then one gradient exponent after the other, for which `fscm` keeps its kernel's
        integrals; of each the largest Tabor numbers first: they take longest, and one that starts last would keep one
        core busy alone.
    """
    tasks = {
        Task(model, quantity, problem_for(model, problem), (external or {}).get(model))
        for grid in grids
        for model in {grid.reference, *(models or grid.models)} - {""}
        for quantity in grid.quantities
        for problem in grid.cases
    }
    return sorted(tasks, key=_quickest_order)


def _quickest_order(task: Task) -> tuple[float, float, Problem, str, str]:
    # Complete, so that every process plans the same order.
    gradient, tabor = task.problem["k"], task.problem["mu"]
    return -1.0 if gradient is None else gradient, -(tabor or math.inf), task.problem, task.model, task.quantity


def evaluate(model: str | Model, quantity: str, problem: Problem) -> Row:
    """Evaluate a model and return the row.

    Parameters
    ----------
    model : str or Model
        A name, a SPEC or a model.
    quantity : str
        One of `comparisons.QUANTITIES`, or a curve.
    problem : Problem

    Raises
    ------
    ValueError
        If the model or the quantity is unknown, or the model refuses the problem as inadmissible; any other failure is
        a row with status and reason.

    Examples
    --------
    >>> evaluate("bradley", "pull_off_force", Problem.dimensionless(2, 0, 1)).status
    'ok'
    """
    known_name("quantity", quantity, ALL_QUANTITIES, "evaluate")
    model = _model(model, _known(problem))
    started = time.perf_counter()
    try:
        outcome = {"status": "ok"} | _fields(problem, quantity, evaluated(problem, model, quantity))
    except NotApplicable as refusal:
        outcome = {"status": "not-applicable", "reason": str(refusal)}
    except ComputationFailed as failure:
        outcome = {"status": "failed", "reason": str(failure)}
    except ValueError:
        raise
    except Exception as error:
        # A defect of the model: its row names the function, and the other models are computed.
        function = extract_tb(error.__traceback__)[-1].name
        outcome = {"status": "failed", "reason": f"{type(error).__name__} in {function}: {error}"}
    return _row(model, quantity, problem, started, **outcome)


def curve(model: str | Model, problem: Problem) -> Curve:
    """Return the force-displacement curve of a model, in the units of the problem: SI, or dimensionless.

    That of a solver is its whole equilibrium path: ``columns`` says which states can be held.

    Parameters
    ----------
    model : str or Model
        A name, a SPEC or a model.
    problem : Problem

    Raises
    ------
    ValueError
        If the model is unknown, or the problem is inadmissible.
    NotApplicable, ComputationFailed
        If the model has no curve of this problem.

    Examples
    --------
    >>> path = curve("jkr", Problem.dimensionless(2, 0, 1))
    >>> round(float(-path.load.min()), 3)
    1.5
    """
    points = cast(Points, evaluated(_known(problem), _model(model, problem), "force_curve"))
    return Curve(np.array(points.x), np.array(points.y), points.columns, points.u_distance)


def _known(problem: Problem) -> Problem:
    if not isinstance(problem, Problem):
        raise ValueError(f"problem = {problem!r} is no Problem: write Problem.dimensionless(n, k, mu), or Problem.load")
    return problem


def _model(model: str | Model, problem: Problem) -> Model:
    """The model of a name; some need Poisson's ratio."""
    return create(model, problem.nu) if isinstance(model, str) else model


def _fields(problem: Problem, quantity: str, result: Result | Points) -> dict[str, Any]:
    """Return the entries of a row that a result has; those of `Result` have the same names."""
    if isinstance(result, Points):
        return {"points": (result.x, result.y, result.u_distance)}
    fields = asdict(result)
    if not result.seconds:
        del fields["seconds"]
    scaled = dimensionless_result(problem, quantity, result)
    return fields | (dict(zip(DIMENSIONLESS, scaled, strict=True)) if scaled else {})


def _row(model: Model | ExternalIdentity, quantity: str, problem: Problem, started: float, **outcome: Any) -> Row:
    """Return a row; its time is that since it was started, unless the model states one."""
    about: dict[str, Any] = {
        "model": model.name,
        "model_version": model.version,
        "quantity": quantity,
        "problem": problem.name,
        "digest": problem.digest,
        "parameters": dict(problem.parameters),
        "unit": unit_of(problem, quantity),
    }
    effort: dict[str, Any] = dict.fromkeys(EFFORT) | {"seconds": time.perf_counter() - started}
    return Row(**about | effort | outcome)


def evaluate_task(task: Task) -> Row:
    """Return the row of a task, whatever happens: a problem that its model refuses as inadmissible is a failed row.

    An external model is not even started outside the domain that it declares, and has failed if it is not what it was
    at the start of the run.

    Examples
    --------
    >>> evaluate_task(Task("bradley", "pull_off_force", Problem.dimensionless(2, 0, 1))).value
    2.0
    """
    started = time.perf_counter()
    identity, problem = task.external, task.problem
    try:
        if identity is None:
            return evaluate(task.model, task.quantity, problem)
        domain = identity.applies_to
        if domain is not None and (reason := domain.skip(problem, task.quantity)):
            return _row(identity, task.quantity, problem, started, status="not-applicable", reason=reason)
        model = create(identity.spec, problem.nu)
        if (model.name, model.version) != (identity.name, identity.version):
            raise ValueError(contradiction((identity.name, identity.version), (model.name, model.version)))
        return evaluate(model, task.quantity, problem)
    except ValueError as refusal:
        return failed_row(task, str(refusal), started)


def failed_row(task: Task, reason: str = LOST, started: float | None = None) -> Row:
    """Return the row of a task that has failed since it was started; by default, one that has ended its process twice.

    Examples
    --------
    >>> failed_row(Task("jkr", "pull_off_force", Problem.dimensionless(2, 0, 1))).status
    'failed'
    """
    model = task.external or create(task.model, task.problem.nu)
    started = time.perf_counter() if started is None else started
    return _row(model, task.quantity, task.problem, started, status="failed", reason=reason)


def batches(tasks: Iterable[Task]) -> list[list[Task]]:
    """Return tasks of one model for one problem together: in one process the solver finds its meshes again.

    Examples
    --------
    >>> sphere = Problem.dimensionless(2, 0, 1)
    >>> of_jkr = [Task("jkr", quantity, sphere) for quantity in ("pull_off_force", "pull_off_displacement")]
    >>> [len(batch) for batch in batches([*of_jkr, Task("dmt", "pull_off_force", sphere)])]
    [2, 1]
    """
    return [list(batch) for _, batch in groupby(tasks, key=lambda task: task.problem_key)]
