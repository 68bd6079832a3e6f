"""Certified enclosure of a pull-off force: n = 2, k = 0, the 9-3 law.

Theorem, with the numbers that `pull_off_enclosure` returns.  For every displacement in [delta* - eta, delta* + eta] the
contact has exactly one equilibrium in the tube about the approximate state.  Along these equilibria P is a smooth
function of delta with P'' >= m > 0.  It has exactly one minimum there, inside the interval, and -P at it is in the
ball `force`.

Proof.  `state_bounds` encloses P and P' at delta*, and P'' on the whole interval.  If abs(P'(delta*)) < m eta, then P'
changes its sign inside the interval, and P(delta*) - P'(delta*)^2 / (2 m) <= min P <= P(delta*).

What is not proved: that no deeper minimum exists elsewhere on the path.  `fscm` decides this by its complete path.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, ctx, fmpq

from tests.certified.approximate_states import ApproximateStates, approximate_states
from tests.certified.panel_bounds import NotProved, PanelBounds, panel_bounds
from tests.certified.panel_functions import BITS
from tests.certified.sphere_form import SphereForm
from tests.certified.state_bounds import enclose

__all__ = ["PullOff", "minimum", "pull_off_enclosure"]

# Half-width of the interval of delta on which P'' > 0 is proved, and the tubes there and at its centre.
_ETA, _TUBE, _NARROW_TUBE = 2e-7, 2e-5, 1e-8


@dataclass(frozen=True)
class PullOff:
    """Enclosures at the minimum of P; `eta` and `tube` say where the equilibria are proved."""

    force: arb
    displacement: arb
    curvature: arb
    eta: arb
    tube: arb


def minimum(states: ApproximateStates, bounds: list[PanelBounds]) -> PullOff:
    """Enclose the minimum of P next to the approximate state.

    Raises
    ------
    NotProved
        If a condition of the theorem fails.
    """
    with ctx.workprec(BITS):
        eta, tube = arb(_ETA), arb(_TUBE)
        centre = enclose(states, bounds, arb(0), arb(_NARROW_TUBE))
        interval = enclose(states, bounds, eta, tube)
        m = interval.second.lower()
        slope = abs(centre.first).upper()
        if not (m > 0 and slope < m * eta):
            raise NotProved(
                f"no sign change of P' is proved: P' = {centre.first.str(5)}, P'' = {interval.second.str(5)}"
            )
        lowering = slope**2 / (2 * m)
        return PullOff(
            force=-centre.load.union(centre.load - lowering),
            displacement=arb(states.delta) + arb(0, (slope / m).upper()),
            curvature=interval.second,
            eta=eta,
            tube=tube,
        )


def pull_off_enclosure(form: SphereForm, panel_count: int) -> PullOff:
    """Approximate, bound and prove."""
    states = approximate_states(form)
    return minimum(states, panel_bounds(states, panel_count))


if __name__ == "__main__":
    ctx.dps = 20
    print(pull_off_enclosure(SphereForm(fmpq(1, 2), 6, 400), 160))
