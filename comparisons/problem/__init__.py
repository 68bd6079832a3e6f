"""The one problem of a model, the table of kinds, and the reader of problem files."""

from comparisons.problem.problem import PARAMETERS, Problem, Section

__all__ = ["PARAMETERS", "Problem", "Section"]
