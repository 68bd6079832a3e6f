"""Least CPU time of a result: the linear algebra and the law that every solver with its mesh needs.

It is measured where the result is measured: on the same machine, in the same process, right after it.

* `fscm`: a dense linear system, and the law and its slope at each unknown, for each Newton step on the last mesh.
* `fem`: one sparse factorisation with a solve.  The matrix is the five-point Laplacian on a square grid, which has
  fewer entries a row than elements of higher degree.
* `fem-large-strain`: the same for each Newton step, because the matrix changes at finite strain.

It leaves out the path to the state, the response of the solid, and the bound.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from math import isqrt
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

#: The least time of so many counts.
_REPEATS = 3


def floor_seconds(model: str, unknowns: int | None, iterations: int | None) -> float | None:
    """Return the least CPU time of a result in seconds; None for a model or a quantity without one.

    Parameters
    ----------
    model : str
    unknowns, iterations : int or None
        Of the mesh of the result, and Newton steps on it.

    Examples
    --------
    >>> floor_seconds("jkr", 0, 0) is None
    True
    """
    if not unknowns:
        return None
    steps = iterations or 1
    if model == "fscm":
        return _least(lambda: newton_steps(unknowns, steps))
    if model == "fem":
        return _least(lambda: factorisations(unknowns, 1))
    if model == "fem-large-strain":
        return _least(lambda: factorisations(unknowns, steps))
    return None


def newton_steps(unknowns: int, steps: int) -> float:
    """Return the CPU time of dense Newton steps: the law and its slope at each unknown, and a linear system."""
    matrix = np.random.default_rng(1).normal(size=(unknowns, unknowns)) + unknowns * np.eye(unknowns)
    gap = np.linspace(1.0, 50.0, unknowns)
    begin = time.process_time()
    for _ in range(steps):
        cube = gap**-3
        pressure, slope = cube**3 - cube, (3.0 * cube - 9.0 * cube**3) / gap
        np.linalg.solve(matrix - np.diag(slope), pressure)
    return time.process_time() - begin


def factorisations(unknowns: int, steps: int) -> float:
    """Return the CPU time of factorisations of a five-point Laplacian of about so many unknowns, each with a solve."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    side = isqrt(unknowns)
    line = sparse.diags_array([-np.ones(side - 1), 2.0 * np.ones(side), -np.ones(side - 1)], offsets=[-1, 0, 1])
    matrix = sparse.csc_array(sparse.kronsum(line, line))
    begin = time.process_time()
    for _ in range(steps):
        # The order for a symmetric matrix without pivots has the least fill-in that SuperLU offers.
        lu = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        lu.solve(np.ones(side**2))
    return time.process_time() - begin


def _least(measured: Callable[[], float]) -> float:
    """Return the least of some times."""
    return min(measured() for _ in range(_REPEATS))


def draw_floor(axes: Axes, rows: pd.DataFrame, x: str, style: Mapping[str, Any], *, across: bool = False) -> None:
    """Draw the floor of a model as a dotted line with hollow markers, where it has one.

    Parameters
    ----------
    axes : Axes
    rows : DataFrame
        Of one model; a table that was measured by an earlier version has no column of the floor.
    x : str
        Column along the axis that is not the time.
    style : mapping
        Colour and marker of the model.
    across : bool
        Whether the time is on the horizontal axis.
    """
    floors = rows.get("floor_seconds")
    if floors is None or floors.isna().all():
        return
    pair = (floors, rows[x]) if across else (rows[x], floors)
    axes.loglog(*pair, ls=":", mfc="none", label=f"{rows['model'].iloc[0]}, floor", **style)
