"""Cases of the agreement: twenty graded solids of five kinds, three Tabor numbers, a sphere and a cone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from comparisons.problem import Problem, Section

__all__ = ["CASES", "MU", "PUNCHES", "QUANTITIES", "SOLIDS", "AgreementCase"]

#: Quantities that are compared.
QUANTITIES = ("pull_off_force", "jump_in_displacement", "jump_out_displacement")

#: Tabor numbers, with the modulus of the surface.
MU = (1.0, 0.3, 3.0)

#: Punches: the shape index n of r^n / n.
PUNCHES: Mapping[str, float] = MappingProxyType({"sphere": 2.0, "cone": 1.0})


def _offset(k: float, z_s: float, nu: float) -> Section:
    return Section("offset-power-law", {"E0": 1.0, "c0": 1.0, "k": k, "z_s": z_s, "nu": nu})


def _exponential(surface: float, depth: float, length: float, nu: float) -> Section:
    return Section("exponential", {"E_surface": surface, "E_depth": depth, "length": length, "nu": nu})


def _coating(coating: float, thickness: float, transition: float, nu: float, below: float) -> Section:
    """On a substrate of modulus 1 with Poisson's ratio `below`."""
    interface = {"thickness": thickness, "transition": transition}
    ratios = {"nu_coating": nu, "nu_substrate": below}
    return Section("coating", {"E_coating": coating, "E_substrate": 1.0, **interface, **ratios})


def _table(depths: tuple[float, ...], moduli: tuple[float, ...], nu: float) -> Section:
    return Section("table", {"nu": nu}, {"z": depths, "E": moduli})


#: Solids by name.  Lengths are in those of the punch at a height of z0; only ratios of the moduli matter.
SOLIDS: Mapping[str, Section] = MappingProxyType(
    {
        "offset-1": _offset(0.4, 1.0, 0.3),
        "exponential-1": _exponential(1.0, 4.0, 1.0, 0.3),
        "smooth-1": _coating(0.2, 0.7, 0.1, 0.3, 0.3),
        "sharp-1": _coating(5.0, 0.7, 0.0, 0.3, 0.3),
        "table-1": _table((0.0, 1.0, 2.0, 5.0), (1.0, 3.0, 4.0, 10.0), 0.3),
        "offset-2": _offset(0.2, 0.3, 0.45),
        "exponential-2": _exponential(4.0, 1.0, 1.0, 0.3),
        "smooth-2": _coating(5.0, 0.7, 0.1, 0.3, 0.3),
        "sharp-2": _coating(0.1, 0.5, 0.0, 0.45, 0.25),
        "table-2": _table((0.0, 0.5, 1.0, 3.0), (2.0, 1.0, 3.0, 0.5), 0.2),
        "offset-3": _offset(0.6, 0.5, 0.2),
        "exponential-3": _exponential(1.0, 10.0, 0.3, 0.45),
        "smooth-3": _coating(0.5, 2.0, 0.5, 0.4, 0.2),
        "sharp-3": _coating(2.0, 2.0, 0.0, 0.2, 0.4),
        "table-3": _table((0.0, 0.3, 1.0, 4.0, 8.0), (1.0, 1.5, 2.0, 2.2, 5.0), 0.4),
        "offset-4": _offset(0.8, 2.0, 0.0),
        "exponential-4": _exponential(3.0, 1.0, 5.0, 0.1),
        "smooth-4": _coating(3.0, 1.0, 0.3, 0.1, 0.45),
        "sharp-4": _coating(0.3, 0.2, 0.0, 0.3, 0.3),
        "table-4": _table((0.0, 1.0, 3.0), (3.0, 2.0, 1.0), 0.3),
    }
)


@dataclass(frozen=True, slots=True)
class AgreementCase:
    """A solid of `SOLIDS`, a punch of `PUNCHES` and a Tabor number.

    Examples
    --------
    >>> problem = AgreementCase("table-4", "cone", 3.0).problem
    >>> round(problem.posed.mu, 12), round(problem.units["radius"], 12)
    (3.0, 1.0)
    """

    solid: str
    punch: str
    mu: float

    @property
    def problem(self) -> Problem:
        """The problem of a file: unit length of the punch and unit range of the law."""
        n = PUNCHES[self.punch]
        unit = self._problem(n, 1.0)
        # The Tabor number is a power of the work of adhesion over the modulus.
        at_one = unit.posed.mu
        return self._problem(n, (self.mu / at_one) ** ((2.0 * n - 1.0) / n))

    def _problem(self, n: float, work: float) -> Problem:
        law = Section("lennard-jones-9-3", {"work_of_adhesion": work, "z0": 1.0})
        return Problem(SOLIDS[self.solid], Section("power-law", {"n": n, "Q": 1.0}), law)


#: All of them, in an order in which every part of the list has all kinds of solid.
CASES = tuple(AgreementCase(solid, punch, mu) for mu in MU for punch in PUNCHES for solid in SOLIDS)
