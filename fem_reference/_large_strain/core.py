"""Elements of the core of finite strain: their strains, residuals and tangents, condensed to their sides.

Functions, numbering and degree are those of scikit-fem's `ElementQuadP` on the tensor-product meshes of
`fem_reference._elastic`.  The axes of an element are those of r and z, so that the gradients of a function at a point
are those on the unit square times one factor each, and the factors go into the weights.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from skfem import Dofs, ElementQuadP

from fem_reference._elastic.dof_ordering import both_components
from fem_reference._elastic.elasticity import EXTRA_POINTS, element_places, gauss_product
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.tensor_elements import factors, pressure_functions, unit_functions
from fem_reference._large_strain.material import HOOP, energy, kinematics, stress, tangent
from fem_reference._large_strain.tensor_tangent import KINDS, TensorTangent, tensor_tangent
from fem_reference._typing import Array, Index

__all__ = ["Condensed", "Constants", "Core", "core_of"]

#: Of the shear modulus: compressibility of the tangent of an incompressible solid. The residual has none, so that the
#: solution is incompressible, and Newton's steps leave this share of what the volumes lack.
TANGENT_COMPRESSIBILITY = 1e-7

#: Part of lambda that the displacement carries itself in the mixed form: that many shear moduli, or that many of the
#: largest tensions if this is more, and at most that share of lambda. The volume is kept in the mean over test
#: functions only; at a mean tension T, displacements that change it between them have the stiffness 2 G - T + this part
#: (derived for a change of one stretch), and the exact solution changes no volume there.
OWN_STIFFNESS, OWN_TENSIONS, OWN_SHARE = 8.0, 1.5, 0.5

#: Elements whose tangents are formed at once: the caches hold them (measured: 17, 14 and 15 ms for 112 elements of
#: degree 6 with 8, 32 and 64).
CHUNK = 32

#: Depths -> shear modulus and 1/lambda.
Constants = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True, slots=True, eq=False)
class Condensed:
    """How elements respond: what is inside them, and their pressures, follow from their sides.

    Attributes
    ----------
    follow : ndarray, shape (e, i, s)
        The functions inside fall by this much when those of the sides rise.
    inverse : ndarray, shape (e, i, i)
        Of the tangent of the functions inside.
    response : ndarray, shape (e, m, s + i)
        Rise of the pressures with all functions; only in the mixed form.
    rise : ndarray, shape (e, m, m)
        And with what the volumes lack. Both are large and nearly cancel: they have to be those of one place.
    """

    follow: Array
    inverse: Array
    response: Array
    rise: Array


@dataclass(frozen=True, slots=True, eq=False)
class Forces:
    """What elements lack of their balance.

    Attributes
    ----------
    residual : ndarray, shape (e, s + i)
        Derivatives of the energy.
    lack : ndarray, shape (e, m)
        What the volumes lack for the pressures; only in the mixed form.
    """

    residual: Array
    lack: Array


@dataclass(frozen=True, slots=True, eq=False)
class Core:
    """Elements of a meshed square.

    Attributes
    ----------
    grid : Grid
    dofs : skfem.Dofs
        Numbering of the scalar functions; component c of unknown i is row 2 i + c.
    order : int
        Degree p of the displacement; that of the pressure is p - 1.
    mixed : bool
        Whether the pressure is an unknown of its own.
    rows : ndarray of int, shape (e, 2 n)
        Rows of the functions of each element, both components interleaved, those inside last.
    functions : ndarray, shape (3, q, n)
        Slopes along both axes of the unit square, and values.
    tests : ndarray, shape (q, m)
        Functions of the pressure.
    scale : ndarray, shape (3, e, q)
        Factors of the slopes, and 1/r.
    measure, shear, lame, compressibility : ndarray, shape (e, q)
        Weights of r dr dz, shear modulus, the part of lambda that the displacement carries, and the inverse of the
        rest, which the pressure carries.
    rise : ndarray, shape (e, m, m)
        Of the pressures with what the volumes lack; only in the mixed form.
    sums : TensorTangent
        Over the points of an element.
    couplings : ndarray, shape (3, q, m n)
        Products of `tests` and `functions`; only in the mixed form.
    """

    grid: Grid
    dofs: Dofs
    order: int
    mixed: bool
    rows: Index
    functions: Array
    tests: Array
    scale: Array
    measure: Array
    shear: Array
    lame: Array
    compressibility: Array
    rise: Array
    sums: TensorTangent
    couplings: Array

    @property
    def size(self) -> int:
        """Rows of the displacement."""
        return 2 * int(self.dofs.N)

    @property
    def sides(self) -> Index:
        """Rows of the functions that do not vanish on the sides of each element, shape (e, s)."""
        return self.rows[:, : self.rows.shape[1] - 2 * int(self.dofs.interior_dofs.shape[0])]

    def no_pressure(self) -> Array:
        """Return the pressures of the undeformed solid, shape (e, m)."""
        return np.zeros((self.rows.shape[0], self.tests.shape[1]))

    def has_places_of(self, other: Core) -> bool:
        """Whether rows, elements and pressures are those of other elements, of any form."""
        shapes = [(core.grid.r.size, core.grid.z.size, core.order, core.mixed) for core in (self, other)]
        return self is other or shapes[0] == shapes[1]

    def condensed(self, u: Array, pressures: Array, finiteness: float) -> tuple[Array, Condensed] | None:
        """Linearise every element, and eliminate what is inside; None if an element is turned inside out.

        Parameters
        ----------
        u : ndarray, shape (2 N,)
        pressures : ndarray, shape (e, m)
            Not used but in the mixed form.
        finiteness : float
            Factor of the strains, see `fem_reference._large_strain.material`.

        Returns
        -------
        tangent : ndarray, shape (e, s, s)
            Of the sides.
        condensed : Condensed
        """
        e, s = self.sides.shape
        inside, pressed = self.rows.shape[1] - s, self.tests.shape[1] if self.mixed else 0
        tangent = np.empty((e, s, s))
        result = Condensed(
            np.empty((e, inside, s)),
            np.empty((e, inside, inside)),
            np.empty((e, pressed, s + inside)),
            self.rise,
        )
        for start in range(0, e, CHUNK):
            chunk = slice(start, start + CHUNK)
            linear = self._linearised(chunk, u, pressures[chunk], finiteness)
            if linear is None:
                return None
            K, response = linear
            if response is not None:
                result.response[chunk] = response
            result.inverse[chunk] = np.linalg.inv(K[:, s:, s:])
            np.matmul(result.inverse[chunk], K[:, s:, :s], out=result.follow[chunk])
            tangent[chunk] = K[:, :s, :s] - K[:, :s, s:] @ result.follow[chunk]
        return tangent, result

    def forces(self, u: Array, pressures: Array, finiteness: float) -> Forces | None:
        """Return what the elements lack of their balance, as in `condensed`; None if one is turned inside out."""
        state = kinematics(self._gradients(slice(None), u), finiteness)
        if state is None:
            return None
        volume = state.log_J / finiteness
        carried = pressures @ self.tests.T
        P = stress(state, self.shear, self.lame * volume + carried)
        e, n = self.rows.shape[0], self.functions.shape[2]
        residual = np.zeros((e, n, 2))
        for of_gradient, (i, kind) in zip(P, KINDS, strict=True):
            residual[:, :, int(i > HOOP)] += (of_gradient * self.scale[kind] * self.measure) @ self.functions[kind]
        lack = (self.measure * (volume - self.compressibility * carried)) @ self.tests
        return Forces(residual.reshape(e, 2 * n), lack)

    def _gradients(self, chunk: slice, u: Array) -> Array:
        """Displacement gradients of some elements, shape (5, e, q)."""
        kinds, points, n = self.functions.shape
        local = u[self.rows[chunk]].reshape(-1, n, 2).swapaxes(1, 2)
        along = (local.reshape(-1, n) @ self.functions.reshape(-1, n).T).reshape(-1, 2, kinds, points)
        return np.stack([along[:, int(i > HOOP), kind] * self.scale[kind, chunk] for i, kind in KINDS])

    def _linearised(
        self, chunk: slice, u: Array, pressure: Array, finiteness: float
    ) -> tuple[Array, Array | None] | None:
        """Tangent of some elements, and how their pressures follow."""
        state = kinematics(self._gradients(chunk, u), finiteness)
        if state is None:
            return None
        shear, lame, measure = self.shear[chunk], self.lame[chunk], self.measure[chunk]
        q = lame * state.log_J / finiteness + pressure @ self.tests.T
        scale = np.stack([self.scale[kind, chunk] for _, kind in KINDS])
        K = self.sums.of(tangent(state, shear, q, lame) * scale * (scale[:, None] * measure))
        if not self.mixed:
            return K, None
        couplings = state.inverse * scale * measure
        of_components = np.zeros((K.shape[0], self.tests.shape[1], self.functions.shape[2], 2))
        for i, kind in KINDS:
            of_components[..., int(i > HOOP)] += (couplings[i] @ self.couplings[kind]).reshape(of_components.shape[:3])
        B = of_components.reshape(K.shape[0], -1, K.shape[1])
        response = self.rise[chunk] @ B
        K += B.swapaxes(1, 2) @ response
        return K, response

    def eliminated(self, condensed: Condensed, forces: Forces) -> tuple[Array, Array]:
        """Return the forces on the sides, shape (e, s), and how the functions inside fall if the sides stay.

        What is inside and the pressures then are in balance, by the tangent.

        Parameters
        ----------
        condensed : Condensed
        forces : Forces
            Where the tangent was taken, or near it.
        """
        s, r = self.sides.shape[1], forces.residual
        if self.mixed:
            r = r + (forces.lack[:, None] @ condensed.response)[:, 0]
        inner = r[:, None, s:]
        # The tangent is symmetric.
        return r[:, :s] - (inner @ condensed.follow)[:, 0], (inner @ condensed.inverse)[:, 0]

    def recover(self, condensed: Condensed, forces: Forces, own: Array, step: Array) -> Array:
        """Fill in the step inside the elements, in place, from that of their sides; return that of the pressures.

        Parameters
        ----------
        condensed : Condensed
        forces : Forces
        own : ndarray, shape (e, i)
            Of `eliminated`.
        step : ndarray, shape (2 N,)
        """
        s = self.sides.shape[1]
        step[self.rows[:, s:]] = -own - (condensed.follow @ step[self.sides][:, :, None])[:, :, 0]
        if not self.mixed:
            return self.no_pressure()
        risen = condensed.response @ step[self.rows][:, :, None] + condensed.rise @ forces.lack[:, :, None]
        return np.asarray(risen[:, :, 0])

    def energy(self, u: Array, finiteness: float = 1.0) -> float:
        """Elastic energy of the core per radian; inf if an element is turned inside out."""
        state = kinematics(self._gradients(slice(None), u), finiteness)
        if state is None:
            return float("inf")
        softness, lame = self.compressibility, self.lame.copy()
        lame[softness > 0.0] += 1.0 / softness[softness > 0.0]
        return float((self.measure * energy(state, self.shear, lame)).sum())


def core_of(
    grid: Grid, constants: Constants, order: int, mixed: bool, tension: float = 0.0, extra: int = EXTRA_POINTS
) -> Core:
    """Return the elements of a grid.

    Parameters
    ----------
    grid : Grid
    constants : callable
        Depths -> shear modulus and 1/lambda.
    order : int
        Degree p of the displacement; that of the pressure is p - 1.
    mixed : bool
        Whether the pressure is an unknown of its own.
    tension : float
        Largest tension on the surface.
    extra : int
        Gauss points a direction beyond the degree.
    """
    mesh = grid.quads()
    dofs = Dofs(mesh, ElementQuadP(order))
    rows = both_components(np.asarray(dofs.element_dofs)).T
    columns, layers = element_places(mesh)
    X, W = gauss_product(order + extra, order + extra)
    N, along_r, along_z = unit_functions(mesh, order, X)
    wide, high = np.diff(grid.r)[columns, None], np.diff(grid.z)[layers, None]
    r, z = grid.r[columns, None] + wide * X[0], grid.z[layers, None] + high * X[1]
    shear, softness = constants(z)
    stiff = np.divide(1.0, softness, out=np.full_like(softness, np.inf), where=softness > 0.0)
    own = np.maximum(OWN_STIFFNESS * shear, OWN_TENSIONS * tension)
    lame = np.minimum(OWN_SHARE * stiff, own) if mixed else stiff
    rest = np.where(np.isinf(stiff), 0.0, 1.0 / (stiff - lame)) if mixed else np.zeros_like(stiff)
    scale = np.stack([np.broadcast_to(1.0 / wide, r.shape), np.broadcast_to(1.0 / high, r.shape), 1.0 / r])
    functions, tests = np.stack([along_r, along_z, N]), pressure_functions(X, order - 1)
    measure = r * W * wide * high
    rise = np.zeros((rows.shape[0], tests.shape[1], tests.shape[1]))
    if mixed:
        softened = (rest + np.where(rest > 0.0, 0.0, TANGENT_COMPRESSIBILITY / shear)) * measure
        rise = np.linalg.inv(tests.T @ (softened[:, :, None] * tests))
    sums = tensor_tangent(order, order + extra, factors(mesh, order))
    couplings = np.einsum("qm,kqn->kqmn", tests, functions) if mixed else np.zeros((3, X.shape[1], 0))
    return Core(
        grid,
        dofs,
        order,
        mixed,
        rows,
        functions,
        tests,
        scale,
        measure,
        shear,
        lame,
        rest,
        rise,
        sums,
        couplings.reshape(3, X.shape[1], -1),
    )
