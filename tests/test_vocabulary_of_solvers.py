"""Both references have the same names with the same arguments for solids, punches and laws; both solve layers."""

import inspect

import numpy as np
import pytest

import fem_reference
import fscm
from tests.layered_jkr import Stack, minima_with_error

NAMES = (
    *("PowerLaw", "Homogeneous", "OffsetPowerLaw", "Exponential", "Coating", "Layers", "TabulatedModulus"),
    *("CustomSolid", "Ball", "PowerPunch", "RoundedCone", "PowerSum", "MeasuredPunch", "CustomPunch"),
    *("LennardJones", "Mie", "TabulatedLaw"),
)
#: Arguments that one of them has besides, after the shared ones.
MORE = {
    "TabulatedLaw": ("smoothing",),
    "CustomSolid": ("surface_exponent", "depth_exponent"),
}


@pytest.mark.parametrize("name", NAMES)
def test_a_class_has_the_same_arguments_in_both(name):
    lists = [tuple(inspect.signature(getattr(package, name)).parameters) for package in (fscm, fem_reference)]
    shorter, longer = sorted(lists, key=len)
    assert longer == (*shorter, *MORE.get(name, ()))


@pytest.mark.parametrize("package", [fscm, fem_reference])
def test_the_constants_of_layers_are_those_of_their_depth(package):
    solid = package.Layers(E=[1.0, 9.0, 2.0], nu=[0.3, 0.2, 0.4], thickness=[1.0, 0.5])
    z = np.array([0.0, 0.9, 1.1, 1.4, 1.6, 1e6])
    assert solid.modulus(z).tolist() == [1.0, 1.0, 9.0, 9.0, 2.0, 2.0]
    assert solid.poisson(z).tolist() == [0.3, 0.3, 0.2, 0.2, 0.4, 0.4]
    assert solid == package.Layers(E=(1, 9, 2), nu=(0.3, 0.2, 0.4), thickness=(1, 0.5))


@pytest.mark.parametrize("package", [fscm, fem_reference])
@pytest.mark.parametrize(
    ("E", "nu", "thickness", "words"),
    [
        ([1.0], [0.3], [], "one entry more"),
        ([1.0, 2.0], [0.3], [1.0], "one entry more"),
        ([1.0, 2.0, 3.0], [0.3, 0.3], [1.0], "one entry more"),
        ([1.0, -2.0], [0.3, 0.3], [1.0], r"E\[1\] = -2"),
        ([1.0, 2.0], [0.3, 0.3], [0.0], r"thickness\[0\] = 0"),
        ([1.0, 2.0], [0.3, 0.6], [1.0], "0.6"),
        (1.0, [0.3, 0.3], [1.0], "sequence"),
    ],
)
def test_impossible_layers_are_refused(package, E, nu, thickness, words):
    with pytest.raises(ValueError, match=words):
        package.Layers(E, nu, thickness)


def _force(package, solid, z0=0.4e-9):
    solid = package.Layers(*solid)
    punch, law = package.PowerPunch(n=2, Q=1e-6), package.LennardJones(work_of_adhesion=0.05, z0=z0)
    return package.solve(package.Problem(solid, punch, law), "pull_off_force", 1e-5)


THREE = [1e9, 3e9, 9e9, 2e9], [0.3, 0.4, 0.2, 0.35], [10e-9, 20e-9, 15e-9]


def test_one_layer_is_a_coating():
    law, punch = fscm.LennardJones(0.05, 0.4e-9), fscm.PowerPunch(2, 1e-7)
    solids = fscm.Layers([1e9, 3e9], [0.3, 0.4], [1e-8]), fscm.Coating(1e9, 3e9, 1e-8, 0.0, 0.3, 0.4)
    forces = [fscm.solve(fscm.Problem(solid, punch, law), "pull_off_force", 1e-5) for solid in solids]
    assert forces[0].value == pytest.approx(forces[1].value, rel=1e-12)


@pytest.mark.heavy
def test_both_references_agree_on_three_layers():
    integral, elements = (_force(package, THREE) for package in (fscm, fem_reference))
    assert abs(integral.value - elements.value) <= integral.u_num + elements.u_num < 1e-5 * integral.value


@pytest.mark.heavy
def test_a_short_range_on_three_layers_tends_to_jkr():
    """The difference to JKR falls with the range of the law."""
    soft = [3e7, 1e8, 2e7, 5e7], *THREE[1:]
    E, nu, thickness = soft
    stack = Stack(tuple(zip(E[:-1], nu[:-1], thickness, strict=True)), (E[-1], nu[-1]))
    jkr = -min(minimum.load for minimum in minima_with_error(stack, 0.05, 1e-6))
    errors = [abs(_force(fscm, soft, z0).value / jkr - 1.0) for z0 in (0.8e-9, 0.4e-9, 0.2e-9)]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 5e-3
