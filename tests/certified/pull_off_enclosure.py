"""Certified enclosures of local minima of the load: n = 2, k = 0, the 9-3 law.

Theorem, with the numbers that `pull_off_enclosure` returns.  For every displacement in [delta* - eta, delta* + eta] the
contact has exactly one equilibrium in the tube about the approximate state.  Along these equilibria P is a smooth
function of delta with P'' >= m > 0.  It has exactly one minimum there, inside the interval, and -P at it is in the
ball `force`.

Proof.  `state_bounds` encloses P and P' at delta*, and P'' on the whole interval.  If abs(P'(delta*)) < m eta, then P'
changes its sign inside the interval, and P(delta*) - P'(delta*)^2 / (2 m) <= min P <= P(delta*).

What is not proved here: that no deeper minimum exists elsewhere on the path.  `branch` proves it for mu = 1/10; `fscm`
decides it for the others by its complete path.

The tests prove the committed values again.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, ctx, fmpq

from tests.certified.approximate_states import ApproximateStates, approximate_states
from tests.certified.panel_bounds import NotProved, PanelBounds, panel_bounds
from tests.certified.panel_functions import BITS
from tests.certified.sphere_form import SphereForm
from tests.certified.state_bounds import enclose

# Tubes of the proof at delta* and on the interval, in units of W; wide enough for the states, narrow enough for N.
_NARROW_TUBE, _TUBE = arb(1e-8), arb(1e-5)


@dataclass(frozen=True)
class PullOff:
    """Balls of the pull-off force, of its displacement, and of P'' on the whole interval."""

    force: arb
    displacement: arb
    curvature: arb


@dataclass(frozen=True)
class Certified:
    """A committed enclosure and the sizes with which it is proved; radii are rounded up by a fifth.

    Attributes
    ----------
    eta : float
        Half-width of the interval of displacements.
    force, displacement : str
        Ball "[midpoint +/- radius]".
    """

    form: SphereForm
    panel_count: int
    eta: float
    force: str
    displacement: str


CERTIFIED = {
    "mu = 1/10": Certified(
        SphereForm(fmpq(1, 10), 5, 240),
        80,
        1e-3,
        "[1.96895637932829 +/- 1e-11]",
        "[-0.058632631557597 +/- 1.2e-12]",
    ),
    "mu = 1/2": Certified(
        SphereForm(fmpq(1, 2), 6, 400),
        160,
        1e-4,
        "[1.78748293102689 +/- 6e-13]",
        "[-0.447016584589004 +/- 8e-13]",
    ),
    "mu = 1": Certified(
        SphereForm(fmpq(1), 4, 500),
        200,
        2e-5,
        "[1.6706647764763 +/- 1.6e-12]",
        "[-0.87337951490526 +/- 2.9e-11]",
    ),
}
"""Enclosures by the Tabor number."""


def minimum(states: ApproximateStates, bounds: list[PanelBounds], eta: float) -> PullOff:
    """Enclose the minimum of P next to the approximate state.

    Raises
    ------
    NotProved
        If a condition of the theorem fails.
    """
    with ctx.workprec(BITS):
        centre = enclose(states, bounds, arb(0), _NARROW_TUBE)
        interval = enclose(states, bounds, arb(eta), _TUBE)
        m = interval.second.lower()
        slope = abs(centre.first).upper()
        # A comparison with a number that is not finite is False.
        if not (centre.load.is_finite() and m > 0 and slope < m * arb(eta)):
            slopes = f"P' = {centre.first.str(5)}, P'' = {interval.second.str(5)}"
            raise NotProved(f"no change of the sign of P' is proved: {slopes}")
        return PullOff(
            force=-centre.load.union(centre.load - slope * slope / (2 * m)),
            displacement=arb(states.delta) + arb(0, (slope / m).upper()),
            curvature=interval.second,
        )


def pull_off_enclosure(certified: Certified) -> PullOff:
    """Approximate next to the committed displacement, bound and prove."""
    states = approximate_states(certified.form, float(arb(certified.displacement)))
    return minimum(states, panel_bounds(states, certified.panel_count), certified.eta)
