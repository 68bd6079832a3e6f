"""
The Tabor number of a material
==============================

From newtons and metres to the one number that decides which model holds: the Tabor number of spheres of three moduli.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

radii = np.geomspace(1e-9, 1e-3, 50)
figure, axes = plt.subplots(layout="constrained")
for E0, name in ((70e9, "glass, 70 GPa"), (2e9, "polymer, 2 GPa"), (1e6, "rubber, 1 MPa")):
    solid, law = fscm.Homogeneous(E=E0, nu=0.3), fscm.LennardJones(work_of_adhesion=0.05, z0=0.4e-9)
    spheres = [fscm.Problem(solid, fscm.PowerPunch(n=2, Q=radius), law) for radius in radii]
    axes.loglog(radii * 1e6, [sphere.mu for sphere in spheres], label=name)
axes.axhspan(0.1, 5, color="0.9", label="neither Bradley nor JKR")
axes.set(xlabel="radius of the sphere, micrometres", ylabel="Tabor number")
axes.legend(frameon=False)
plt.show()
