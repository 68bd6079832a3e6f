"""Contributions of the radii beyond the mesh to load, displacement and energy.

Beyond the last node, at the radius T, the height f is so large that p = -C f^-m (1 - m e/f), with
e = w - delta - singular gap.  There f grows as F (t/T)^g, and every integral on a power-law solid is one of a power.
On other bodies a ring at t moves the contact by G(0, t) (`response.response`), which varies with t as far as the
modulus varies with depth: there the displacement is by quadrature over t, until G is a power of t again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fscm._surface.kernel import kernel_of
from fscm._surface.response import response_of
from fscm._surface.tail_of_body import TailOfBody
from fscm._typing import Array
from fscm.interaction import Derjaguin
from fscm.problem import Problem

__all__ = ["Tail", "deformation_beyond", "tail_energy", "tail_errors", "tail_of", "tail_variation"]

#: Quadrature behind the mesh: pieces on which the radius grows by _FARTHER (less for steep punches), nodes of each.
_FARTHER, _PIECES = 4.0, 3
_GAUSS = np.polynomial.legendre.leggauss(20)
#: A steeper punch overflows at _FARTHER times the radius; its tail is negligible.
_STEEPEST = 150.0
#: Rounding of a number of pieces.
_SAME = 1e-9
#: Approximate height above which the energy takes the punch for a power of the radius; a rounded cone is one to 1e-12.
_FARTHEST = 1e12
#: Height above which the tail is neglected: the tension there is below 1e-60 for m > 1.
_ZERO = 1e60
#: Quadrature over distant rings: t^-a falls by at most exp(-_FALL) on a piece, and by exp(-_LEFT) on all of them.
_FALL, _LEFT = 8.0, 42.0
#: Factor beyond the reach of the distant rings up to which their response is computed in the other way.
_BEYOND_REACH = 100.0
#: Radii, in T, at which the variation of the displacement over the mesh is computed, and factors from T of the rings.
_VARIATION = np.sort(np.concatenate([0.5 ** np.arange(1, 14), 1.0 - 0.5 ** np.arange(2, 21)]))
_RINGS = 4.0 ** np.arange(8)


#: Displacements below are zero.
_TINY = 1e-300


@dataclass(frozen=True)
class Tail:
    """Load and displacement from radii beyond the mesh, and their exact derivatives.

    Attributes
    ----------
    load, load_rate, load_slope : float
        Part of P, dimensionless (unit of Eq. 31); its derivatives by log c and by delta.
    displacement, displacement_rate, displacement_slope : float
        Part of w, in z0, the same at every radius of the mesh; its derivatives by log c and by delta.
    """

    load: float
    displacement: float
    load_rate: float
    displacement_rate: float
    load_slope: float
    displacement_slope: float


def tail_of(problem: Problem, T: float, displacement: float) -> Tail:
    """Tail beyond the radius T, at the displacement delta.

    Parameters
    ----------
    problem : Problem
    T : float
        End of the mesh, in (Q z0)^(1/n).
    displacement : float
        delta, in z0; w is neglected.
    """
    if _is_whole(problem):
        body = TailOfBody(problem, T, displacement)
        return Tail(body.load[0], body.lift[0], body.load[1], body.lift[1], body.load[2], body.lift[2])
    C, m = problem.law.decay
    F = _height(problem, T)
    if C == 0.0 or F > _ZERO:
        return Tail(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    g, k = problem.punch.growth, problem.k
    e = (-displacement - problem.law.singular_gap) / F
    strength = C * F**-m

    def tail(factor: float, leading: float, following: float, at_start: float) -> tuple[float, float, float]:
        """A part, and its derivatives by log T and by delta, from integrals of t^(-m g) and t^(-(m+1) g) over t/T."""
        rate = -factor * at_start * (1.0 - m * e)
        # e falls like 1/F, hence like T^-g.
        return factor * (leading - m * e * following), rate, factor * m * following / F

    load = tail(-2.0 * strength * T**2, 1.0 / (m * g - 2.0), 1.0 / ((m + 1.0) * g - 2.0), 1.0)
    if problem.graded is None:
        w_factor = -problem.compliance * (1.0 - k) * strength * T ** (1.0 - k)
        w = tail(w_factor, 1.0 / (m * g - 1.0 + k), 1.0 / ((m + 1.0) * g - 1.0 + k), 1.0)
    else:
        w = tail(-problem.compliance * (1.0 - k) * strength * T, *_ring_integrals(problem, T))
    return Tail(load[0], w[0], load[1], w[1], load[2], w[2])


def _is_whole(problem: Problem) -> bool:
    """Whether the potential of the whole punch reaches beyond the mesh."""
    return problem.interaction != "derjaguin" and problem.law.decay[0] != 0.0


def _ring_integrals(problem: Problem, T: float) -> tuple[float, float, float]:
    """Integrals of (t/T)^-(m g) G(0, t) and (t/T)^-((m+1) g) G(0, t) over t/T from 1 on, and G(0, T)."""
    response, g = response_of(problem.graded), problem.punch.growth
    powers = [exponent * g for exponent in (problem.law.decay[1], problem.law.decay[1] + 1.0)]
    totals, at_T = [0.0, 0.0], 0.0
    for k, weight in response.power_laws.items():
        totals = [total + weight * T**-k / (power - 1.0 + k) for total, power in zip(totals, powers, strict=True)]
        at_T += weight * T**-k
    if response.distant is None:
        return totals[0], totals[1], at_T
    rings = response.distant
    stop = min(max(T, rings.reach), T * math.exp(_LEFT / (powers[0] - 1.0)))
    t, weights = _pieces(T, stop, min(math.log(_FARTHER), _FALL / powers[0]))
    at_start, *risen, at_stop = rings.by_images(np.concatenate([[T], t, [stop]]))
    # From there on both are powers; far inside the reach nothing is left.
    exponent = rings.at_reach[1] if stop >= rings.reach else 0.0
    for i, power in enumerate(powers):
        beyond = at_stop * (stop / T) ** (1.0 - power) / (power - 1.0 - exponent)
        integral = float((weights * (t / T) ** -power) @ risen) / T + float(beyond)
        totals[i] += response.weight * integral
    return totals[0], totals[1], at_T + response.weight * float(at_start)


def tail_errors(problem: Problem, T: float, displacement: float, energy: bool = True) -> tuple[Array, Array]:
    """Errors of load, displacement and energy of the closed tail.

    The closed forms are compared with quadrature of the law, on the undeformed punch, over the next radii; beyond,
    the closed forms have a much smaller error.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    energy : bool
        Whether that of the energy is asked for; else it is zero under the potential of a punch, where it is costly.

    Returns
    -------
    computed : ndarray, shape (3,)
        Closed form minus quadrature; the energy, which is by quadrature, is compared with a finer one.
    remainder : ndarray, shape (3,)
        Bound on the error beyond the quadrature: the next term of the expansion, and the deviations of shape and law
        from powers.  That of the energy is the part that differs between states.

    Examples
    --------
    >>> computed, remainder = tail_errors(Problem(n=2, k=0, mu=1), 1414.0, 0.5)
    >>> bool(abs(computed[0]) < 1e-15), bool(remainder[0] < 1e-6 * abs(computed[0]))
    (True, True)
    """
    if _is_whole(problem):
        return TailOfBody(problem, T, displacement).errors(energy)
    C, m = problem.law.decay
    if C == 0.0 or _height(problem, T) > _ZERO:
        return np.zeros(3), np.zeros(3)
    g, k = problem.punch.growth, problem.k
    far = T * math.exp(_PIECES * _log_ratio(g))
    t, weights = _quadrature(T, far, g)
    pressure = problem.law.traction(problem.punch.height(t) - displacement)
    closed, beyond = tail_of(problem, T, displacement), tail_of(problem, far, displacement)
    computed = [closed.load - beyond.load - 2.0 * float((weights * t) @ pressure)]
    relative, _ = _deviations(problem, far, displacement)
    remainder = [abs(beyond.load) * relative]
    if problem.graded is None:
        lifted = problem.compliance * (1.0 - k) * float((weights * t**-k) @ pressure)
        computed.append(closed.displacement - beyond.displacement - lifted)
        remainder.append(abs(beyond.displacement) * relative)
    else:
        lifted, left = _lifted_by_waves(problem, T, displacement)
        computed.append(closed.displacement - lifted)
        remainder.append(left)
    of_energy = tail_energy(problem, T, displacement) - _tail_energy(problem, T, displacement, 2)

    farthest = _farthest(problem)
    relative, e = _deviations(problem, farthest, displacement)
    work = abs(tail_of(problem, farthest, displacement).load * (displacement + problem.law.singular_gap))
    return np.append(computed, of_energy), np.append(remainder, work * (relative + m * abs(e)))


def _lifted_by_waves(problem: Problem, T: float, displacement: float) -> tuple[float, float]:
    """Displacement of the tail on a solid that is no power law, without images, and a bound of the error far out.

    The tension of the law on the shape is integrated with the response that follows from the wave numbers.
    """
    response, g = response_of(problem.graded), problem.punch.growth
    power = problem.law.decay[1] * g
    reach = T if response.distant is None else response.distant.reach
    far = min(max(T, _BEYOND_REACH * reach), T * math.exp(_LEFT / (power - 1.0)))
    far = max(far, T * math.exp(_PIECES * _log_ratio(g)))
    t, weights = _pieces(T, far, min(_log_ratio(g), _FALL / power))
    pressure = problem.law.traction(problem.punch.height(t) - displacement)
    scale = problem.compliance * (1.0 - problem.k)
    lifted = scale * float((weights * response.at_center(t, by_waves=True)) @ pressure)
    beyond = tail_of(problem, far, displacement).displacement
    farther = np.array(_FARTHER * far)
    relative = abs(float(response.at_center(farther) / response.at_center(farther, by_waves=True)) - 1.0)
    return lifted + beyond, abs(beyond) * (relative + _deviations(problem, far, displacement)[0])


def tail_variation(problem: Problem, T: float, displacement: float, radii: Array) -> Array:
    """Displacement of the tail at radii of the mesh minus that at the center, or a bound of its size.

    On a power-law solid a ring at t > T displaces r by t^-k F(a, a; 1; r^2/t^2): at most by the factor of t = T.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    radii : ndarray
        Below T.
    """
    tail, k = tail_of(problem, T, displacement), problem.k
    if problem.graded is None or tail.load == 0.0:
        factor = kernel_of(k).response(radii, np.full_like(radii, T), T - radii) * T**k
        return np.asarray((factor - 1.0) * tail.displacement)
    rings = np.append(T * _RINGS, np.inf)
    t, at = rings[:-1, None], T * _VARIATION
    ring = response_of(problem.graded).ring
    t, at_all = np.broadcast_to(t, (t.size, at.size)), np.broadcast_to(at, (t.size, at.size))
    change = np.abs(ring(at_all, t, t - at) - ring(0.0 * at_all, t, t))
    # The change falls or rises with t between two rings; beyond the last one it falls.
    largest = np.maximum(change, np.append(change[1:], change[-1:], axis=0))
    power = problem.law.decay[1] * problem.punch.growth
    if not isinstance(problem.force, Derjaguin):
        power = TailOfBody(problem, T, displacement).least_exponent()
    at_end = float(problem.force.traction(np.array(T), np.array(_height(problem, T) - displacement)))
    strength = abs(at_end) * T / (power - 1.0)
    shares = -np.diff(np.append(_RINGS ** (1.0 - power), 0.0))
    bound = np.maximum.accumulate(problem.compliance * (1.0 - k) * strength * (shares @ largest))
    # Near the center it falls like r^2.
    inner = bound[0] * (radii / at[0]) ** 2
    return np.where(radii < at[0], inner, np.exp(np.interp(radii, at, np.log(np.maximum(bound, _TINY)))))


def deformation_beyond(problem: Problem, T: float, load: float) -> float:
    """Bound of the deformation beyond T by a load near the center, on a solid that is no power law."""
    t = T * _RINGS
    response = response_of(problem.graded).at_center(np.asarray(t, float))
    return float(np.max(np.abs(response) / t)) * problem.compliance * (1.0 - problem.k) * 0.5 * load


def _deviations(problem: Problem, far: float, displacement: float) -> tuple[float, float]:
    """Relative error of the closed forms beyond a radius, and the small parameter of the expansion there."""
    C, m = problem.law.decay
    g = problem.punch.growth
    F = _height(problem, far)
    e = (-displacement - problem.law.singular_gap) / F
    shape = abs(_height(problem, _FARTHER * far) / (F * _FARTHER**g) - 1.0) if g < _STEEPEST else 0.0
    exact = float(problem.law.traction(np.array([F - displacement]))[0])
    closed = -C * (F - displacement - problem.law.singular_gap) ** -m
    law = abs(exact / closed - 1.0) if closed else 0.0
    return 0.5 * m * (m + 1.0) * e * e + m * shape + law, e


def tail_energy(problem: Problem, T: float, displacement: float) -> float:
    """int e(H) 2 r dr beyond the radius T on the undeformed punch.

    The finite part if the integral diverges: the omitted constant is the same for all states of a problem, wherever
    their meshes end, because the power of the punch is taken at one radius for all of them.

    Parameters
    ----------
    problem, T, displacement
        As for `tail_of`.
    """
    if _is_whole(problem):
        return TailOfBody(problem, T, displacement).energy
    return _tail_energy(problem, T, displacement, 1)


def _tail_energy(problem: Problem, T: float, displacement: float, cuts: int) -> float:
    """The same, with each piece of the quadrature divided by `cuts`."""
    C, m = problem.law.decay
    if C == 0.0 or _height(problem, T) > _ZERO:
        return 0.0
    g, far = problem.punch.growth, _farthest(problem)
    power = _height(problem, far) / far**g
    shift = -displacement - problem.law.singular_gap

    def leading(f: Array) -> Array:
        return -C / (m - 1.0) * f ** (1.0 - m) * (1.0 - (m - 1.0) * shift / f)

    # The law on the shape minus the leading terms on a power of the radius, from T to where the shape is a power.
    t, weights = _quadrature(T, far, g, cuts)
    exact = problem.law.energy(problem.punch.height(t) - displacement)
    deviation = 2.0 * float((weights * t) @ (exact - leading(power * t**g)))
    excess = (m - 1.0) * g - 2.0
    closed = -math.log(T) if excess == 0.0 else 1.0 / excess
    F = power * T**g
    size = -2.0 * C / (m - 1.0) * power ** (1.0 - m) * T**-excess
    return deviation + size * (closed - (m - 1.0) * shift / F / (m * g - 2.0))


def _quadrature(start: float, stop: float, growth: float, cuts: int = 1) -> tuple[Array, Array]:
    """Radii and weights from one radius to another, also inwards, on pieces that suit the growth of the punch."""
    return _pieces(start, stop, _log_ratio(growth), cuts)


def _pieces(start: float, stop: float, log_ratio: float, cuts: int = 1) -> tuple[Array, Array]:
    """Radii and weights on pieces of the logarithm of the radius, of at most that length over `cuts`."""
    x, w = _GAUSS
    length = math.log(stop / start)
    pieces = cuts * max(1, math.ceil(abs(length) / log_ratio - _SAME))
    half = 0.5 * length / pieces
    t = start * np.exp(half * (2.0 * np.arange(pieces)[:, None] + 1.0 + x).ravel())
    return t, half * np.tile(w, pieces) * t


def _log_ratio(growth: float) -> float:
    """Logarithm of the ratio of the radii at the ends of a piece."""
    return math.log(_FARTHER) * min(1.0, 2.0 / growth)


def _farthest(problem: Problem) -> float:
    """Radius beyond which the energy takes the punch for a power of the radius."""
    return float(_FARTHEST ** (1.0 / problem.punch.growth))


def _height(problem: Problem, T: float) -> float:
    return float(problem.punch.height(np.array([T]))[0])
