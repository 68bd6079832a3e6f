"""Thousands of problems of a power-law punch, a power-law solid and the Lennard-Jones 9-3 law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fscm._many.pull_off import pull_off_forces
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.errors import NoSuchEvent, NotConverged
from fscm.interpolation.coordinates import BOX
from fscm.problem import Problem
from fscm.quantities import quantity_named
from fscm.solver import solve

__all__ = ["ManySolutions", "solve_many"]

#: The quantity that is computed in batches.
_BATCHED = "pull_off_force"


@dataclass(frozen=True, eq=False)
class ManySolutions:
    """Values of many problems, arrays of one shape.

    Attributes
    ----------
    value : ndarray of float
        In the units of `fscm.solve`; nan where there is none.
    u_num : ndarray of float
        Bound on the error of each value.
    method : ndarray of str
        "batch", or "solve" where `fscm.solve` was called.
    status : ndarray of str
        "value", or the exception that `fscm.solve` raised: "NoSuchEvent" or "NotConverged".
    reason : ndarray of str
        Why there is no value, else empty.

    Examples
    --------
    >>> forces = solve_many(2, 0, [0.5, 1.0], "pull_off_force")
    >>> forces.value.round(8).tolist(), forces.count("batch")
    ([1.78748293, 1.67066478], 2)
    """

    value: Array
    u_num: Array
    method: NDArray[np.str_]
    status: NDArray[np.str_]
    reason: NDArray[np.str_]

    def count(self, method: str) -> int:
        """Number of problems that were computed by a method."""
        return int(np.count_nonzero(self.method == method))


@one_thread()
def solve_many(n: ArrayLike, k: ArrayLike, mu: ArrayLike, quantity: str) -> ManySolutions:
    """Compute a quantity of many problems, each with the bound on its error.

    Pull-off forces in the range of the atlas (1 <= n <= 6, 0 <= k <= 0.8, 0.01 <= mu <= 10) are computed in batches on
    common meshes, twice each: bounds are at most 1e-8 of the value.  A value whose bound would be larger, that is no
    minimum of the load, or that the atlas contradicts, is computed again by `fscm.solve` (measured: 1 of 10,000
    random ones).  So are all problems outside this range, and all other quantities, one after the other.  The common
    meshes take up to about ten seconds: for a few problems `fscm.solve` is faster.

    Parameters
    ----------
    n, k, mu : array_like of float
        As for `Problem`, broadcast together.
    quantity : str
        One of `QUANTITIES`.

    Returns
    -------
    ManySolutions
        Of the broadcast shape.  A problem without the event, or one that did not converge, has a status and a reason in
        place of a value.

    Raises
    ------
    ValueError
        For an unknown quantity, shapes that do not fit together, or parameters that `Problem` refuses.

    Examples
    --------
    >>> gaps = solve_many(2, 0, [0.5, 2.0], "jump_in_gap")
    >>> gaps.value.round(2).tolist(), gaps.status.tolist(), gaps.reason[0][:50]
    ([nan, 1.26], ['NoSuchEvent', 'value'], 'the displacement rises monotonically along the pat')
    """
    quantity_named(quantity)
    flat, shape = _broadcast(n, k, mu)
    count = len(flat[0])
    value, u_num = np.full(count, np.nan), np.full(count, np.nan)
    inside = np.ones(count, bool)
    for name, parameter in zip(("n", "k", "mu"), flat, strict=True):
        inside &= (parameter >= BOX[name][0]) & (parameter <= BOX[name][1])
    problems = {int(i): _problem(int(i), *(float(parameter[i]) for parameter in flat)) for i in np.flatnonzero(~inside)}
    if quantity == _BATCHED and inside.any():
        value[inside], u_num[inside] = pull_off_forces(*(parameter[inside] for parameter in flat))
    left = np.isnan(value)
    method, statuses, reasons = np.where(left, "solve", "batch"), ["value"] * count, [""] * count
    for i in np.flatnonzero(left).tolist():
        problem = problems[i] if i in problems else _problem(i, *(float(parameter[i]) for parameter in flat))
        try:
            solution = solve(problem, quantity)
            value[i], u_num[i] = solution.value, solution.u_num
        except (NoSuchEvent, NotConverged) as none:
            known = NoSuchEvent if isinstance(none, NoSuchEvent) else NotConverged
            statuses[i], reasons[i] = known.__name__, str(none)
    texts = (method, np.array(statuses, dtype=np.str_), np.array(reasons, dtype=np.str_))
    return ManySolutions(value.reshape(shape), u_num.reshape(shape), *(text.reshape(shape) for text in texts))


def _broadcast(n: ArrayLike, k: ArrayLike, mu: ArrayLike) -> tuple[tuple[Array, Array, Array], tuple[int, ...]]:
    """The parameters as flat arrays of one length, and their common shape."""
    arrays = []
    for name, values in (("n", n), ("k", k), ("mu", mu)):
        array = np.asarray(values)
        if array.dtype.kind not in "iuf":
            raise ValueError(f"{name} = {values!r} is not a real number, nor an array of them")
        arrays.append(array.astype(float))
    try:
        grids = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise ValueError(f"the shapes {shapes} of n, k and mu do not fit together") from None
    first, second, third = (np.ascontiguousarray(grid).ravel() for grid in grids)
    return (first, second, third), grids[0].shape


def _problem(index: int, n: float, k: float, mu: float) -> Problem:
    try:
        return Problem(n, k, mu)
    except ValueError as refused:
        raise ValueError(f"problem {index} of the arrays: {refused}") from None
