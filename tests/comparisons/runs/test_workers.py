"""Work on every core: each item once, in processes of one thread."""

import os

import pytest
import threadpoolctl

from comparisons.runs.workers import each


def threads(_):
    """The process, and the threads of its linear algebra libraries."""
    import scipy.linalg  # noqa: F401

    return os.getpid(), [library["num_threads"] for library in threadpoolctl.threadpool_info()]


def fail(item):
    raise ValueError(f"{item} is refused")


def test_the_linear_algebra_of_a_worker_has_one_thread():
    for process, numbers in each(threads, [1, 2], 2, lost=str):
        assert process != os.getpid()
        assert numbers
        assert set(numbers) == {1}


def test_one_job_works_in_this_process():
    assert [process for process, _ in each(threads, [1, 2], 1, lost=str)] == [os.getpid()] * 2


def test_an_exception_of_the_function_is_raised():
    with pytest.raises(ValueError, match="is refused"):
        list(each(fail, [1, 2], 2, lost=str))
