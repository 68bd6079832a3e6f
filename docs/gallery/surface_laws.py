"""
Laws of attraction
==================

The Lennard-Jones 9-3 law, a steeper one, a law through tabulated points, and two cohesive laws. All have the same work
of adhesion.
"""

import matplotlib.pyplot as plt
import numpy as np

import fscm

points = np.geomspace(0.8, 20, 60)
table = fscm.TabulatedLaw(points, 3 * (points**-12 - points**-4), tail_exponent=4, work=1.0)
gap = np.linspace(-0.15, 3, 400)
figure, axes = plt.subplots(layout="constrained")
trapezoid = fscm.CohesiveTrapezoid(work_of_adhesion=1.0, strength=0.8, rise_end=0.2, fall_start=0.7)
laws = {
    "9-3": fscm.LennardJones(),
    "10-4": fscm.Mie(m=10, n=4),
    "table of a 12-4 law": table,
    "exponential": fscm.CohesiveExponential(),
    "trapezoid": trapezoid,
}
for name, law in laws.items():
    axes.plot(gap, law.traction(gap), label=name)
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="gap / z0", ylabel="traction / (dgamma / z0), compression positive", xlim=(-0.2, 3), ylim=(-2, 2))
axes.legend(frameon=False)
plt.show()
