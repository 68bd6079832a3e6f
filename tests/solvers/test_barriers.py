"""Laws with a barrier by both references."""

from __future__ import annotations

import math

import numpy as np
import pytest

import fem_reference
import fscm
from fscm._units import modulus_for
from tests.marks import heavy

#: Double layer, as a share of 8 w/(3 z0) of the law without one, its length in z0, and the Tabor number.
BARRIERS = [(1.0, 1.0, 0.3), (1.0, 1.0, 1.0), (0.8, 1.0, 0.7), (7.5e-3, 15.0, 3.0), (7.5e-4, 48.0, 3.0)]
QUANTITIES = ("pull_off_force", "jump_in_displacement", "jump_out_displacement", "hysteresis_energy")


def values(share: float, length: float, mu: float, quantity: str, accuracy: str) -> list[tuple[float, float]]:
    """Value and bound of both references, dimensionless."""
    parameters = 16.0 * math.pi, 1.0, 8.0 / 3.0 * share, length
    law = fem_reference.Dlvo(*parameters)
    w = law.work_of_adhesion
    solid, sphere = fem_reference.Homogeneous(w * mu**-1.5, 0.0), fem_reference.PowerPunch(n=2.0, Q=1.0)
    elements = fem_reference.solve(fem_reference.Problem(solid, sphere, law), quantity, accuracy)
    unit = math.pi * w if quantity in ("pull_off_force", "hysteresis_energy") else 1.0
    integral = fscm.solve(fscm.Problem(n=2.0, k=0.0, mu=mu, law=fscm.Dlvo(*parameters)), quantity)
    return [(integral.value, integral.u_num), (elements.value / unit, elements.u_num / unit)]


def check(barrier: tuple[float, float, float], quantity: str, accuracy: str = "default") -> None:
    try:
        (a, u_a), (b, u_b) = values(*barrier, quantity, accuracy)
    except fscm.NoSuchEvent:
        with pytest.raises(fem_reference.NoSuchEvent):
            values(*barrier, quantity, accuracy)
        return
    assert abs(a - b) <= u_a + u_b
    assert u_b <= 1e-4 * (1.0 + abs(b))


def test_the_pull_off_force_of_one_barrier() -> None:
    check(BARRIERS[4], "pull_off_force", "quick")


@pytest.mark.heavy
@pytest.mark.parametrize("barrier", BARRIERS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_quantity_of_five_barriers(barrier: tuple[float, float, float], quantity: str) -> None:
    check(barrier, quantity)


@pytest.mark.parametrize("barrier", BARRIERS)
def test_both_laws_are_the_same(barrier: tuple[float, float, float]) -> None:
    parameters = 16.0 * math.pi, 1.0, 8.0 / 3.0 * barrier[0], barrier[1]
    ours, theirs = fscm.Dlvo(*parameters), fem_reference.Dlvo(*parameters)
    gap = np.geomspace(0.5, 1e3, 60) - ours.distance
    assert theirs.distance == pytest.approx(ours.distance, rel=1e-13)
    assert theirs.work_of_adhesion == pytest.approx(ours.work_of_adhesion, rel=1e-11)
    assert theirs.peak_gap == pytest.approx(ours.peak_gap, rel=1e-12, abs=1e-13)
    for name in ("traction", "slope", "energy"):
        assert getattr(theirs, name)(gap) == pytest.approx(getattr(ours, name)(gap), rel=1e-9, abs=1e-13)


#: Double layer and length as above, Tabor number, n and k, and the units of length and pressure.
OTHERS = [
    (1.0, 1.0, 1.0, 4.0, 0.0, 1.0, 1.0),
    (1.0, 1.0, 1.0, 2.0, 0.4, 1.0, 1.0),
    (1.0, 1.0, 0.7, 1.5, 0.0, 1.0, 1.0),
    (7.5e-3, 15.0, 2.0, 2.0, 0.0, 1e3, 1e-3),
]


@pytest.mark.parametrize(
    ("barrier", "accuracy"), [(OTHERS[0], "quick"), *heavy(*((case, "default") for case in OTHERS))]
)
def test_other_punches_gradients_and_units(barrier: tuple[float, ...], accuracy: str) -> None:
    """In physical units, far from one, and both by the same numbers."""
    share, length, mu, n, k, unit, pressure = barrier
    parameters = 16.0 * math.pi * pressure * unit**3, unit, 8.0 / 3.0 * share * pressure, length * unit
    w, Q = fscm.Dlvo(*parameters).work_of_adhesion, unit ** (n - 1.0)
    E0 = modulus_for(mu, n=n, k=k, nu=0.3, c0=unit, Q=Q, work_of_adhesion=w, z0=unit)
    problems = [
        module.Problem(module.PowerLaw(E0, unit, k, 0.3), module.PowerPunch(n, Q), module.Dlvo(*parameters))
        for module in (fscm, fem_reference)
    ]
    ours = fscm.solve(problems[0], "pull_off_force")
    elements = fem_reference.solve(problems[1], "pull_off_force", accuracy)
    assert abs(ours.value - elements.value) <= ours.u_num + elements.u_num
    assert elements.u_num <= 1e-4 * elements.value
