"""One thread for the linear algebra of the tests: their processes share the cores already."""

import pytest
import scipy.linalg  # noqa: F401  # what is not loaded cannot be limited
from threadpoolctl import threadpool_limits


@pytest.fixture(scope="session", autouse=True)
def one_thread():
    """Limit every library for the whole session."""
    with threadpool_limits(1):
        yield
