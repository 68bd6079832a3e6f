"""The tables of a plate, from calls made here."""

import pytest

from comparisons.paper.cache import Workshop


@pytest.fixture(scope="module")
def tables_of(tmp_path_factory):
    """Make the calls and return the tables of a plate."""

    def tables(plate):
        workshop = Workshop(tmp_path_factory.mktemp("paper") / "calls.jsonl", "test")
        list(workshop.work(plate.calls(), 1))
        return plate.tables(workshop.answers)

    return tables
