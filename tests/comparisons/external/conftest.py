"""External models, written to files as their authors would."""

import hashlib
import time
import tomllib
from functools import partial
from pathlib import Path

import pytest

from comparisons.external.model_source import GROUP, close_models
from comparisons.judging.gates import gates_text
from comparisons.pipeline import finished_run, inputs
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.runs.cases import load_grids
from comparisons.runs.tasks import evaluate

from ..conftest import GATES, with_entries
from ..conftest import GRID as STANDING
from .board_pages import BODY

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "double_hertz"
FORCE = ["--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"]
GOOD = "return Result(1.5, 1e-9)"


def row_of(model, mu=1, k=0.4, n=2, quantity="pull_off_force"):
    """The row of one evaluation."""
    return evaluate(model, quantity, Problem.dimensionless(n, k, mu))


def comes_true(condition):
    """Whether a condition holds within a minute."""
    for _ in range(3000):
        if condition():
            return True
        time.sleep(0.02)
    return False


def has_ended(process):
    """Whether a process is gone, or a zombie that has not been reaped yet."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.fixture(autouse=True)
def _no_children_left():
    yield
    close_models()


@pytest.fixture
def no_cards(monkeypatch):
    """Runs make no report cards, for which they would start several more processes of each model."""
    monkeypatch.setattr(finished_run, "make_cards", lambda external, rows, parts, cases: {})


GRID = with_entries(STANDING, id="few", reference="bradley", models='["dmt"]')
LIMITS = {"lower": -0.1, "upper": 0.1, "min_cases": 2, "min_coverage": 0.9, "not_applicable": "leave-out"}
GATE = with_entries(GATES, id="GIVEN", candidate="given", reference="bradley", cases="{}", **LIMITS)


@pytest.fixture
def few_cases(monkeypatch, no_cards):
    """A run has four cases and makes no report cards."""
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))


HEAD = """
import ctypes, math, os, shutil, signal, sys, threading, time
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


def model_file(folder, body=GOOD, name="stranger", more=""):
    """Write a model with a body of `evaluate` and further members; return its SPEC."""
    file = folder / f"{name}.py"
    lines = "\n".join(f"        {line}" for line in body.splitlines())
    members = "\n".join(f"    {line}" for line in more.splitlines())
    text = f"{HEAD.format(name=name)}\n    def evaluate(self, problem, quantity):\n{lines}\n{members}\n"
    file.write_text(text, encoding="utf-8")
    return f"{file}:Model"


@pytest.fixture
def write_model(tmp_path):
    return partial(model_file, tmp_path)


#: What every submission states besides.
SHARED = 'authors = ["A. <b>Author</b>"]\ncitation = "none"\nlicence = "MIT"\n'


@pytest.fixture
def submissions(small_grid, no_cards, tmp_path, monkeypatch):
    """A function that writes a submission; its gate is a limit of 11 percent for any model."""
    gate = GATES.replace('candidate = "ten-percent"', 'candidate = "given"').replace("0.09", "-0.11")
    monkeypatch.setattr("comparisons.pipeline.inputs.gates_text", lambda path: gates_text(path) if path else gate)

    def written(folder, body=BODY, version="1", name="mine", date="2026-01-01", model="mine.py:Model"):
        path = tmp_path / "submissions" / folder
        path.mkdir(parents=True, exist_ok=True)
        model_file(path, body, name)
        (path / f"{name}.py").rename(path / "mine.py")
        manifest = path / "submission.toml"
        stated = f'name = "{name}"\nversion = "{version}"\ndate = {date}\nmodel = "{model}"\n'
        manifest.write_text(stated + SHARED)
        return manifest

    return written


MANIFEST = """
name = "measured"
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
VALUES = ("2,0,0.1,1.9", "2,0,1,1.6", "2,0.4,0.1,1.95", "2,0.4,1,1.75")
ROWS = [f"pull_off_force,{cells},1e-6" for cells in VALUES]


@pytest.fixture
def write_data(tmp_path):
    """Return a function that writes a folder of predictions; `change` maps texts of the manifest, `more` has files."""

    def write(rows=ROWS, change=(), digest=None, header="quantity,n,k,mu,value,u_num", wrap=str.encode, more=()):
        folder = tmp_path / "data"
        folder.mkdir(exist_ok=True)
        for name, text in dict(more).items():
            (folder / name).write_text(text)
        content = wrap("\n".join([header, *rows]) + "\n")
        (folder / "predictions.csv").write_bytes(content)
        unit = QUANTITIES["pull_off_force"].unit
        manifest = MANIFEST.format(digest=digest or hashlib.sha256(content).hexdigest(), unit=unit)
        for old, new in dict(change).items():
            assert old in manifest
            manifest = manifest.replace(old, new)
        (folder / "model.toml").write_text(manifest, encoding="utf-8")
        return folder

    return write


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Return a function that puts files on the path as the installation of a model leaves them."""

    def installed(name, target, files):
        site, info = tmp_path / "site-packages", f"{name}-1.0.dist-info"
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n"
        entries = {f"{info}/METADATA": metadata, f"{info}/entry_points.txt": f"[{GROUP}]\n{name} = {target}\n"}
        for file, text in (files | entries).items():
            (site / file).parent.mkdir(parents=True, exist_ok=True)
            (site / file).write_text(text)
        monkeypatch.syspath_prepend(site)

    return installed


@pytest.fixture
def installed_example(install):
    """Install the double-Hertz example by its own pyproject.toml; return the name of its model."""
    tables = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))
    ((name, target),) = tables["project"]["entry-points"][GROUP].items()
    files = [EXAMPLE / f"{module}.py" for module in tables["tool"]["setuptools"]["py-modules"]]
    install(name, target, {file.name: file.read_text(encoding="utf-8") for file in files})
    return name
