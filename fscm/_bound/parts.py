"""Error bounds of the values at events, in parts.

A value at a prescribed load, displacement or gap has the error at a fixed value of that control.  A value at its own
extreme has, to first order, the error at a fixed continuation parameter.  Any other value at an extreme also changes
with its location, by (rate of the error of the extremal functional) / (curvature of that functional).
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fscm._bound.defect import Defect, Errors, finer
from fscm._path.arc_length import parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._path.events import MISSED_EXTREME
from fscm._surface.discretisation import Discretisation
from fscm._surface.state import Rates, State
from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.punch import kinks_of
from fscm.solution import Parts

__all__ = ["EventErrors", "bounds", "root_shift"]

#: Share of the error that the finer mesh may not see: measured at most 0.02 over 60 problems (n = 0.8 to 10, k = 0 to
#: 0.9, mu = 0.005 to 20), against meshes of order 18.
_LEFT = 0.5
#: The error of the tail, and that of a located extreme, are computed to first order: their squares remain.
_SECOND_ORDER = 1.1
#: Steps of the continuation parameter, relative to its unit: for the rate of an error, and for the curvature at an
#: extreme, which varies fast near a critical Tabor number.  A step of 1e-2 gave a rate that was 7 times too small at
#: contact initiation (n = 3.75, k = 0.82, mu = 1.9); 1e-3 and 1e-4 agree.
_ERROR_STEP, _CURVATURE_STEP = 1e-3, 1e-4
#: The error on a mesh waves along the path where nodes pass by a bend of the punch or of the law: measured periods from
#: 2e-3 on, and a rate that was 3 times too small (a law through 77 points).  The step is shortened by this factor while
#: the error bends over it by more than this share of its change, at most so often: each time gains a digit.  A share of
#: 0.06 had the wrong sign by accident (an unstated jump of the curvature of a punch, at 1e-10).
_SHORTER, _BENT, _SHORTENINGS = 0.1, 0.02, 2
#: Rate of the error of the response per unit of the continuation parameter, in units of the bound of that error.  The
#: error at the scale c is c int eps(xi) K(xi c) d(xi), and its derivative by log c the same integral of -xi eps'(xi):
#: measured worst 7.7 and 11.3 times the bound of eps on two processors, over a quarter of a decade, on a smooth coating
#: (test_graded_kernel.py).
#: The pressure and the adjoint, which weigh it, change by about their sizes each.
_KERNEL_RATE = 14.0
#: Error that the finer mesh leaves of the difference of two states on one panel, in units of that of one of them times
#: the relative change of the pressure: a value of a power law of the gap, and its derivatives, change by a few times
#: it.
_CHANGE = 10.0
_FUNCTIONALS = ("load", "displacement", "central_gap", "energy")


def root_shift(error: float, slope: float, curvature: float) -> float:
    """Bound on how far the root of a function moves when the function is wrong by at most `error`.

    Parameters
    ----------
    error : float
    slope, curvature : float
        First and second derivative of the function at the root.

    Examples
    --------
    >>> root_shift(1e-6, 2.0, 0.0)
    5e-07
    >>> round(root_shift(1e-6, 0.0, 2.0), 12)       # at an extreme, the square root of the error
    0.001
    """
    slope, curvature = abs(slope), abs(curvature)
    if 2.0 * curvature * error <= slope * slope:
        return 2.0 * error / (slope + math.sqrt(slope * slope - 2.0 * curvature * error)) if error else 0.0
    # The error may move the function to its other root, or leave it without one.
    return (slope + math.sqrt(slope * slope + 2.0 * curvature * error)) / curvature


def bounds(errors: Errors, amplified: float = 1.0) -> Parts:
    """Sums of the sizes of the contributions by cause, all multiplied by `amplified`."""
    mesh, tail, domain = (amplified * float(abs(signed).sum()) for signed in (errors.mesh, errors.tail, errors.domain))
    unsigned = {"rounding": amplified * errors.rounding, "kernel": amplified * errors.kernel}
    unsigned["law"] = amplified * float(abs(errors.law).sum())
    return Parts(mesh / (1.0 - _LEFT), _SECOND_ORDER * tail, domain, **unsigned)


class EventErrors:
    """Errors of the functionals of a state at an event, from its defect and those of its neighbours on the path.

    Parameters
    ----------
    state : State
    """

    def __init__(self, state: State) -> None:
        self.state = state
        self.parameter = "central_gap" if state.parameter == "gap" else state.parameter
        self._unit = 1.0
        self._beside: tuple[float, tuple[Defect, Defect]] | None = None
        if self.parameter == "central_gap":
            self._unit = state.central_gap - state.disc.problem.law.singular_gap
        elif self.parameter != "log_scale":
            self._unit += abs(parameter_of(state))

    @cached_property
    def _fine(self) -> Discretisation:
        return finer(self.state.disc)

    @cached_property
    def _defect(self) -> Defect:
        return Defect(self.state, self._fine)

    def _defects_beside(self, step: float) -> tuple[Defect, Defect]:
        """Defects of the neighbouring states; those of one step at a time, because each holds square matrices."""
        if self._beside is None or self._beside[0] != step:
            self._beside = None  # frees its memory first
            self._beside = step, self._new_defects_beside(step)
        return self._beside[1]

    def _new_defects_beside(self, step: float) -> tuple[Defect, Defect]:
        states = [self._at(side * step)[0] for side in (-1.0, 1.0)]
        # The mesh of a punch with kinks moves with them.
        fine_before, fine_after = (
            self._fine if state.disc is self.state.disc else finer(state.disc) for state in states
        )
        return Defect(states[0], fine_before), Defect(states[1], fine_after)

    @cached_property
    def rates(self) -> Rates:
        """Derivatives of the state by the continuation parameter."""
        return rates_of(self.state)

    def _at(self, step: float) -> tuple[State, Rates]:
        state = moved(self.state, self.rates, parameter_of(self.state) + step * self._unit)
        return state, rates_of(state)

    @cached_property
    def _neighbours(self) -> tuple[tuple[dict[str, float], Rates], tuple[dict[str, float], Rates]]:
        """Values, under kinks, and rates of the functionals at the neighbouring states, whose matrices are not kept."""
        names = _FUNCTIONALS if self._is_kinked else ()
        neighbours = [self._at(step) for step in (-_CURVATURE_STEP, _CURVATURE_STEP)]
        before, after = (({name: getattr(state, name) for name in names}, rates) for state, rates in neighbours)
        return before, after

    @property
    def _is_kinked(self) -> bool:
        """Whether the mesh moves with kinks of the punch."""
        return bool(kinks_of(self.state.disc.problem.punch))

    def controlled(self, functional: str, control: str, value: float | None = None) -> Errors:
        """Errors at a fixed control or continuation parameter; `value` is the prescribed one, if any."""
        missed = 0.0 if value is None else getattr(self.state, control) - value
        return self._defect.errors(functional, control, missed)

    def derivatives(self, functional: str) -> tuple[float, float, float]:
        """First three derivatives of a functional by the continuation parameter."""
        before, after = (getattr(rates, functional) for _, rates in self._neighbours)
        rate, step = getattr(self.rates, functional), _CURVATURE_STEP * self._unit
        return rate, (after - before) / (2.0 * step), (after - 2.0 * rate + before) / step**2

    def rate(self, functional: str) -> Errors:
        """Errors of the derivative of a functional by the continuation parameter."""
        change, step = self._changes(functional)
        rounding = self._defect.rate_rounding(functional, self.parameter)
        mesh = change.mesh / step
        if self._is_kinked:
            mesh = np.append(mesh, self._moving(functional))
        # The error of the response varies over a radius as the response itself: per unit of the parameter, by its size.
        kernel = _KERNEL_RATE * change.kernel / (2.0 * self._unit)
        return Errors(mesh, change.tail / step, change.domain / step, rounding, kernel, change.law / step)

    def _changes(self, functional: str) -> tuple[Errors, float]:
        """Change of the errors of a functional over a step of the parameter, and the length of the step."""
        at, step = self._defect.errors(functional, self.parameter), _ERROR_STEP
        for shortenings in range(_SHORTENINGS + 1):
            before, after = (defect.errors(functional, self.parameter) for defect in self._defects_beside(step))
            change = after.plus(before, -1.0)
            if shortenings == _SHORTENINGS or not before.mesh.shape == at.mesh.shape == after.mesh.shape:
                break
            bend = float(np.abs(before.mesh - 2.0 * at.mesh + after.mesh).sum())
            if bend <= max(_BENT * float(np.abs(change.mesh).sum()), at.rounding):
                break
            step *= _SHORTER
        return change, 2.0 * step * self._unit

    def _moving(self, functional: str) -> float:
        """Mean rate of a functional on meshes that move with the kinks minus that on fixed ones (Simpson)."""
        (before, rate_before), (after, rate_after) = self._neighbours
        change = after[functional] - before[functional]
        rates = [getattr(rates, functional) for rates in (rate_before, self.rates, rate_after)]
        return float(change / (2.0 * _CURVATURE_STEP * self._unit) - (rates[0] + 4.0 * rates[1] + rates[2]) / 6.0)

    def on_path(self, functional: str) -> Parts:
        """Bounds on the error of a functional at a value of the continuation parameter."""
        return bounds(self.controlled(functional, self.parameter))

    def at_extreme(self, functional: str, extremal: str) -> Parts:
        """Bounds on the error of a functional at the extreme of another, or at its own."""
        if functional == extremal:
            missed = MISSED_EXTREME * (1.0 + abs(getattr(self.state, functional)))
            return self.on_path(functional).plus(Parts(rounding=missed))
        _, curvature, third = self.derivatives(extremal)
        if curvature == 0.0:
            raise NotConverged(f"the {extremal} has no curvature at its extreme", Failure.EVENT)
        rate = self.rate(extremal)
        size = bounds(rate).total
        factor = root_shift(size, curvature, third) * abs(curvature) / size if size else 1.0
        at_parameter = self.controlled(functional, self.parameter)
        # The remaining rate at the located extreme changes the functional, too.
        left = abs(getattr(self.rates, extremal) * getattr(self.rates, functional) / curvature)
        return bounds(at_parameter.plus(rate, -getattr(self.rates, functional) / curvature), factor).plus(
            Parts(rounding=_SECOND_ORDER * left)
        )

    def prescribed(self, functional: str, control: str, value: float) -> Parts:
        """Bounds on the error of a functional at a prescribed value of a control, also next to its extreme."""
        free = self.on_path(control)
        slope, curvature, _ = self.derivatives(control)
        if 4.0 * abs(curvature) * free.total <= slope * slope:
            factor = root_shift(free.total, slope, curvature) * abs(slope) / free.total if free.total else 1.0
            return bounds(self.controlled(functional, control, value), factor)
        # The error of the control reaches its extreme: the square root of it moves the state.
        shift = root_shift(free.total, slope, curvature)
        functional_rate, functional_curvature, _ = self.derivatives(functional)
        effect = (abs(functional_rate) * shift + 0.5 * abs(functional_curvature) * shift**2) / free.total
        at_parameter = self.on_path(functional)
        return at_parameter.plus(Parts(*(effect * bound for bound in free.values())))

    def at_fold(self) -> tuple[Errors, Errors]:
        """Errors of energy and displacement at a fold of the displacement, where both are extreme: dE = P d(delta)."""
        return self.controlled("energy", self.parameter), self.controlled("displacement", self.parameter)


def energy_of_jump(energy: Errors, displacement: Errors, fold: State, landing: State) -> Parts:
    """Bounds on the error of the energy lost in a jump from a fold.

    The errors of both states on a panel that their meshes share cancel as far as their pressures agree, and so does
    the part of them that the finer mesh does not see.

    Parameters
    ----------
    energy, displacement : Errors
        Of the fold (`EventErrors.at_fold`).
    fold : State
    landing : State
        At the displacement of the fold: an error of that displacement changes its energy by P times as much.
    """
    left = energy.plus(displacement, -landing.load)
    right = EventErrors(landing).controlled("energy", "displacement")
    of_fold, of_landing, change = _common_panels(fold, landing)
    fold_errors, landing_errors = left.mesh[of_fold], right.mesh[of_landing]
    unseen = _LEFT * np.minimum(1.0, _CHANGE * change) * (abs(fold_errors) + abs(landing_errors))
    mesh = np.concatenate(
        [np.delete(left.mesh, of_fold), np.delete(right.mesh, of_landing), fold_errors - landing_errors, unseen]
    )
    return bounds(replace(left.beside(right), mesh=mesh))


def _common_panels(a: State, b: State) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Panels that the meshes of two states share, as indices in both, and the relative change of the pressure there."""
    ends = [state.scale * state.disc.mesh.breaks for state in (a, b)]
    panels = [{(start, stop): i for i, (start, stop) in enumerate(pairwise(radii))} for radii in ends]
    shared = sorted(panels[0].keys() & panels[1].keys())
    indices = [np.array([of_state[panel] for panel in shared], np.intp) for of_state in panels]
    pressure_a, pressure_b = (
        state.pressure.reshape(-1, state.disc.mesh.order)[index] for state, index in zip((a, b), indices, strict=True)
    )
    change = np.max(abs(pressure_a - pressure_b), axis=1) / np.maximum(
        np.max(abs(pressure_a), axis=1), np.finfo(float).tiny
    )
    return indices[0], indices[1], change
