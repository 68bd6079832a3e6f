"""Settings of all tests: one thread for the linear algebra unless asked, as processes share the cores; no deadlines."""

import gc
import signal

import pytest
import scipy.linalg  # noqa: F401  # what is not loaded cannot be limited
from hypothesis import settings
from threadpoolctl import threadpool_limits

from tests import slow_tests

# An example that takes longer than hypothesis allows by default is no error on a busy machine.
settings.register_profile("no deadline", deadline=None)
settings.load_profile("no deadline")


def pytest_addoption(parser):
    """More threads add in another order: `tests.blas.kernels` runs the tests with two."""
    parser.addoption("--blas-threads", type=int, default=1, metavar="N", help="threads of the linear algebra")


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Do not search all the tests for garbage, neither while they are collected nor afterwards."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Mark the slow tests, before others are deselected."""
    config.stash[slow_tests.ABSENT] = slow_tests.mark(items)


@pytest.fixture(scope="session", autouse=True)
def blas_threads(pytestconfig):
    """Set the threads of every library for the whole session."""
    with threadpool_limits(pytestconfig.getoption("--blas-threads")):
        yield


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """Processes that tests start obey SIGINT, also where the tests run in the background of a shell that ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
