"""The fields, pictures and refusals of ``fscm-bench fem``."""

from functools import partial

import meshio
import numpy as np
import pytest

import fem_reference
from comparisons.cli.main import main

CASE = ["fem", "--n", "2", "--k", "0.4", "--mu", "0.5"]


def test_fields_for_paraview(tmp_path, monkeypatch):
    """The vtu holds the strength of the law as surface stress, in dimensionless units, and a picture is drawn.

    On the coarsest meshes, which have it to five digits.
    """
    monkeypatch.setattr(fem_reference, "event_state", partial(fem_reference.event_state, accuracy="quick"))
    vtu, picture = tmp_path / "body.vtu", tmp_path / "body.png"
    assert main([*CASE, "--vtu", str(vtu), "--plot", str(picture)]) == 0
    mesh = meshio.read(vtu)
    assert set(mesh.point_data) >= {"displacement", "modulus", "von_mises", "sigma_zz"}
    surface = np.abs(mesh.points[:, 1]) < 1e-6
    # Tension at the surface is at most the theoretical strength 16 sqrt(3) / 27, and reaches it at pull-off.
    assert mesh.point_data["sigma_zz"][surface].max() == pytest.approx(1.0264, abs=5e-3)
    assert mesh.points[:, 1].max() <= 0.0
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fem"], "nothing to do"),
        (["fem", "--vtu", "x.vtu", "--n", "2"], "--k, --mu"),
        ([*CASE, "--vtu", "x.vtk"], "vtu"),
        ([*CASE, "--plot", "x.png", "--nu", "0.5"], "nu"),
        (["fem", "--n", "-1", "--k", "0", "--mu", "1", "--plot", "x.png"], "n = -1"),
    ],
)
def test_bad_input_is_one_sentence(arguments, message, refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused(arguments, message)
