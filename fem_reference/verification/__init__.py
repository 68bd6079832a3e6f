"""Verification of the finite elements: checks against exact solutions, and the study of the linear solver.

Nothing that solves imports this package.
"""

from fem_reference.verification.check import Check
from fem_reference.verification.checks import elastic_checks
from fem_reference.verification.solver_study import FULL_STUDY, QUICK_STUDY, SolverCase, SolverRow, solver_table
from fem_reference.verification.uncondensed import FullContact, FullState

__all__ = [
    "FULL_STUDY",
    "QUICK_STUDY",
    "Check",
    "FullContact",
    "FullState",
    "SolverCase",
    "SolverRow",
    "elastic_checks",
    "solver_table",
]
