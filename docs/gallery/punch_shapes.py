"""
Shapes of punches
=================

Power laws from the cone to a nearly flat punch, a rounded cone, and a measured profile.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

measured = fscm.MeasuredPunch([0, 0.5, 1, 1.5, 2], [0, 0.05, 0.4, 1.4, 2.6])
radius = np.linspace(0, 2, 200)
figure, axes = plt.subplots(layout="constrained")
for n in (1, 2, 6):
    axes.plot(radius, fscm.PowerPunch(n).height(radius), label=f"r^n / n, n = {n}")
axes.plot(radius, fscm.RoundedCone(1.0).height(radius), ls="--", label="rounded cone")
axes.plot(radius, measured.height(radius), ls=":", label="measured profile")
axes.set(xlabel="radius / (Q z0)^(1/n)", ylabel="height / z0", ylim=(0, 3))
axes.legend(frameon=False)
plt.show()
