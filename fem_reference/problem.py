"""Problem as data: a solid, a punch and a surface law, in any consistent units."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem_reference._validation import check_tension
from fem_reference.interaction import Interaction, InteractionName, interaction_of
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import CustomPunch, Punch, radius_at_height
from fem_reference.solid import Solid

__all__ = ["Problem", "checked_problem"]

#: Height, in lengths of the law, at which the growth of the punch is measured.
FAR = 1e4

#: Largest relative difference of a declared growth from the one measured at `FAR`. A shape may still approach its power
#: there: r^2 + r is off by 1 % at a height of 1e4 of its own units.
GROWTH_TOLERANCE = 0.05

#: The load integral of p ~ r^(-m growth) times r dr converges if m growth exceeds this.
LOAD_INTEGRAL = 2.0


@dataclass(frozen=True, slots=True)
class Problem:
    """Adhesive contact of a punch, rigid or elastic, with a graded half-space.

    Parameters
    ----------
    solid : Solid
        Modulus E(z) and Poisson ratio.
    punch : Punch
        Shape f(r).
    law : SurfaceLaw
        Traction p(H).
    punch_solid : Solid, optional
        Of an elastic punch: its surface moves like that of a half-space, and the displacements of both bodies add.
        Rigid by default.
    interaction : {"derjaguin", "body", "auto"}
        Where the surface force of small strain is taken: the law at the vertical gap, or the potential of a rigid punch
        at the place of each point.  That is exact under `LennardJones` or `Mie`; any other law acts at the normal
        distance of the point to the punch, without the terms of curvature.  "auto" is "body" for a `Ball` under
        `LennardJones` or `Mie`.

    Raises
    ------
    ValueError
        If a part is of another kind or not hashable, or the load integral diverges.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerLaw, PowerPunch, Problem
    >>> sphere, law = PowerPunch(n=2.0, Q=1.0), LennardJones(work_of_adhesion=1.0, z0=1.0)
    >>> Problem(PowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.3), sphere, law).punch.n
    2.0
    """

    solid: Solid
    punch: Punch
    law: SurfaceLaw
    punch_solid: Solid | None = None
    interaction: InteractionName = "derjaguin"

    def __post_init__(self) -> None:
        if not isinstance(self.solid, Solid):
            raise ValueError(
                f"solid = {self.solid!r} is not a solid of this package: give its functions to CustomSolid(E, nu, "
                "length, interfaces)"
            )
        if self.punch_solid is not None and not isinstance(self.punch_solid, Solid):
            raise ValueError(
                f"punch_solid = {self.punch_solid!r} is not a solid of this package: leave it out for a rigid punch, "
                "or give its functions to CustomSolid(E, nu, length, interfaces)"
            )
        if not isinstance(self.punch, Punch):
            raise ValueError(f"punch = {self.punch!r} is not a punch shape: it needs height(r) and slope(r)")
        if not isinstance(self.law, SurfaceLaw):
            raise ValueError(
                f"law = {self.law!r} is not a surface law: it needs traction, slope and energy of the gap, and "
                "work_of_adhesion, z0, peak_gap, singular_gap and decay"
            )
        for solid in self.solids:
            check_tension(solid.surface_tension)
        try:
            hash((self.solid, self.punch, self.law, self.punch_solid))
        except TypeError as error:
            raise ValueError(f"the problem is not hashable ({error}); make its parts frozen dataclasses") from error
        interaction_of(self.punch, self.law, self.interaction)
        if self.punch_solid is not None and self.interaction == "body":
            raise ValueError(
                "interaction 'body' is not known with a punch_solid: the potential is that of a rigid punch; take "
                "'derjaguin'"
            )
        C, m = self.law.decay
        r = radius_at_height(self.punch, FAR * self.law.z0)
        growth = r * float(self.punch.slope(np.array(r))) / float(self.punch.height(np.array(r)))
        if isinstance(self.punch, CustomPunch) and not abs(growth / self.punch.growth - 1.0) <= GROWTH_TOLERANCE:
            raise ValueError(
                f"growth = {self.punch.growth:g} is not the exponent of the punch: at the height {FAR:g} z0 it grows "
                f"like r^{growth:.3g}"
            )
        if C != 0.0 and not m * growth > LOAD_INTEGRAL:
            raise ValueError(
                f"growth f ~ r^{growth:.9g} of the punch is outside ({LOAD_INTEGRAL:g}/{m:g}, inf): with "
                f"p ~ H^-{m:g} far away, the load integral of p r dr diverges"
            )

    @property
    def force(self) -> Interaction:
        """The surface force of small strain."""
        return interaction_of(self.punch, self.law, self.interaction)

    def under(self, interaction: InteractionName | None) -> Problem:
        """Return the problem with another interaction, or itself for None.

        Raises
        ------
        ValueError
            If the interaction is unknown, or not known for an elastic punch.
        """
        return self if interaction is None else replace(self, interaction=interaction)

    @property
    def solids(self) -> tuple[Solid, ...]:
        """The solid, and that of an elastic punch."""
        return (self.solid,) if self.punch_solid is None else (self.solid, self.punch_solid)


def checked_problem(problem: object) -> Problem:
    """Return the argument, if it is a problem of this package.

    Raises
    ------
    ValueError
        One sentence; for a problem of another package, which has a method `build`, with what to give instead.

    Examples
    --------
    >>> checked_problem((2, 0.4, 1))
    Traceback (most recent call last):
    ValueError: a builtins.tuple is no Problem of fem_reference: write Problem(solid, punch, law)
    """
    if isinstance(problem, Problem):
        return problem
    remedy = "write Problem(solid, punch, law)"
    if hasattr(problem, "build"):
        remedy = (
            'give it to comparisons.evaluate with the model "fem"; or give problem.build(fem_reference), if it is in '
            "physical units"
        )
    package = type(problem).__module__.partition(".")[0]
    raise ValueError(f"a {package}.{type(problem).__name__} is no Problem of fem_reference: {remedy}")
