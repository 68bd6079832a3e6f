"""Quadrature rule on (0, 1) for integrands with a singularity at or near either end.

With z = 1 / (1 + exp(-u)) the trapezoidal rule in u converges geometrically whatever algebraic singularity
the integrand has at z = 0, at z = 1 or just outside: z = -eps becomes log(eps) + i pi, pi from the real line.
The cohesive-zone integrals have such singularities at distance (a/c)^2, for every a/c from 0 to 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.model import Array

#: exp(-40) = 4e-18 truncates a bounded end, exp(-76/2) = 3e-17 an end as singular as 1 / sqrt(1 - z).
_LEFT, _RIGHT = -40.0, 76.0


@dataclass(frozen=True, slots=True)
class UnitRule:
    """Nodes and weights on (0, 1), each node given with its accurate complement.

    Attributes
    ----------
    z, complement : ndarray, shape (m,)
        Nodes, and 1 - z without cancellation.
    log_z : ndarray, shape (m,)
        log(z), accurate where z rounds to 1.
    weight : ndarray, shape (m,)
        Weights of the integral over z from 0 to 1.

    Examples
    --------
    >>> bool(abs(FINE.weight.sum() - 1.0) < 1e-14)
    True
    """

    z: Array
    complement: Array
    log_z: Array
    weight: Array

    @classmethod
    def with_step(cls, step: float) -> UnitRule:
        """Return the rule with trapezoidal step `step` in u (dimensionless, > 0).

        Examples
        --------
        >>> rule = UnitRule.with_step(0.25)
        >>> round(float(np.sum(rule.weight / np.sqrt(rule.complement))), 14)
        2.0
        """
        u = np.arange(_LEFT, _RIGHT + 0.5 * step, step)
        e = np.exp(-np.abs(u))
        small, large = e / (1.0 + e), 1.0 / (1.0 + e)
        z = np.where(u > 0, large, small)
        complement = np.where(u > 0, small, large)
        return cls(z, complement, -np.logaddexp(0.0, -u), step * z * complement)


#: The nearest singularity of the integrands in use is pi / 2 from the real line: the error exp(-pi^2 / step)
#: is 1e-16 at a step of 0.27.
#: The rule of every value: exact to rounding.
FINE = UnitRule.with_step(0.25)
#: exp(-3 pi^2) = 1e-13: enough to see where a slope changes sign, never used for a value.
#: The rule of searches, whose results are no values.
COARSE = UnitRule.with_step(1.0 / 3.0)
