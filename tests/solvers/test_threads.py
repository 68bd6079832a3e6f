"""One BLAS thread inside a computation of either reference, and afterwards what was set before."""

import threading
from contextlib import ExitStack

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController

import fem_reference
import fscm
from fem_reference import _threads as threads_of_elements
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.verification.solver_study import SolverCase, solver_table
from fscm import _threads
from fscm._threads import one_thread
from fscm.stieltjes import StieltjesScheme, stieltjes_solution


def blas_threads():
    return {library["num_threads"] for library in ThreadpoolController().select(user_api="blas").info()}


@pytest.fixture(autouse=True)
def two_threads():
    with ThreadpoolController().limit(limits=2, user_api="blas"):
        if blas_threads() != {2}:
            pytest.skip("this BLAS has one thread only")
        yield


class EndsTheComputation(Exception):
    """Raised by the surface law inside the computation."""


PROBLEM = fscm.Problem(2, 0.4, 1.0)
#: Of no other test: the elements keep the path of the latest problems.
SOLID = fem_reference.PowerLaw(51.7, 1.0, 0.0, 0.3)
OF_ELEMENTS = fem_reference.Problem(SOLID, fem_reference.PowerPunch(2.0, 1.0), fem_reference.LennardJones(1.0, 1.0))
COMPUTATIONS = {
    "force": lambda: fscm.solve(PROBLEM, "pull_off_force"),
    "path": lambda: fscm.trace(PROBLEM, "quick"),
    "profile": lambda: fscm.profile(PROBLEM),
    "critical": lambda: fscm.solve(PROBLEM, "critical_tabor_number"),
    "analysis": lambda: fscm.Analysis(PROBLEM).points,
    "states": lambda: fscm.equilibria(PROBLEM, "displacement", 0.0),
    "scheme": lambda: StieltjesScheme(PROBLEM, 20).solve(10.0),
    "scheme's force": lambda: stieltjes_solution(PROBLEM, "pull_off_force", 20, last_gap=5.0),
    "Gibson": lambda: fscm.solve(fscm.Problem(2, 1, 1), "pull_off_force"),
    "force of elements": lambda: fem_reference.solve(OF_ELEMENTS, "pull_off_force", "quick"),
    "path of elements": lambda: fem_reference.trace(OF_ELEMENTS, "quick"),
    "profile of elements": lambda: fem_reference.profile(OF_ELEMENTS, accuracy="quick"),
}


@pytest.mark.parametrize("compute", COMPUTATIONS.values(), ids=COMPUTATIONS)
def test_a_computation_has_one_thread_and_an_exception_inside_restores_two(compute, monkeypatch):
    def traction(law, H):
        assert blas_threads() == {1}
        raise EndsTheComputation

    for package in (fscm, fem_reference):
        monkeypatch.setattr(package.LennardJones, "traction", traction)
    with pytest.raises(EndsTheComputation):
        compute()
    assert blas_threads() == {2}


def test_the_solver_study_has_one_thread(monkeypatch):
    seen, exact = set(), np.exp
    monkeypatch.setattr(np, "exp", lambda *args: seen.update(blas_threads()) or exact(*args))
    solver_table([SolverCase(MeshSpec(0.5, 0.05, 32.0, 1.2, 4), 0.4, 0.25)])
    assert seen == {1}


@pytest.mark.parametrize("limit", [one_thread, lambda: threads_of_elements.one_thread], ids=["fscm", "fem_reference"])
def test_computations_that_overlap_leave_what_was_set(limit):
    """One inside the other, and a Python thread that enters second and leaves last."""
    inside, leave = threading.Event(), threading.Event()

    def second():
        with limit():
            inside.set()
            leave.wait()

    with limit():
        with limit():
            assert blas_threads() == {1}
        assert blas_threads() == {1}
        thread = threading.Thread(target=second)
        thread.start()
        inside.wait()
    leave.set()
    thread.join()
    assert blas_threads() == {2}


def test_a_library_that_is_loaded_during_a_computation_is_limited_by_the_next_one(monkeypatch):
    """Each call restores the libraries that it has limited, whichever ends first."""
    blas = ThreadpoolController().select(user_api="blas")
    first = blas.select(filepath=[blas.lib_controllers[0].filepath])
    if len(first.lib_controllers) == len(blas.lib_controllers):
        pytest.skip("NumPy and SciPy share a library")
    found = iter([first, blas])
    monkeypatch.setattr(_threads, "_blas", lambda with_scipy: next(found))
    outer, inner = ExitStack(), ExitStack()
    outer.enter_context(one_thread())
    assert blas_threads() == {1, 2}
    inner.enter_context(one_thread())
    assert blas_threads() == {1}
    outer.close()
    assert blas_threads() == {1, 2}
    inner.close()
    assert blas_threads() == {2}
