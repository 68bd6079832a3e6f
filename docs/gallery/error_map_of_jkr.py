"""
Where JKR is good enough
========================

Relative error of the JKR pull-off force over shape and Tabor number. For a paraboloid it is at most 15 percent wrong
at any Tabor number; for other shapes it holds for soft solids alone.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm
from comparisons import create

jkr = create("jkr")
shapes, mu = np.linspace(1, 6, 31), np.geomspace(0.05, 10, 40)
model = [[jkr.evaluate(fscm.Problem(n=n, k=0.4, mu=m), "pull_off_force").value for m in mu] for n in shapes]
force, _ = fscm.atlas(shapes[:, None], 0.4, mu, "pull_off_force")
kappa = 100 * (np.array(model) / force - 1)
figure, axes = plt.subplots(layout="constrained")
picture = axes.pcolormesh(mu, shapes, kappa, cmap="RdBu_r", vmin=-30, vmax=30, rasterized=True)
axes.clabel(axes.contour(mu, shapes, kappa, levels=[-10, -5, -2, -1, 1, 2, 5, 10], colors="k", linewidths=0.8))
axes.set(xscale="log", xlabel="Tabor number", ylabel="shape index n", title="JKR, k = 0.4: error in percent")
figure.colorbar(picture, ax=axes, extend="both")
plt.show()
