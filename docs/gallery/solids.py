"""
Moduli over the depth
=====================

The finite elements take any modulus E(z): a power law, one that is not zero at the surface, a skin, a coating.
"""

import matplotlib.pyplot as plt
import numpy as np

import fem_reference

moduli = {
    "2 GPa (z / 1 um)^0.4": fem_reference.PowerLawModulus(E0=2e9, c0=1e-6, k=0.4),
    "the same, 5 nm deeper": fem_reference.OffsetPowerLawModulus(E0=2e9, c0=1e-6, k=0.4, z_s=5e-9),
    "20 nm of 1 GPa on 10 GPa": fem_reference.CoatingModulus(E_coating=1e9, E_substrate=10e9, thickness=20e-9),
}
depth = np.geomspace(1e-10, 1e-6, 400)
figure, axes = plt.subplots(layout="constrained")
for name, modulus in moduli.items():
    axes.loglog(depth * 1e9, modulus(depth) / 1e9, label=name)
axes.set(xlabel="depth, nm", ylabel="modulus, GPa")
axes.legend(frameon=False)
plt.show()
