"""A gecko-like graded pad, from numbers with units to a plot: the code of docs/tutorial.md.

python docs/examples/gecko_pad.py        # writes gecko_pad.png into the current folder
"""

from matplotlib.figure import Figure

import fem_reference
import fscm
from comparisons import create

# An asperity of 100 nm on keratin whose modulus grows with the depth: 2 GPa at 1 micrometre.  SI units.
solid = {"E0": 2e9, "c0": 1e-6, "k": 0.4, "nu": 0.3}  # Pa, m
sphere = {"n": 2, "Q": 100e-9}  # a paraboloid, so that Q is its radius, m
law = {"work_of_adhesion": 0.05, "z0": 0.5e-9}  # J/m^2, and the range of the surface forces, m
problem = fscm.Problem(fscm.PowerLaw(**solid), fscm.PowerPunch(**sphere), fscm.LennardJones(**law))
print(f"Tabor number {problem.mu:.4f}")

# The pull-off force: the reference with its uncertainty, and three closed forms.
reference = fscm.solve(problem, "pull_off_force")
nN = 1e9
print(f"pull-off force {reference.value * nN:.6f} nN, numerical uncertainty {reference.u_num * nN:.0e} nN")
for name in ("jkr", "md-improved", "md-original"):
    force = create(name).evaluate(problem.dimensionless, "pull_off_force").value * problem.units["load"]
    print(f"  {name:12} {force * nN:.3f} nN, {100 * (force / reference.value - 1):+.2f} %")

# The same contact by finite elements, which contain neither the Tabor number nor the integral equation.
contact = fem_reference.Problem(
    fem_reference.PowerLaw(**solid), fem_reference.PowerPunch(**sphere), fem_reference.LennardJones(**law)
)
second = fem_reference.solve(contact, "pull_off_force", accuracy="quick")
print(f"  finite elements {second.value * 1e9:.6f} nN, numerical uncertainty {second.u_num * 1e9:.0e} nN")

# The record of a testing machine that approaches and retreats at a prescribed displacement.
path = fscm.trace(problem)
cycle = fscm.displacement_cycle(path)
lost = fscm.solve(problem, "hysteresis_energy")
print(f"energy lost in one cycle {lost.value * 1e18:.4f} aJ")

figure = Figure(figsize=(5.0, 3.6), layout="constrained")
axes = figure.subplots()
nm = 1e9
axes.plot(path.displacement * nm, path.load * nN, color="0.6", lw=1, label="equilibrium")
for (displacement, load), label, style in (
    (cycle.loading, "approach", {"color": "#0072b2"}),
    (cycle.unloading, "retreat", {"color": "#d55e00", "ls": "--"}),
):
    axes.plot(displacement * nm, load * nN, label=label, **style)
axes.axhline(0, color="0.4", lw=0.8)
axes.set(xlabel="displacement (nm)", ylabel="load (nN)", xlim=(-4, 2), ylim=(-30, 5))
axes.legend(frameon=False, loc="lower left")
figure.savefig("gecko_pad.png", dpi=150)
