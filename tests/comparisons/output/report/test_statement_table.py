"""The statements of the paper in the report."""

import pytest

from comparisons.data.paper_statements import verdicts
from comparisons.output.report.statement_table import statements


@pytest.fixture(scope="module")
def table():
    return statements()


def test_every_statement_is_there_and_what_does_not_hold_is_first(table):
    found = [row.cells[0].text for row in table.rows]
    assert sorted(found) == sorted(row["verdict"] for row in verdicts())
    assert found.index("true") == len(found) - found.count("true")
    assert f"{len(found)} statements: {found.count('false')} false" in table.note


def test_a_row_has_its_evidence_and_its_command(table):
    by_command = {row.cells[-1].text: row for row in table.rows}
    for stored in verdicts():
        row = by_command[stored["command"]]
        assert len(row.cells) == len(table.columns)
    assert all(row.cells[2].more for row in by_command.values())
