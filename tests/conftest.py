"""One thread for the linear algebra of the tests, whose processes share the cores already; their table of values."""

import importlib.util
import sys
from pathlib import Path

import pytest
import scipy.linalg  # noqa: F401  # what is not loaded cannot be limited
from threadpoolctl import threadpool_limits

# The folder of the tests is no import path: its subfolders have the names of the packages.
_TABLE = importlib.util.spec_from_file_location("reference_values", Path(__file__).with_name("reference_values.py"))
sys.modules["reference_values"] = importlib.util.module_from_spec(_TABLE)
_TABLE.loader.exec_module(sys.modules["reference_values"])


@pytest.fixture(scope="session", autouse=True)
def one_thread():
    """Limit every library for the whole session."""
    with threadpool_limits(1):
        yield
