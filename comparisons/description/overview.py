"""Overview of a problem file: Tabor number, pull-off force, error of every closed form, recommended models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.model import Model
from comparisons.problem.evaluation import REFERENCES
from comparisons.problem.problem import Problem
from comparisons.registry import MODELS, create
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

__all__ = [
    "LIMITS",
    "SIMPLEST_FIRST",
    "ModelError",
    "Overview",
    "model_errors",
    "overview_of",
    "recommended",
    "simplest_within",
]

#: Errors for which a model is recommended.
LIMITS = (0.01, 0.05)

#: Order in which a closed form is recommended: limits, asymptote, models of the transition.  Every other one, a fit or
#: another cohesive stress, comes after them: it may be right in one problem because errors cancel.
SIMPLEST_FIRST = ("jkr", "dmt", "bradley", "semi-rigid", "md-improved", "md-original", "md-jin", "double-hertz-n-k")


@dataclass(frozen=True, slots=True)
class ModelError:
    """Relative error of the pull-off force of a model, and the bound of its numerical error.

    Examples
    --------
    >>> ModelError("jkr", -0.004, 1e-9).within(0.01)
    True
    """

    model: str
    error: float
    bound: float

    def within(self, limit: float) -> bool:
        """Whether the error is certainly at most a limit."""
        return abs(self.error) + self.bound <= limit


@dataclass(frozen=True)
class Overview:
    """What is known of a problem without a choice of a model.

    Attributes
    ----------
    tabor_number : float
        Generalised Tabor number (Eq. 29); of a solid that is no power law that with the modulus of its surface.
    critical_tabor_number : float or None
        Where jumps begin, for a problem of the paper in the range of the atlas.
    force : Row
        Pull-off force of the FSCM, or of the atlas where it has the problem.
    errors : tuple of ModelError
        Of the closed forms that take the problem, smallest first.
    """

    problem: Problem
    tabor_number: float
    critical_tabor_number: float | None
    force: Row
    errors: tuple[ModelError, ...]

    @property
    def regime(self) -> str:
        """The limit whose pull-off force is within 5 %, by a sentence.

        A problem without closed forms has none.
        """
        errors = {found.model: found for found in self.errors}
        near = [name for name in ("bradley", "jkr") if name in errors and errors[name].within(LIMITS[-1])]
        if not errors:
            return "not classified: no closed form takes this problem"
        if len(near) == 2:
            return "the rigid limit (Bradley) and the limit of JKR are both within 5 % of the pull-off force"
        if near:
            limit = "rigid limit (Bradley, DMT)" if near[0] == "bradley" else "limit of soft solids (JKR)"
            return f"{limit}, within 5 % of the pull-off force"
        return "transition between the rigid limit (Bradley, DMT) and that of soft solids (JKR)"


def simplest_within(errors: Sequence[ModelError], limit: float) -> str | None:
    """Return the simplest closed form whose error is within a limit, in the order of `SIMPLEST_FIRST`.

    Examples
    --------
    >>> errors = ModelError("schwarz", 1e-4, 0.0), ModelError("md-improved", -3e-3, 0.0), ModelError("jkr", 0.02, 0.0)
    >>> simplest_within(errors, 0.05), simplest_within(errors, 0.01), simplest_within(errors, 1e-5)
    ('jkr', 'md-improved', None)
    """
    within = [row.model for row in errors if row.within(limit)]
    return next((name for name in (*SIMPLEST_FIRST, *within) if name in within), None)


def recommended(overview: Overview, limit: float) -> str:
    """Return the simplest closed form whose error is within a limit, or else the reference.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> some = SimpleNamespace(errors=(ModelError("md-improved", -0.003, 1e-9),), force=SimpleNamespace(model="atlas"))
    >>> recommended(some, 0.01), recommended(some, 1e-3)
    ('md-improved', 'atlas')
    """
    return simplest_within(overview.errors, limit) or overview.force.model


def overview_of(problem: Problem) -> Overview:
    """Compute the overview of a problem.

    Returns
    -------
    Overview
        The status of its force is "failed" where the FSCM does not converge; there are no errors then.

    Examples
    --------
    >>> from comparisons.problem import Problem, Section
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> overview = overview_of(Problem(solid, Section("sphere", {"R": 1e-6}), law))
    >>> overview.force.model, recommended(overview, 0.01)
    ('atlas', 'md-improved')
    """
    force = _reference(problem)
    return Overview(problem, problem.posed.mu, _critical(problem), force, model_errors(problem, force))


def model_errors(problem: Problem, force: Row) -> tuple[ModelError, ...]:
    """Return the errors of the closed forms that take a problem against a pull-off force, smallest first.

    Parameters
    ----------
    problem : Problem
        For the closed forms.
    force : Row
        Of this problem, or of another one that this one stands for.

    Examples
    --------
    >>> from comparisons.problem import Problem, Section
    >>> solid = Section("power-law", {"E0": 70e9, "c0": 1.0, "k": 0.0, "nu": 0.2})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 3e-10})
    >>> problem = Problem(solid, Section("sphere", {"R": 1e-6}), law)
    >>> errors = model_errors(problem, evaluate("bradley", "pull_off_force", problem))
    >>> {found.model: round(found.error, 9) for found in errors}["jkr"]
    -0.25
    """
    errors: list[ModelError] = []
    if problem.is_of_the_paper and force.value is not None and force.u_num is not None:
        for model in _closed_forms():
            found = evaluate(model, "pull_off_force", problem)
            if found.value is not None and found.u_num is not None:
                ratio = found.value / force.value
                bound = (found.u_num + abs(ratio) * force.u_num) / (force.value - force.u_num)
                errors.append(ModelError(model.name, ratio - 1.0, bound))
    return tuple(sorted(errors, key=lambda found: abs(found.error)))


def _reference(problem: Problem) -> Row:
    """The force of the atlas where it has the problem, and else that of the FSCM."""
    if problem.is_of_the_paper:
        found = evaluate("atlas", "pull_off_force", problem)
        if found.status == "ok":
            return found
    return evaluate("fscm", "pull_off_force", problem)


def _closed_forms() -> list[Model]:
    return [create(name) for name in MODELS if name not in REFERENCES]


def _critical(problem: Problem) -> float | None:
    if not problem.is_of_the_paper:
        return None
    return evaluate("atlas", "critical_tabor_number", problem).value
