r"""Stability of an equilibrium state under prescribed displacement and under prescribed load.

The surface may move by v(r, theta) and, under prescribed load, the punch by e along its axis; the punch cannot tilt or
shift.  With the elastic stiffness K^{-1} the second variation of the energy is

    int v K^{-1} v  -  int p'(H) (v - e)^2,        e = 0 unless the load is prescribed.

*Prescribed displacement.*  p' > 0 beyond the gap of largest tension, where the attraction grows as the gap closes: only
there the second variation is reduced, at most by the share of the other terms that is the largest eigenvalue of
(1 + K p'_-)^{-1} K p'_+ , p' = p'_+ - p'_-.  The margin is 1 minus this share, positive for a stable state.

*Prescribed load.*  With the surface in equilibrium the energy is U(delta) - P delta, so that the load adds one unstable
direction if dP/d(delta) < 0.  A state is stable if it is so under prescribed displacement and dP/d(delta) > 0.

*Axisymmetric motions decide.*  On a power law K^{-1} is the power (1-k)/2 of the Laplacian, whose heat kernel
for v cos(m theta) is positive and decreases with m.  By Trotter's formula so does that of K^{-1} - p'(H(r)): the margin
increases with m, and no state that is stable for m = 0 is unstable for another m, whatever the law, the punch and the
gradient.  On other solids the margin is that of axisymmetric motions; other motions are not examined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fscm._path.arc_length import Point, rates_of
from fscm._surface.state import State
from fscm._threads import one_thread
from fscm._typing import Array
from fscm.errors import Failure, NotConverged

__all__ = ["Stability", "margins", "stability_of", "stable_sections"]

#: Largest number of unstable directions that is counted at the initial state of a path.
_MOST = 6
#: Distance of two folds, relative to 1 + abs(delta), whose order is that of rounding: the tolerance of the path.  Folds
#: that are counted wrong without such a pair are a path that may have missed some.
_COIL = 1e-8


@dataclass(frozen=True)
class Stability:
    """Stability of a state.

    Attributes
    ----------
    margin : float
        Smallest second variation of the energy under prescribed displacement, relative to its stiffening terms: at
        most 1, 0 at a fold of the displacement, negative for an unstable state.
    stiffness : float
        dP/d(delta) along the path, in the units of the problem.

    Examples
    --------
    >>> from fscm import Problem, equilibria
    >>> for state in equilibria(Problem(n=2, k=0, mu=1.0), "load", -1.5):
    ...     print(round(state.displacement, 2), state.stable_under_displacement, state.stable_under_load)
    -1.48 True False
    -0.07 True True
    """

    margin: float
    stiffness: float

    @property
    def under_displacement(self) -> bool:
        """Whether the state is stable under prescribed displacement."""
        return self.margin > 0.0

    @property
    def under_load(self) -> bool:
        """Whether the state is stable under prescribed load."""
        return self.under_displacement and self.stiffness > 0.0


def margins(state: State, count: int = 1) -> Array:
    """The `count` smallest margins of a state, ascending.

    Parameters
    ----------
    state : State
    count : int

    Raises
    ------
    NotConverged
        When the eigenvalues are not found.
    """
    from scipy.sparse.linalg import ArpackError, eigs

    d = state.disc
    slope = d.force.slope(state.radius, state.gap)
    attracted = slope > 0.0
    K = d.stiffness_scale(state.scale) * d.response(state.scale)
    size = int(np.count_nonzero(attracted))
    try:
        stiffened = np.eye(len(slope)) + K * np.maximum(-slope, 0.0)
        reduced = np.linalg.solve(stiffened, K[:, attracted] * slope[attracted])[attracted]
        if size <= count + 1:
            values = np.linalg.eigvals(reduced)
        else:
            with one_thread():  # the BLAS of SciPy may be new
                values = eigs(reduced, k=count, which="LM", v0=np.ones(size), return_eigenvectors=False)
    except (np.linalg.LinAlgError, ArpackError) as error:
        raise NotConverged(
            f"the stability of the state at H_0 = {state.central_gap:.6g} was not found: {error}",
            Failure.ITERATION,
        ) from error
    return np.sort(1.0 - values.real)[:count]


def stability_of(state: State) -> Stability:
    """Stability of an equilibrium state.

    Parameters
    ----------
    state : State

    Raises
    ------
    NotConverged
    """
    rates = rates_of(state)
    stiffness = rates.load / rates.displacement if rates.displacement else np.inf
    return Stability(float(margins(state)[0]), float(stiffness))


def stable_sections(start: Point, end: Point, folds: Sequence[tuple[str, float]]) -> list[tuple[bool, bool]]:
    """Whether the sections of a path between its folds are stable, under displacement and under load.

    Unstable directions are counted at the initial state.  At each fold dP/d(delta) changes its sign.  The unstable
    directions under prescribed load are those under prescribed displacement and one more if dP/d(delta) < 0; a fold of
    the displacement does not change the former, and a fold of the load not the latter.

    The path of a flat punch on a solid with a large gradient coils up where contact begins, and folds that follow each
    other to less than the tolerance of the path are in no order.  Then the count does not lead to that of the last
    state, and the sections behind the place where two folds are nearest are counted from there.

    Parameters
    ----------
    start, end : Point
        The first and the last point of the path.
    folds : sequence of (str, float)
        "displacement" or "load", and the displacement there, in the order of the path.

    Returns
    -------
    list of (bool, bool)
        One pair more than folds.
    """
    names = [name for name, _ in folds]
    sections = _sections(start, names)
    if sections[-1][0] or len(folds) < 2:
        return sections
    behind = _sections(end, names[::-1])[::-1]
    if not behind[-1][0]:
        return sections
    places = np.array([displacement for _, displacement in folds])
    distances = np.abs(np.diff(places)) / (1.0 + np.abs(places[1:]))
    nearest = int(np.argmin(distances))
    if distances[nearest] > _COIL:
        return sections
    return [*sections[: nearest + 1], *behind[nearest + 1 :]]


def _sections(origin: Point, folds: Sequence[str]) -> list[tuple[bool, bool]]:
    """Stability of the sections from one end of the path to the other."""
    unstable = int(np.count_nonzero(margins(origin.state, _MOST) <= 0.0))
    rising = origin.rates.load * origin.rates.displacement > 0.0
    sections = [(unstable == 0, unstable == 0 and rising)]
    for fold in folds:
        if fold == "displacement":
            unstable += -1 if rising else 1
        rising = not rising
        sections.append((unstable == 0, unstable == 0 and rising))
    return sections
