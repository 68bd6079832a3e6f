"""
Pull-off force over the gradient exponent
=========================================

At a Tabor number of 1 a larger gradient exponent raises the pull-off force of a paraboloid and lowers that of a cone.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

k = np.linspace(0, 0.8, 100)
figure, axes = plt.subplots(layout="constrained")
for n, name in ((1, "cone, n = 1"), (2, "paraboloid, n = 2"), (5, "n = 5")):
    force, _ = fscm.atlas(n, k, 1.0, "pull_off_force")
    axes.plot(k, force / force[0] - 1, label=name)
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="gradient exponent k", ylabel="pull-off force relative to k = 0, less 1", title="mu = 1")
axes.legend(frameon=False)
plt.show()
