"""Tables of a figure, from calls that are made here."""

import pytest

from comparisons.paper.cache import CallCache
from comparisons.paper.paper_figure import calls_of, given


@pytest.fixture(scope="module")
def made_of(tmp_path_factory):
    """Make the calls of a plan and return what it makes of their results."""

    def made(plan):
        cache = CallCache(tmp_path_factory.mktemp("paper") / "calls", "test")
        list(cache.work(calls_of(plan()), 1))
        return given(plan(), cache.results)

    return made
