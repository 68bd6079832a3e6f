"""Failures of the finite elements: each exception names what failed, with its remedy; where the rooms are."""

import ast
import importlib
import pickle
import re
from pathlib import Path

import pytest

import fem_reference
from fem_reference import Coating, Failure, NotConverged, solve
from tests.fem_reference.solved_together import sphere_on

ROOT = Path(fem_reference.__file__).parent
CALLS = [
    (path.name, node)
    for path in sorted(ROOT.rglob("*.py"))
    if path.parent.name != "_large_strain"
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "NotConverged"
]


def test_whatever_does_not_converge_names_its_failure():
    named = {
        argument.attr
        for _, call in CALLS
        for argument in call.args
        if isinstance(argument, ast.Attribute) and getattr(argument.value, "id", "") == "Failure"
    }
    assert [name for name, call in CALLS if len(call.args) < 2] == []
    assert named == {failure.name for failure in Failure}


def test_a_failure_ends_the_message_with_its_remedy():
    with pytest.raises(NotConverged) as refused:
        solve(sphere_on(Coating(1e-12, 1.0, 1.0, 0.0, 0.3)), "pull_off_force", "quick")
    assert refused.value.failure is Failure.MESH
    assert str(refused.value) == f"{refused.value.reason}; {Failure.MESH.value}"


def test_a_failure_passes_between_processes():
    error = pickle.loads(pickle.dumps(NotConverged("no edge", Failure.MESH)))
    assert (error.reason, error.failure) == ("no edge", Failure.MESH)
    assert str(NotConverged("only a reason")) == "only a reason"


def test_the_modules_that_the_package_numbers_exist():
    named = re.findall(r"`((?:_\w+\.)?\w+)`", fem_reference.__doc__.split("What a solver")[1].split("The names")[0])
    assert len(named) > 15
    for name in named:
        importlib.import_module(f"fem_reference.{name}")
