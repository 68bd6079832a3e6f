"""
Force-displacement curves of the models
=======================================

The curves of two closed forms in contact, beside the full self-consistent model.
"""

import matplotlib.pyplot as plt

import fscm
from comparisons import create

problem = fscm.Problem(n=2, k=0.4, mu=1)
path = fscm.trace(problem, "quick", max_load=0.5)
figure, axes = plt.subplots(layout="constrained")
axes.plot(path.displacement, path.load, color="k", label="full self-consistent model")
for name, style in (("jkr", "--"), ("md-improved", ":")):
    curve = create(name).curve(problem)
    axes.plot(curve.displacement, curve.load, style, label=name)
axes.set(xlabel="displacement / z0", ylabel="load / (pi R dgamma)", xlim=(-4, 2), ylim=(-2, 0.5))
axes.legend(frameon=False)
plt.show()
