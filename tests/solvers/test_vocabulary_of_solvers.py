"""Both references have the same names with the same arguments for solids, punches and laws; both solve layers."""

import inspect
import math

import numpy as np
import pytest

import fem_reference
import fscm

NAMES = (
    *("PowerLaw", "Homogeneous", "OffsetPowerLaw", "Exponential", "Coating", "Layers", "TabulatedModulus"),
    *("CustomSolid", "Ball", "PowerPunch", "RoundedCone", "PowerSum", "MeasuredPunch", "CustomPunch"),
    *("LennardJones", "Mie", "TabulatedLaw"),
)
#: Arguments that one of them has besides the shared ones, which have one order.
MORE = {
    "TabulatedLaw": ("smoothing",),
    "CustomSolid": ("surface_exponent", "depth_exponent"),
}


def test_the_names_of_a_package_are_listed_once():
    for package in (fscm, fem_reference):
        assert sorted(package.__all__) == sorted(set(dir(package)))
        assert {*NAMES, "solve"} <= set(package.__all__)


def test_a_class_has_the_same_arguments_in_both():
    for name in NAMES:
        lists = [tuple(inspect.signature(getattr(package, name)).parameters) for package in (fscm, fem_reference)]
        shorter, longer = sorted(lists, key=len)
        assert tuple(argument for argument in longer if argument not in MORE.get(name, ())) == shorter, name


@pytest.mark.parametrize("package", [fscm, fem_reference])
def test_the_constants_of_layers_are_those_of_their_depth(package):
    solid = package.Layers(E=[1.0, 9.0, 2.0], nu=[0.3, 0.2, 0.4], thickness=[1.0, 0.5])
    z = np.array([0.0, 0.9, 1.1, 1.4, 1.6, 1e6])
    assert solid.modulus(z).tolist() == [1.0, 1.0, 9.0, 9.0, 2.0, 2.0]
    assert solid.poisson(z).tolist() == [0.3, 0.3, 0.2, 0.2, 0.4, 0.4]
    assert solid == package.Layers(E=(1, 9, 2), nu=(0.3, 0.2, 0.4), thickness=(1, 0.5))


@pytest.mark.parametrize("package", [fscm, fem_reference])
def test_impossible_solids_are_refused(package):
    for name, arguments, words in (
        ("OffsetPowerLaw", (1.0, 1.0, 1.0, 1.0, 0.3), r"k = 1.0 is outside \[0, 1\)"),
        ("OffsetPowerLaw", (1.0, 1.0, 0.4, 0.0, 0.3), r"z_s = 0.0 is outside \(0, inf"),
        ("Exponential", (-1.0, 1.0, 1.0, 0.3), r"E_surface = -1.0 is outside \(0, inf"),
        ("Exponential", (1.0, -1.0, 1.0, 0.3), "E_depth = -1.0"),
        ("Exponential", (1.0, 1.0, math.nan, 0.3), "length = nan"),
        ("Coating", (1.0, 0.0, 1.0, 0.0, 0.3), "E_substrate = 0.0 is outside"),
        ("Coating", (1.0, 1.0, 1.0, -1.0, 0.3), r"transition = -1.0 is outside \[0, inf"),
        ("Coating", (1.0, 1.0, 1.0, 0.0, 0.6), r"nu\w* = 0.6 is outside \[0, 0.5"),
        ("TabulatedModulus", ([0.0], [1.0], 0.3), "not form a table"),
        ("TabulatedModulus", ([0.0, 2.0, 1.0], [1.0, 1.0, 1.0], 0.3), "depth.* 1 .*is not above"),
        ("TabulatedModulus", ([-1.0, 1.0], [1.0, 2.0], 0.3), "depth.* -1.* is outside"),
        ("TabulatedModulus", ([0.0, 1.0], [1.0, math.nan], 0.3), "nan"),
        ("TabulatedModulus", ([0.0, 1.0], [1.0, 0.0], 0.3), "modul.* 0.* is outside"),
        ("TabulatedModulus", ("ab", [1.0, 2.0], 0.3), "number"),
        ("CustomSolid", (lambda z: 1 - z, 0.3, 1.0), r"modulus .*outside \(0, inf"),
        ("CustomSolid", (lambda z: 1.0, 0.3, 1.0), "shape"),
        ("Layers", ([1.0], [0.3], []), "one entry more"),
        ("Layers", ([1.0, 2.0], [0.3], [1.0]), "one entry more"),
        ("Layers", ([1.0, 2.0, 3.0], [0.3, 0.3], [1.0]), "one entry more"),
        ("Layers", ([1.0, -2.0], [0.3, 0.3], [1.0]), r"E\[1\] = -2"),
        ("Layers", ([1.0, 2.0], [0.3, 0.3], [0.0]), r"thickness\[0\] = 0"),
        ("Layers", ([1.0, 2.0], [0.3, 0.6], [1.0]), "0.6"),
        ("Layers", (1.0, [0.3, 0.3], [1.0]), "sequence"),
    ):
        with pytest.raises(ValueError, match=words):
            getattr(package, name)(*arguments)
