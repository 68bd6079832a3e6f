"""Displacement and stresses of a contact for ParaView (vtu through meshio) and as a matplotlib picture.

The field is recovered from the surface: the surface displacement of an equilibrium gives the load vector, the
load vector the displacement of the whole solid, and its derivatives the stresses, sampled on a sub-grid of
every element.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation
from numpy.typing import NDArray
from skfem import Basis, ElementQuadP

from fem_reference._contact.friction import FrictionName
from fem_reference._contact.states import Point
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.mapping import ChartMapping
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_cg
from fem_reference._threads import one_thread
from fem_reference._typing import Array, Index
from fem_reference.solid import ScaledSolid

__all__ = ["Field", "contact_field", "draw", "write_vtu"]


#: Sample points an element side; stresses are those of the order-6 element, the picture is linear between.
SAMPLES = 4

#: Samples keep this share of an element away from its sides: on the axis u_r / r is 0/0, at the surface of a graded
#: solid the strain u_z,z ~ z^-k is unbounded while the stress is not.
SURFACE_OFFSET = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Field:
    """Sampled solution of a solid.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        (r, z), z positive into the solid.
    quads : ndarray of int, shape (m, 4)
        Cells of the sample grid.
    displacement : ndarray, shape (n, 2)
        (u_r, u_z).
    stress : ndarray, shape (n, 4)
        sigma_rr, sigma_tt (hoop), sigma_zz, sigma_rz; tension positive.
    modulus : ndarray, shape (n,)
        E at the points.
    gap, pressure : ndarray, shape (n,)
        Gap to the punch and pressure (positive in compression) at the points of the surface; NaN below it.
    """

    points: Array
    quads: Index
    displacement: Array
    stress: Array
    modulus: Array
    gap: Array
    pressure: Array

    def in_units_of(self, length: float, traction: float) -> Field:
        """Return the field in another unit of every length, and of stresses, moduli and pressures.

        Raises
        ------
        ValueError
            If a unit is not positive.

        Examples
        --------
        >>> one, none = np.ones(1), np.zeros((0, 4), int)
        >>> metres = Field(np.ones((1, 2)), none, np.ones((1, 2)), np.ones((1, 4)), one, one, one)
        >>> metres.in_units_of(1e-9, 1e6).gap, metres.in_units_of(1e-9, 1e6).pressure
        (array([1.e+09]), array([1.e-06]))
        """
        for name, unit in (("length", length), ("traction", traction)):
            if not unit > 0.0:
                raise ValueError(f"{name} = {unit:g} is outside (0, inf): it is a unit")
        return Field(
            self.points / length,
            self.quads,
            self.displacement / length,
            self.stress / traction,
            self.modulus / traction,
            self.gap / length,
            self.pressure / traction,
        )

    @property
    def von_mises(self) -> Array:
        """Von Mises stress, shape (n,).

        Examples
        --------
        >>> point, cell = np.zeros((1, 2)), np.zeros((0, 4), int)
        >>> uniaxial = np.array([[0.0, 0.0, -2.0, 0.0]])
        >>> Field(point, cell, point, uniaxial, *np.ones((3, 1))).von_mises
        array([2.])
        """
        rr, tt, zz, rz = self.stress.T
        return np.sqrt(0.5 * ((rr - tt) ** 2 + (tt - zz) ** 2 + (zz - rr) ** 2) + 3.0 * rz**2)


def contact_field(solid: Any, spec: MeshSpec, point: Point, friction: FrictionName = "none") -> Field:
    """Recover displacement and stress in the whole solid at a point of the equilibrium path.

    Parameters
    ----------
    solid : Solid
        The material.
    spec : MeshSpec
        The mesh the point was computed on.
    point : Point
        A converged equilibrium.
    friction : {"none", "bonded"}
        That of the point.

    Returns
    -------
    Field
        Of the solid, also where the punch is elastic.

    Raises
    ------
    NotConverged
        If the stiffness is singular, or conjugate gradients miss their tolerance.
    """
    with one_thread:
        contact, y = point.branch.contact, point.state.y
        c = float(y[-1])
        # Lengths scale by c: stiffness by c, load by c^2; the forces of the surface tension stay.
        scaled = ScaledSolid(solid, c, friction == "bonded")
        half_space = assemble_half_space(spec.grid(), scaled, spec.order)
        trace = contact.compliance.trace
        pressure = contact.pressure(y)
        load = np.zeros(half_space.elements.size)
        load[half_space.surface] = trace.phi.T @ (trace.weight * trace.s * pressure)
        u = c * half_space.completed(solve_cg(half_space, load).solution[:, None])[:, 0]
        body = half_space.body
        side = np.linspace(SURFACE_OFFSET, 1.0 - SURFACE_OFFSET, SAMPLES)
        X = np.array([np.tile(side, SAMPLES), np.repeat(side, SAMPLES)])
        mapping = ChartMapping(body.mesh, body.chart)
        basis = Basis(
            body.mesh,
            ElementQuadP(body.order),
            mapping,
            quadrature=(X, np.ones(X.shape[1])),
            disable_doflocs=True,
        )
        s, zeta = np.asarray(basis.global_coordinates())
        radial, axial = basis.interpolate(u[0::2]), basis.interpolate(u[1::2])
        ur, uz = np.asarray(radial), np.asarray(axial)
        strain = [radial.grad[0] / c, ur / (c * s), axial.grad[1] / c]
        shear = (radial.grad[1] + axial.grad[0]) / c
        E, nu = scaled.modulus(zeta), scaled.poisson(zeta)
        lame = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
        twice = E / (1.0 + nu)
        volume = lame * (strain[0] + strain[1] + strain[2])
        stress = [volume + twice * e for e in strain] + [0.5 * twice * shear]
        radius, at_surface = c * s.ravel(), _at_surface(body.mesh.nelements, zeta)
        gap = np.full(radius.size, np.nan)
        deformed = trace.evaluate(s.ravel()[at_surface]) @ y[:-2]
        gap[at_surface] = contact.punch.height(radius[at_surface]) - y[-2] + deformed
        return Field(
            c * np.stack([s.ravel(), zeta.ravel()], axis=1),
            _cells(body.mesh.nelements),
            np.stack([ur.ravel(), uz.ravel()], axis=1),
            np.stack([component.ravel() for component in stress], axis=1),
            E.ravel(),
            gap,
            contact.force.traction(radius, gap),
        )


def _at_surface(elements: int, depth: Array) -> NDArray[np.bool_]:
    """Whether a sample is on the side of an element that is part of the surface."""
    side = np.zeros((elements, SAMPLES, SAMPLES), bool)
    depths = np.asarray(depth).reshape(elements, SAMPLES, SAMPLES)
    # The samples of the surface are off it by a share of their element.
    side[:] = np.abs(depths) <= 2.0 * SURFACE_OFFSET * np.ptp(depths, axis=(1, 2), keepdims=True)
    return side.ravel()


def _cells(elements: int) -> Index:
    corner = np.arange(SAMPLES * SAMPLES).reshape(SAMPLES, SAMPLES)
    unit = np.stack([corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]], axis=-1).reshape(-1, 4)
    return (unit[None] + (SAMPLES * SAMPLES * np.arange(elements))[:, None, None]).reshape(-1, 4)


def write_vtu(field: Field, path: str | Path) -> None:
    """Write a field for ParaView; the axis of symmetry is the vertical axis and depth points down.

    Point data: displacement, modulus, stresses, and gap and pressure, which are NaN below the surface.

    Parameters
    ----------
    field : Field
        Sampled solution; in consistent units "Warp By Vector" with the factor 1 shows the deformed body.
    path : str or Path
        File name, ending in .vtu.
    """
    flat = np.zeros(len(field.points))
    points = np.stack([field.points[:, 0], -field.points[:, 1], flat], axis=1)
    displacement = np.stack([field.displacement[:, 0], -field.displacement[:, 1], flat], axis=1)
    names = ("sigma_rr", "sigma_tt", "sigma_zz", "sigma_rz")
    data = {"displacement": displacement, "modulus": field.modulus, "von_mises": field.von_mises}
    data |= {"gap": field.gap, "pressure": field.pressure}
    # The shear stress changes sign with the direction of the vertical axis.
    signs = (1.0, 1.0, 1.0, -1.0)
    data |= {name: sign * column for name, sign, column in zip(names, signs, field.stress.T, strict=True)}
    meshio.Mesh(points, [("quad", field.quads)], point_data=data).write(path, file_format="vtu")


def draw(field: Field, radius: float, magnification: float = 1.0, stress: str = "sigma_zz") -> Figure:
    """Draw the punch and the deformed, stressed body inside a radius.

    Parameters
    ----------
    field : Field
        Sampled solution.
    radius : float
        What to show: r < radius, z < radius.
    magnification : float
        Factor on the displacement.
    stress : {"sigma_zz", "sigma_rr", "sigma_tt", "sigma_rz", "von_mises"}
        What the colours mean.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        For an unknown stress.
    """
    names = {"sigma_rr": 0, "sigma_tt": 1, "sigma_zz": 2, "sigma_rz": 3}
    if stress not in names and stress != "von_mises":
        raise ValueError(f"stress {stress!r} is unknown; choose von_mises or one of {', '.join(names)}")
    values = field.von_mises if stress == "von_mises" else field.stress[:, names[stress]]
    corners = field.points[field.quads]
    inside = (corners < 1.2 * radius).all(axis=(1, 2))
    quads = field.quads[inside]
    r = field.points[:, 0] + magnification * field.displacement[:, 0]
    z = field.points[:, 1] + magnification * field.displacement[:, 1]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    used = np.unique(triangles)
    renumber = np.zeros(len(values), np.intp)
    renumber[used] = np.arange(used.size)
    figure = Figure(figsize=(6.0, 5.0), layout="constrained")
    axes = figure.subplots()
    triangulation = Triangulation(r[used], z[used], renumber[triangles])
    # Zero is white: blue is compression, red tension.
    limit = float(np.abs(values[used]).max())
    image = axes.tripcolor(triangulation, values[used], shading="gouraud", cmap="RdBu_r", vmin=-limit, vmax=limit)
    surface = np.flatnonzero(np.isfinite(field.gap) & (field.points[:, 0] < 1.2 * radius))
    surface = surface[np.argsort(field.points[surface, 0])]
    across = field.points[surface, 0]
    lower = magnification * (field.displacement[surface, 1] - field.gap[surface])
    axes.fill_between(across, lower, -10.0 * radius, fc="0.85", ec="0.3", lw=0.8, hatch="////")
    figure.colorbar(image, ax=axes, label=stress.replace("_", " "))
    axes.set(xlim=(0.0, radius), xlabel="r", ylabel="depth z", aspect="equal")
    # A third of the body's height for the punch.
    axes.set_ylim(radius, min(-radius / 3.0, float(z[used].min())))
    return figure
