"""
The cohesive zone
=================

Contact radius and outer radius of the cohesive zone of the Maugis-Dugdale model: the zone is narrow where the solid is
soft.
"""

import matplotlib.pyplot as plt

import fscm
from comparisons import create

figure, panels = plt.subplots(1, 3, sharey=True, figsize=(9, 3.5), layout="constrained")
for axes, mu in zip(panels, (0.3, 1, 5), strict=True):
    curve = create("md-improved").curve(fscm.Problem(n=2, k=0.4, mu=mu))
    inner, outer = curve.columns["contact_radius"], curve.columns["cohesive_radius"]
    axes.fill_betweenx(curve.load, inner, outer, color="#d55e00", alpha=0.3, label="cohesive zone")
    axes.plot(inner, curve.load, color="k", label="contact radius")
    axes.set(xlabel="radius / (R z0)^(1/2)", title=f"mu = {mu}", xlim=(0, 4), ylim=(-2, 2))
panels[0].set_ylabel("load / (pi R dgamma)")
panels[0].legend(frameon=False, loc="upper left")
plt.show()
