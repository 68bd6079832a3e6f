"""
Laws of attraction
==================

The Lennard-Jones 9-3 law, a steeper one, and a law through tabulated points. All have the same work of adhesion.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

points = np.geomspace(0.8, 20, 60)
table = fscm.TabulatedLaw(points, 3 * (points**-12 - points**-4), tail_exponent=4, work=1.0)
gap = np.linspace(-0.15, 3, 400)
figure, axes = plt.subplots(layout="constrained")
for law, name in ((fscm.LennardJones(), "9-3"), (fscm.Mie(m=10, n=4), "10-4"), (table, "table of a 12-4 law")):
    axes.plot(gap, law.traction(gap), label=name)
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="gap / z0", ylabel="traction / (dgamma / z0), compression positive", ylim=(-2, 2))
axes.legend(frameon=False)
plt.show()
