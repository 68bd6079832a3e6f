"""
Work of adhesion from measured pull-off forces
==============================================

Spheres of five radii were pulled off. A fit with the atlas finds the work of adhesion; the JKR formula, used outside
its range, does not.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

import fscm

radii = np.array([20, 50, 100, 200, 500]) * 1e-9  # m
measured = np.array([6.25, 15.6, 30.9, 60.3, 151.9]) * 1e-9  # N: made with 0.05 J/m^2 and an error of one percent


def force(work, radius):
    """Pull-off force of a sphere of 70 GPa, in newtons."""
    law = fscm.LennardJones(work_of_adhesion=work, z0=0.3e-9)
    sphere = fscm.Problem(fscm.Homogeneous(E=70e9, nu=0.2), fscm.PowerPunch(n=2, Q=radius), law)
    return fscm.atlas(2, 0, sphere.mu, "pull_off_force").value * sphere.units["load"]


fitted = [brentq(lambda w, r=r, f=f: force(w, r) - f, 0.02, 0.2) for r, f in zip(radii, measured, strict=True)]
jkr = measured / (1.5 * np.pi * radii)
figure, axes = plt.subplots(layout="constrained")
axes.semilogx(radii * 1e9, np.array(fitted) * 1e3, "o", label="full self-consistent model (atlas)")
axes.semilogx(radii * 1e9, jkr * 1e3, "s", label="JKR formula")
axes.axhline(50, color="0.6", lw=0.8)
axes.set(xlabel="radius, nm", ylabel="work of adhesion, mJ/m^2", ylim=(40, 75))
axes.legend(frameon=False)
plt.show()
