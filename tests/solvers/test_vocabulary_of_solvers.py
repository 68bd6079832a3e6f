"""Both references have the same names with the same arguments for solids, punches and laws; both solve layers."""

import importlib
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

#: Keywords that a dimensionless problem, which `fscm` alone solves, need not state.
SCALES = {
    "PowerPunch": ("Q",),
    "LennardJones": ("work_of_adhesion", "z0"),
    "Mie": ("work_of_adhesion", "z0", "m", "n"),
}


def arguments(package, name):
    """Keywords of a class and their defaults; the scales of a dimensionless problem have one in `fscm` alone."""
    parameters = inspect.signature(getattr(package, name)).parameters
    return {word: None if word in SCALES.get(name, ()) else rule.default for word, rule in parameters.items()}


@pytest.mark.parametrize("name", NAMES)
def test_a_class_has_the_same_arguments_with_the_same_defaults_in_both(name):
    of_fscm, of_elements = arguments(fscm, name), arguments(fem_reference, name)
    assert list(of_fscm.items()) == list(of_elements.items())


def test_the_names_of_a_package_are_listed_once():
    for package in (fscm, fem_reference):
        assert sorted(package.__all__) == sorted(set(dir(package)))
        assert {*NAMES, "solve"} <= set(package.__all__)


@pytest.mark.parametrize(
    "module",
    [
        "cohesive_laws",
        "custom_punch",
        "custom_solid",
        "dlvo",
        "laws",
        "layers",
        "measured_punch",
        "punch",
        "solids",
        "tabulated_law",
        "tabulated_modulus",
    ],
)
def test_the_names_of_solids_punches_and_laws_are_names_of_the_package(module):
    module = importlib.import_module(f"fscm.{module}")
    assert [name for name in module.__all__ if getattr(fscm, name) is not getattr(module, name)] == []


@pytest.mark.parametrize("package", [fscm, fem_reference])
def test_a_solid_of_the_other_reference_is_refused_by_a_problem_or_solved(package):
    """An exponential of the finite elements has what the integral equation needs; its value is that of its own."""
    other = fem_reference if package is fscm else fscm
    parts = package.PowerPunch(2.0, 10.0), package.LennardJones(1.0, 1.0)
    for solid in (other.PowerLaw(1.0, 1.0, 0.4, 0.3), other.Coating(1.0, 2.0, 1.0, 0.0, 0.3)):
        with pytest.raises(ValueError, match="solid"):
            package.Problem(solid, *parts)
    constants = 1.0, 2.0, 1.0, 0.3
    if package is fem_reference:
        with pytest.raises(ValueError, match="solid"):
            package.Problem(other.Exponential(*constants), *parts)
        return
    values = [
        fscm.solve(fscm.Problem(body.Exponential(*constants), *parts), "pull_off_force") for body in (fscm, other)
    ]
    assert values[0].value == pytest.approx(values[1].value, rel=1e-12)


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
