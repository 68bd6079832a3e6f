"""
One cycle of loading and unloading
==================================

The equilibrium path (grey) folds back. A machine that prescribes the displacement jumps at both folds, and the area
between approach and retreat is lost.
"""

import matplotlib.pyplot as plt

import fscm

path = fscm.trace(fscm.Problem(n=2, k=0, mu=2), "quick", max_load=0.5)
cycle = fscm.displacement_cycle(path)
figure, axes = plt.subplots(layout="constrained")
axes.plot(path.displacement, path.load, color="0.6", lw=1, label="equilibrium path")
axes.plot(*cycle.loading, color="#0072b2", label="approach")
axes.plot(*cycle.unloading, color="#d55e00", ls="--", label="retreat")
axes.set(xlabel="displacement / z0", ylabel="load / (pi R dgamma)", xlim=(-5, 2), ylim=(-1.7, 0.5))
axes.legend(frameon=False)
plt.show()
