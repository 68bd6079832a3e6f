"""Fig. 10: pull-off force from Bradley to JKR."""

import pytest

from comparisons.paper.figures import fig10_transition as transition


@pytest.mark.heavy
def test_both_limits(tables_of, monkeypatch):
    monkeypatch.setattr(transition, "_SHAPES", (2.0, 5.0))
    monkeypatch.setattr(transition, "_GRADIENTS", (0.4, 1.0))
    monkeypatch.setattr(transition, "_TABOR_NUMBERS", (0.01, 1.0, 10.0))
    table = tables_of(transition.TRANSITION)[""]
    force = table.set_index(["model", "n", "k", "mu"])["value"]
    assert (table["status"] == "ok").all()
    for n, rigid in ((2.0, 2.0), (5.0, 1.669)):
        # Printed in the paper (Eq. 56).
        assert round(force["bradley", n, 0.0, 0.01], 3) == rigid
        assert force["fscm", n, 0.4, 0.01] == pytest.approx(rigid, rel=2e-3)
        # Within 1 % of JKR at mu = 10, and not yet at 1.
        jkr = [force["jkr", n, 0.4, 10.0] * (10.0 / mu) ** (1 - 2 / n) for mu in (1.0, 10.0)]
        assert force["fscm", n, 0.4, 10.0] == pytest.approx(jkr[1], rel=0.01)
        assert force["fscm", n, 0.4, 1.0] != pytest.approx(jkr[0], rel=0.03)
    # A paraboloid on the Gibson solid has 2 at every Tabor number.
    assert [force["fscm", 2.0, 1.0, mu] for mu in (0.01, 1.0, 10.0)] == pytest.approx([2, 2, 2], rel=1e-11)


def test_every_case_is_computed_once():
    tasks = transition.TRANSITION.tasks()
    assert len(tasks) == len(set(tasks)) == 4 * 5 * 16 + 4 * 5 * 2 + 4 * 2
