"""Name of `comparisons.output.latex.escaped` for the tests of the page of a sweep over a problem file."""

from comparisons.output.latex import escaped

__all__ = ["escaped"]
