"""The kernel and the threads that the tests are given, and the choice of others."""

import os
import subprocess
from types import SimpleNamespace

import pytest
from threadpoolctl import threadpool_info

from tests.blas import kernels
from tests.blas.kernels import KERNELS, Run, ending, in_force, main, planned, refusal
from tests.marks import LIGHT


def test_the_tests_have_the_kernel_and_the_threads_that_they_are_given(request):
    now = [library for library in threadpool_info() if library["user_api"] == "blas"]
    assert {library["num_threads"] for library in now} == {request.config.getoption("--blas-threads")}
    if (forced := os.environ.get("OPENBLAS_CORETYPE")) in KERNELS:
        assert {library["architecture"] for library in now} == {forced}


@pytest.fixture(scope="module")
def own_kernels():
    return in_force()


def test_a_kernel_that_there_is_not_is_refused_with_the_one_in_its_place(own_kernels):
    assert all(name in refusal("Imaginary") for name in own_kernels)


def test_the_oldest_kernel_can_be_forced(own_kernels):
    """It has no instruction that NumPy does not need, too."""
    if not own_kernels <= {*KERNELS}:
        pytest.skip(f"the kernels of this machine are {own_kernels}")
    assert refusal("Nehalem") == ""


def test_a_kernel_that_ends_the_process_is_refused_with_the_signal(monkeypatch):
    monkeypatch.setattr(kernels, "_PROBE", "import os, signal; os.kill(os.getpid(), signal.SIGILL)")
    assert "SIGILL" in refusal("Haswell")
    assert "status 3" in ending(3)


@pytest.mark.parametrize("own", [{"SkylakeX"}, {"Haswell"}, {"Zen"}, {"Haswell", "Zen"}])
def test_all_kernels_run_with_one_and_two_threads_and_one_other_without_all(own):
    every = planned(own, KERNELS, every=True)
    assert {(run.kernel, run.threads) for run in every} == {
        (kernel, threads) for kernel in KERNELS for threads in (1, 2) if (own, threads) != ({kernel}, 1)
    }
    (single,) = planned(own, KERNELS, every=False)
    assert single.threads == 1
    assert {single.kernel} != own


def test_slow_tests_run_under_a_kernel_too(monkeypatch):
    commands = []
    monkeypatch.setattr(
        subprocess, "run", lambda command, **options: commands.append(command) or SimpleNamespace(returncode=0)
    )
    assert Run("Haswell", 1).passes(["-n", "2"])
    ((*_, selection),) = [command[: command.index(LIGHT) + 1] for command in commands]
    assert "slow" not in selection


@pytest.mark.parametrize(("passes", "status"), [(True, 0), (False, 1)])
def test_the_status_is_that_of_the_runs(passes, status, monkeypatch, capsys):
    given = []
    monkeypatch.setattr(Run, "passes", lambda run, arguments: given.append(arguments) or passes)
    monkeypatch.setattr(kernels, "in_force", lambda kernel=None: {"SkylakeX" if kernel is None else kernel})
    assert main(["-n", "2"]) == status
    assert given == [["-n", "2"]]


def test_no_kernel_that_can_be_forced_is_an_error_that_names_each(monkeypatch, capsys):
    monkeypatch.setattr(kernels, "in_force", lambda kernel=None: {"ARMV8"})
    assert main([]) == 1
    said = capsys.readouterr().out
    assert all(f"kernel {kernel} is skipped" in said for kernel in KERNELS)
