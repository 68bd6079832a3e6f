"""Registry of the tests of statements: name -> test."""

from __future__ import annotations

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.statements import closeness, formulas, paths, surfaces, trends
from comparisons.paper.statements.numbers import StatementTest

__all__ = ["TESTS", "find_test"]

_GROUPS = (trends, closeness, paths, surfaces, formulas)

#: Every test by its name; a group that repeats a name would hide a test, which `tests` refuse.
TESTS: dict[str, StatementTest] = {name: test for group in _GROUPS for name, test in group.TESTS.items()}


def find_test(statement: PaperStatement) -> StatementTest:
    """Return the test of a statement.

    Raises
    ------
    ValueError
        If there is no test of that name; the sentence lists those that exist.
    """
    if statement.test not in TESTS:
        raise ValueError(f"statement {statement.id} has no test {statement.test!r}; there are {', '.join(TESTS)}")
    return TESTS[statement.test]
