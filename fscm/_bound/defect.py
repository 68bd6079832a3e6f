r"""Errors of a discrete state from its residual on a finer mesh, weighed by adjoint solutions.

A state u is interpolated to a finer mesh, whose residual is R.  The state u* of the finer mesh satisfies R(u*) = 0 and
has the same value of a control C.  For a functional J, to first order in u - u*,

    J(u) - J(u*) = y . (R(u), anchor(u), C(u) - C) + J_coarse(u) - J_fine(u),   B^T y = dJ/du,

with the bordered matrix B of the finer mesh.  The right side is a sum of contributions, one for each source of error:
a panel, the closed tail, the kernel beyond the mesh.

The adjoint y and the deformation are smooth on a panel.  The pressure is only as smooth as the punch and the law are,
and they may bend between the nodes of any mesh: its error, and the surface energy, are integrated over samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fscm._surface.bordered import FAR, Bordered
from fscm._surface.discretisation import Discretisation
from fscm._surface.linearisation import linearised
from fscm._surface.mesh import PanelMesh
from fscm._surface.response import response_of
from fscm._surface.samples import POINTS, Samples
from fscm._surface.state import State
from fscm._surface.tail import deformation_beyond, tail_energy, tail_errors, tail_variation
from fscm._typing import Array

__all__ = ["Defect", "Errors", "finer"]

#: The finer mesh has more nodes a panel, and its innermost panel is cut at this share of its length: at the tip the
#: pressure follows r^n, so that its error falls with the length, on all other panels with the order.
_MORE_NODES, _TIP = 4, 0.125
#: A panel longer than this many times its neighbour is cut at their common end into panels that grow by this factor:
#: its own nodes are too far from that end to sample the pressure there.
_GROWTH = 16.0
#: Relative rounding of a few operations; in units of it, those of an entry of the response matrix (kernel and sums of
#: products) and of a pressure times an area.
_ROUNDOFF = 2.0**-51
_ENTRY, _WEIGHT = 8.0, 4.0
#: Functionals whose derivatives by the unknowns cost little.
_WITH_GRADIENT = ("load", "displacement", "central_gap")
#: Relative step of the derivatives of the tail's energy.
_STEP = 1e-5


@dataclass(frozen=True)
class Errors:
    """Contributions to the error of one number, by cause.

    Attributes
    ----------
    mesh, tail, domain, law : ndarray
        Signed, one entry for each source.  That of the law is an estimate (`fscm._curved_face`).
    rounding, kernel : float
        Bounds.
    """

    mesh: Array
    tail: Array
    domain: Array
    rounding: float
    kernel: float = 0.0
    law: Array = field(default_factory=lambda: np.zeros(0))

    def plus(self, other: Errors, factor: float) -> Errors:
        """Contributions of self + factor * other; if their sources differ, the sizes add up."""
        if self.mesh.shape != other.mesh.shape or self.law.shape != other.law.shape:
            size = abs(factor)
            signed = size * other.mesh, size * other.tail, size * other.domain
            return self.beside(Errors(*signed, size * other.rounding, size * other.kernel, size * other.law))
        return Errors(
            self.mesh + factor * other.mesh,
            self.tail + factor * other.tail,
            self.domain + factor * other.domain,
            self.rounding + abs(factor) * other.rounding,
            self.kernel + abs(factor) * other.kernel,
            self.law + factor * other.law,
        )

    def beside(self, other: Errors) -> Errors:
        """Contributions of two independent sets of sources: their sizes add up."""
        return Errors(
            np.concatenate([self.mesh, other.mesh]),
            np.concatenate([self.tail, other.tail]),
            np.concatenate([self.domain, other.domain]),
            self.rounding + other.rounding,
            self.kernel + other.kernel,
            np.concatenate([self.law, other.law]),
        )


def finer(disc: Discretisation) -> Discretisation:
    """The same problem on the finer mesh on which residuals are evaluated."""
    mesh, ends = disc.mesh, disc.mesh.offsets
    added = [ends[0] + _TIP * mesh.lengths[0]]
    for end, shorter, longer, sign in _uneven(mesh):
        while (shorter := _GROWTH * shorter) < longer:
            added.append(end + sign * shorter)
    ends = np.array(sorted({*ends.tolist(), *added}))
    return Discretisation(disc.problem, PanelMesh(ends, mesh.order + _MORE_NODES, mesh.origin))


def _uneven(mesh: PanelMesh) -> Iterator[tuple[float, float, float, float]]:
    """Common ends of two panels of very different length, both lengths, and the side of the longer one."""
    for end, left, right in zip(mesh.offsets[1:-1], mesh.lengths[:-1], mesh.lengths[1:], strict=True):
        if max(left, right) > _GROWTH * min(left, right):
            yield float(end), float(min(left, right)), float(max(left, right)), 1.0 if right > left else -1.0


class Defect:
    """Residual of a state on a finer mesh, and the adjoint solutions there.

    Parameters
    ----------
    state : State
        In equilibrium on its own mesh.
    fine : Discretisation
        From `finer`; states on one mesh share it.
    """

    def __init__(self, state: State, fine: Discretisation) -> None:
        self.coarse = state
        coarse, mesh = state.disc.mesh, fine.mesh
        # The deformation is smoother than the gap.
        nodal = state.nodal_deformation
        self.fine = f = replace(state, disc=fine).with_deformation(coarse.transfer(nodal, mesh))
        self._system = linearised(f)
        self._stiffness = fine.stiffness_scale(state.scale)
        self._area = 2.0 * state.scale**2 * mesh.weights * mesh.nodes
        polynomial = coarse.transfer(state.pressure, mesh)
        # Errors of the interpolated pressure, and of the deformation between the nodes.
        samples, force = Samples(mesh), fine.force
        radii = state.scale * samples.radii
        gap = fine.height(radii) - state.displacement + coarse.transfer(nodal, mesh, POINTS)
        sampled = force.traction(radii, gap) - coarse.transfer(state.pressure, mesh, POINTS)
        self._pressure_error = samples.projected(sampled)
        self._pressure = polynomial + self._pressure_error
        self._sampled = samples, radii, gap
        deformation = self._stiffness * (fine.response(state.scale) @ polynomial) + f.tail.displacement
        self._gap_error = f.mismatch(deformation)
        axis = (d.axis_response(state.scale) @ p for d, p in ((fine, polynomial), (state.disc, state.pressure)))
        self._axis_error = self._stiffness * float(next(axis) - next(axis))
        self._owner = np.repeat(coarse.locate(mesh.middles), mesh.order)
        self._panels = len(coarse.lengths)
        self._edge = max(int(np.searchsorted(coarse.offsets, 1.0 - coarse.origin)) - 1, 0)

    def errors(self, functional: str, control: str, missed: float = 0.0) -> Errors:
        """Errors of "load", "displacement", "central_gap" or "energy" at a fixed value of a control.

        Parameters
        ----------
        functional, control : str
            The control may also be "log_scale".
        missed : float
            Value of the control minus the prescribed one, by rounding.
        """
        y = self._adjoint(functional, control)
        N = self.fine.disc.mesh.size
        adjoint, anchor, border = y[:N], float(y[N]), float(y[N + 1])
        mesh = self._by_panel(adjoint * self._gap_error - self._backwards(adjoint) * self._pressure_error)
        mesh += border * self._difference(control) - self._difference(functional)
        mesh[self._edge] += anchor * self._system.anchor
        tail, domain = self._behind(adjoint, border, functional, control)
        rounding = self._rounding(adjoint, border, functional, control) + abs(border * missed)
        kernel = self._kernel(adjoint, border, functional, control)
        return Errors(mesh, tail, domain, rounding, kernel, self._left_out(adjoint, border, functional, control))

    def _left_out(self, adjoint: Array, border: float, functional: str, control: str) -> Array:
        """Contributions of what the traction leaves out of the potential of the punch, by node and behind the mesh."""
        if self._remainder is None:
            return np.zeros(0)
        tail = self.fine.tail
        effect = border * self._by_pressure(control) - self._by_pressure(functional) - self._backwards(adjoint)
        behind = border * self._explicit(control) - self._explicit(functional)
        behind[1] -= float(np.sum(adjoint))
        return np.append(effect * self._remainder, behind[:2] * [tail.load, tail.displacement])

    @cached_property
    def _remainder(self) -> Array | None:
        f = self.fine
        return f.disc.force.remainder(f.radius, f.gap)

    def _by_pressure(self, name: str) -> Array:
        """Derivatives of a functional by the pressure at fixed unknowns."""
        f = self.fine
        if name == "load":
            return self._area
        if name == "central_gap":
            return self._stiffness * f.disc.axis_response(f.scale)
        if name == "energy":
            # With that of the surface, whose energy is at most the pressure times the distance.
            distance = np.minimum(f.gap - f.disc.problem.law.singular_gap, f.radius + 1.0)
            elastic = 0.5 * (self._area * f.deformation + self._backwards(self._area * f.pressure))
            return np.abs(elastic) + self._area * distance
        return np.zeros_like(self._area)

    def _by_panel(self, values: Array) -> Array:
        return np.asarray(np.bincount(self._owner, values, minlength=self._panels), float)

    def _bordered(self, control: str) -> Bordered:
        return self._system.bordered(self._gradient(control))

    def _adjoint(self, functional: str, control: str) -> Array:
        """Solution of the transposed system; with the first one of a control come all whose right sides cost little."""
        known = self._adjoints.setdefault(control, {})
        if functional not in known:
            names = [functional, *(name for name in _WITH_GRADIENT if name != functional and not known)]
            right = np.column_stack([self._gradient(name) for name in names])
            bordered = self._bordered(control)
            known.update(zip(names, bordered.condensed(bordered.near(FAR)).adjoints(right).T, strict=True))
        return known[functional]

    @cached_property
    def _adjoints(self) -> dict[str, dict[str, Array]]:
        return {}

    def _backwards(self, adjoint: Array) -> Array:
        """Adjoint of the response: K W^T adjoint."""
        return self._stiffness * (adjoint @ self.fine.disc.response(self.fine.scale))

    def _gradient(self, name: str) -> Array:
        """Derivatives of a functional by the unknowns."""
        system = self._system
        if name == "load":
            return system.load_gradient
        if name == "central_gap":
            return system.axis_gap_gradient
        if name == "energy":
            return self._energy_gradient()
        unit = np.zeros(len(self._area) + 2)
        unit[-2 if name == "displacement" else -1] = 1.0
        return unit

    def _energy_gradient(self) -> Array:
        f, tail, force = self.fine, self.fine.tail, self.fine.disc.force
        k = f.disc.problem.k
        weighed = self._area * f.pressure
        slope = force.slope(f.radius, f.gap)
        row = self._area * (0.5 * slope * f.deformation - f.pressure) + 0.5 * slope * self._backwards(weighed)

        def behind(relative: float, shift: float) -> float:
            return tail_energy(f.disc.problem, f.end * (1.0 + relative), f.displacement + shift)

        pressure = 0.5 * float(np.sum(weighed))
        surface = self._area @ (0.5 * f.pressure * f.deformation + force.energy(f.radius, f.gap))
        elastic = 0.5 * (1.0 - k) * float(weighed @ (f.deformation - tail.displacement))
        growth = f.disc.growth(f.scale, f.pressure)[0]
        elastic += 0.5 * self._stiffness * float(np.sum(weighed * growth))
        by_displacement = pressure * tail.displacement_slope + (behind(0.0, _STEP) - behind(0.0, -_STEP)) / (
            2.0 * _STEP
        )
        by_scale = 2.0 * float(surface) + elastic + pressure * tail.displacement_rate
        by_scale += (behind(_STEP, 0.0) - behind(-_STEP, 0.0)) / (2.0 * _STEP)
        if self._system.drift is not None:
            by_scale += self._drift_of_energy(weighed, self._system.drift)
        return self._system.by_unknowns(row, by_displacement, by_scale)

    def _drift_of_energy(self, weighed: Array, drift: Array) -> float:
        """Derivative of the energy by log c by that of the pressure at a fixed gap."""
        f, force = self.fine, self.fine.disc.force
        outside, inside = (force.energy(f.radius * (1.0 + step), f.gap) for step in (_STEP, -_STEP))
        elastic = 0.5 * (self._area * f.deformation + self._backwards(weighed)) @ drift
        return float(elastic + self._area @ (outside - inside) / (2.0 * _STEP))

    def _difference(self, name: str) -> Array:
        """A functional on the finer mesh minus that on the coarse one, by panel."""
        if name == "load":
            return self._by_panel(self._area * self._pressure_error)
        if name == "central_gap":
            by_panel = self._by_panel(
                self._stiffness * self.fine.disc.axis_response(self.fine.scale) * self._pressure_error
            )
            by_panel[0] += self._axis_error
            return by_panel
        return self._energy() - self._coarse_energy() if name == "energy" else np.zeros(self._panels)

    def _energy(self) -> Array:
        """Elastic and surface energy of the interpolated state, by panel."""
        f = self.fine
        deformation = self._stiffness * (f.disc.response(f.scale) @ self._pressure) + f.tail.displacement
        surface = np.bincount(self._owner[:: f.disc.mesh.order], self._surface_energy, minlength=self._panels)
        return self._by_panel(0.5 * self._area * self._pressure * deformation) + surface

    @cached_property
    def _surface_energy(self) -> Array:
        """That of the gap between the nodes, by panel of the finer mesh."""
        samples, radii, gap = self._sampled
        energy = self.fine.disc.force.energy(radii, gap)
        return samples.integrals(2.0 * self.coarse.scale * radii * energy)

    def _coarse_energy(self) -> Array:
        state = self.coarse
        mesh, force = state.disc.mesh, state.disc.force
        density = 0.5 * state.pressure * state.deformation + force.energy(state.radius, state.gap)
        return (2.0 * state.scale**2 * mesh.weights * mesh.nodes * density).reshape(self._panels, -1).sum(axis=1)

    def _explicit(self, name: str) -> Array:
        """Derivatives of a functional by load, displacement and energy of the tail, at fixed unknowns."""
        by_displacement = {"central_gap": 1.0, "energy": 0.5 * float(self._area @ self.fine.pressure)}
        return np.array([float(name == "load"), by_displacement.get(name, 0.0), float(name == "energy")])

    def _behind(self, adjoint: Array, border: float, functional: str, control: str) -> tuple[Array, Array]:
        """Contributions of the closed tail, and of what is neglected beyond the mesh."""
        f = self.fine
        problem, tail = f.disc.problem, f.tail
        effect = border * self._explicit(control) - self._explicit(functional)
        effect[1] -= float(np.sum(adjoint))
        computed, remainder = tail_errors(problem, f.end, f.displacement, energy=bool(effect[2]))
        # The closed tail is too large by `computed`.
        of_tail = np.concatenate([-effect * computed, effect * remainder])
        # The tail neglects w, which decreases outwards from the last node on, or as under a distant load.
        w = abs(float(f.deformation[-1]))
        if problem.graded is not None:
            w = max(w, deformation_beyond(problem, f.end, abs(f.load - tail.load) + abs(tail.load)))
        neglected = effect * np.array([tail.load_slope * w, tail.displacement_slope * w, tail.load * w])
        elastic = float(functional == "energy") * 0.5 * tail.load * w
        # The tail displaces all radii as the center.
        ring = adjoint + (0.5 * self._area * f.pressure if functional == "energy" else 0.0)
        variation = self._by_panel(ring * self._variation)
        return of_tail, np.concatenate([neglected, [elastic], variation])

    @cached_property
    def _variation(self) -> Array:
        f = self.fine
        return tail_variation(f.disc.problem, f.end, f.displacement, f.radius)

    def _kernel(self, adjoint: Array, border: float, functional: str, control: str) -> float:
        """Bound of the error of the response of a graded solid, weighed by the adjoint."""
        f = self.fine
        if f.disc.problem.graded is None:
            return 0.0
        nodes, axis = response_of(f.disc.problem.graded).error(f.disc.mesh, f.scale, f.pressure)
        weights = np.abs(adjoint)
        on_axis = float(functional == "central_gap") + abs(border) * float(control == "central_gap")
        if functional == "energy":
            weights = weights + 0.5 * np.abs(self._area * f.pressure)
        return self._stiffness * float(weights @ nodes + on_axis * axis)

    def _rounding(self, adjoint: Array, border: float, functional: str, control: str) -> float:
        """Rounding of the residual weighed by the adjoint, and of the functionals."""
        f = self.fine
        row = np.abs(adjoint)
        backwards = np.abs(self._backwards(row))
        force = f.disc.force
        product = float(backwards @ force.size(f.radius, f.gap))
        size, of_gap = self._system.sizes()
        product += float(backwards @ np.abs(force.slope(f.radius, f.gap) * of_gap)) / _ENTRY
        functionals = self._functional_rounding(functional) + abs(border) * self._functional_rounding(control)
        return _ROUNDOFF * (float(row @ size) + _ENTRY * product + functionals)

    def _functional_rounding(self, name: str) -> float:
        """Sizes of the terms of a functional, in units of the roundoff."""
        f, force = self.fine, self.fine.disc.force
        sizes = force.size(f.radius, f.gap)
        stored = float(np.abs(self._gradient(name)[:-2]) @ np.abs(f.gap))
        if name == "load":
            return stored + _WEIGHT * float(self._area @ sizes)
        if name == "central_gap":
            return (
                stored + abs(f.displacement) + _ENTRY * self._stiffness * float(f.disc.axis_response(f.scale) @ sizes)
            )
        if name == "energy":
            density = 0.5 * sizes * np.abs(f.deformation) + np.abs(force.energy(f.radius, f.gap))
            return stored + _WEIGHT * float(self._area @ density)
        return abs(f.displacement)

    def rate_rounding(self, functional: str, control: str) -> float:
        """Rounding of the derivative of a functional by a control: of the bordered solution that gives it."""
        matrix, right = self._bordered(control).matrix(), np.zeros(len(self._area) + 2)
        right[-1] = 1.0
        tangent = np.abs(np.linalg.solve(matrix, right))
        adjoint, gradient = np.abs(self._adjoint(functional, control)), np.abs(self._gradient(functional))
        return _ROUNDOFF * _ENTRY * float(adjoint @ (np.abs(matrix) @ tangent) + gradient @ tangent)
