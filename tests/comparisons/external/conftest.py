"""External models, written to files as their authors would."""

import hashlib
import shutil
import tomllib
from pathlib import Path

import pytest

from comparisons.external.model_source import close_models
from comparisons.pipeline import finished_run
from comparisons.quantities import QUANTITIES

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "double_hertz"


@pytest.fixture(autouse=True)
def _no_children_left():
    yield
    close_models()


@pytest.fixture
def no_cards(monkeypatch):
    """Runs make no report cards, for which they would start several more processes of each model."""
    monkeypatch.setattr(finished_run, "make_cards", lambda external, rows, parts, cases: {})


def light(cases, *places):
    """Cases of which those at some places are in every test run, and the others are heavy."""
    cases = list(cases)
    assert set(places) < set(range(len(cases)))
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=() if at in places else pytest.mark.heavy)
        for at, case in enumerate(cases)
    ]


HEAD = """
import ctypes, math, os, signal, sys, threading, time
from contextlib import suppress
from pathlib import Path
import numpy as np
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result

class Model:
    name = "{name}"
    version = "1"
    citation = "A. Author"
    domain = "tests"
"""


@pytest.fixture
def write_model(tmp_path):
    """Return a function that writes a model with a given body of `evaluate` and returns its SPEC."""

    def write(body, name="stranger", more=""):
        file = tmp_path / f"{name}.py"
        lines = "\n".join(f"        {line}" for line in body.splitlines())
        members = "\n".join(f"    {line}" for line in more.splitlines())
        text = f"{HEAD.format(name=name)}\n    def evaluate(self, problem, quantity):\n{lines}\n{members}\n"
        file.write_text(text, encoding="utf-8")
        return f"{file}:Model"

    return write


MANIFEST = """
name = "{name}"
version = "1"
author = "A. Author"
doi = "10.1000/182"
licence = "CC-BY-4.0"
domain = "n = 2"
predictions = "predictions.csv"
sha256 = "{digest}"
[units]
pull_off_force = "{unit}"
[[covers]]
quantities = ["pull_off_force"]
n = [2]
k = [0, 0.4]
mu = [0.1, 1]
"""
ROWS = [
    "pull_off_force,2,0,0.1,1.9,1e-6",
    "pull_off_force,2,0,1,1.6,1e-6",
    "pull_off_force,2,0.4,0.1,1.95,1e-6",
    "pull_off_force,2,0.4,1,1.75,1e-6",
]


@pytest.fixture
def write_data(tmp_path):
    """Return a function that writes a folder of predictions; `change` maps texts of the manifest."""

    def write(rows=ROWS, change=(), digest=None, header="quantity,n,k,mu,value,u_num", name="measured"):
        folder = tmp_path / "data"
        folder.mkdir(exist_ok=True)
        content = "\n".join([header, *rows]) + "\n"
        (folder / "predictions.csv").write_text(content, encoding="utf-8")
        manifest = MANIFEST.format(
            name=name,
            digest=digest or hashlib.sha256(content.encode()).hexdigest(),
            unit=QUANTITIES["pull_off_force"].unit,
        )
        for old, new in dict(change).items():
            assert old in manifest
            manifest = manifest.replace(old, new)
        (folder / "model.toml").write_text(manifest, encoding="utf-8")
        return folder

    return write


@pytest.fixture
def installed_example(tmp_path, monkeypatch):
    """Put the double-Hertz example on the path as an installation leaves it, by its own pyproject.toml."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))
    site = tmp_path / "site-packages"
    info = site / "double_hertz-1.0.dist-info"
    info.mkdir(parents=True)
    for module in project["tool"]["setuptools"]["py-modules"]:
        shutil.copy(EXAMPLE / f"{module}.py", site)
    name, version = project["project"]["name"], project["project"]["version"]
    info.joinpath("METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    groups = project["project"]["entry-points"]
    info.joinpath("entry_points.txt").write_text(
        "".join(
            f"[{group}]\n" + "".join(f"{key} = {value}\n" for key, value in entries.items())
            for group, entries in groups.items()
        )
    )
    monkeypatch.syspath_prepend(site)
    return name
