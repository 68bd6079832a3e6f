"""The Gibson solid, k = 1 and nu = 1/2, for which the model is algebraic."""

from fscm.gibson.local_equilibrium import Front, LocalEquilibrium, root
from fscm.gibson.solid import GibsonSolid

__all__ = ["Front", "GibsonSolid", "LocalEquilibrium", "root"]
