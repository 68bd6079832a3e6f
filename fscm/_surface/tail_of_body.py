"""Contributions of the radii beyond the mesh under the potential of the whole punch (`fscm._whole_punch`).

The punch is seen as a whole there, so that the traction is no power of its height.  Integrals of it on the undeformed
surface are by quadrature to a radius from which on the traction is a power of the radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fscm._surface.response import response_of
from fscm._surface.response.distant_ring import DistantRing
from fscm._typing import Array
from fscm._whole_punch import WholePunch
from fscm.problem import Problem

__all__ = ["TailOfBody"]

#: The radius grows by this factor on a piece of the quadrature, whose rule has so many nodes: the nearest singularity
#: of the traction is half a turn away in its logarithm, and the error of a piece 1e-27.
_RATIO = 4.0
_GAUSS = np.polynomial.legendre.leggauss(20)
#: The traction is a power beyond this many radii of the mesh, where it is one of the punch.
_MESH_RADII = 16.0
#: Radius, in that from which on a cone has nearly its power, at which it has it to all digits.
_FARTHEST = 1e8
#: Quadrature over distant rings of a solid that is no power law, as in `tail`: t^-a falls by at most exp(-_FALL)
#: on a piece, and by exp(-_LEFT) on all of them; farthest ring whose response is computed in two ways.
_FALL, _LEFT, _BEYOND_REACH = 8.0, 42.0, 100.0


@dataclass(frozen=True)
class TailOfBody:
    """Integrals of the traction beyond the radius T on the undeformed surface at the displacement delta.

    Parameters
    ----------
    problem : Problem
        Dimensionless, with a `WholePunch`.
    T, displacement : float
    cuts : int
        Each piece of the quadrature is divided by it.
    """

    problem: Problem
    T: float
    displacement: float
    cuts: int = 1

    @property
    def force(self) -> WholePunch:
        """The interaction."""
        force = self.problem.force
        assert isinstance(force, WholePunch)  # the caller asked
        return force

    @cached_property
    def _rings(self) -> DistantRing:
        rings = None if self.problem.graded is None else response_of(self.problem.graded).distant
        assert rings is not None  # one solid that is no power law
        return rings

    @cached_property
    def exponent(self) -> float:
        """q of p ~ t^-q far away."""
        return self.force.falls_as(self.T)

    def least_exponent(self) -> float:
        """Exponent of the slowest fall of the traction beyond T: nearer than the ball is wide, that of a paraboloid."""
        return min(self.exponent, 2.0 * self.force.exponents[1])

    @cached_property
    def far(self) -> float:
        """Radius from which on the traction is a power."""
        far = max(_MESH_RADII * self.T, self.force.far_radius)
        if self.problem.graded is not None:
            reach = max(self.T, _BEYOND_REACH * self._rings.reach)
            far = max(far, min(reach, self.T * math.exp(_LEFT / (self.exponent - 1.0))))
        return far

    @cached_property
    def _rule(self) -> tuple[Array, Array]:
        """Radii from T to `far`, and weights of their logarithm."""
        x, w = _GAUSS
        length = math.log(self.far / self.T)
        longest = math.log(_RATIO) if self.problem.graded is None else min(math.log(_RATIO), _FALL / self.exponent)
        pieces = self.cuts * math.ceil(length / longest)
        half = 0.5 * length / pieces
        t = self.T * np.exp(half * (2.0 * np.arange(pieces)[:, None] + 1.0 + x).ravel())
        return t, half * np.tile(w, pieces)

    def _gap(self, t: Array) -> Array:
        return self.problem.punch.height(t) - self.displacement

    def traction(self, t: Array) -> Array:
        """p at radii beyond the mesh."""
        return self.force.traction(t, self._gap(t))

    @cached_property
    def _tractions(self) -> tuple[Array, Array]:
        """Traction and minus its derivative by delta: at the radii of the rule, T and `far`."""
        t = np.concatenate([self._rule[0], [self.T, self.far]])
        return self.traction(t), -self.force.slope(t, self._gap(t))

    def _integrals(self, response: Array, power: float) -> tuple[float, float, float]:
        """Integral of p times a response over t, and its derivatives by log T and by delta.

        Parameters
        ----------
        response : ndarray
            At the radii of the rule, T and `far`, from which on it is a power of t.
        power : float
            Its exponent there.
        """
        t, weights = self._rule
        values = []
        exponents = self.exponent, self.exponent + self.force.slope_falls_by
        for p, q in zip(self._tractions, exponents, strict=True):
            beyond = p[-1] * response[-1] * self.far / (q - 1.0 - power)
            values.append(float((weights * t * response[:-2]) @ p[:-2] + beyond))
        return values[0], -float(self._tractions[0][-2] * response[-2]) * self.T, values[1]

    @cached_property
    def load(self) -> tuple[float, float, float]:
        """Load, and its derivatives by log T and by delta."""
        t = np.concatenate([self._rule[0], [self.T, self.far]])
        return self._integrals(2.0 * t, 1.0)

    @cached_property
    def lift(self) -> tuple[float, float, float]:
        """Displacement of the center, and its derivatives by log T and by delta."""
        t, problem = np.concatenate([self._rule[0], [self.T, self.far]]), self.problem
        if problem.graded is None:
            return self._integrals(problem.compliance * (1.0 - problem.k) * t**-problem.k, -problem.k)
        rings = self._rings
        power = rings.at_reach[1] if self.far >= rings.reach else 0.0
        return self._integrals(problem.compliance * rings.by_images(t), power)

    @property
    def energy(self) -> float:
        """int e 2 t dt, its finite part if it diverges."""
        t, weights = self._rule
        t_far = np.append(t, self.far)
        e = self.force.energy(t_far, self._gap(t_far))
        inside = float((weights * 2.0 * t * t) @ e[:-1])
        excess = self.exponent - 3.0
        if excess:
            return inside + 2.0 * float(e[-1]) * self.far**2 / excess
        # On a cone e = A/t^2 and a term in delta/t^3: without the part of all states, that of A.
        farthest = np.array([_FARTHEST * self.force.far_radius])
        A = float((self.force.energy(farthest, self.problem.punch.height(farthest)) * farthest**2)[0])
        return inside + 2.0 * (float(e[-1]) * self.far**2 - A) - 2.0 * A * math.log(self.far)

    def errors(self, energy: bool = True) -> tuple[Array, Array]:
        """Errors of load, displacement and energy: those of the quadrature, and bounds of what is beyond `far`."""
        finer = TailOfBody(self.problem, self.T, self.displacement, 2 * self.cuts)
        p, farther = self._tractions[0][-1], float(self.traction(np.array([_RATIO * self.far]))[0])
        relative = abs(farther / p * _RATIO**self.exponent - 1.0)
        load = 2.0 * p * self.far**2 / (self.exponent - 2.0)
        of_energy = 2.0 * p * self.far**2 * (abs(self.displacement) + self.force.size_of_punch + self.far)
        lifted, of_lift = (finer.lift[0], 0.0) if self.problem.graded is None else self._lifted_by_waves(finer)
        beyond = self.problem.compliance * abs(p) * self.far ** (1.0 - self.problem.k)
        change = self.energy - finer.energy if energy else 0.0
        computed = self.load[0] - finer.load[0], self.lift[0] - lifted, change
        remainder = relative * abs(load), relative * beyond + of_lift, relative * abs(of_energy) if energy else 0.0
        return np.array(computed), np.array(remainder)

    def _lifted_by_waves(self, finer: TailOfBody) -> tuple[float, float]:
        """Displacement on a solid that is no power law without images, and a bound of what they leave far away."""
        rings, (t, weights) = self._rings, finer._rule
        p = finer._tractions[0]
        compliance = self.problem.compliance
        farther = np.array([self.far, _RATIO * self.far])
        images, waves = rings.by_images(farther), rings.by_waves(farther)
        power = rings.at_reach[1] if self.far >= rings.reach else 0.0
        beyond = compliance * float(p[-1] * images[0]) * self.far / (self.exponent - 1.0 - power)
        lifted = compliance * float((weights * t * rings.by_waves(t)) @ p[:-2]) + beyond
        return lifted, abs(beyond) * float(np.max(np.abs(images / waves - 1.0)))
