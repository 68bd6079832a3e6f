"""The ring code against closed forms; reference values and `fscm` against the ring code."""

import numpy as np
import pytest
from scipy.special import gamma, hyp1f1

from fscm import Problem
from fscm import solve as fscm_solve
from tests.fscm import ring_code
from tests.marks import heavy
from tests.reference_values import REFERENCE_VALUES

# Measured worst: 2e-12 of the pull-off force (n = 1, k = 0.6, mu = 0.5: 4.6e-13 of 4.3; n = 2, k = 0, mu = 0.1: 6e-13).
AGREEMENT = 1e-11
# An extreme of the load gives its place to the root of the accuracy of its value; measured worst 2e-11.
AGREEMENT_OF_PLACE = 1e-9

CASES = [
    ("pull_off", 2.0, 0.0, 0.1),
    ("jump_in", 5.0, 0.4, 3.0),
    # Those that take longer.
    ("pull_off", 2.0, 0.4, 0.5),
    ("pull_off", 2.0, 0.0, 0.5),
    ("pull_off", 2.0, 0.0, 1.0),
    ("pull_off", 2.0, 0.0, 2.0),
    ("pull_off", 2.0, 0.4, 1.0),
    ("pull_off", 2.0, 0.4, 1.4),
    ("pull_off", 3.0, 0.2, 1.0),
    ("pull_off", 5.0, 0.4, 0.6),
    ("pull_off", 1.5, 0.8, 0.3),
    ("pull_off", 1.0, 0.0, 0.5),
    ("pull_off", 1.0, 0.3, 0.2),
    ("pull_off", 1.0, 0.6, 0.5),
    ("jump_in", 2.0, 0.6, 3.0),
    ("jump_in", 2.0, 0.0, 1.5),
    ("jump_out", 2.0, 0.0, 1.5),
]


@pytest.mark.parametrize("k", [0.0, 0.9])
def test_displacement_under_a_gaussian_pressure(k: float) -> None:
    """The transforms of exp(-r^2) are M (1-k)/2 Gamma((1-k)/2) 1F1((1+k)/2; 1; -r^2); M = 2 at mu = 1."""
    breaks = np.concatenate([np.arange(0.0, 8.0, 0.25), 8.0 * 2.0 ** np.arange(5)])
    surface = ring_code.Surface(2.0, k, 1.0, breaks)
    exact = (1 - k) * gamma((1 - k) / 2) * hyp1f1((1 + k) / 2, 1.0, -(surface.radius**2))
    # Measured worst 3e-14, k = 0.9.
    assert np.allclose(surface.response @ np.exp(-(surface.radius**2)), exact, rtol=1e-13, atol=0.0)


@pytest.mark.parametrize(("event", "n", "k", "mu"), [*CASES[:2], *heavy(*CASES[2:])])
def test_fscm_and_the_reference_values(event: str, n: float, k: float, mu: float) -> None:
    """Two codes that share no line, to 1e-11; and every digit of the table."""
    state = ring_code.solve(n, k, mu, event)
    results = {f"{event}_displacement": state.displacement}
    if event == "pull_off":
        results["pull_off_force"] = -state.load
    for quantity, value in results.items():
        tolerance = AGREEMENT_OF_PLACE if quantity == "pull_off_displacement" else AGREEMENT
        assert fscm_solve(Problem(n, k, mu), quantity).value == pytest.approx(value, abs=tolerance, rel=tolerance)
        for row in REFERENCE_VALUES:
            if (row.quantity, row.n, row.k, row.mu) == (quantity, n, k, mu):
                assert abs(value - row.value) <= 0.5 * row.last_digit + AGREEMENT


def test_an_event_that_does_not_exist() -> None:
    """A stiff solid does not jump: no number."""
    with pytest.raises(ring_code.RingCodeFailed, match="no jump_out"):
        ring_code.solve(2.0, 0.0, 0.1, "jump_out")
