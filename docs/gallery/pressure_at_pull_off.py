"""
Pressure at pull-off
====================

The full self-consistent model has compression in the middle and a peak of tension at the edge, which decays. The
Maugis-Dugdale model replaces the peak by a constant.
"""

import matplotlib.pyplot as plt

import fscm
from comparisons import create

problem = fscm.Problem(n=2, k=0.4, mu=2)
exact = fscm.profile(problem, "pull_off", "quick")
model = create("md-improved").pull_off_profile(problem)
figure, axes = plt.subplots(layout="constrained")
axes.plot(exact.radius, exact.pressure, label="full self-consistent model")
axes.plot(model.radius, model.pressure, ls="--", label="Maugis-Dugdale, improved")
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="radius / (R z0)^(1/2)", ylabel="pressure / (dgamma / z0)", xlim=(0, 5), title="n = 2, k = 0.4, mu = 2")
axes.legend(frameon=False)
plt.show()
