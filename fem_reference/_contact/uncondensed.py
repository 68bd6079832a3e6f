"""Events of a path solved again without condensation: every displacement, by pyamg.

The condensed path finds an event, its size c and its parameter.  There conjugate gradients give all displacements under
the traction of the condensed surface, and the last Newton steps of the whole system, bordered by the control of the
path, are solved by GMRES.  Both use the elastic preconditioner, whose coarse level is pyamg's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import Control, Size
from fem_reference._contact.events import PathEvents
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.path import Point
from fem_reference._linear.linear_solver import solve_bordered
from fem_reference.errors import NotConverged

__all__ = ["UncondensedEvents", "last_newton_steps"]

START_TOLERANCE = 1e-7
"""Relative residual of the displacements from which Newton starts."""

LINEAR_TOLERANCE = 1e-4
"""Relative residual of a Newton step: the error falls by as much."""

NEWTON_TOLERANCE = 1e-10
"""Largest error left, in lengths of the law plus the largest displacement."""

NEWTON_STEPS = 5
"""Steps before giving up: the start is an equilibrium but for `START_TOLERANCE`."""


class UncondensedEvents:
    """Events of a condensed path, each solved again on the whole mesh.

    Parameters
    ----------
    path : PathEvents
        The condensed path.
    system : FullSystem
        The same problem on the same mesh.
    """

    def __init__(self, path: PathEvents, system: FullSystem) -> None:
        self._path, self._system = path, system
        self._found: dict[str, Point] = {}

    def _at(self, name: str, find: Callable[[], Point]) -> Point:
        if name not in self._found:
            self._found[name] = last_newton_steps(self._system, find())
        return self._found[name]

    @property
    def pull_off(self) -> Point:
        """The deepest minimum of the load along the path."""
        return self._at("pull_off", lambda: self._path.pull_off)

    @property
    def jump_in(self) -> Point:
        """The first fold on approach."""
        return self._at("jump_in", lambda: self._path.jump_in)

    @property
    def jump_out(self) -> Point:
        """The lowest fold."""
        return self._at("jump_out", lambda: self._path.jump_out)

    @property
    def zero_load(self) -> Point:
        """The point in contact where the load changes from tension to compression."""
        return self._at("zero_load", lambda: self._path.zero_load)

    @property
    def landing(self) -> Point:
        """The point in contact where the jump into contact ends."""
        return self._at("landing", lambda: self._path.landing)

    @property
    def separated(self) -> Point:
        """The point where the jump out of contact ends."""
        return self._at("separated", lambda: self._path.separated)

    @property
    def jump_in_loss(self) -> float:
        """Energy lost by the jump into contact."""
        return _energy(self.jump_in) - _energy(self.landing)

    @property
    def jump_out_loss(self) -> float:
        """Energy lost by the jump out of contact."""
        return _energy(self.jump_out) - _energy(self.separated)


def last_newton_steps(system: FullSystem, point: Point) -> Point:
    """Solve the whole system at the size and the parameter of a condensed equilibrium.

    Parameters
    ----------
    system : FullSystem
        The same problem on the same mesh.
    point : Point
        The condensed equilibrium.

    Returns
    -------
    Point
        With the surface displacement, delta and P of the whole system; the rates are those of `point`.

    Raises
    ------
    NotConverged
        If Newton or a linear solve misses its tolerance.
    """
    contact, y = point.branch.contact, point.state.y.copy()
    free, surface, scale = system.half_space.free, system.half_space.surface, system.preconditioner.scale
    c = float(y[-1])
    factor = contact.compliance.factor(c)
    control = _control(point)
    u = np.zeros(system.half_space.matrix.shape[0])
    u[surface] = y[:-2]
    u = system.under_pressure(system.law.traction(system.gap(u, y[-2], c)), factor, START_TOLERANCE)
    A = system.preconditioner.matrix
    for count in range(1, NEWTON_STEPS + 1):
        y[:-2] = u[surface]
        F, T, F_delta, _ = system.loads(u, y[-2], c)
        row = np.zeros(u.size)
        row[surface] = control.gradient(contact, y)[:-2]
        operator = system.bordered(A / factor - T, F_delta, scale * row[free])
        residual = np.append(A @ (u[free] / scale) / factor - F, control.value(contact, y))
        step, _ = solve_bordered(operator, residual, system.preconditioner, factor, LINEAR_TOLERANCE)
        u[free] -= scale * step[:-1]
        y[-2] -= step[-1]
        y[:-2] = u[surface]
        largest = max(float(np.abs(scale * step[:-1]).max()), abs(float(step[-1])))
        if largest * LINEAR_TOLERANCE <= NEWTON_TOLERANCE * (system.law.length + float(np.abs(u).max())):
            load = system.load(u, float(y[-2]), c) + contact.load_beyond(y)
            return replace(point, state=replace(point.state, y=y, load=load, iterations=count))
    raise NotConverged(
        f"the uncondensed Newton steps at delta = {point.state.displacement:.6g} did not converge; "
        "take a finer accuracy"
    )


def _control(point: Point) -> Control:
    """The control that closes the equations at a fixed size."""
    family = point.branch.family(point.parameter)
    return point.branch.fixed if isinstance(family, Size) else family


def _energy(point: Point) -> float:
    contact: Contact = point.branch.contact
    return contact.energy(point.state.y)
