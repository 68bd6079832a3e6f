"""Solids whose modulus is any function of the depth: their surface compliance and their response to a ring."""

from fscm.graded.any_solid import GradedSolid
from fscm.graded.kernel import GradedKernel
from fscm.graded.physical import graded_problem
from fscm.graded.problem import GradedProblem
from fscm.graded.solids import Coating, Exponential, GradedHalfSpace, OffsetPowerLaw
from fscm.graded.table import TabulatedModulus

__all__ = [
    "Coating",
    "Exponential",
    "GradedHalfSpace",
    "GradedKernel",
    "GradedProblem",
    "GradedSolid",
    "OffsetPowerLaw",
    "TabulatedModulus",
    "graded_problem",
]
