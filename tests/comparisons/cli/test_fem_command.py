"""The fields, pictures and refusals of ``fscm-bench fem``."""

from functools import partial
from pathlib import Path

import meshio
import numpy as np
import pandas as pd
import pytest

import fem_reference
from comparisons.cli.main import main
from comparisons.output.figures import references

CASE = ["fem", "--n", "2", "--k", "0.4", "--mu", "0.5"]


def test_fields_for_paraview(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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
        (["fem", "--vtu", "x.vtu", "--n", "2"], "give --k, --mu too"),
        ([*CASE, "--vtu", "x.vtk"], "vtu"),
        ([*CASE, "--plot", "x.png", "--nu", "0.5"], "nu"),
        (["fem", "--n", "-1", "--k", "0", "--mu", "1", "--plot", "x.png"], "n = -1"),
    ],
)
def test_bad_input_is_one_sentence(arguments, message, capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert "Traceback" not in captured.err
    assert captured.out == ""


def test_picture_of_both_references() -> None:
    """One line and one row of points a case, in both panels."""
    rows = [
        {"model": m, "quantity": q, "n": 2.0, "k": 0.4, "mu": 1.0, "point": i, "x": x, "y": -x, "status": "ok"}
        for m in ("fscm", "fem")
        for q in ("force_curve", "pull_off_pressure")
        for i, x in enumerate((0.0, 1.0))
    ]
    figure = references.draw(pd.DataFrame(rows))
    labels = [line.get_label() for line in figure.axes[0].lines]
    assert [label.split(",")[0] for label in labels[:2]] == ["FEM", "FSCM"]
    assert len(figure.axes) == 2
