"""Contact initiation near k = 1: the radius of the first contact grows through many decades."""

from __future__ import annotations

import numpy as np

from fscm._surface.state import Rates, State

__all__ = ["gap_at_first_contact"]

#: Above this k contact begins at a radius many decades smaller than that of the punch, with a gap at its edge above
#: that of largest tension until it has grown: this edge is followed.  Below, contact initiation takes few points of a
#: path.
_NARROW = 0.8
#: The first contact is inside the share _SMALL of the radius at which the punch has the height _FLAT_HEIGHT; its gap is
#: below the gap there by the share _DEEP of its distance to the singular gap; log c grows at least by _GROWING.
_FLAT_HEIGHT, _SMALL, _DEEP, _GROWING = 0.02, 0.05, 0.2, 0.3


def gap_at_first_contact(state: State, rates: Rates) -> float | None:
    """The gap at the edge of a small growing first contact, if there is one."""
    problem, mesh = state.disc.problem, state.disc.mesh
    if state.anchor.in_contact or problem.k <= _NARROW:
        return None
    flat = int(np.argmax(problem.punch.height(state.radius) >= _FLAT_HEIGHT)) - 1
    inner = state.central_gap
    if flat < 1 or state.gap[flat] - inner < _DEEP * (inner - problem.law.singular_gap):
        return None
    # The front is where the gap is steepest in log r: it decays slowly farther out.
    gap, log_r = state.gap[: flat + 1], np.log(mesh.nodes[: flat + 1])
    slopes = np.diff(gap) / np.diff(log_r)
    i = int(np.argmax(slopes))
    if mesh.nodes[i + 1] > _SMALL * mesh.nodes[flat]:
        return None
    front = 0.5 * float(gap[i] + gap[i + 1])
    # Growth at a fixed share of the depth: the radius of a fixed gap also grows while the contact forms.
    share = (front - inner) / (float(gap[flat]) - inner)
    moving = state.change_of_gap(rates.unknowns, rates.displacement, rates.log_scale)
    change = (1.0 - share) * rates.central_gap + share * moving[flat] - 0.5 * (moving[i] + moving[i + 1])
    return front if change > _GROWING * slopes[i] else None
