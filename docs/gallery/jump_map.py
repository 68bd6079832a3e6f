"""
Where a contact jumps
=====================

Above the critical Tabor number approach and retreat jump, and a cycle loses energy.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

n, k = np.meshgrid(np.linspace(1, 6, 60), np.linspace(0, 0.8, 60))
critical, _ = fscm.atlas(n, k, 1.0, "critical_tabor_number")
figure, axes = plt.subplots(layout="constrained")
lines = axes.contour(n, k, critical, levels=12, cmap="viridis")
axes.clabel(lines, fmt="%.2f")
axes.set(xlabel="shape index n", ylabel="gradient exponent k", title="Critical Tabor number")
plt.show()
