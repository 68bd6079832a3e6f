"""
The deformed surface at jump-in and at pull-off
===============================================

Just before jump-in the surface rises towards the punch. At pull-off a neck connects them.
"""

import matplotlib.pyplot as plt

import fscm

problem = fscm.Problem(n=2, k=0, mu=2)
figure, panels = plt.subplots(1, 2, sharey=True, figsize=(8, 4), layout="constrained")
for axes, event, title in zip(panels, ("jump_in", "pull_off"), ("just before jump-in", "at pull-off"), strict=True):
    field = fscm.profile(problem, event, "quick")
    near = field.radius < 6
    radius, surface = field.radius[near], -field.deformation[near]
    axes.fill_between(radius, surface, -4, color="#56b4e9", label="half-space")
    axes.fill_between(radius, surface + field.gap[near], 12, color="0.7", label="punch")
    axes.set(xlabel="radius / (R z0)^(1/2)", title=title, ylim=(-2, 10))
panels[0].set_ylabel("height / z0")
panels[0].legend(loc="upper left")
plt.show()
