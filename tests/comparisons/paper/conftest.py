"""Tables of a figure, from calls that are made here."""

import pytest

from comparisons.paper.cache import make_calls
from comparisons.paper.paper_figure import calls_of, given


@pytest.fixture(scope="module")
def made_of(tmp_path_factory):
    """Make the calls of a plan and return what it makes of their results."""

    def made(plan):
        return given(plan(), make_calls(calls_of(plan()), tmp_path_factory.mktemp("paper")).results)

    return made
