"""Scaling of a stiffness to a unit diagonal."""

from __future__ import annotations

import numpy as np

from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged

__all__ = ["unit_scaling"]


def unit_scaling(diagonal: Array) -> Array:
    """Symmetric scaling to a unit diagonal, which a positive definite matrix has.

    Parameters
    ----------
    diagonal : ndarray

    Returns
    -------
    ndarray, like `diagonal`
        Its -1/2nd power.

    Raises
    ------
    NotConverged
        If an entry is not positive.

    Examples
    --------
    >>> unit_scaling(np.array([4.0, 25.0]))
    array([0.5, 0.2])
    """
    if not np.all(diagonal > 0):
        raise NotConverged("the stiffness has a non-positive diagonal entry", Failure.STIFFNESS)
    return np.asarray(1.0 / np.sqrt(diagonal))
