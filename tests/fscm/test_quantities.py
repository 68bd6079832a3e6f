"""The table of quantities: a row is enough, and none is without its value from elsewhere."""

import pytest

import fem_reference.quantities
from comparisons.quantities import QUANTITIES as COMPARED
from fscm import NoSuchEvent, Problem, quantities, solve
from fscm.gibson import GibsonSolid
from fscm.quantities import EVENTS, FUNCTIONALS, TABLE, AtEvent, Quantity
from tests.marks import heavy
from tests.reference_values import REFERENCE_VALUES
from tests.refusals import refused

PROBLEM = Problem(2, 0.4, 1.0)
ROWS = [(event, functional) for event in EVENTS for functional in FUNCTIONALS]
#: A row that is in no table: the energy of a state, which changes by P d(delta) along the path.
LIGHT = [("pull_off", "energy"), ("jump_out", "energy"), ("zero_load", "energy"), ("jump_in", "load")]


@pytest.mark.parametrize(("event", "functional"), [*LIGHT, *heavy(*(row for row in ROWS if row not in LIGHT))])
def test_a_row_is_enough_for_a_quantity_with_its_bound(event, functional, monkeypatch):
    monkeypatch.setitem(TABLE, "new", AtEvent("number", event, functional))
    coarse, fine = (solve(PROBLEM, "new", accuracy) for accuracy in ("quick", "fine"))
    assert abs(coarse.value - fine.value) <= coarse.u_num + fine.u_num
    assert fine.u_num < 1e-8 * (1.0 + abs(fine.value))


def test_a_row_of_an_unknown_event_or_functional_is_refused():
    refused("event = 'landing' of a quantity is unknown", AtEvent, "load", "landing", "load")
    refused("functional = 'force' of a quantity is unknown", AtEvent, "load", "pull_off", "force")


def test_a_row_of_no_kind_that_is_computed_is_no_number(monkeypatch):
    monkeypatch.setitem(TABLE, "new", Quantity("load"))
    with pytest.raises(TypeError):
        solve(PROBLEM, "new")


@pytest.mark.parametrize("quantity", TABLE)
def test_a_quantity_is_known_everywhere_and_has_a_reference_value(quantity):
    assert quantity in COMPARED
    assert quantity in {reference.quantity for reference in REFERENCE_VALUES}
    gibson = GibsonSolid(Problem(2, 1.0, 1.2))
    if quantity == "jump_out_gap":
        with pytest.raises(NoSuchEvent):
            gibson.solution(quantity)
    else:
        assert gibson.solution(quantity).u_num < 1e-8


def test_each_compared_quantity_has_its_row_in_both_references():
    """The critical Tabor number is that of a modulus in physical units."""
    assert set(COMPARED) == set(TABLE) == set(quantities.QUANTITIES)
    assert set(COMPARED) - {"critical_tabor_number"} <= set(fem_reference.quantities.TABLE)
