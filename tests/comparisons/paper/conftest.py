"""Tables of a figure, from tasks that are made here."""

import pytest

from comparisons.paper.cache import CallCache


@pytest.fixture(scope="module")
def tables_of(tmp_path_factory):
    """Make the tasks and return the tables of a figure."""

    def tables(figure):
        cache = CallCache(tmp_path_factory.mktemp("paper") / "tasks.jsonl", "test")
        list(cache.work(figure.tasks(), 1))
        return figure.tables(cache.results)

    return tables
