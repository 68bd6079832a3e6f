"""
Energy lost in a cycle
======================

The hysteresis energy begins at the critical Tabor number and grows with the softness of the solid.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

mu = np.linspace(0.4, 10, 300)
figure, axes = plt.subplots(layout="constrained")
for k in (0, 0.2, 0.4, 0.6):
    energy, _ = fscm.atlas(2, k, mu, "hysteresis_energy", missing="nan")
    axes.plot(mu, energy, label=f"k = {k}")
axes.set(xlabel="Tabor number", ylabel="hysteresis energy / (pi R dgamma z0)", title="Paraboloid, n = 2")
axes.legend(frameon=False)
plt.show()
