"""Finite elements against the FSCM on random problems: neither bound knows of the other method."""

import math
from functools import lru_cache

import pytest

import fscm
from tests.fem_reference.random_problems import TABLE, problems, rows
from tests.random_tables import stored

SAMPLE = 80
"""Every so many problems of the table are compared in the light test."""

UNIT = {"pull_off_force": math.pi, "hysteresis_energy": math.pi}
"""Of the finite elements in units of the FSCM: forces and energies are divided by pi Q w."""


@lru_cache(maxsize=1)
def _table():
    table = {}
    for row in stored(TABLE):
        table.setdefault(int(row["number"]), []).append(row)
    return table


@lru_cache
def _by_fscm(number):
    n, k, mu, _ = problems(number + 1)[number]
    names = [row["quantity"] for row in _table()[number] if row["quantity"] in fscm.QUANTITIES]
    try:
        return fscm.solve_together(fscm.Problem(n, k, mu), names)
    except fscm.NotConverged:
        return {}


def _disagreements(number, elements):
    """Quantities whose values differ by more than both bounds, or that exist by one method only."""
    other = _by_fscm(number)
    differing = {}
    for row in elements:
        name, status = row["quantity"], row["status"]
        if name not in other or status == "NotConverged":
            continue
        if status != "value" or not isinstance(other[name], fscm.Solution):
            if status != type(other[name]).__name__:
                differing[name] = (status, other[name])
            continue
        unit = UNIT.get(name, 1.0)
        difference = abs(float(row["value"]) / unit - other[name].value)
        bounds = float(row["u_num"]) / unit + other[name].u_num
        if not difference <= bounds:
            differing[name] = (difference, bounds)
    return differing


def test_a_sample_of_the_table_agrees_within_both_bounds():
    numbers = sorted(_table())[::SAMPLE]
    assert numbers
    assert {number: pairs for number in numbers if (pairs := _disagreements(number, _table()[number]))} == {}


@pytest.mark.heavy
@pytest.mark.parametrize("number", sorted(_table()))
def test_every_problem_agrees_within_both_bounds(number):
    """The values of the table, and those of the elements now, which stay within their bounds of the table."""
    assert _disagreements(number, _table()[number]) == {}
    now = rows(number)
    assert _disagreements(number, now) == {}
    for old, new in zip(_table()[number], now, strict=True):
        assert (old["quantity"], old["status"]) == (new["quantity"], new["status"])
        if old["status"] == "value":
            assert abs(float(old["value"]) - new["value"]) <= float(old["u_num"]) + new["u_num"]


def test_a_value_outside_both_bounds_is_found():
    sample = [(number, _table()[number]) for number in sorted(_table())[::SAMPLE]]
    number, elements = next((number, table) for number, table in sample if table[0]["status"] == "value")
    worse = [{**row, "value": float(row["value"]) + 2.0 * float(row["u_num"]) + 1e-6} for row in elements[:1]]
    assert set(_disagreements(number, worse)) == {elements[0]["quantity"]}
    absent = [{**elements[0], "status": "NoSuchEvent"}]
    assert set(_disagreements(number, absent)) == {elements[0]["quantity"]}
