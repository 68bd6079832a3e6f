"""Adaption of the panel mesh to the pressure: panels are split where it is unresolved, merged where over-resolved.

A panel is resolved when the last Legendre coefficients e of the pressure on it are too small to matter: the
load moves by 2 c^2 s h e, the work of adhesion (which fixes the edge, as in fracture) by e times the change
of the distance over the panel, and the central gap, from the innermost panel, by M (1-k) (c h)^{1-k} e.
A kink of the punch ends a panel only where the pressure that the panel misses at the kink matters as much.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from fscm._surface.breaks import SLIVER, are_halves, at_kinks, end_radius, extended, joints_in
from fscm._surface.discretisation import Discretisation
from fscm._surface.mesh import PanelMesh
from fscm._surface.newton import STEP_TOLERANCE, newton
from fscm._surface.state import Control, State
from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.punch import kinks_of

__all__ = [
    "adapted",
    "balanced",
    "indicator",
    "newton_tolerance",
    "on_mesh",
    "resolved",
    "resolving",
]

#: A pair of panels is merged when the merged panel would still be this much below the tolerance.
_MERGE_MARGIN = 0.02
#: Merged panels reach at most this many times as far from the axis as they start.
_LARGEST_RATIO = 8.0
#: Share of a jump of the pressure between two panels that counts as a last coefficient.  On a resolved mesh a jump is
#: about ten coefficients, and this is a fifth of one; it is large where no node of a panel samples a feature on it.
#: (Gaps of 25 to 6e4 z0 were once on one panel, n = 2, k = 0, mu = 1e5: the pull-off force was wrong by 2e-3.)
_JUMP = 0.02
#: Above this number of panels, as at a very narrow edge, merging saves more than reusing the stored response does.
_MANY = 40
#: On a balanced mesh neighbours differ by at most this factor in length: the pressure on a longer one is no polynomial
#: next to a narrow edge, which its last coefficients do not show.  Without it, bounds at accuracy 1e-6 were up to 0.3
#: of the pull-off force (n = 2.1, k = 0.85, mu = 19).
_BALANCE = 8.0
#: A mesh is rebuilt to merge panels only if at least this share of its breaks is superfluous.
_WORTH_MERGING = 0.2
#: Newton error relative to the error of the mesh.
_NEWTON_MARGIN = 0.01
_MAX_ROUNDS = 60
#: Rounds of splitting for known gaps between two solves; for the gaps of a guess.
_KNOWN_ROUNDS, _GUESS_ROUNDS = 6, 2
#: r^n at the tip of a punch is not smooth: coefficients of the innermost panel fall algebraically, so that the
#: omitted ones together exceed the last.  Measured on n = 1.5, k = 0.6, mu = 3: by up to 10.
_ALGEBRAIC = 30.0
#: Largest number of times that the innermost panel is halved at once.
_MOST_SPLITS = 8


class _Field:
    """Gap and pressure on a mesh at one scale, from which the indicator is computed."""

    def __init__(
        self, state: State, mesh: PanelMesh | None = None, gap: Array | None = None, scale: float | None = None
    ) -> None:
        self.problem, self.load = state.disc.problem, state.load
        self.scale = state.scale if scale is None else scale
        self.mesh = state.disc.mesh if mesh is None else mesh
        self.gap = state.gap if gap is None else gap
        self.stiffness = state.disc.stiffness_scale(self.scale)
        self.pressure = state.pressure
        if gap is not None:
            self.pressure = self.problem.force.traction(self.scale * self.mesh.nodes, gap)


def _missed_at_kinks(field: _Field, starts: Array, lengths: Array, modes: Array) -> tuple[Array, Array]:
    """Pressure that each polynomial misses, in the mean over its panel, by a kink inside it, and that kink.

    The gap is the height and a smooth deformation.  A polynomial of q nodes misses a kink on about 1/q of its panel, or
    between the kink and the end if that is closer.
    """
    mesh, height = field.mesh, field.problem.punch.height
    largest, places = np.zeros(len(starts)), starts.copy()
    if not (kinks_at := kinks_of(field.problem.punch)):
        return largest, places
    kinks = np.array(kinks_at) / field.scale - mesh.origin
    from_start = kinks - starts[:, None]
    panel, kink = np.nonzero((from_start > SLIVER) & (from_start < lengths[:, None] - SLIVER))
    if not kink.size:
        return largest, places
    points = np.concatenate([starts, starts + lengths, kinks])
    radii = field.scale * (mesh.origin + points)
    deformation = field.gap - height(field.scale * mesh.nodes)
    gap = height(radii) + mesh.evaluate_at_offsets(deformation, points)
    # Where the polynomial falls below the singular gap, as in `_unknowns_on`.
    below = gap <= field.problem.law.singular_gap
    gap = np.where(below, np.interp(points, mesh.node_offsets, field.gap), gap)
    at_start, at_end, at_kink = np.split(field.problem.force.traction(radii, gap), [len(starts), 2 * len(starts)])
    u = from_start[panel, kink] / lengths[panel]
    polynomial = np.einsum("ij,ij->i", legendre.legvander(2.0 * u - 1.0, mesh.order - 1), modes[panel])
    # A polynomial that knows one side of the kink alone misses nothing there, but at the end of its panel.
    start, end = _ends(modes)
    beyond = np.where(u < 0.5, np.abs(at_start - start)[panel], np.abs(at_end - end)[panel])
    missed = np.maximum(np.abs(at_kink[kink] - polynomial), beyond)
    missed *= np.minimum(np.minimum(u, 1.0 - u), 1.0 / mesh.order)
    np.maximum.at(largest, panel, missed)
    worst = missed == largest[panel]
    places[panel[worst]] = kinks[kink[worst]]
    return largest, places


def _weights(field: _Field, starts: Array, lengths: Array) -> Array:
    """Largest effect of a unit pressure error on a panel (start relative to the origin, length) on the results."""
    mesh, c = field.mesh, field.scale
    ends = starts + lengths
    load = 2.0 * c * c * (mesh.origin + ends) * lengths / max(1.0, abs(field.load))
    at_ends = np.append(starts, ends)
    gap = np.interp(at_ends, mesh.node_offsets, field.gap).reshape(2, -1)
    opening = field.problem.force.opening(c * (mesh.origin + at_ends.reshape(2, -1)), gap)
    central = _ALGEBRAIC * field.stiffness * lengths ** (1.0 - field.problem.k)
    central = np.where(starts == -mesh.origin, central, 0.0)
    return np.maximum(np.maximum(load, opening), central)


def _unseen(modes: Array, jump: Array) -> Array:
    """Error of the pressure on each panel, from its last coefficients and the jumps at its ends."""
    return np.maximum(np.max(np.abs(modes[:, -2:]), axis=1), _JUMP * jump)


def _ends(modes: Array) -> tuple[Array, Array]:
    """Pressure at the start and at the end of each panel."""
    return modes @ (-1.0) ** np.arange(modes.shape[1]), modes.sum(axis=1)


def indicator(state: State) -> Array:
    """Estimated effect of the unresolved pressure of each panel, shape (m,), dimensionless."""
    return _indicator(_Field(state))[0]


def _indicator(field: _Field, jumps_count: bool = True) -> tuple[Array, Array]:
    """The indicator, and the places, relative to the origin, at which the panels are split if they are unresolved."""
    mesh = field.mesh
    modes = mesh.modes(field.pressure)
    jump = np.zeros(len(mesh.lengths))
    if jumps_count:
        at_start, at_end = _ends(modes)
        jumps = np.abs(at_start[1:] - at_end[:-1])
        jump = np.maximum(np.append(0.0, jumps), np.append(jumps, 0.0))
    return _effect(field, mesh.offsets[:-1], mesh.lengths, modes, jump)


def _effect(field: _Field, starts: Array, lengths: Array, modes: Array, jump: Array) -> tuple[Array, Array]:
    """Effect of what each polynomial of the pressure leaves out, and where its panel is split: at a kink or halved.

    Gauss's rule integrates a smooth pressure with an error of about the square of its last coefficients, so that a kink
    counts with the root of its effect.
    """
    weights = _weights(field, starts, lengths)
    missed, kinks = _missed_at_kinks(field, starts, lengths, modes)
    smooth, kinked = _unseen(modes, jump) * weights, np.sqrt(missed * weights)
    return np.maximum(smooth, kinked), np.where(kinked > smooth, kinks, starts + 0.5 * lengths)


def resolving(
    state: State,
    mesh: PanelMesh,
    tolerance: float,
    gap_on: Callable[[PanelMesh], Array],
    rounds: int = _KNOWN_ROUNDS,
    scale: float | None = None,
) -> PanelMesh:
    """The mesh with panels split until each resolves the pressure of the given gaps; nothing is solved.

    Parameters
    ----------
    state : State
        Gives the load, and the scale by default.
    mesh : PanelMesh
    tolerance : float
        Of the indicator, without jumps between panels: the gaps may jump where the mesh they come from is too coarse.
    gap_on : callable
        Mesh -> gaps at its nodes.
    rounds : int
        Largest number of splits of a panel: gaps that are not in equilibrium may be unresolvable.
    scale : float, optional
        Of the new mesh, when it differs from that of the state.
    """
    for _ in range(rounds):
        effect, places = _indicator(_Field(state, mesh, gap_on(mesh), scale), jumps_count=False)
        places = places[effect > tolerance]
        ends = np.sort(np.concatenate([mesh.offsets, places]))
        if not places.size or np.any(np.diff(ends) <= 0.0):
            break
        mesh = replace(mesh, offsets=ends)
    return mesh


def balanced(mesh: PanelMesh) -> PanelMesh:
    """The mesh with panels halved until neighbours have similar lengths."""
    while True:
        h = mesh.lengths
        shortest = np.minimum(np.append(h[1:], np.inf), np.append(np.inf, h[:-1]))
        middles = mesh.middles[h > _BALANCE * shortest]
        if not middles.size:
            return mesh
        mesh = replace(mesh, offsets=np.sort(np.concatenate([mesh.offsets, middles])))


def _superfluous(state: State, tolerance: float) -> NDArray[np.intp]:
    """Indices of breaks whose removal leaves the pressure resolved; no two are neighbours."""
    mesh = state.disc.mesh
    starts, lengths = mesh.offsets[:-2], mesh.lengths[:-1] + mesh.lengths[1:]
    rule = mesh.rule
    nodes = starts[:, None] + lengths[:, None] * rule.nodes
    pressure = mesh.evaluate_at_offsets(state.pressure, nodes.ravel()).reshape(nodes.shape)
    modes = pressure @ rule.to_modes.T
    (at_start, at_end), (new_start, new_end) = _ends(mesh.modes(state.pressure)), _ends(modes)
    jump = np.maximum(np.abs(new_start - at_start[:-1]), np.abs(new_end - at_end[1:]))
    effect, _ = _effect(_Field(state), starts, lengths, modes, jump)
    keeps_edge = mesh.offsets[1:-1] != 1.0 - mesh.origin
    keeps_joint = ~np.isin(mesh.offsets[1:-1], joints_in(state.disc.problem, state.scale) - mesh.origin)
    not_too_long = lengths <= (_LARGEST_RATIO - 1.0) * mesh.starts[:-1]
    removable = (effect < _MERGE_MARGIN * tolerance) & keeps_edge & keeps_joint & not_too_long
    if len(mesh.lengths) < _MANY and not kinks_of(state.disc.problem.punch):
        removable &= are_halves(mesh)
    indices: list[int] = []
    for i in np.flatnonzero(removable) + 1:
        if not indices or i > indices[-1] + 1:
            indices.append(int(i))
    return np.array(indices, np.intp)


def _unknowns_on(state: State, mesh: PanelMesh) -> Array:
    """The unknowns of a state on another mesh at the same scale.

    Where the polynomial falls below the singular gap, linear interpolation between the nodes replaces it.
    """
    old, problem = state.disc.mesh, state.disc.problem
    unknowns = state.unknowns_on(mesh)
    gap = state.gap_of(unknowns, state.scale * mesh.nodes)
    below = gap <= problem.law.singular_gap
    if np.any(below):
        unknowns = np.where(below, unknowns + np.interp(mesh.nodes, old.nodes, state.gap) - gap, unknowns)
    return unknowns


def _gap_on(state: State, mesh: PanelMesh) -> Array:
    return state.gap_of(_unknowns_on(state, mesh), state.scale * mesh.nodes)


def on_mesh(state: State, mesh: PanelMesh) -> State:
    """The state interpolated to another mesh at the same scale: a guess, not an equilibrium."""
    disc = Discretisation(state.disc.problem, mesh, state.disc)
    state.disc.factor = None  # rarely used again, and as large as the response
    return replace(state, disc=disc, unknowns=_unknowns_on(state, mesh), iterations=0, residual=0.0)


def lengthened(state: State, end_height: float) -> State:
    """The state on a mesh extended to the end height: a guess, for which no response is computed.

    Beyond the old end the deformation decays like that of a load at the center, r^-(1 + k).
    """
    mesh, problem = state.disc.mesh, state.disc.problem
    end = end_radius(problem, end_height) / state.scale
    if state.disc.steep or mesh.breaks[-1] >= end:
        return state
    longer = replace(mesh, offsets=extended(mesh.offsets, mesh.origin, end))
    added = longer.nodes[mesh.size :]
    w = state.gap[-1] + state.displacement - state.disc.height(state.radius[-1:])[0]
    behind = w * (mesh.nodes[-1] / added) ** (1.0 + problem.k)
    gap = state.disc.height(state.scale * added) - state.displacement + behind
    return replace(state, disc=Discretisation(problem, longer, state.disc), unknowns=np.concatenate([state.gap, gap]))


def _towards_tip(tip: float, before: tuple[float, float], now: tuple[float, float], tolerance: float) -> Array:
    """Places where the innermost panel is split further, if it is unresolved again.

    At the tip of a punch the pressure is a power of the radius, and what a panel there leaves unresolved is a power of
    its length: the lengths and effects of two rounds tell the length that is resolved.

    Examples
    --------
    >>> _towards_tip(0.0, (1.0, 1e-2), (0.5, 1e-3), 1e-5).tolist()  # a tenth by each half, one of which is made anyway
    [0.125]
    """
    (length_before, effect_before), (length, effect) = before, now
    if not (tolerance < effect < effect_before and length < length_before):
        return np.empty(0)
    power = math.log(effect / effect_before) / math.log(length / length_before)
    splits = min(math.ceil(math.log2(effect / tolerance) / power), _MOST_SPLITS)
    return tip + length * 0.5 ** np.arange(2.0, splits + 1.0)


def newton_tolerance(tolerance: float) -> float:
    """Tolerance of Newton's method whose error is negligible relative to that of the mesh."""
    return max(STEP_TOLERANCE, _NEWTON_MARGIN * tolerance)


def resolved(guess: State, tolerance: float) -> State:
    """The guess on a mesh that resolves its pressure, split as by `adapted`; nothing is solved."""
    mesh = resolving(guess, guess.disc.mesh, tolerance, partial(_gap_on, guess), _GUESS_ROUNDS)
    return guess if mesh is guess.disc.mesh else on_mesh(guess, mesh)


def adapted(
    state: State,
    control: Control,
    tolerance: float,
    coarsen: bool = False,
    step_tolerance: float | None = None,
) -> State:
    """Solve on meshes refined until every panel is resolved to `tolerance`.

    Parameters
    ----------
    state : State
        In equilibrium on its own mesh.
    control : Control
        The same on all meshes.
    tolerance : float
        Of the indicator, dimensionless.
    coarsen : bool
        Merge superfluous panels in the first round.
    step_tolerance : float, optional
        Of Newton's method; by default its error is negligible relative to that of the mesh.

    Raises
    ------
    NotConverged
        When the refinement does not end.
    """
    iterations = state.iterations
    if step_tolerance is None:
        step_tolerance = newton_tolerance(tolerance)
    at_tip = math.inf, 0.0
    for attempt in range(_MAX_ROUNDS):
        mesh = state.disc.mesh
        effect, places = _indicator(_Field(state))
        before, at_tip = at_tip, (float(mesh.lengths[0]), float(effect[0]))
        further = _towards_tip(mesh.offsets[0], before, at_tip, tolerance)
        places = np.concatenate([further, places[effect > tolerance]])
        drop = _superfluous(state, tolerance) if coarsen and attempt == 0 else np.empty(0, np.intp)
        # A new mesh costs a solve: worth it for missing panels, or for many superfluous ones.
        if not places.size and drop.size < _WORTH_MERGING * len(mesh.offsets):
            return replace(state, iterations=iterations)
        mesh = replace(mesh, offsets=np.delete(mesh.offsets, drop))
        mesh = at_kinks(state.disc.problem, mesh, state.scale, state.scale)
        places = places[np.all(places[:, None] != mesh.offsets, axis=1)]  # a kink beside its end
        ends = np.sort(np.concatenate([mesh.offsets, places]))
        if np.any(np.diff(ends) <= 0.0):
            raise NotConverged(
                "the contact edge is narrower than the rounding of its radius: no panel resolves the pressure there",
                Failure.MESH,
            )
        mesh = resolving(state, replace(mesh, offsets=ends), tolerance, partial(_gap_on, state))
        state = newton(on_mesh(state, mesh), control, step_tolerance)
        iterations += state.iterations
    raise NotConverged(
        f"the mesh was refined {_MAX_ROUNDS} times without resolving the pressure to {tolerance:.0e}", Failure.MESH
    )
