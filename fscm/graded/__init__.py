"""Solids whose modulus is any function of the depth: their surface compliance and their response to a ring."""

from fscm.graded.kernel import GradedKernel
from fscm.graded.solids import Coating, Exponential, GradedHalfSpace, GradedSolid, OffsetPowerLaw
from fscm.graded.table import TabulatedModulus

__all__ = ["Coating", "Exponential", "GradedHalfSpace", "GradedKernel", "GradedSolid", "OffsetPowerLaw", "TabulatedModulus"]
