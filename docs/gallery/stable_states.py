"""
States that can be held
=======================

Marks along the path tell which states are stable with a prescribed displacement, and which with a prescribed load.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

path = fscm.trace(fscm.Problem(n=2, k=0, mu=2), "quick", max_load=0.5)
figure, axes = plt.subplots(layout="constrained")
axes.plot(path.displacement, path.load, color="0.7", lw=1, label="unstable")
for stable, name, width in (
    (path.stable_under_displacement, "stable, displacement prescribed", 5),
    (path.stable_under_load, "stable, load prescribed", 2),
):
    axes.plot(path.displacement, np.where(stable, path.load, np.nan), lw=width, label=name)
axes.set(xlabel="displacement / z0", ylabel="load / (pi R dgamma)", xlim=(-5, 2), ylim=(-1.7, 0.5))
axes.legend(frameon=False)
plt.show()
