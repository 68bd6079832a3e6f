"""Verification of the finite elements: checks against exact solutions, and the study of the linear solver.

Nothing that solves imports this package.
"""

from fem_reference.verification.check import Check
from fem_reference.verification.checks import elastic_checks
from fem_reference.verification.solver_study import FULL_STUDY, QUICK_STUDY, SolverCase, SolverRow, solver_table

__all__ = [
    "FULL_STUDY",
    "QUICK_STUDY",
    "Check",
    "SolverCase",
    "SolverRow",
    "elastic_checks",
    "solver_table",
]
