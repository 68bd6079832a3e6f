"""Marks of the cases of a parametrised test."""

import pytest


def heavy(*cases):
    """The cases, a tuple of values or a value each, marked as heavy."""
    return [pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.heavy) for case in cases]
