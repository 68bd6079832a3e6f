"""
Moduli over the depth
=====================

Both references take any modulus E(z): a power law, one that is not zero at the surface, a skin, a coating.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

solids = {
    "2 GPa (z / 1 um)^0.4": fscm.PowerLaw(E0=2e9, c0=1e-6, k=0.4, nu=0.3),
    "the same, 5 nm deeper": fscm.OffsetPowerLaw(E0=2e9, c0=1e-6, k=0.4, z_s=5e-9, nu=0.3),
    "20 nm of 1 GPa on 10 GPa": fscm.Layers(E=[1e9, 10e9], nu=[0.3, 0.3], thickness=[20e-9]),
}
depth = np.geomspace(1e-10, 1e-6, 400)
figure, axes = plt.subplots(layout="constrained")
for name, solid in solids.items():
    axes.loglog(depth * 1e9, solid.modulus(depth) / 1e9, label=name)
axes.set(xlabel="depth, nm", ylabel="modulus, GPa")
axes.legend(frameon=False)
plt.show()
