"""Another route to the contact of finite strain: triangles of Taylor and Hood in a square, in forms of scikit-fem.

Nothing of `fem_reference` is used.  Displacements are quadratic, the pressure q is linear on each triangle and
continuous, for every Poisson's ratio.  Stationary is

    integral of [G/2 (I1 - 3 - 2 ln J) + q ln J - q^2/(2 lambda)] r dr dz + integral of U(H) rho rho' dr

with J = (F_rr F_zz - F_rz F_zr) (1 + u_r/r), rho = r + u_r and H = f(rho) - delta + u_z.  The energy of the faces is
varied as it stands, without integration by parts.  The square of `EXTENT` radii is fixed at its side and bottom.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import bmat, csc_array
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP1, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri

#: Side of the square in radii of the sphere.
EXTENT = 30.0

#: What an element is longer by, away from the contact edge, over its distance.
GROWTH = 0.15

#: Newton's method: its last step, and the largest change of a displacement in one step, in z0; its steps.
TOLERANCE, LARGEST_CHANGE, STEPS = 1e-8, 0.5, 60

#: Approach at which the faces do not attract.
FAR = -1e6

#: Radius at which the sphere goes over into its Taylor polynomial of second degree.
SPHERICAL = 0.95


def lines(fine, low, high):
    """Coordinates from 0 to `EXTENT`, with fine steps between two places, and a line at `SPHERICAL`."""
    x = [0.0]
    while x[-1] < EXTENT:
        x.append(x[-1] + fine + GROWTH * max(low - x[-1], x[-1] - high, 0.0))
    x = np.array(x)
    for place in (SPHERICAL, EXTENT):
        x[np.argmin(np.abs(x - place))] = place
    return x[x <= EXTENT]


def sphere(r):
    """Height, slope and curvature of a sphere of radius 1."""
    s, d = np.minimum(r, SPHERICAL), np.maximum(r - SPHERICAL, 0.0)
    root = np.sqrt(1.0 - s * s)
    slope, curvature = s / root, 1.0 / root**3
    return 1.0 - root + d * (slope + 0.5 * curvature * d), slope + curvature * d, curvature


def lennard_jones(H, z0):
    """Energy of the 9-3 law of unit work of adhesion, and its first two derivatives."""
    x = z0 / H
    energy = -(4.0 / 3.0) * (x**2 - x**8 / 4.0)
    return energy, (8.0 / 3.0) * (x**3 - x**9) / z0, (8.0 / 3.0) * (9.0 * x**10 - 3.0 * x**4) / z0**2


def change_of_area(F, v):
    return F[1, 1] * v.grad[0, 0] + F[0, 0] * v.grad[1, 1] - F[1, 0] * v.grad[0, 1] - F[0, 1] * v.grad[1, 0]


def change_of_volume(w, v):
    """Derivative of J."""
    return w.hoop * change_of_area(w.F, v) + w.area * v[0] / w.x[0]


@BilinearForm
def stiffness(u, v, w):
    r, J = w.x[0], w.area * w.hoop
    crossed = u.grad[0, 0] * v.grad[1, 1] + v.grad[0, 0] * u.grad[1, 1]
    crossed = crossed - u.grad[0, 1] * v.grad[1, 0] - v.grad[0, 1] * u.grad[1, 0]
    second = w.hoop * crossed + (change_of_area(w.F, u) * v[0] + change_of_area(w.F, v) * u[0]) / r
    both = change_of_volume(w, u) * change_of_volume(w, v) / J
    shear = sum(u.grad[i, j] * v.grad[i, j] for i in range(2) for j in range(2)) + u[0] * v[0] / r**2
    return r * (w.G * shear + (w.q - w.G) / J * (second - both))


@LinearForm
def forces(v, w):
    r, J = w.x[0], w.area * w.hoop
    shear = sum(w.F[i, j] * v.grad[i, j] for i in range(2) for j in range(2)) + w.hoop * v[0] / r
    return r * (w.G * shear + (w.q - w.G) / J * change_of_volume(w, v))


@BilinearForm
def coupling(u, p, w):
    return w.x[0] * p * change_of_volume(w, u) / (w.area * w.hoop)


@BilinearForm
def softness(q, p, w):
    return -w.x[0] * p * q * w.inverse_lame


@LinearForm
def volumes(p, w):
    return w.x[0] * p * (np.log(w.area * w.hoop) - w.q * w.inverse_lame)


@BilinearForm
def attraction(u, v, w):
    U, f = w.U, w.f
    a, b = f[1] * u[0] + u[1], f[1] * v[0] + v[1]
    du, dv = u.grad[0, 0], v.grad[0, 0]
    face, change = w.rho * w.stretch, U[1] * w.stretch
    return (
        U[2] * a * b * face
        + U[1] * f[2] * u[0] * v[0] * face
        + change * (a * v[0] + b * u[0])
        + U[1] * w.rho * (a * dv + b * du)
        + U[0] * (u[0] * dv + v[0] * du)
    )


@LinearForm
def pull(v, w):
    b = w.f[1] * v[0] + v[1]
    return w.U[1] * b * w.rho * w.stretch + w.U[0] * (v[0] * w.stretch + w.rho * v.grad[0, 0])


@LinearForm
def pull_by_approach(v, w):
    b = w.f[1] * v[0] + v[1]
    return -(w.U[2] * b * w.rho + w.U[1] * v[0]) * w.stretch - w.U[1] * w.rho * v.grad[0, 0]


@LinearForm
def pressed(v, w):
    return w.x[0] * w.p * v[1]


def factorised(K):
    return splu(csc_array(K), "MMD_AT_PLUS_A", 0.0, options={"SymmetricMode": True})


class Square:
    """A neo-Hookean solid in a square under a sphere of radius 1, with unit work of adhesion.

    Parameters
    ----------
    z0, E, nu : float
        Length of the law, modulus, and Poisson's ratio up to 0.5.
    step : float
        Side of the elements at the contact edge, in z0.
    edge : float
        Radius of the contact edge, about.
    """

    def __init__(self, z0, E, nu, step, edge):
        self.z0, self.G, self.inverse_lame = z0, 0.5 * E / (1.0 + nu), (1.0 + nu) * (1.0 - 2.0 * nu) / (nu * E)
        across, down = lines(step * z0, edge - 5.0 * z0, edge + 5.0 * z0), lines(0.5 * step * z0, 0.0, 0.0)
        mesh = MeshTri.init_tensor(across, down)
        self.inside = Basis(mesh, ElementVector(ElementTriP2()), intorder=6)
        self.pressures = self.inside.with_element(ElementTriP1())
        facets = mesh.facets_satisfying(lambda x: x[1] == 0.0)
        self.surface = FacetBasis(mesh, ElementVector(ElementTriP2()), facets=facets, intorder=10)
        self.radii = np.array(self.surface.global_coordinates())[0]
        held = self.inside.get_dofs(lambda x: (x[0] == EXTENT) | (x[1] == EXTENT)).all()
        axis = self.inside.get_dofs(lambda x: x[0] == 0.0).all(["u^1"])
        self.size, total = self.inside.N, self.inside.N + self.pressures.N
        self.free = np.setdiff1d(np.arange(total), np.union1d(held, axis))
        at_centre = (self.inside.doflocs == 0.0).all(axis=0)
        self.centre = int(np.flatnonzero(at_centre & ~np.isin(np.arange(self.size), axis))[0])

    def linear(self, pressure):
        """Return the unknowns of small strain under a pressure, a function of the radius."""
        x, free = np.zeros(self.size + self.pressures.N), self.free
        K = self._linearised(x, FAR)[0]
        load = pressed.assemble(self.surface, p=pressure(self.radii))
        x[free] = factorised(K[free][:, free]).solve(np.append(load, np.zeros(self.pressures.N))[free])
        return x

    def solved(self, x, gap):
        """Solve for the unknowns at a central gap, from a guess; return them and the load in pi w R."""
        delta, free = x[self.centre] - gap, self.free
        for _ in range(STEPS):
            K, residual, by_delta, _ = self._linearised(x, delta)
            step, response = np.zeros((2, x.size))
            sides = np.stack([-residual[free], -by_delta[free]], axis=1)
            step[free], response[free] = factorised(K[free][:, free]).solve(sides).T
            rise = (gap - (x[self.centre] - delta) - step[self.centre]) / (response[self.centre] - 1.0)
            step += rise * response
            size = np.abs(step[: self.size]).max() / self.z0
            share = min(1.0, LARGEST_CHANGE / size)
            while not self._upright(x + share * step):
                share *= 0.5
            x, delta = x + share * step, delta + share * rise
            if size < TOLERANCE:
                return x, self._linearised(x, delta)[3] / math.pi
        raise RuntimeError(f"Newton's method ends at a step of {size:.1e} z0")

    def _upright(self, x):
        F, hoop = self._deformation(x)
        return min(hoop.min(), (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]).min()) > 0.0

    def _deformation(self, x):
        """Deformation gradient in the plane, and hoop stretch."""
        field = self.inside.interpolate(x[: self.size])
        F = np.array(field.grad)
        F[0, 0] += 1.0
        F[1, 1] += 1.0
        return F, 1.0 + np.array(field)[0] / np.array(self.inside.global_coordinates())[0]

    def _linearised(self, x, delta):
        """Tangent, residual, its derivative by the approach, and load."""
        u, q = np.split(x, [self.size])
        F, hoop = self._deformation(x)
        values = {
            "F": F,
            "area": F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0],
            "hoop": hoop,
            "q": np.array(self.pressures.interpolate(q)),
            "G": self.G,
            "inverse_lame": self.inverse_lame,
        }
        B = coupling.assemble(self.inside, self.pressures, **values)
        at = self.surface.interpolate(u)
        rho, stretch = self.radii + np.array(at)[0], 1.0 + np.array(at.grad)[0, 0]
        f = np.array(sphere(rho))
        U = np.array(lennard_jones(f[0] - delta + np.array(at)[1], self.z0))
        faces = {"f": f, "U": U, "rho": rho, "stretch": stretch}
        K = stiffness.assemble(self.inside, **values) + attraction.assemble(self.surface, **faces)
        K = bmat([[K, B.T], [B, softness.assemble(self.pressures, **values)]], format="csr")
        residual = forces.assemble(self.inside, **values) + pull.assemble(self.surface, **faces)
        residual = np.concatenate([residual, volumes.assemble(self.pressures, **values)])
        by_delta = np.append(pull_by_approach.assemble(self.surface, **faces), np.zeros(q.size))
        return K, residual, by_delta, -2.0 * math.pi * float((U[1] * rho * stretch * self.surface.dx).sum())

    def pull_off(self, guess, gap, change):
        """Return the pull-off force in pi w R.

        Parameters
        ----------
        guess : ndarray
            Unknowns near the pull-off.
        gap, change : float
            Central gap there and its steps.
        """
        states, lowest = {0: self.solved(guess, gap)}, 0
        while not {lowest - 1, lowest + 1} <= states.keys():
            for i in (lowest - 1, lowest + 1):
                if i not in states:
                    states[i] = self.solved(states[lowest][0], gap + i * change)
            lowest = min(states, key=lambda i: states[i][1])
        for i in (lowest - 2, lowest + 2):
            if i not in states:
                states[i] = self.solved(states[lowest + (i - lowest) // 2][0], gap + i * change)
        near = range(lowest - 2, lowest + 3)
        polynomial = np.polynomial.Polynomial.fit(near, [states[i][1] for i in near], 4)
        turns = np.asarray(polynomial.deriv().roots(), complex)
        inside = turns[(abs(turns.imag) < 1e-12) & (abs(turns.real - lowest) < 1.0)].real
        return -float(polynomial(inside[0]))
