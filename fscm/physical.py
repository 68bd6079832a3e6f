"""Problem in physical units, and its conversion to the dimensionless one and back (Eqs. 3, 7, 24-31).

Any consistent units do: lengths in one unit, moduli and tractions in another, loads in traction * length^2,
the work of adhesion in traction * length, Q in length^(n-1).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import overload

from fscm._response_factor import response_factor, response_factor_per_rest
from fscm._typing import Array
from fscm._validation import real_number
from fscm.laws import SurfaceLaw
from fscm.problem import Problem
from fscm.punch import PunchShape

__all__ = ["PhysicalProblem"]

# Natural logarithm of 1e304: within the range of floating-point numbers.
_LOG_RANGE = 700.0


@dataclass(frozen=True, slots=True)
class PhysicalProblem:
    """A power-law punch f = r^n / (n Q) on a half-space E = E0 (z/c0)^k, in any consistent units.

    Parameters
    ----------
    E0 : float
        Reference modulus, > 0 (traction).
    c0 : float
        Depth at which E = E0, > 0 (length).
    k : float
        Gradient exponent, 0 <= k <= 1.
    nu : float
        Poisson's ratio, 0 <= nu <= 1/2; for k = 1 (the Gibson solid) exactly 1/2, or the response is infinite.
    Q : float
        Shape parameter, > 0 (length^(n-1)); the radius of a paraboloid, R^(n-1) in general.
    n : float
        Shape index, > (1 - k) / 2.
    work_of_adhesion : float
        Energy per area to part the surfaces, > 0 (traction * length).
    z0 : float
        Range of the surface forces, > 0 (length); the equilibrium gap of Eq. 10 measured from its
        singularity.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    A silica-like sphere of 1 micrometre: Tabor's parameter (Eq. 1).

    >>> sphere = PhysicalProblem(E0=70e9, c0=1.0, k=0, nu=0.2, Q=1e-6, n=2, work_of_adhesion=0.05, z0=0.3e-9)
    >>> round(sphere.tabor_number, 6)
    0.259204
    >>> round(sphere.from_dimensionless("load", -2.0) / 0.05e-6, 9)     # Bradley: 2 pi R dgamma
    -6.283185307
    """

    E0: float
    c0: float
    k: float
    nu: float
    Q: float
    n: float
    work_of_adhesion: float
    z0: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "k":
                reason = "E = E0 (z/c0)^k has no finite surface response there"
                value = real_number("k", value, low=0.0, high=1.0, closed_low=True, closed_high=True, reason=reason)
            elif field.name == "nu":
                reason = "the solid is elastic, and incompressible at 0.5"
                value = real_number("nu", value, low=0.0, high=0.5, closed_low=True, closed_high=True, reason=reason)
            else:
                value = real_number(field.name, value, low=0.0, high=math.inf, reason="it is a positive quantity")
            object.__setattr__(self, field.name, value)
        if self.k == 1.0 and self.nu != 0.5:
            raise ValueError(
                f"nu = {self.nu:g} is outside [0.5, 0.5] for k = 1: only the incompressible Gibson solid has "
                "a finite b / (1 - k) in Eq. 29"
            )
        if 2.0 * self.n + self.k <= 1.0:
            raise ValueError(
                f"n = {self.n:g} is outside ({(1.0 - self.k) / 2.0:g}, inf) for k = {self.k:g}: "
                "the Tabor number of Eq. 29 is a power 1 / (2n + k - 1)"
            )
        z, w = math.log(self.z0), math.log(self.work_of_adhesion)
        r = (math.log(self.Q) + z) / self.n
        load = math.log(math.pi) + 2.0 * r + w - z
        derived = {"Tabor number": self._log_tabor_number, "unit of radii": r, "unit of tractions": w - z}
        derived |= {"unit of loads": load, "unit of energies": load + z, "unit of stiffnesses": load - z}
        for name, log in derived.items():
            if not abs(log) < _LOG_RANGE:
                raise ValueError(
                    f"the {name} is 10^{log / math.log(10.0):.0f}, outside (1e-304, 1e304): check the units"
                )

    @classmethod
    def from_problem(
        cls, problem: Problem, *, c0: float, nu: float, Q: float, work_of_adhesion: float, z0: float
    ) -> PhysicalProblem:
        """Return the physical problem of given scales whose modulus E0 gives the Tabor number of `problem`.

        Parameters
        ----------
        problem : Problem
            Its n, k and mu are used; punch and law stay dimensionless.
        c0, nu, Q, work_of_adhesion, z0 : float
            As for the class.

        Examples
        --------
        >>> scales = dict(c0=1e-6, nu=0.3, Q=1e-6, work_of_adhesion=0.05, z0=3e-10)
        >>> round(PhysicalProblem.from_problem(Problem(2, 0.4, 1.5), **scales).tabor_number, 12)
        1.5
        """
        # E0 enters Eq. 29 as E0^(-n / (2n+k-1)); start from a unit modulus and scale.
        unit = cls(1.0, c0, problem.k, nu, Q, problem.n, work_of_adhesion, z0)
        exponent = (2.0 * unit.n + unit.k - 1.0) / unit.n
        log_E0 = exponent * (unit._log_tabor_number - math.log(problem.mu))
        if not abs(log_E0) < _LOG_RANGE:
            raise ValueError(
                f"mu = {problem.mu:g} needs a modulus of 10^{log_E0 / math.log(10.0):.0f}, "
                "outside (1e-304, 1e304): check the units"
            )
        return cls(math.exp(log_E0), c0, unit.k, nu, Q, unit.n, work_of_adhesion, z0)

    def problem(self, punch: PunchShape | None = None, law: SurfaceLaw | None = None) -> Problem:
        """Return the dimensionless problem, with the punch r^n / n and the 9-3 law unless others are given.

        Parameters
        ----------
        punch : PunchShape, optional
            Punch in units of `z0` (heights) and `length_r` (radii).
        law : SurfaceLaw, optional
            Surface law in units of `z0` and `work_of_adhesion / z0`.

        Examples
        --------
        >>> sphere = PhysicalProblem(E0=1.0, c0=1.0, k=0, nu=0, Q=1.0, n=2, work_of_adhesion=1.0, z0=1.0)
        >>> sphere.problem()
        Problem(n=2.0, k=0.0, mu=1.0, punch=PowerPunch(n=2.0), law=LennardJones93())
        """
        return Problem(self.n, self.k, self.tabor_number, punch, law)

    @property
    def contact_modulus(self) -> float:
        """E* = E0 / (1 - nu^2) (traction).

        Examples
        --------
        >>> PhysicalProblem(E0=3.0, c0=1.0, k=0, nu=0.4, Q=1.0, n=2, work_of_adhesion=1.0, z0=1.0).contact_modulus
        3.571...
        """
        return self.E0 / (1.0 - self.nu**2)

    @property
    def response_factor(self) -> float:
        """Factor b of Eq. 7, dimensionless."""
        return response_factor(self.k, self.nu)

    @property
    def tabor_number(self) -> float:
        """Generalised Tabor number mu of Eq. 29, dimensionless."""
        return math.exp(self._log_tabor_number)

    @property
    def tabor_number_jin(self) -> float:
        """mu_Jin of Eq. 30: the Tabor number of Jin et al. (2021), without the factor b / (1 - k).

        Examples
        --------
        >>> graded = PhysicalProblem(E0=1.0, c0=1.0, k=0.5, nu=0.3, Q=1.0, n=2, work_of_adhesion=1.0, z0=1.0)
        >>> n, k, b = graded.n, graded.k, graded.response_factor
        >>> round(graded.tabor_number / graded.tabor_number_jin / (b / (1 - k)) ** (n / (2 * n + k - 1)), 12)
        1.0
        """
        n, k = self.n, self.k
        return self.tabor_number * response_factor_per_rest(k, self.nu) ** (-n / (2.0 * n + k - 1.0))

    @property
    def _log_tabor_number(self) -> float:
        # Logarithms, because the powers of metres and pascals in Eq. 29 overflow for large n.
        n, k = self.n, self.k
        elastic = math.log(self.work_of_adhesion) - math.log(self.contact_modulus)
        elastic += math.log(response_factor_per_rest(k, self.nu))
        total = (1.0 - k) * math.log(self.Q) + n * k * math.log(self.c0) + n * elastic
        return total / (2.0 * n + k - 1.0) - math.log(self.z0)

    @property
    def length_z(self) -> float:
        """Unit of gaps, displacements and heights: z0 (Eq. 25)."""
        return self.z0

    @property
    def length_r(self) -> float:
        """Unit of radii: (Q z0)^(1/n) (Eq. 25)."""
        return self.scales["radius"]

    @property
    def scales(self) -> Mapping[str, float]:
        """Physical unit of each kind of quantity, by name.

        displacement, gap: z0; radius: (Q z0)^(1/n); traction: dgamma / z0; load: pi Q^(2/n) dgamma z0^(2/n-1)
        (Eq. 31); energy: load * displacement; stiffness: load / displacement; energy_per_area: dgamma.

        Examples
        --------
        >>> sphere = PhysicalProblem(E0=1.0, c0=1.0, k=0, nu=0, Q=8.0, n=2, work_of_adhesion=3.0, z0=2.0)
        >>> round(sphere.scales["radius"], 12), sphere.scales["traction"]
        (4.0, 1.5)
        """
        z0, w = self.z0, self.work_of_adhesion
        r = self.Q ** (1.0 / self.n) * z0 ** (1.0 / self.n)
        load = math.pi * (r * w) * (r / z0)
        return {
            "displacement": z0,
            "gap": z0,
            "radius": r,
            "traction": w / z0,
            "load": load,
            "energy": load * z0,
            "stiffness": load / z0,
            "energy_per_area": w,
        }

    @overload
    def to_dimensionless(self, kind: str, value: float) -> float: ...
    @overload
    def to_dimensionless(self, kind: str, value: Array) -> Array: ...
    def to_dimensionless(self, kind: str, value: float | Array) -> float | Array:
        """Divide a physical value, or an array of them, by the unit of its kind (see `scales`).

        Raises
        ------
        ValueError
            When `kind` is not one of the names in `scales`.

        Examples
        --------
        >>> import numpy as np
        >>> sphere = PhysicalProblem(E0=1.0, c0=1.0, k=0, nu=0, Q=1.0, n=2, work_of_adhesion=1.0, z0=2.0)
        >>> sphere.to_dimensionless("gap", np.array([1.0, 4.0]))
        array([0.5, 2. ])
        """
        return value / self._scale(kind)

    @overload
    def from_dimensionless(self, kind: str, value: float) -> float: ...
    @overload
    def from_dimensionless(self, kind: str, value: Array) -> Array: ...
    def from_dimensionless(self, kind: str, value: float | Array) -> float | Array:
        """Multiply a dimensionless value, or an array of them, by the unit of its kind (see `scales`).

        Raises
        ------
        ValueError
            When `kind` is not one of the names in `scales`.

        Examples
        --------
        >>> import numpy as np
        >>> sphere = PhysicalProblem(E0=1.0, c0=1.0, k=0, nu=0, Q=1.0, n=2, work_of_adhesion=1.0, z0=2.0)
        >>> sphere.from_dimensionless("gap", np.array([0.5, 2.0]))
        array([1., 4.])
        """
        return value * self._scale(kind)

    def _scale(self, kind: str) -> float:
        scales = self.scales
        if kind not in scales:
            raise ValueError(f"kind = {kind!r} has no scale: use one of {', '.join(scales)}")
        return scales[kind]
