"""The finite elements with finite strain as a model: its curve, the bound of that, and what it refuses."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
from comparisons.cli.main import main
from comparisons.description.strain_errors import ball_on
from comparisons.models.fem_model import LargeStrain
from comparisons.numerics.curve_distance import curve_distance

GEL = ball_on(5e-3, 2.0, 0.3)

#: Largest bound of a curve (measured: 1.0e-5 for nu = 0.3 and 0.5, w/(E* R) = 5e-3 and mu = 2).
LARGEST_BOUND = 3e-5

FILE = """\
[solid]
kind = "power-law"
E0 = "2 MPa"
c0 = "1 um"
k = 0.3
nu = 0.3
[punch]
kind = "ball"
R = "5 um"
[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "10 mJ/m^2"
z0 = "50 nm"
"""


def test_the_bound_of_a_curve_is_the_largest_of_its_points_in_parts_of_the_picture(monkeypatch):
    units = GEL.units
    zeros = np.zeros(3)
    path = SimpleNamespace(
        displacement=np.array([-4.0, -2.0, 0.0]) * units["displacement"],
        load=np.array([0.0, -1.0, 1.0]) * units["load"],
        central_gap=zeros,
        edge_radius=zeros,
        u_displacement=np.array([0.0, 0.012, 0.0]) * units["displacement"],
        u_load=np.array([0.0, 0.008, 0.009]) * units["load"],
    )
    monkeypatch.setattr(fem_reference, "trace_large_strain", lambda body: path)
    curve = LargeStrain().curve(GEL)
    assert curve.displacement == pytest.approx([-4.0, -2.0, 0.0])
    assert curve.load == pytest.approx([0.0, -1.0, 1.0])
    assert curve.u_distance == pytest.approx(math.hypot(0.003, 0.004))


@pytest.mark.heavy
def test_a_curve_on_finer_meshes_is_within_both_bounds(monkeypatch):
    curve = LargeStrain().curve(GEL)
    assert curve.u_distance < LARGEST_BOUND
    trace = fem_reference.trace_large_strain
    monkeypatch.setattr(fem_reference, "trace_large_strain", lambda body: trace(body, accuracy="default"))
    finer = LargeStrain().curve(GEL)
    distance = curve_distance(curve.displacement, curve.load, finer.displacement, finer.load)
    assert distance.value <= curve.u_distance + finer.u_distance + distance.u_interpolation


@pytest.mark.parametrize(
    "arguments",
    [
        ["describe", "FILE", "--large-strain"],
        ["solve", "--model", "fem-large-strain", "--quantity", "pull_off_force", "--problem", "FILE"],
        ["curve", "--model", "fem-large-strain", "--problem", "FILE"],
    ],
    ids=["describe", "solve", "curve"],
)
def test_a_modulus_that_vanishes_at_the_surface_is_wrong_input(arguments, tmp_path, capsys):
    file = tmp_path / "graded.toml"
    file.write_text(FILE)
    assert main([str(file) if argument == "FILE" else argument for argument in arguments]) == 2
    printed, sentence = capsys.readouterr()
    assert not printed
    assert len(sentence.strip().splitlines()) == 1
    assert "vanishes at the surface" in sentence
