"""Marks of the cases of a parametrised test, and selections of tests by their marks."""

import pytest

#: Every test but those marked heavy and lint, for the option -m of pytest: the fast ones and the slow ones.
LIGHT = "not heavy and not lint"


def heavy(*cases):
    """The cases, a tuple of values or a value each, marked as heavy."""
    return [pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.heavy) for case in cases]
