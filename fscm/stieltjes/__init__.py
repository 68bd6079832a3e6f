"""The Stieltjes scheme, the discretisation of the paper (Sec. 2.4, Eqs. 34-39)."""

from fscm.stieltjes.events import find_event
from fscm.stieltjes.scheme import CentralGapRates, StieltjesScheme, StieltjesState
from fscm.stieltjes.solution import STIELTJES_QUANTITIES, stieltjes_solution

__all__ = [
    "STIELTJES_QUANTITIES",
    "CentralGapRates",
    "StieltjesScheme",
    "StieltjesState",
    "find_event",
    "stieltjes_solution",
]
