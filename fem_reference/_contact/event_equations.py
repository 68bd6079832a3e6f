"""Equations of one event, whose unknowns are an equilibrium, its rate along the path, and the parameter.

The displacement under the traction is given: another module solves the elastic system.  Newton's method begins with the
state on another mesh.  Its tangent is that of the condensed system of this mesh, which decides how fast the steps fall
but not where they end.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Self

import numpy as np
from scipy import linalg

from fem_reference._contact.carried import carried, projected, projected_rate
from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import Control, EdgeRadius
from fem_reference._contact.cusp import displacement_rates
from fem_reference._contact.event_kinds import CUSP, JUMP_IN, JUMP_OUT, beginning_of, kind_of
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.newton import State
from fem_reference._contact.states import Point, point_at
from fem_reference._typing import Array

__all__ = ["EventEquations"]

#: Change of the parameter, in its largest steps, for the slope of a rate: an error of this size slows Newton only.
SLOPE_STEP = 1e-4


class EventEquations:
    """State of Newton's method at one event.

    Parameters
    ----------
    name : str
        Of the event, as a property of `fem_reference._contact.events.PathEvents`.
    point : Point
        The event on the condensed path: its controls and tangents are those of the equations.
    other : Contact
        The problem with elements of another degree or size: Newton's method begins with its state at the same value of
        the parameter.

    Attributes
    ----------
    y, rate : ndarray, shape (m + 2,)
        Equilibrium, and its derivative with respect to the parameter.
    parameter : float
        Of the second control.
    contact : Contact
        The condensed contact.  At the cusp its modulus is the unknown, and the parameter stays what it is: the rate is
        stationary in it.
    """

    def __init__(self, name: str, point: Point, other: Contact) -> None:
        self.name, self.point, self.parameter = name, point, point.parameter
        self.contact = point.branch.contact
        start = _state_on(other, point)
        # The mesh of a solid that does not scale has one size.
        c = (start if self.contact.compliance.scales else point).state.size
        self.y = projected(start, self.contact, c)
        # The rate is an unknown at a fold only; elsewhere it is a part of the tangent.
        self.rate = projected_rate(start, self.contact, c) if self.is_fold else point.state.rate.copy()
        rates = displacement_rates(point) if name == CUSP else None
        self._change = None if rates is None else rates.change
        # A pinned point keeps its parameter.
        self._slope = (math.inf if point.pinned else self._excess_slope()) if rates is None else rates.modulus

    @property
    def is_fold(self) -> bool:
        """Whether a rate vanishes at the event."""
        return not self.point.pinned and kind_of(self.name) in ("pull_off", JUMP_IN, JUMP_OUT, CUSP)

    @property
    def controls(self) -> tuple[float, float, float]:
        """Approach, size, and factor of the compliance at this size."""
        delta, c = float(self.y[-2]), float(self.y[-1])
        return delta, c, self.contact.compliance.factor(c)

    def copy(self) -> Self:
        """Return equations whose unknowns can be changed without changing these."""
        duplicate = object.__new__(type(self))
        duplicate.__dict__.update(self.__dict__)
        return duplicate

    def step(self, w: Array, w_rate: Array | None, events: Mapping[str, EventEquations]) -> float:
        """Take a Newton step.

        Parameters
        ----------
        w : ndarray, shape (m,)
            Surface displacement under the traction of `y`, per unit factor of the compliance.
        w_rate : ndarray, shape (m,), optional
            The same under the rate of the traction; the rate stays what it is without it.
        events : mapping of str to EventEquations
            Holds the beginning of the jump that ends here; its step comes first.

        Returns
        -------
        float
            Largest change, and largest defect of the surface displacement before it, both relative to the displacement
            (the change of the size to itself).  The defect is the larger: where the law is steep, a small change of the
            gap is a large one of the traction.
        """
        y, rate, fixed, family = self.y, self.rate, *self._controls()
        defect = np.append(y[:-2], [fixed.value(self.contact, y), family.value(self.contact, y)])
        defect_rate = None
        if w_rate is not None:
            parameter_rate = family.parameter_rate(self.contact, y) if isinstance(family, EdgeRadius) else 1.0
            rows = fixed.gradient(self.contact, y) @ rate, family.gradient(self.contact, y) @ rate - parameter_rate
            defect_rate = np.append(rate[:-2], rows)
        self._correct(defect, defect_rate, w, w_rate, events)
        change = np.abs(self.y - y)
        left = float(np.abs(y[:-2] - self.contact.compliance.factor(float(y[-1])) * w).max())
        scale = self.contact.law.z0 + float(np.abs(self.y[:-2]).max())
        # NumPy's maximum, unlike Python's, of NaN is NaN.
        return float(np.max([left / scale, change[:-1].max() / scale, change[-1] / y[-1]]))

    def shift(
        self,
        w: Array,
        w_rate: Array | None,
        events: Mapping[str, EventEquations],
        unshifted: Mapping[str, EventEquations],
    ) -> None:
        """Move to where the displacements `w` and `w_rate`, added to those of the last step, would have led.

        The last step has moved the state along the path, but not its rate: what this leaves of the condition of the
        event is no error.
        """
        zero = np.zeros_like(self.y)
        excess = unshifted[self.name]._excess(unshifted)
        self._correct(zero, None if w_rate is None else zero, w, w_rate, events, excess)

    def point_of(self, system: FullSystem, iterations: int, residual: float) -> Point:
        """Return the event as a point of the path."""
        y, delta, c = self.y, float(self.y[-2]), float(self.y[-1])
        load = system.load(system.on_surface(y[:-2]), delta, c) + self.contact.load_beyond(y)
        load_rate = float(self.contact.load_gradient(y) @ self.rate)
        branch = replace(self.point.branch, contact=self.contact)
        return Point(branch, self.parameter, State(y, load, load_rate, self.rate, iterations, residual))

    def _controls(self) -> tuple[Control, Control]:
        return self.point.branch.fixed, self.point.branch.family(self.parameter)

    def _correct(
        self,
        defect: Array,
        defect_rate: Array | None,
        w: Array,
        w_rate: Array | None,
        events: Mapping[str, EventEquations],
        excess: float = 0.0,
    ) -> None:
        """Solve the equations linearised at `y`, less the displacements from both defects, then move the parameter."""
        contact, c = self.contact, float(self.y[-1])
        factor, factor_slope = contact.compliance.factor(c), contact.compliance.factor_slope(c)
        K = self._tangent()
        self.y = self.y - _solved(K, defect - _padded(factor * w))
        if w_rate is not None and defect_rate is not None:
            under = factor * w_rate + factor_slope * self.rate[-1] * w
            moved = self._tangent()
            defect_rate = defect_rate - _padded(under) + (moved - K) @ self.rate
            self.rate = self.rate - _solved(moved, defect_rate)
        self._move((excess - self._excess(events)) / self._slope)

    def _move(self, move: float) -> None:
        """Move the parameter, and the state along the path.

        The path is curved, and where the traction is steep much so: what its tangent leaves of the equilibrium is
        corrected by the condensed system, to which it is as small as to the whole one.
        """
        if move == 0.0:
            return
        before = self.contact.residual(self.y)
        if self._change is None:
            self.parameter += move
            self.y = self.y + move * self.rate
        else:
            self.contact = replace(self.contact, compliance=self.contact.compliance.stiffened(math.exp(move)))
            self.y = self.y + move * self._change
        controls = [control.value(self.contact, self.y) for control in self._controls()]
        self.y = self.y - _solved(self._tangent(), np.append(self.contact.residual(self.y) - before, controls))

    def _tangent(self) -> Array:
        """Derivative of the condensed equations and the controls with respect to y, shape (m + 2, m + 2)."""
        fixed, family = self._controls()
        rows = fixed.gradient(self.contact, self.y), family.gradient(self.contact, self.y)
        return np.vstack([self.contact.tangent(self.y), *rows])

    def _excess(self, events: Mapping[str, EventEquations]) -> float:
        """What vanishes at the event."""
        if self.point.pinned:
            return 0.0
        beginning = beginning_of(self.name)
        if beginning is not None:
            return float(self.y[-2] - events[beginning].y[-2])
        if self.name == "zero_load":
            return self.contact.load(self.y)
        if self.name == "pull_off":
            return float(self.contact.load_gradient(self.y) @ self.rate)
        return float(self.rate[-2])

    def _excess_slope(self) -> float:
        """Return the derivative of `_excess` with respect to the parameter, from the condensed path."""
        state = self.point.state
        if beginning_of(self.name) is not None:
            return state.displacement_rate
        if self.name == "zero_load":
            return state.load_rate
        parameter = self.point.parameter
        step = SLOPE_STEP * self.point.branch.largest_step(parameter)
        ahead = point_at(self.point, parameter + step).state
        if self.name == "pull_off":
            return (ahead.load_rate - state.load_rate) / step
        return (ahead.displacement_rate - state.displacement_rate) / step


def _state_on(contact: Contact, point: Point) -> Point:
    """State of another discretisation, at the parameter and the modulus of a point."""
    compliance = contact.compliance.stiffened(point.branch.contact.compliance.stiffness)
    branch, parameter, y = carried(point, replace(contact, compliance=compliance))
    return branch.solve(parameter, y)


def _solved(matrix: Array, b: Array) -> Array:
    """Solve a linear system; a step too large to be sensible is the caller's to refuse."""
    return np.asarray(linalg.lu_solve(linalg.lu_factor(matrix, check_finite=False), b, check_finite=False))


def _padded(w: Array) -> Array:
    """Append zeros for the two controls."""
    return np.append(w, [0.0, 0.0])
