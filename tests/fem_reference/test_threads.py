"""One BLAS thread inside a computation, and what was set before it afterwards."""

import threading

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from fem_reference import CustomPunch, LennardJones, NotConverged, PowerLaw, Problem, profile, solve, trace
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._threads import one_thread
from fem_reference.verification.solver_study import SolverCase, solver_table

SOLID, LAW = PowerLaw(E0=50.0, c0=1.0, k=0.0, nu=0.3), LennardJones(1.0, 1.0)


def blas_threads():
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def two_threads():
    """The number of threads around each test is not one."""
    with threadpool_limits(2):
        yield


def test_the_solver_study_has_one_thread(monkeypatch):
    seen = set()
    exact = np.exp
    monkeypatch.setattr(np, "exp", lambda *args: seen.update(blas_threads()) or exact(*args))
    solver_table([SolverCase(MeshSpec(0.5, 0.05, 32.0, 1.2, 4), 0.4, 0.25)])
    assert seen == {1}


@pytest.mark.parametrize(
    "compute",
    [
        lambda problem: solve(problem, "pull_off_force", "quick"),
        lambda problem: trace(problem, "quick"),
        lambda problem: profile(problem, accuracy="quick"),
    ],
    ids=["solve", "trace", "profile"],
)
def test_an_exception_restores_the_threads(compute):
    """It is raised inside the computation, by what has one thread."""

    def height(r):
        if blas_threads() == {1}:
            raise NotConverged("inside the computation")
        return r**2 / 2

    with pytest.raises(NotConverged, match="inside the computation"):
        compute(Problem(SOLID, CustomPunch(height, 2.0, lambda r: r), LAW))
    assert blas_threads() == {2}


def test_nested_use():
    with one_thread:
        with one_thread:
            assert blas_threads() == {1}
        assert blas_threads() == {1}
    assert blas_threads() == {2}


def test_overlapping_use():
    """A Python thread that enters second and leaves last does not keep the limit."""
    inside, leave = threading.Event(), threading.Event()

    def other():
        with one_thread:
            inside.set()
            leave.wait()

    with one_thread:
        worker = threading.Thread(target=other)
        worker.start()
        inside.wait()
    leave.set()
    worker.join()
    assert blas_threads() == {2}
    with one_thread:
        assert blas_threads() == {1}
