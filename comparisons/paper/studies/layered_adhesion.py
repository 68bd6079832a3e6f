"""Layered solids against results of the literature; not in the paper.

Each row compares the FSCM, or its compliance, with a number that is published or follows from a published statement:

* *compliance*: xi C(xi) of a coating on a substrate in closed form (Burmister 1945; as written by O'Sullivan and King
  1988 and Nogi and Kato 1997).
* *JKR*: 3/2 pi w R on a homogeneous solid (Johnson, Kendall and Roberts 1971).
* *coated JKR*: the pull-off force of a sphere on a coated solid, derived from the balance of energy of JKR and the
  integral equation of the coated solid (Perriot and Barthel 2004; `coated_jkr`), by other code than the FSCM.
* *thin coating*: 2 pi w R on a coating that is thin beside the contact, on a rigid substrate, from the theory of Reedy
  (2006): the coating is a layer of springs and separates at the tension (2 w E_u/h)^(1/2), E_u its uniaxial modulus.
  With s = (2 w h/E_u)^(1/2) the load at the contact radius a is (pi E_u/h) (a^4/(4 R) - s a^2), least at a^2 = 2 R s.
  Beside it stands the limit of *coated JKR* as the thickness falls, on a substrate that is 1e6 times as stiff.

The FSCM has a finite range of attraction z0: its Tabor number mu goes to infinity at a constant thickness in
(w R^2/E*)^(1/3), which is L mu^(1/2).  Then the force approaches that of JKR as mu^-2 (A ln mu + B): the cohesive zone
has a width of about L mu^(-3/2), and the tension beyond it decays so slowly that a logarithm remains.  Five Tabor
numbers determine the limit and the coefficients of mu^-2 ln mu, mu^-2, mu^-3 ln mu, mu^-3.  The bound is what the last
Tabor number changes, and the bounds of all forces, weighed as they enter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comparisons.models.solver import translated
from comparisons.numerics.bounds import combined
from comparisons.paper.paper_figure import Plan, Tables, paper_figure, result_of, together
from comparisons.paper.studies.coated_jkr import coated_compliance, coated_pull_off
from fscm import Coating, NoSuchEvent, NotConverged, Problem, solve
from fscm.graded.compliance import compliance

__all__ = ["coated_force", "extrapolated", "layer_compliance", "layered_adhesion"]

NU = 0.3

#: Tabor numbers, of which the last five give the limit and the first five its bound.
TABOR_NUMBERS = (2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
_TERMS = 5

#: Moduli of the substrate over that of the coating, and thicknesses in (w R^2/E*)^(1/3).
_COATED = ((4.0, 0.5), (0.25, 0.5), (100.0, 0.3))
_HOMOGENEOUS = (1.0, 0.5)
#: Wave number times thickness, ratio of the moduli, Poisson's ratios of coating and substrate.
_LAYERS = ((0.1, 4.0, 0.3, 0.3), (1.0, 0.25, 0.45, 0.2), (0.5, 100.0, 0.4, 0.1))
#: A substrate that is rigid to 1e-6, and thicknesses that fall.
_RIGID, _THIN = 1e6, (0.3, 0.1, 0.03)

# Both compliances are closed to rounding: measured 4e-15 over these layers.
_U_COMPLIANCE = 1e-13

Number = tuple[float, float]


def coated_force(ratio: float, thickness: float, mu: float) -> list[float]:
    """Return the pull-off force of a coated solid by the FSCM, in pi w R, and its bound.

    Parameters
    ----------
    ratio : float
        Modulus of the substrate over that of the coating, 1 for a homogeneous solid.
    thickness : float
        In (w R^2/E*)^(1/3), E* of the coating.
    mu : float
        Tabor number with the modulus of the coating.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.

    Examples
    --------
    >>> round(coated_force(1.0, 0.5, 1.0)[0], 6)
    1.670665
    """
    solid = Coating(1.0, ratio, thickness * mu**0.5, 0.0, NU)
    with translated(NoSuchEvent, NotConverged):
        force = solve(Problem(2.0, 0.0, mu, graded=solid), "pull_off_force")
    return [force.value, force.u_num]


def layer_compliance(q: float, ratio: float, nu_coating: float, nu_substrate: float) -> float:
    """Return xi C(xi) E*/2 of a coating by the FSCM, as `comparisons.paper.studies.coated_jkr.coated_compliance`.

    Examples
    --------
    >>> round(layer_compliance(20.0, 4.0, 0.3, 0.3), 12)
    1.0
    """
    solid = Coating(1.0, ratio, 1.0, 0.0, nu_coating, nu_substrate)
    return float(compliance(solid, np.array([q]))[0]) / (2.0 * (1.0 - nu_coating**2))


def extrapolated(mu: Sequence[float], forces: Sequence[Sequence[float]]) -> Number:
    """Return the limit of a force at large mu, and its bound.

    Parameters
    ----------
    mu : sequence of float
        One more Tabor number than there are terms, rising.
    forces : sequence of pairs of float
        Value and bound at each.

    Examples
    --------
    >>> mu = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0]
    >>> value, u_num = extrapolated(mu, [(1.5 + x**-2.0 * (np.log(x) - 1.0 / x), 0.0) for x in mu])
    >>> round(value, 12), u_num < 1e-12
    (1.5, True)
    """
    m, x = np.asarray(mu, float), np.array(forces)

    def limit(selection: slice) -> Number:
        # The row of the inverse that gives the constant: its entries are the weights of the forces.
        weights = np.linalg.inv(_terms(m[selection]))[0]
        return float(weights @ x[selection, 0]), float(np.abs(weights) @ x[selection, 1])

    before, (value, u_forces) = limit(slice(-_TERMS - 1, -1)), limit(slice(-_TERMS, None))
    return value, combined(abs(value - before[0]), u_forces)


def _terms(mu: NDArray[np.float64]) -> NDArray[np.float64]:
    log = np.log(mu)
    return np.stack([np.ones_like(mu), log / mu**2, 1.0 / mu**2, log / mu**3, 1.0 / mu**3], axis=1)


def _thin_limit(thicknesses: Sequence[float], pull_offs: Sequence[dict[str, float]]) -> Number:
    """The force as the thickness falls: a parabola in thickness over contact radius; its bound is the linear term's."""
    x = np.array([thickness / pull_off["radius"] for thickness, pull_off in zip(thicknesses, pull_offs, strict=True)])
    y = np.array([pull_off["force"] for pull_off in pull_offs])
    parabola, line = float(np.polyfit(x, y, 2)[-1]), float(np.polyfit(x[1:], y[1:], 1)[-1])
    return parabola, abs(parabola - line)


@paper_figure()
def layered_adhesion() -> Plan[Tables]:
    """Coated solids against results of the literature, in the limit of large Tabor numbers."""
    results = yield from together(_plans())
    soft = {
        case: extrapolated(TABOR_NUMBERS, [results[case, mu] for mu in TABOR_NUMBERS])
        for case in (*_COATED, _HOMOGENEOUS)
    }
    # Check, origin, by whom, modulus ratio and thickness, expected and found.
    rows: list[tuple[Any, ...]] = []
    for q, ratio, *nu in _LAYERS:
        closed = float(coated_compliance(np.array([q]), ratio, *nu)[0])
        numbers = closed, _U_COMPLIANCE, results[q, ratio, *nu], _U_COMPLIANCE
        rows.append(("compliance", "published", "fscm", ratio, q, *numbers))
    rows.append(("JKR", "published", "fscm", 1.0, np.nan, 1.5, 0.0, *soft[_HOMOGENEOUS]))
    for case in _COATED:
        derived = results[case]["force"], results[case]["u_num"]
        rows.append(("coated JKR", "derived", "fscm", *case, *derived, *soft[case]))
    limit = _thin_limit(_THIN, [results[_RIGID, thickness] for thickness in _THIN])
    rows.append(("thin coating", "published", "coated JKR", _RIGID, 0.0, 2.0, 0.0, *limit))
    columns = ("check", "origin", "by", "modulus_ratio", "thickness", "expected", "u_expected", "found", "u_found")
    table = pd.DataFrame(rows, columns=columns)
    apart, bound = table["found"] - table["expected"], combined(table["u_expected"], table["u_found"])
    return {"": table.assign(agreement=np.where(apart.abs() <= bound, "agrees", "disagrees"))}


def _plans() -> dict[Any, Plan[Any]]:
    """Plans of all forces and compliances, by their cases."""
    coated = (*_COATED, *((_RIGID, thickness) for thickness in _THIN))
    plans: dict[Any, Plan[Any]] = {case: result_of(coated_pull_off, *case, NU, NU) for case in coated}
    for case in (*_COATED, _HOMOGENEOUS):
        plans |= {(case, mu): result_of(coated_force, *case, mu) for mu in TABOR_NUMBERS}
    return plans | {layer: result_of(layer_compliance, *layer) for layer in _LAYERS}
