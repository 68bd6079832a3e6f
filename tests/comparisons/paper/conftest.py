"""Tables of a figure, from calls that are made here, and the committed ones."""

import pandas as pd
import pytest

from comparisons.paper.baseline import PAPER_BASELINE
from comparisons.paper.cache import make_calls
from tests.paths import ROOT


@pytest.fixture(scope="module")
def made_of(tmp_path_factory):
    """Make the calls of a plan and return what it makes of their results."""

    def made(plan):
        return plan().given(make_calls(plan().needed, tmp_path_factory.mktemp("paper")).outcomes)

    return made


@pytest.fixture(scope="session")
def committed():
    """Read a committed table of the paper."""
    return lambda name, **options: pd.read_csv(ROOT / PAPER_BASELINE / f"{name}.csv", **options)
