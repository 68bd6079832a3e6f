"""Template of `new-model`: installed, checked, tested, and gated by its workflow."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import GROUP

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def package(tmp_path, capsys):
    folder = tmp_path / "my-model"
    assert main(["new-model", str(folder)]) == 0
    printed = capsys.readouterr()
    assert f"check-model {folder / 'my_model.py'}:MyModel" in printed.err
    assert sorted(printed.out.splitlines()) == sorted(str(path) for path in folder.rglob("*") if path.is_file())
    return folder


def test_the_package_is_complete_and_is_not_overwritten(package, refused):
    assert not any(re.search(r"@[A-Z]+@", path.read_text()) for path in package.rglob("*") if path.is_file())
    project = tomllib.loads((package / "pyproject.toml").read_text())
    assert project["project"]["entry-points"][GROUP] == {"my-model": "my_model:MyModel"}
    assert project["tool"]["setuptools"]["py-modules"] == ["my_model"]
    (gate,) = tomllib.loads((package / "gates.toml").read_text())["gate"]
    assert gate["candidate"] == "my-model"
    # 1.5 against the FSCM at n = 2, k = 0, mu = 2, the worst of the cases.
    assert gate["worst_measured"] == pytest.approx(1.5 / 1.58359530 - 1, abs=1e-4)
    before = (package / "my_model.py").read_text()
    refused(["new-model", package], "not an empty folder")
    assert (package / "my_model.py").read_text() == before


def test_the_model_keeps_the_contract_and_its_own_tests_pass(package, capsys):
    assert main(["check-model", f"{package / 'my_model.py'}:MyModel"]) == 0
    assert "is right in the limit jkr" in capsys.readouterr().out
    command = ["-q", "-p", "no:cacheprovider", str(package)]
    program = f"import sys, pytest; sys.path[:0] = [{str(ROOT)!r}]; sys.exit(pytest.main({command!r}))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=package)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


NAMES = "<b> 3d given jkr MD.improved comparisons Json lambda true not-applicable my-model-"


@pytest.mark.parametrize("name", NAMES.split())
def test_a_name_that_cannot_be_is_refused(tmp_path, refused, name):
    refused(["new-model", tmp_path / name])
    assert not (tmp_path / name).exists()
