"""Factors of units: usual ones are those of pint, which reads the others."""

import pint
import pytest

from comparisons.problem import units
from comparisons.problem.units import NotAValue, unit_factor


@pytest.fixture(scope="module")
def registry():
    return pint.UnitRegistry()


@pytest.mark.parametrize("target", sorted(units._IN_SI))
def test_a_usual_unit_has_the_factor_of_pint(target, registry):
    for prefix in units._POWERS:
        # An attopascal and the like: pint reads all of them.
        factor = registry.Quantity(1.0, prefix + target).to(target).magnitude
        assert unit_factor(prefix + target, target) == pytest.approx(factor, rel=4e-16), prefix


def test_a_usual_unit_is_read_without_pint(monkeypatch):
    monkeypatch.setattr(units, "_registry", None)
    unit_factor.cache_clear()
    assert unit_factor("mJ/m²", "J/m^2") == 1e-3
    assert unit_factor("GPa", "Pa") == 1e9


@pytest.mark.parametrize(("unit", "factor"), [("erg/cm^2", 1e-3), ("Å", 1e-10), ("min", None), ("pm^2", None)])
def test_other_units_are_read_by_pint(unit, factor):
    target = "J/m^2" if "/" in unit else "m"
    if factor is None:
        with pytest.raises(NotAValue):
            unit_factor(unit, target)
    else:
        assert unit_factor(unit, target) == pytest.approx(factor, rel=1e-12)
