"""Surface compliance of graded solids against layers and other forms of one solid."""

import numpy as np
import pytest

from fscm import CustomSolid, TabulatedModulus
from fscm.errors import NotConverged
from fscm.graded.compliance import compliance
from fscm.solids import contact_modulus
from tests.solvers.layered_jkr import Stack

XI = np.geomspace(1e-4, 1e4, 25)


def test_sharp_layers_are_those_of_a_code_of_their_own():
    rng = np.random.default_rng(4)
    ends = np.append(0.0, np.sort(rng.uniform(0.0, 3.0, 6)))
    moduli = rng.uniform(0.2, 5.0, 7)
    solid = CustomSolid(lambda z: moduli[np.searchsorted(ends[1:], z, side="right")], 0.3, 1.0, ends[1:])
    xi = np.array([0.05, 0.5, 2.0, 8.0])
    layers = tuple((E, 0.3, thickness) for E, thickness in zip(moduli[:-1], np.diff(ends), strict=True))
    stack = Stack(layers, (moduli[-1], 0.3))
    relative = 0.5 * contact_modulus(solid) * compliance(solid, xi)
    assert relative == pytest.approx(stack.relative_compliance(xi), rel=1e-11)


def test_tabulated_modulus_is_its_interpolant():
    solid = TabulatedModulus([0.0, 1.0, 2.0, 5.0], [1.0, 3.0, 4.0, 10.0], 0.3)
    same = CustomSolid(solid.modulus, 0.3, 1.0, [1.0, 2.0, 5.0])
    assert np.array_equal(compliance(solid, XI), compliance(same, XI))


def test_a_jump_that_is_no_interface_is_refused():
    solid = CustomSolid(lambda z: np.where(z < 1.0, 1.0, 2.0), 0.3, 1.0)
    with pytest.raises(NotConverged, match="jumps near the depth 1"):
        compliance(solid, np.array([1.0]))
