"""
Pull-off force over the Tabor number
====================================

The full self-consistent model (lines) joins two limits: Bradley for a stiff solid (dotted) and JKR for a soft one
(dashed).
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm
from comparisons import create

mu = np.geomspace(0.01, 10, 200)
figure, axes = plt.subplots(layout="constrained")
for k, colour in ((0, "#0072b2"), (0.4, "#d55e00"), (0.8, "#009e73")):
    force, _ = fscm.atlas(2, k, mu, "pull_off_force")
    axes.semilogx(mu, force, color=colour, label=f"k = {k}")
    jkr = create("jkr").evaluate(fscm.Problem(n=2, k=k, mu=1), "pull_off_force").value
    axes.axhline(jkr, color=colour, lw=0.8, ls="--")
axes.axhline(2, color="0.4", lw=0.8, ls=":")
axes.set(xlabel="Tabor number", ylabel="pull-off force / (pi R dgamma)", title="Paraboloid, n = 2")
axes.legend(frameon=False)
plt.show()
