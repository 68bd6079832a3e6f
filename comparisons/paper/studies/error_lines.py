"""Errors of the closed forms along lines of constant n and k, the references from the atlas."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd

from comparisons.paper.cache import CachedCall
from comparisons.paper.paper_figure import Plan, results_by
from comparisons.paper.studies.error_grid import GRADIENT_SLICES, ONSET_EXCESS, SHAPE_SLICES, compared, with_kappa
from comparisons.paper.tasks import quantity
from fscm.interpolation.atlas import atlas

__all__ = ["MAPPED", "TABOR_RANGE", "along_gradients", "along_shapes", "errors_along", "line_errors"]

#: Quantities of the maps, and the closed forms.  DMT has Bradley's pull-off force by its cohesive stress (Eq. 74).
MAPPED = {
    "pull_off_force": ("md-improved", "md-original", "jkr", "bradley"),
    "jump_in_displacement": ("semi-rigid",),
    "jump_out_displacement": ("jkr",),
}

#: Tabor numbers from nearly rigid to nearly JKR; jumps begin at the critical one.
TABOR_RANGE = (0.01, 5.0)
#: So many points that straight lines between them look like curves in a panel of 3 inches.
_TABOR_NUMBERS, _AT_JUMPS = 28, 18
#: Shape indices and gradient exponents, over the range of the atlas.
_SHAPES = tuple(float(f"{n:.4g}") for n in np.geomspace(1.0, 6.0, 21))
_GRADIENTS = tuple(float(f"{k:.4g}") for k in np.linspace(0.0, 0.8, 17))

#: Shape index and gradient exponent.
Line = tuple[float, float]


def along_shapes() -> list[Line]:
    """Return the lines of the maps over the shape index."""
    return [(n, k) for k in SHAPE_SLICES for n in _SHAPES]


def along_gradients() -> list[Line]:
    """Return the lines of the maps over the gradient exponent."""
    return [(n, k) for n in GRADIENT_SLICES for k in _GRADIENTS]


def line_errors(n: float, k: float) -> dict[str, Any]:
    """Return reference values and those of the closed forms over the Tabor number.

    Returns
    -------
    dict
        ``critical`` and ``u_critical``, the critical Tabor number; ``points``, for each quantity a list of dicts with
        ``mu``, ``fscm`` and each closed form, as of `comparisons.paper.tasks.quantity`.

    Examples
    --------
    >>> found = line_errors(2.0, 0.4)
    >>> round(found["critical"], 4), round(found["points"]["pull_off_force"][0]["bradley"]["value"], 9)
    (0.7825, 2.0)
    """
    critical = atlas(n, k, TABOR_RANGE[1], "critical_tabor_number")
    above = np.geomspace(critical.value * (1.0 + ONSET_EXCESS), TABOR_RANGE[1], _AT_JUMPS)
    points = {}
    for name, models in MAPPED.items():
        numbers = np.geomspace(*TABOR_RANGE, _TABOR_NUMBERS) if name == "pull_off_force" else above
        reference = atlas(n, k, numbers, name)
        points[name] = [
            {"mu": mu, "fscm": {"value": value, "u_num": bound, "reason": ""}}
            | {model: quantity(model, name, n, k, mu) for model in models}
            for mu, value, bound in np.column_stack([numbers, *reference]).tolist()
        ]
    return {"critical": critical.value, "u_critical": critical.bound, "points": points}


def errors_along(lines: Iterable[Line], names: Sequence[str]) -> Plan[pd.DataFrame]:
    """Plan a table of one row a point, quantity and closed form.

    Returns
    -------
    DataFrame
        ``n``, ``k``, ``point`` (its number on the line), ``mu``, ``quantity``, ``model``, ``fscm``, ``u_fscm`` (from
        the atlas), ``kappa`` and ``u_kappa``; for jumps also ``critical`` and ``u_critical``.
    """
    found = yield from results_by({line: CachedCall.of(line_errors, *line) for line in lines})
    rows = []
    for (n, k), of_line in found.items():
        for name in names:
            more = {} if name == "pull_off_force" else {of: of_line[of] for of in ("critical", "u_critical")}
            for number, point in enumerate(of_line["points"][name]):
                key = {"n": n, "k": k, "point": number, "mu": point["mu"], "quantity": name}
                for model in MAPPED[name]:
                    rows.append(key | {"model": model} | compared(point["fscm"], point[model]) | more)
    table = with_kappa(rows).drop(columns=["value", "u_num", "reason"])
    last = [name for name in table if name in ("critical", "u_critical")]
    return table[[*table.columns.drop(last), *last]]
