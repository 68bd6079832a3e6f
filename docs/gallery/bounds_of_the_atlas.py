"""
How certain the atlas is
========================

Bound and deviation of the atlas from a solution of the equations. The solver has a bound of its own, which is much
smaller.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

mu = np.geomspace(0.02, 2, 9)
values, bounds = fscm.atlas(2, 0.4, mu, "pull_off_force")
solved = [fscm.solve(fscm.Problem(n=2, k=0.4, mu=one), "pull_off_force") for one in mu]
figure, axes = plt.subplots(layout="constrained")
axes.loglog(mu, bounds / values, "-", label="bound of the atlas")
axes.loglog(
    mu, [abs(a - s.value) / a for a, s in zip(values, solved, strict=True)], "o", label="deviation of the atlas"
)
axes.loglog(mu, [s.u_num / s.value for s in solved], "s-", label="bound of the solver")
axes.set(xlabel="Tabor number", ylabel="relative to the pull-off force", title="n = 2, k = 0.4")
axes.legend(frameon=False)
plt.show()
