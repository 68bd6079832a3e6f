r"""End of the equilibrium path, beyond which no state carries tension.

A punch without asperities is one for which r f' does not decrease, such as a power law.  On a homogeneous or power-law
solid its load has one minimum on the contact branch, and the path ends at the first compressive load.

On any other solid the load may have a minimum for each layer.  In a contact of radius a, with the modulus E_a of the
solid at the wavelength a, the load is P_1 - P_2 with the compressive part P_1 ~ E_a a^2 f'(a) and the adhesive part
P_2 ~ (w E_a a^3)^(1/2), so that (P_1/P_2)^2 grows like g(a) = E_a a f'(a)^2.  Only if g decreases, under a stiff layer
that bends, can tension return.  The path ends where g does not decrease again by more than the square of P_1/P_2.  That
ratio follows from the load and the tension of the state: JKR's edge carries the share (P_2/P_1)^(1/2) of P_2.

Any other punch may have asperities, and a law several wells: in a liquid a contact in the outer well is compressed
until its barrier is passed, and carries tension again.  Then the load of every state of displacement delta has a lower
bound.  Let q be the pressure of a flat punch of radius a for a unit indentation.  The surface moves by 1 below the flat
punch and by phi < 1 outside.  With the reciprocity of q and p, H > s (the singular gap) and Eq. 4,

    P >= C_a (delta + s - <f>) - int_a^oo t(f - delta - W) (1 - phi) 2 r dr       for every a.

C_a is the load of the flat punch, <f> the mean of f with the weight q, and t(H) the largest tension at any gap of at
least H.  W bounds the deformation by tension: it is the largest W that does not exceed the deformation by the tension
t(f - delta - W).  Nothing is assumed of the state.  The path is assumed not to return to a smaller displacement once it
has reached one above which the bound is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fscm._surface.response import response_of
from fscm._surface.state import State
from fscm._typing import Array
from fscm._whole_punch import WholePunch
from fscm.errors import Failure, NotConverged
from fscm.interaction import Derjaguin
from fscm.problem import Problem
from fscm.punch import PunchShape, ScaledPunch, kinks_of
from fscm.wells import has_one_well, tension_beyond

__all__ = ["LeastLoad", "PathEnd", "depth", "displacement_of_compression", "refusal"]

#: Number of radii at which the shape is evaluated; every _EVERY-th is the radius of a flat punch.
_RADII, _EVERY = 3000, 24
#: Smallest radius, in units of the largest: features below it carry less than 1e-9 of any load.
_FIRST_RADIUS = 1e-7
#: Largest displacement, in units of the height of the punch at the largest radius: small enough for the closed tail.
_LARGEST = 1e-2
#: Relative decrease of r f' that counts as rounding: a slope by differences has an error of 1e-11 of f / r.
_LEVEL = 1e-6
#: Difference of exponents that is rounding.
_SAME_POWER = 1e-6
#: Ratio of successive displacements in the search.
_RATIO = 1.05
#: Iterations for the deformation by tension: they decrease, so that each is a bound.
_ITERATIONS = 60
#: The modulus for a contact of radius a is that at wave numbers around 1/a, within this factor; number of points there.
_WINDOW, _IN_WINDOW = 3.0, 25
#: Change of log D that is negligible; largest radius, in units of the deepest change, and number of radii.
_UNCHANGED, _LAYERS, _LATER = 0.02, 10.0, 200
#: Factor for the tension beyond the largest radius, where H is smaller than f.
_TAIL_MARGIN = 1.5


@dataclass
class PathEnd:
    """Condition that ends a path: a compressive load beyond all asperities and layers, at the largest displacement.

    Attributes
    ----------
    displacement : float
        Displacement above which every load is compressive (see `displacement_of_compression`).
    load : float
        The load has to exceed this as well.
    farthest : float
        Largest displacement of the states so far.
    """

    displacement: float
    load: float = 0.0
    farthest: float = -math.inf

    def __call__(self, state: State) -> bool:
        self.farthest = max(self.farthest, state.displacement)
        deepest = state.displacement >= max(self.farthest, self.displacement)
        force = state.disc.problem.force
        touching = state.central_gap < state.disc.problem.law.peak_gap or np.any(
            state.gap < force.peak_gap(state.radius)
        )
        return bool(state.anchor.in_contact or touching) and state.load > self.load and deepest and beyond_layers(state)


def beyond_layers(state: State) -> bool:
    """Whether no layer of the solid makes the load tensile again once it is compressive."""
    problem, punch = state.disc.problem, state.disc.problem.punch
    if problem.graded is None or response_of(problem.graded).kernel is None:
        return True
    response = response_of(problem.graded)
    stiffness = _Stiffness(*response.spectrum)
    touching = state.radius[state.gap < state.disc.problem.force.peak_gap(state.radius)]
    a = max(float(touching[-1]) if touching.size else 0.0, float(state.radius[0]))
    later = np.geomspace(a, max(a, stiffness.deepest) * _LAYERS, _LATER)
    least = float(np.min(stiffness.least(later) * later * punch.slope(later) ** 2))
    present = float(stiffness.largest(np.array([a]))[0] * a * punch.slope(np.array([a]))[0] ** 2)
    area = 2.0 * state.scale**2 * state.disc.mesh.weights * state.disc.mesh.nodes
    tension = -float(area @ np.minimum(state.pressure, 0.0))
    return (1.0 + max(state.load, 0.0) / tension) ** (4.0 / 3.0) * least >= present


class _Stiffness:
    """Smallest and largest modulus around a wavelength, in an arbitrary unit, from the softness at wave numbers."""

    def __init__(self, waves: Array, softness: Array) -> None:
        self._log_waves, self._log_D = np.log(waves), np.log(softness)
        changing = np.flatnonzero(np.abs(self._log_D - self._log_D[0]) > _UNCHANGED)
        #: Radius beyond which the solid is homogeneous.
        self.deepest = float(1.0 / waves[changing[0]]) if changing.size else 0.0

    def _around(self, a: Array) -> Array:
        shifts = np.linspace(-math.log(_WINDOW), math.log(_WINDOW), _IN_WINDOW)
        return np.exp(-np.interp(shifts - np.log(a)[:, None], self._log_waves, self._log_D))

    def least(self, a: Array) -> Array:
        """Shape of `a`."""
        return np.asarray(np.min(self._around(a), axis=1))

    def largest(self, a: Array) -> Array:
        """Shape of `a`."""
        return np.asarray(np.max(self._around(a), axis=1))


def _radii(end: float) -> Array:
    return np.concatenate([[0.0], np.geomspace(_FIRST_RADIUS * end, end, _RADII)])


def depth(problem: Problem, end: float) -> float:
    """Depth of the lowest point of the punch below its center, up to the radius `end`; 0 unless the tip is concave."""
    return -min(0.0, float(np.min(problem.punch.height(_radii(end)))))


def _first_fall(punch: PunchShape, end: float) -> float | None:
    """Radius from which on r f' decreases, 0 for a concave tip; None without asperities."""
    r = _radii(end)
    rising = r[1:] * punch.slope(r[1:])
    falls = np.flatnonzero(np.diff(rising, prepend=0.0) < -_LEVEL * np.abs(rising))
    if not falls.size:
        return None
    before, behind = r[falls[0]], r[falls[0] + 1]
    return float(next((kink for kink in kinks_of(punch) if before < kink <= behind), before))


def refusal(problem: Problem, end: float, unknown: str) -> NotConverged:
    """The error on a path whose end is not known, with the radius at which the punch bends down, if it does.

    Parameters
    ----------
    problem : Problem
    end : float
        Largest radius that is examined.
    unknown : str
        What is not known, in words.
    """
    punch = problem.punch
    fall = _first_fall(punch, end)
    if fall is None:
        return NotConverged(unknown, Failure.END)
    # A scaled punch is that of a physical problem.
    r = fall * punch.radius if isinstance(punch, ScaledPunch) else fall
    unit = "" if isinstance(punch, ScaledPunch) else f" {problem.unit_name('radius')}"
    bends = f"{unknown}: the punch bends down at r = {r:.4g}{unit}"
    if fall in kinks_of(punch):
        # On both sides of the kink, whose radius is rounded.
        sides = fall * (1.0 + np.array([-8.0, 8.0]) * np.finfo(float).eps)
        inside, beyond = sides * punch.slope(sides) / punch.height(sides)
        if abs(beyond - punch.growth) < _SAME_POWER:
            grown = math.ceil((inside - _SAME_POWER) * 100.0) / 100.0
            return NotConverged(
                f"{bends}, its last row: up to there it grows like r^{grown:g}, and beyond like r^{punch.growth:g}, "
                f"its growth (2 by default); set growth = {grown:g}",
                Failure.GROWTH,
            )
    return NotConverged(f"{bends}, as outside an asperity", Failure.END)


def displacement_of_compression(problem: Problem, end: float) -> float:
    """Displacement above which no state carries tension; -inf without asperities, where no bound is needed.

    Parameters
    ----------
    problem : Problem
    end : float
        Largest radius that is examined.

    Returns
    -------
    float
        Infinite if the bound is not positive at the largest displacement examined.
    """
    has_barrier = not has_one_well(problem.law)
    if _first_fall(problem.punch, end) is None and not has_barrier:
        return -math.inf
    law = ", whose law has a barrier," if has_barrier else ""
    if problem.graded is not None:
        raise refusal(problem, end, f"the end of the path of {problem}{law} is known for a power-law modulus only")
    if has_barrier and not isinstance(problem.force, Derjaguin):
        raise refusal(problem, end, f"the end of the path of {problem}{law} is known for vertical gaps only")
    bound = LeastLoad(problem, end)
    largest = _LARGEST * float(problem.punch.height(np.array([end]))[0])
    smallest, displacement = math.inf, largest
    while displacement > largest * _FIRST_RADIUS and bound(displacement) > 0.0:
        smallest, displacement = displacement, displacement / _RATIO
    return smallest


class LeastLoad:
    """Lower bound of the load of every equilibrium state, as a function of its displacement.

    Parameters
    ----------
    problem : Problem
    end : float
        Largest radius examined; the punch is taken for a power of the radius beyond.
    """

    def __init__(self, problem: Problem, end: float) -> None:
        self.problem = problem
        self.radii = _radii(end)
        self.heights = problem.punch.height(self.radii)
        # The largest non-decreasing function below f: its tension lifts the surface most at the center.
        self._rising = np.minimum.accumulate(self.heights[::-1])[::-1]
        self._peaks = problem.force.peak_gap(self.radii)

    def __call__(self, displacement: float) -> float:
        tension = self._tension(self.heights, displacement + self.deformation(displacement))
        outside = np.maximum(tension[:-1], tension[1:])
        compliant, mean, weights = self._flat_punches
        pressed = displacement + self.problem.law.singular_gap - mean
        return float(np.max(compliant * pressed - weights @ outside)) - self._tail(2.0) * 2.0

    def deformation(self, displacement: float) -> float:
        """Bound of the deformation by tension, W."""
        k = self.problem.k
        bound = 1.0
        while (lifted := self._lifted(displacement + bound)) > bound:
            bound = 2.0 * lifted
        for _ in range(_ITERATIONS):
            bound, previous = self._lifted(displacement + bound), bound
            if previous - bound < 1e-3 * (1.0 - k) * bound:
                break
        return bound

    def _lifted(self, approach: float) -> float:
        """Deformation at the center by the tension at the gaps f - approach."""
        k = self.problem.k
        tension = self._tension(self._rising, approach)[:-1]
        inside = float(tension @ np.diff(self.radii ** (1.0 - k)))
        return self.problem.compliance * (inside + (1.0 - k) * self._tail(1.0 - k))

    def _tension(self, heights: Array, approach: float) -> Array:
        if isinstance(self.problem.force, Derjaguin):
            return tension_beyond(self.problem.law, heights - approach)
        gap = np.maximum(heights - approach, self._peaks)
        return np.asarray(-self.problem.force.traction(self.radii, gap))

    def _tail(self, power: float) -> float:
        """Integral of t r^(power - 1) beyond the last radius."""
        C, m = self.problem.law.decay
        if C == 0.0:
            return 0.0
        T, F, force = self.radii[-1], self.heights[-1], self.problem.force
        if isinstance(force, WholePunch):
            tension = -float(force.traction(self.radii[-1:], self.heights[-1:])[0])
            return _TAIL_MARGIN * tension * T**power / (force.falls_as(T) - power)
        return float(C * _TAIL_MARGIN**m * F**-m * T**power / (m * self.problem.punch.growth - power))

    @cached_property
    def _flat_punches(self) -> tuple[Array, Array, Array]:
        """C_a, <f> and the weights (1 - phi) 2 r dr outside, for the radii a."""
        from scipy.special import betainc

        k, squares = self.problem.k, self.radii**2
        a = self.radii[_EVERY::_EVERY]
        C = 4.0 * math.cos(0.5 * math.pi * k) / (math.pi * self.problem.compliance * (1.0 - k * k))
        # <f> is exact where f is linear in r^2 between the radii.
        left = np.maximum(a[:, None] ** 2 - squares, 0.0) ** (0.5 * (3.0 + k)) / (0.5 * (3.0 + k))
        slopes = np.diff(self.heights) / np.diff(squares)
        mean = self.heights[0] + (-np.diff(left, axis=1) @ slopes) / a ** (1.0 + k)
        with np.errstate(divide="ignore"):
            ratio = np.minimum(a[:, None] ** 2 / squares[1:], 1.0)
        phi = betainc(0.5 * (1.0 + k), 0.5 * (1.0 - k), ratio)
        return C * a ** (1.0 + k), mean, (1.0 - phi) * np.diff(squares)
