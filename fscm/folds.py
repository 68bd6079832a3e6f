"""Turning points of load and displacement on the equilibrium path."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fscm._path import events
from fscm._path.arc_length import Point, parameter_of
from fscm._path.punch_rules import rules_of
from fscm._roots import bracketed_root
from fscm._surface.state import State

__all__ = ["Fold", "edge_radius", "fold_at", "folds_between", "folds_of"]

_FOLDS = {"load": events.load_fold, "displacement": events.displacement_fold}


@dataclass(frozen=True)
class Fold:
    """One turning point of the path, in the units of the problem.

    Attributes
    ----------
    quantity : str
        "load" or "displacement": what turns.
    maximum : bool
        Whether it is a maximum.
    central_gap, displacement, load : float
    edge_radius : float
        Radius where the tension is largest; nan before contact.

    Examples
    --------
    >>> from fscm import Analysis, Problem
    >>> [fold.quantity for fold in Analysis(Problem(n=2, k=0.4, mu=0.3)).folds]
    ['load']
    """

    quantity: str
    maximum: bool
    central_gap: float
    displacement: float
    load: float
    edge_radius: float

    def in_units(self, units: Mapping[str, float]) -> Fold:
        """The fold of a dimensionless problem in the units of a physical one."""
        return replace(
            self,
            central_gap=self.central_gap * units["gap"],
            displacement=self.displacement * units["displacement"],
            load=self.load * units["load"],
            edge_radius=self.edge_radius * units["radius"],
        )


def fold_at(state: State, quantity: str, maximum: bool) -> Fold:
    """The fold at a state."""
    edge = edge_radius(state)
    return Fold(quantity, maximum, float(state.central_gap), float(state.displacement), float(state.load), edge)


def edge_radius(state: State) -> float:
    """Outermost radius at which the gap is that of the largest tension; nan before contact."""
    problem, mesh = state.disc.problem, state.disc.mesh
    if state.anchor.in_contact:
        return float(state.scale)
    force = problem.force
    inside = np.flatnonzero(state.gap < force.peak_gap(state.radius))
    # For a power law the mesh follows the edge soon after it appears.
    if not (inside.size and rules_of(problem).may_hide_folds):
        return math.nan
    low, high = mesh.nodes[inside[-1] : inside[-1] + 2]

    def excess(s: float) -> float:
        at = np.array([s])
        return float((mesh.evaluate(state.gap, at) - force.peak_gap(state.scale * at))[0])

    s = bracketed_root(excess, low, high)
    return float(state.scale * s)


def folds_between(a: Point, b: Point) -> list[tuple[State, str, bool]]:
    """State, quantity, and whether it is a maximum, of the folds between neighbouring points.

    The last point of a segment and the first of the next are the same state on two meshes.  Where a path coils up, a
    fold may be so near that its rates there differ in sign: it is at that state.
    """
    located = []
    for quantity, condition in _FOLDS.items():
        before, after = condition(a.state, a.rates), condition(b.state, b.rates)
        if before * after < 0.0:
            state = b.state if a.segment != b.segment else events.locate(a, b, condition)
            located.append((state, quantity, before > 0.0))
    if a.segment != b.segment:
        return located
    direction = a.state.orientation
    return sorted(located, key=lambda item: direction * parameter_of(item[0]))


def folds_of(points: Sequence[Point]) -> tuple[Fold, ...]:
    """The folds of a path that is complete (see `fscm._path.completeness`)."""
    return tuple(fold_at(*fold) for a, b in pairwise(points) for fold in folds_between(a, b))
