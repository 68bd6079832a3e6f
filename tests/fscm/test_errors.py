"""Failures: each exception names what failed, with its remedy."""

import ast
import pickle
from pathlib import Path

import pytest

import fscm
from fscm import Failure, NotConverged, Problem, solve
from fscm.errors import RingsForm

CALLS = [
    (path.name, node)
    for path in sorted(Path(fscm.__file__).parent.rglob("*.py"))
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("NotConverged", "RingsForm")
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
        solve(Problem(n=2, k=0.999, mu=1), "pull_off_force")
    assert refused.value.failure is Failure.MESH
    assert str(refused.value) == f"{refused.value.reason}; {Failure.MESH.value}"


@pytest.mark.parametrize("kind", [NotConverged, RingsForm])
def test_a_failure_passes_between_processes(kind):
    error = pickle.loads(pickle.dumps(kind("no rings", Failure.RINGS)))
    assert (type(error), error.reason, error.failure) == (kind, "no rings", Failure.RINGS)
    assert str(kind("only a reason")) == "only a reason"
