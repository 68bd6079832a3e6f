"""The minimum of the load from stored series of the states of least load, in place of a path.

The series (`fscm._many.guess`) give a first state for every power-law punch in the range of the atlas.  The minimum
that Newton's method reaches from there is the deepest one if the atlas has its load: any other minimum is less than a
third as deep there (see `docs/sweeps.md`).  What the atlas knows is from whole paths.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fscm._many.guess import guesses
from fscm._path.arc_length import Point, rates_of
from fscm._path.continuation import moved
from fscm._path.events import Bracket
from fscm._surface.adaptivity import adapted, resolving
from fscm._surface.anchors import AtEdge
from fscm._surface.breaks import edge_mesh
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.newton import newton
from fscm._surface.state import Control, State
from fscm._typing import Array
from fscm.accuracy import Meshes
from fscm.errors import NotConverged
from fscm.interpolation.atlas import atlas
from fscm.interpolation.coordinates import BOX
from fscm.laws import LennardJones
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["known_minimum"]

#: Height of the punch where the coarse mesh ends, and the error of Newton's method on it: as of `pull_off_path`.
_END, _NEWTON = 1e3, 1e-3
#: Times that the panels at the edge are split for the gaps of the series: it may be 1e-11 of the contact radius.
_ROUNDS = 80
#: Steps of log c in which the minimum is looked for: the series miss it by 0.0014 in the median and by up to 0.03
#: (measured, 2000 problems).
_STEPS = (0.02, 0.04, 0.08)
#: Largest distance of the load on a coarse mesh from that of the atlas, relative to it; that of any other minimum is
#: 0.73 or more.
_SAME = 0.05


def known_minimum(problem: Problem, meshes: Meshes) -> Bracket | None:
    """Two neighbouring states between which the load has its deepest minimum; None where a path has to tell it.

    Parameters
    ----------
    problem : Problem
        Dimensionless.
    meshes : Meshes
    """
    if not _is_in_the_atlas(problem):
        return None
    try:
        bracket = _bracket(_first(problem, meshes))
    except NotConverged:
        return None
    if bracket is None:
        return None
    known = float(atlas(problem.n, problem.k, problem.mu, "pull_off_force").value)
    least = min(point.state.load for point in bracket)
    return bracket if abs(least + known) <= _SAME * known else None


def _is_in_the_atlas(problem: Problem) -> bool:
    if not isinstance(problem.punch, PowerPunch) or problem.graded is not None or problem.interaction != "derjaguin":
        return False
    parameters = {"n": problem.n, "k": problem.k, "mu": problem.mu}
    return type(problem.law) is LennardJones and all(
        BOX[name][0] <= value <= BOX[name][1] for name, value in parameters.items()
    )


def _first(problem: Problem, meshes: Meshes) -> Point:
    """The state at the edge of the series, on a coarse mesh."""
    guess = guesses(*(np.array([value]) for value in (problem.n, problem.k, problem.mu)))
    log_scale, (order, tolerance) = float(guess.log_scale[0]), meshes.path
    scale = math.exp(log_scale)

    def gap_on(mesh: PanelMesh) -> Array:
        return guess.gaps(0, problem.n, problem.k, mesh.node_offsets)

    mesh = edge_mesh(problem, order, scale, min(_END, meshes.end_height))
    state = State(Discretisation(problem, mesh), scale, gap_on(mesh), float(guess.displacement[0]), AtEdge())
    mesh = resolving(state, mesh, tolerance, gap_on, _ROUNDS)
    state = replace(state, disc=Discretisation(problem, mesh), unknowns=gap_on(mesh))
    control = Control(log_scale, log_scale=1.0)
    return _point(adapted(newton(state, control, _NEWTON), control, tolerance, True, _NEWTON))


def _bracket(point: Point) -> Bracket | None:
    """The last two of states at steps downhill, between which the load turns."""
    start, downhill = math.log(point.state.scale), -math.copysign(1.0, point.rates.load)
    for step in _STEPS:
        state = moved(point.state, rates_of(point.state), start + downhill * step, _NEWTON)
        after = _point(state)
        if downhill * after.rates.load >= 0.0:
            return (point, after) if downhill > 0.0 else (after, point)
        point = after
    return None


def _point(state: State) -> Point:
    return Point(state, rates_of(state).scaled(state.orientation))
