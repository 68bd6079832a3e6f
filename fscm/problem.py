"""A punch in contact with a half-space: in physical units, or dimensionless (Eqs. 24-31).

Dimensionless, lengths normal to the surface are in z0, radii in (Q z0)^(1/n), tractions in dgamma / z0.  Tension is
negative.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from numbers import Number
from typing import Any, overload

from fscm._presentation import unit_name
from fscm._problem_checks import check_bodies, check_exponents, check_parts, check_tabor_number, checked_numbers
from fscm._response_factor import response_factor_per_rest
from fscm._units import DIMENSIONLESS, log_tabor_number, modulus_for, number_from_log, units_of
from fscm.bodies import Bodies, ScaledSolid, power_law_of, scaled
from fscm.interaction import Interaction, interaction_of
from fscm.laws import LennardJones, SurfaceLaw, dimensionless_law, unit_of_energy
from fscm.punch import PowerPunch, PunchShape, ScaledPunch, scaled_punch, unit_of_radii
from fscm.solids import GradedHalfSpace, PowerLaw, Solid

__all__ = ["Problem", "checked_problem"]


#: Arguments of the two kinds of problems, in the order of their positions.
_PHYSICAL = ("solid", "punch", "law", "punch_solid", "interaction")
_DIMENSIONLESS = ("n", "k", "mu", "punch", "law", "graded", "interaction")


@dataclass(frozen=True, slots=True, init=False)
class Problem:
    """Adhesive contact of a punch, rigid or elastic, with a half-space, in physical units or dimensionless.

    ``Problem(solid, punch, law)`` and its results are in any consistent units, for example SI.  In
    ``Problem(solid, punch, law, punch_solid)`` the punch is elastic: the compliances of both bodies add.
    ``Problem(n, k, mu)`` is dimensionless: a power-law graded half-space.  A physical problem also has n, k and mu, and
    `dimensionless`, the same problem without units.  Immutable, hashable, and picklable when its parts are.

    Parameters
    ----------
    solid : Solid
        `PowerLaw`, `Homogeneous`, `OffsetPowerLaw`, `Exponential`, `Coating`, `Layers`, `TabulatedModulus`,
        `CustomSolid`, or your own `GradedHalfSpace`.
    punch : PunchShape
        Shape of the punch; of a dimensionless problem the power law r^n / n by default.
    law : SurfaceLaw
        Surface law; of a dimensionless problem Lennard-Jones 9-3 by default.
    punch_solid : Solid, optional
        Solid of the punch, of any kind, with depths from its surface on; without one the punch is rigid.
    n : float
        Shape index of the punch, 0 < n <= 300; it also enters the definition of `mu` (Eq. 29), which needs
        2n + k > 1.
    k : float
        Gradient exponent of E = E0 (z/c0)^k, 0 <= k <= 1 (k = 1, the Gibson solid, is `fscm.gibson`).
    mu : float
        Generalised Tabor number (Eq. 29), > 0 and such that 1e-30 <= M <= 1e15 (see `compliance`).
    graded : GradedHalfSpace or Bodies, optional
        A solid that is not a power law, or several (`fscm.bodies`), with lengths in (Q z0)^(1/n).  Their k and mu are
        those of all compliances at short wave lengths without surface tension: k = 0 and the modulus
        E(0) / (1 - nu(0)^2) of one graded solid.
    interaction : str
        Of the surface: "derjaguin", the law at the vertical gap, or "body", the potential of the punch at the place of
        each point, which is known for a rigid punch with a growth of at least 1 under `LennardJones` or `Mie` (see
        `fscm.interaction`).

    Attributes
    ----------
    n, k, mu, punch, law, solid, punch_solid, graded, interaction
        As above.  In a physical problem punch and law are physical, n and Q define the unit of the radii (those of the
        punch if it is a power law), and `graded` is None; in a dimensionless one `solid` is None.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    >>> Problem(n=2, k=0.4, mu=1.0).compliance
    2.0

    A silica-like sphere of 1 micrometre in SI: Tabor's parameter (Eq. 1), and Bradley's limit 2 pi R dgamma.

    >>> from fscm import Homogeneous, LennardJones, PowerPunch
    >>> law = LennardJones(work_of_adhesion=0.05, z0=0.3e-9)
    >>> sphere = Problem(Homogeneous(E=70e9, nu=0.2), PowerPunch(n=2, Q=1e-6), law)
    >>> round(sphere.mu, 6), round(2.0 * sphere.units["load"] / 0.05e-6, 9)
    (0.259204, 6.283185307)

    The same sphere of the same material on it: half of E / (1 - nu^2).

    >>> round(Problem(sphere.solid, sphere.punch, law, punch_solid=sphere.solid).mu / sphere.mu, 9)
    1.587401052
    """

    n: float
    k: float
    mu: float
    punch: PunchShape
    law: SurfaceLaw
    graded: GradedHalfSpace | Bodies | None
    solid: Solid | None
    punch_solid: Solid | None
    interaction: str
    _dimensionless: Problem | None = field(init=False, repr=False, compare=False)
    _units: Mapping[str, float] = field(init=False, repr=False, compare=False)

    @overload
    def __init__(
        self,
        solid: Solid,
        punch: PunchShape,
        law: SurfaceLaw,
        punch_solid: Solid | None = None,
        *,
        interaction: str = "derjaguin",
    ) -> None: ...
    @overload
    def __init__(
        self,
        n: float,
        k: float,
        mu: float,
        punch: PunchShape | None = None,
        law: SurfaceLaw | None = None,
        graded: GradedHalfSpace | Bodies | None = None,
        interaction: str = "derjaguin",
    ) -> None: ...
    def __init__(self, *parts: Any, **named: Any) -> None:
        stated = {name: part for name, part in named.items() if part is not None}
        is_physical = "solid" in stated or (bool(parts) and not isinstance(parts[0], Number))
        names = _PHYSICAL if is_physical else _DIMENSIONLESS
        if len(parts) > len(names) or not {*stated} <= {*names}:
            raise ValueError(
                f"{', '.join(sorted({*stated} - {*names}) or ['more arguments'])} and the others are no one problem: "
                "it has a solid, a punch, a law and perhaps a punch_solid, or else n, k and mu; a physical problem is "
                "changed by making another one of its parts"
            )
        (self._pose_physical if is_physical else self._pose)(*parts, **stated)

    def _pose(
        self,
        n: Any = None,
        k: Any = None,
        mu: Any = None,
        punch: Any = None,
        law: Any = None,
        graded: Any = None,
        interaction: str = "derjaguin",
    ) -> None:
        """Check and set the attributes of a dimensionless problem."""
        n, k, mu = checked_numbers(n, k, mu)
        punch = PowerPunch(n) if punch is None else punch
        law = LennardJones() if law is None else law
        check_parts(punch, law)
        check_exponents(n, k, punch, law)
        check_tabor_number(n, k, mu)
        if graded is not None:
            check_bodies(graded, k)
        if isinstance(punch, PowerPunch) and punch != PowerPunch(n):
            raise ValueError(
                f"punch = {punch!r} does not fit n = {n:g}: a dimensionless power-law punch is r^n / n, with "
                "the n in the scale (Q z0)^(1/n) of its radii"
            )
        if law.z0 != 1.0:
            raise ValueError(
                f"law = {law!r} has the range {law.z0:g} and not 1: the lengths of a dimensionless problem are in z0; "
                "a physical one is Problem(solid, punch, law)"
            )
        law = dimensionless_law(law)
        interaction_of(punch, law, interaction)
        if interaction == "body" and isinstance(punch, PowerPunch):
            raise ValueError(
                "interaction 'body' is not known for a dimensionless PowerPunch: it needs the ratio of radii to "
                "heights; state the problem in physical units, or take 'derjaguin'"
            )
        if k == 1.0 and interaction != "derjaguin":
            raise ValueError(
                f"interaction {interaction!r} is not known for k = 1: the Gibson solid is solved for a traction that "
                "depends on the gap alone; take 'derjaguin'"
            )
        self._set(n, k, mu, punch, law, graded, None, None, interaction, None, DIMENSIONLESS)

    def _pose_physical(
        self, solid: Any, punch: Any = None, law: Any = None, punch_solid: Any = None, interaction: str = "derjaguin"
    ) -> None:
        """Set a physical problem, and its dimensionless one, which is checked."""
        check_parts(punch, law)
        w, z0 = unit_of_energy(law), law.z0
        n, Q = unit_of_radii(punch, z0)
        units = units_of(n, Q, w, z0)
        bodies = Bodies((solid,) if punch_solid is None else (solid, punch_solid))
        for body in bodies.solids:
            if power_law_of(body) is None and not isinstance(body, GradedHalfSpace):
                raise ValueError(
                    f"solid = {body!r} is no solid: one of your own needs modulus(z), poisson(z), length, interfaces"
                )
        # Everything is measured as on the power law that all bodies are at short waves.
        power_law = bodies.surface
        graded: ScaledSolid | Bodies | None = None
        if not bodies.are_one_power_law:
            first, *others = (scaled(body, units["radius"]) for body in bodies.solids)
            graded = first if isinstance(first, ScaledSolid) and not others else Bodies((first, *others))
        k = power_law.k
        check_exponents(n, k, punch, law)
        mu = number_from_log("Tabor number", log_tabor_number(power_law, n, Q, w, z0))
        shape: PunchShape = ScaledPunch(punch, units["radius"], z0)
        if interaction == "derjaguin":
            shape = PowerPunch(n) if type(punch) is PowerPunch else scaled_punch(punch, units["radius"], z0)
        if punch_solid is not None and interaction != "derjaguin":
            raise ValueError(
                f"interaction {interaction!r} is not known with a punch_solid: the potential is that of a rigid punch; "
                "take 'derjaguin'"
            )
        core = Problem(n, k, mu, shape, dimensionless_law(law), graded, interaction=interaction)
        self._set(n, k, core.mu, punch, law, None, solid, punch_solid, interaction, core, units)

    def _set(self, *values: Any) -> None:
        # The generated __setattr__ of a frozen class refuses; writing through object is its own idiom.
        parts = ("n", "k", "mu", "punch", "law", "graded", "solid", "punch_solid", "interaction")
        for name, value in zip((*parts, "_dimensionless", "_units"), values, strict=True):
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        names = ["n", "k", "mu", "punch", "law"] if self.solid is None else ["solid", "punch", "law"]
        names += [name for name in ("punch_solid", "graded") if getattr(self, name) is not None]
        if self.interaction != "derjaguin":
            names.append("interaction")
        return f"Problem({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    def __str__(self) -> str:
        numbers = f"n = {self.n:g}, k = {self.k:g}, mu = {self.mu:.6g}"
        return numbers if self.solid is None else f"{self!r}: {numbers}"

    def __reduce__(self) -> tuple[Any, ...]:
        """Rebuilt from its parts: units cannot be pickled."""
        if self.solid is not None:
            return Problem, (self.solid, self.punch, self.law, self.punch_solid, self.interaction)
        return Problem, (self.n, self.k, self.mu, self.punch, self.law, self.graded, self.interaction)

    @property
    def dimensionless(self) -> Problem:
        """The dimensionless problem; itself if it is one."""
        return self if self._dimensionless is None else self._dimensionless

    @property
    def units(self) -> Mapping[str, float]:
        """Unit of each kind of quantity: what a dimensionless value is multiplied by; ones if dimensionless.

        displacement, gap: z0; radius: (Q z0)^(1/n); traction: dgamma / z0; load: pi Q^(2/n) dgamma z0^(2/n-1)
        (Eq. 31); energy: load * displacement; stiffness: load / displacement; energy_per_area: dgamma; number: 1.
        """
        return self._units

    def unit_name(self, kind: str) -> str:
        """Name of the unit of a kind of quantity, as "z0"; of a physical problem that in SI, as "N in SI".

        Examples
        --------
        >>> Problem(n=2, k=0.4, mu=1.0).unit_name("load")
        'pi Q^(2/n) dgamma z0^(2/n-1)'
        """
        return unit_name(kind, is_physical=self._dimensionless is not None)

    def under(self, interaction: str | None) -> Problem:
        """The problem with another interaction; itself for None.

        Raises
        ------
        ValueError
            When the interaction is unknown, or not known for this punch and law.

        Examples
        --------
        >>> from fscm import Ball, Homogeneous, LennardJones
        >>> bead = Problem(Homogeneous(E=1.5e6, nu=0.5), Ball(R=5e-6), LennardJones(0.05, 3e-9))
        >>> bead.under("body").interaction
        'body'
        """
        if interaction in (None, self.interaction):
            return self
        if self.solid is None:
            return replace(self, interaction=interaction)
        return Problem(self.solid, self.punch, self.law, self.punch_solid, interaction=interaction)

    def in_units(self, *, c0: float, nu: float, Q: float, work_of_adhesion: float, z0: float) -> Problem:
        """The physical problem of given scales whose modulus E0 gives the Tabor number of this one.

        Parameters
        ----------
        c0, nu : float
            Of the `PowerLaw`.
        Q : float
            Of the `PowerPunch`.
        work_of_adhesion, z0 : float
            Of the law, Lennard-Jones 9-3.

        Raises
        ------
        ValueError
            When a scale is outside its range, or this problem has another solid, punch or law.

        Examples
        --------
        >>> physical = Problem(2, 0.4, 1.5).in_units(c0=1e-6, nu=0.3, Q=1e-6, work_of_adhesion=0.05, z0=3e-10)
        >>> round(physical.mu, 12), round(physical.solid.E0 / 1e9, 6)
        (1.5, 25.113266)
        """
        core = self.dimensionless
        if core != Problem(core.n, core.k, core.mu):
            raise ValueError(
                f"{self!r} has another solid, punch or law than the three numbers n, k and mu: scale these"
            )
        punch, law = PowerPunch(self.n, Q), LennardJones(work_of_adhesion, z0)
        scales = {"c0": c0, "Q": punch.Q, "work_of_adhesion": law.work_of_adhesion, "z0": law.z0}
        E0 = modulus_for(self.mu, n=self.n, k=self.k, nu=nu, **scales)
        return Problem(PowerLaw(E0, c0, self.k, nu), punch, law)

    @property
    def force(self) -> Interaction:
        """The interaction of punch and law."""
        return interaction_of(self.punch, self.law, self.interaction)

    @property
    def tabor_number_jin(self) -> float:
        """mu_Jin of Eq. 30: the Tabor number of Jin et al. (2021), without the factor b / (1 - k).

        It needs Poisson's ratio: AttributeError for a problem that is not of one power law in physical units.
        """
        if self.punch_solid is not None:
            raise AttributeError("two bodies have two of Poisson's ratios")
        nu = self.solid.power_law.nu  # type: ignore[union-attr]  # None: AttributeError
        return self.mu * response_factor_per_rest(self.k, nu) ** (-self.n / (2.0 * self.n + self.k - 1.0))

    @property
    def compliance(self) -> float:
        """M = 2 mu^((2n+k-1)/n), the factor of the surface deformation in Eq. 28, of a dimensionless problem.

        Raises
        ------
        ValueError
            For a physical problem: the equations are dimensionless.
        """
        if self._dimensionless is not None:
            raise ValueError(f"{self!r} is in physical units; the equations take problem.dimensionless")
        return 2.0 * self.mu ** ((2.0 * self.n + self.k - 1.0) / self.n)


def checked_problem(problem: object) -> Problem:
    """The argument, if it is a problem of this package.

    Raises
    ------
    ValueError
        One sentence; for a problem of another package, which has a method `build`, with what to give instead.

    Examples
    --------
    >>> checked_problem((2, 0.4, 1))
    Traceback (most recent call last):
    ValueError: a builtins.tuple is no Problem of fscm: write Problem(n=2, k=0.4, mu=1), or a solid, punch and law
    """
    if isinstance(problem, Problem):
        return problem
    remedy = "write Problem(n=2, k=0.4, mu=1), or a solid, punch and law"
    if hasattr(problem, "build"):
        remedy = (
            "give it to comparisons.evaluate or comparisons.curve, or give problem.build(fscm) here (problem.posed if "
            "n, k and mu state it)"
        )
    package = type(problem).__module__.partition(".")[0]
    raise ValueError(f"a {package}.{type(problem).__name__} is no Problem of fscm: {remedy}")
