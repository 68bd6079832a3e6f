"""One BLAS thread inside a computation of either reference, and afterwards what was set before."""

import threading

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController

import fem_reference
import fscm
from fem_reference import _threads as threads_of_elements
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.verification.solver_study import SolverCase, solver_table
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
    """Raised by the punch, with the number of threads that it sees inside the computation."""


def height(r):
    if blas_threads() == {1}:
        raise EndsTheComputation
    return np.asarray(r) ** 2 / 2


COMPUTATIONS = {
    "force": lambda package, problem: package.solve(problem, "pull_off_force", "quick"),
    "path": lambda package, problem: package.trace(problem, "quick"),
    "profile": lambda package, problem: package.profile(problem, accuracy="quick"),
}


@pytest.mark.parametrize("package", [fscm, fem_reference], ids=lambda package: package.__name__)
@pytest.mark.parametrize("compute", COMPUTATIONS.values(), ids=COMPUTATIONS)
def test_an_exception_inside_the_computation_restores_the_threads(package, compute):
    punch = package.CustomPunch(height, 2.0, lambda r: r)
    problem = package.Problem(package.PowerLaw(50.0, 1.0, 0.0, 0.3), punch, package.LennardJones(1.0, 1.0))
    with pytest.raises(EndsTheComputation):
        compute(package, problem)
    assert blas_threads() == {2}


@pytest.mark.parametrize(
    "compute",
    [
        lambda problem: fscm.solve(problem, "critical_tabor_number"),
        lambda problem: fscm.Analysis(problem).points,
        lambda problem: fscm.equilibria(problem, "displacement", 0.0),
        lambda problem: StieltjesScheme(problem, 20).solve(10.0),
        lambda problem: stieltjes_solution(problem, "pull_off_force", 20, last_gap=5.0),
        lambda problem: fscm.solve(fscm.Problem(2, 1, 1, law=problem.law), "pull_off_force"),
    ],
)
def test_other_computations_of_the_integral_equation_have_one_thread(compute, monkeypatch):
    def traction(law, H):
        assert blas_threads() == {1}
        raise EndsTheComputation

    monkeypatch.setattr(fscm.LennardJones, "traction", traction)
    with pytest.raises(EndsTheComputation):
        compute(fscm.Problem(2, 0.4, 1.0))
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
