"""Error of the assumptions beside a printed force: a line of text and an object of JSON, without a solution."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from comparisons.description.shared_errors import NOT_ASSUMED_OF_BALLS, Json, direction, error_of, estimates, together
from comparisons.numerics.number_text import percent_text
from comparisons.problem import Problem
from comparisons.registry import MODELS

if TYPE_CHECKING:
    import pandas as pd

#: An error is stated where it may be more than this many bounds of what is printed.
_BOUNDS = 10.0

#: Assumptions that a model does not make for any punch.
_OF_ALL = {"fem-large-strain": ("strain",)}


def budget(problem: Problem, model: str = "fscm") -> Json | None:
    """Return the error of the assumptions that a model makes in the pull-off force of a problem.

    Parameters
    ----------
    problem : Problem
    model : str

    Returns
    -------
    dict or None
        ``geometry``, ``derjaguin``, ``strain``, ``surface_tension``, ``friction`` and ``total``, as of
        `comparisons.description.assumptions.assumptions`, by the table of balls and closed forms.  None for a
        dimensionless problem, whose solid has no size beside the sphere, and for an external model.

    Examples
    --------
    >>> budget(Problem.dimensionless(2, 0, 1)) is None
    True
    >>> from comparisons.problem import Section
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 5e-3, "z0": 4e-10})
    >>> gel = Problem(Section("homogeneous", {"E": 5e3, "nu": 0.5}), Section("sphere", {"R": 1e-5}), law)
    >>> -0.2 < budget(gel)["total"]["error"] < -0.04
    True
    """
    if problem.is_dimensionless or model not in MODELS:
        return None
    avoided = (NOT_ASSUMED_OF_BALLS if problem.punch.kind == "ball" else _OF_ALL).get(model, ())
    errors = estimates(problem) | {name: error_of((0.0, 0.0)) for name in avoided}
    return errors | {"total": together(errors)}


def budget_line(assumed: Json | None, relative_bound: float, where: str = "") -> str | None:
    """Return a line on the total of `budget`; None where it is at most ten bounds of what is printed.

    Parameters
    ----------
    assumed : dict, optional
        As of `budget`.
    relative_bound : float
        Bound of the printed force, relative to it.
    where : str
        The problem, where several are printed.

    Examples
    --------
    >>> total = {"error": -0.02, "u_num": 0.003, "basis": "estimate", "reason": ""}
    >>> budget_line({"geometry": total, "total": total}, 1e-9).partition(": error ")[2]
    '-2.0(3) % (too small), estimate from a table; fscm-bench describe computes it'
    >>> budget_line({"geometry": total, "total": total}, 0.01) is None
    True
    """
    if assumed is None:
        return None
    end = "fscm-bench describe computes it"
    total = assumed["total"]
    rows = [assumed[name] for name in ("geometry", "derjaguin", "strain") if name in assumed]
    unknown = [row["reason"] for row in rows if row["error"] is None]
    if total["error"] is not None:
        if abs(total["error"]) + total["u_num"] <= _BOUNDS * relative_bound:
            return None
        error = f"error {percent_text(total['error'], total['u_num'])} %{direction(total)}"
        text = ", ".join(filter(None, (error, "estimate from a table", total["reason"])))
    elif unknown:
        text = f"error unknown, {unknown[0]}"
        end = "see fscm-bench describe"
    else:
        # None of those that are known is an error.
        return None
    return f"the assumptions of all models change the pull-off force{where}: {text}; {end}"


def largest_line(entries: Iterable[tuple[Json | None, float, str]]) -> str | None:
    """Return the line of the largest error, of the arguments of `budget_line`; an unknown error counts as larger."""
    lines = []
    for assumed, relative_bound, where in entries:
        line = budget_line(assumed, relative_bound, where)
        if assumed is not None and line is not None:
            error = assumed["total"]["error"]
            lines.append((math.inf if error is None else abs(error), line))
    return max(lines, key=lambda pair: pair[0])[1] if lines else None


def line_of_results(problems: Iterable[Problem], results: pd.DataFrame) -> str | None:
    """Return the line of the pull-off force whose error by the assumptions is largest.

    Parameters
    ----------
    problems : iterable of Problem
    results : DataFrame
        Rows of results, with ``model``, ``quantity``, ``problem``, ``value`` and ``u_num``.
    """
    by_name = {problem.name: problem for problem in problems if not problem.is_dimensionless}
    if not by_name:
        return None
    forces = results[results["quantity"].eq("pull_off_force") & results["value"].notna()]
    return largest_line(
        (
            budget(by_name[row.problem], row.model) if row.problem in by_name else None,
            row.u_num / abs(row.value) if row.value else 0.0,
            f", most for {row.problem}" if len(by_name) > 1 else "",
        )
        for row in forces.itertuples()
    )
