"""One BLAS thread while the solver computes, and afterwards what was set before."""

import threading

import pytest
from threadpoolctl import ThreadpoolController

import fscm
from fscm._threads import one_thread
from fscm.gibson import GibsonSolid
from fscm.laws import LennardJones
from fscm.stieltjes import StieltjesScheme, stieltjes_solution

PROBLEM = fscm.Problem(2, 0.4, 1.0)


def blas_threads() -> set[int]:
    info = ThreadpoolController().select(user_api="blas").info()
    assert info, "NumPy and SciPy bring at least one BLAS library"
    return {library["num_threads"] for library in info}


@pytest.fixture
def two_threads():
    with ThreadpoolController().limit(limits=2, user_api="blas"):
        if blas_threads() != {2}:
            pytest.skip("this BLAS has one thread only")
        yield


@pytest.mark.usefixtures("two_threads")
@pytest.mark.parametrize(
    "compute",
    [
        lambda problem: fscm.solve(problem, "pull_off_force"),
        lambda problem: fscm.solve(problem, "critical_tabor_number"),
        lambda problem: fscm.Analysis(problem).points,
        lambda problem: fscm.Analysis(problem).event("zero_load"),
        lambda problem: fscm.Analysis(problem).landing("jump_in"),
        lambda problem: fscm.Analysis(problem).solution("hysteresis_energy"),
        fscm.trace,
        fscm.profile,
        lambda problem: fscm.equilibria(problem, "displacement", 0.0),
        lambda problem: StieltjesScheme(problem, 20).solve(10.0),
        lambda problem: stieltjes_solution(problem, "pull_off_force", 20, last_gap=5.0),
        lambda problem: GibsonSolid(fscm.Problem(2, 1, 1, law=problem.law)).solution("pull_off_force"),
    ],
)
def test_one_thread_inside_and_two_afterwards(compute, monkeypatch: pytest.MonkeyPatch) -> None:
    """The surface law sees the number of threads; the first call ends the computation with an exception."""
    seen = set()

    def traction(law, H):
        seen.update(blas_threads())
        raise InterruptedError

    monkeypatch.setattr(LennardJones, "traction", traction)
    with pytest.raises(InterruptedError):
        compute(PROBLEM)
    assert seen == {1}
    assert blas_threads() == {2}


@pytest.mark.usefixtures("two_threads")
def test_computations_that_overlap_in_two_threads_leave_what_was_set() -> None:
    entered, leave = threading.Event(), threading.Event()

    def other() -> None:
        with one_thread():
            entered.set()
            leave.wait()

    thread = threading.Thread(target=other)
    with one_thread():
        thread.start()
        entered.wait()
        with one_thread():
            assert blas_threads() == {1}
        assert blas_threads() == {1}
    leave.set()
    thread.join()
    assert blas_threads() == {2}


@pytest.mark.usefixtures("two_threads")
def test_what_was_set_is_restored_after_a_result() -> None:
    assert fscm.solve(fscm.Problem(2, 0, 0.1), "pull_off_force").value > 0
    assert blas_threads() == {2}
