"""Help and the name of the program; the commands `cite` and `fem`."""

import re
import shlex
import subprocess
import sys
from functools import partial

import meshio
import numpy as np
import pytest

import fem_reference
from comparisons.cli.main import _COMMANDS, _parser, main
from comparisons.pipeline.run import run
from tests.comparisons.grid_text import grid_text


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    grid = grid_text(["jkr", "bradley"], "atlas", n=[2], k=[0], mu=[1])
    return run(grid, folder=tmp_path_factory.mktemp("cite") / "sweep").folder


def test_a_sweep_is_cited_with_its_models_and_its_reference(folder, capsys):
    assert main(["cite", str(folder)]) == 0
    paragraph = capsys.readouterr().out.splitlines()[0]
    assert all(name in paragraph for name in ("bradley (version 1)", "jkr (version 1)", "atlas (version "))
    assert main(["cite", "--format", "bibtex", str(folder)]) == 0
    assert "@article{jkr-1971," in capsys.readouterr().out
    # Without a folder, the version of the program.
    assert (main(["--version"]), main(["cite"])) == (0, 0)
    version, text = capsys.readouterr().out.split("\n", 1)
    assert f"version {version.removeprefix('fscm-bench ')}" in text


def test_a_changed_table_is_refused(folder, refused):
    (folder / "results.csv").write_text("model\n")
    refused(["cite", folder], "results.csv")


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


@pytest.mark.parametrize("command", ["", *_COMMANDS])
def test_help_has_examples_that_are_admissible(capsys, command):
    assert main([command, "--help"] if command else ["--help"]) == 0
    examples = re.findall(r"^  (fscm-bench .*)", capsys.readouterr().out.partition("\nexample")[2], re.MULTILINE)
    assert examples
    for words in map(shlex.split, examples):
        if "COMMAND" not in words:
            assert words[1] == command or not command
            _parser(words[1:2]).parse_args(words[1:])


def test_python_m_comparisons_calls_itself_so():
    done = subprocess.run([sys.executable, "-m", "comparisons", "dance"], capture_output=True, text=True)
    assert done.returncode == 2
    assert "python -m comparisons" in done.stderr
