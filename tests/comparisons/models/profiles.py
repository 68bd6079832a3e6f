"""Problems of punches by their profiles."""

from __future__ import annotations

from comparisons.problem import Problem, Section
from fscm._units import modulus_for

#: The 9-3 law by its exponents, which is not the law of n, k and mu.
MIE = Section("mie", {"work_of_adhesion": 1.0, "z0": 1.0, "m": 9.0, "n": 3.0})


def power_law(n: float, k: float, mu: float, law: Section = MIE) -> Problem:
    """A power-law punch on a power-law solid, lengths in z0 and Q = 1."""
    nu = 0.5 if k == 1.0 else 0.3
    E0 = modulus_for(mu, n=n, k=k, nu=nu, c0=1.0, Q=1.0, work_of_adhesion=1.0, z0=1.0)
    solid = Section("power-law", {"E0": E0, "c0": 1.0, "k": k, "nu": nu})
    return Problem(solid, Section("power-law", {"n": n, "Q": 1.0}), law)


def on_solid(punch: Section, modulus: float, k: float = 0.0, law: Section = MIE) -> Problem:
    """A punch on a power-law solid of nu = 0.3."""
    return Problem(Section("power-law", {"E0": modulus, "c0": 1.0, "k": k, "nu": 0.3}), punch, law)
