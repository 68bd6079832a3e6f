"""A gecko-like graded pad, from numbers with units to a plot: the code of docs/tutorial.md.

python docs/examples/gecko_pad.py        # writes gecko_pad.png into the current folder
"""

from matplotlib.figure import Figure

import fem_reference
import fscm
from comparisons import create

# An asperity of 100 nm on keratin whose modulus grows with the depth: 2 GPa at 1 micrometre.  SI units.
pad = fscm.PhysicalProblem(
    E0=2e9,  # Pa
    c0=1e-6,  # m
    k=0.4,
    nu=0.3,
    n=2,  # a paraboloid, so that Q is its radius
    Q=100e-9,  # m
    work_of_adhesion=0.05,  # J/m^2
    z0=0.5e-9,  # m, range of the surface forces
)
problem = pad.problem()
print(f"Tabor number {problem.mu:.4f}")

# The pull-off force: the reference with its uncertainty, and three closed forms.
reference = fscm.solve(problem, "pull_off_force")
nN = pad.scales["load"] * 1e9
print(f"pull-off force {reference.value * nN:.6f} nN, numerical uncertainty {reference.u_num * nN:.0e} nN")
for name in ("jkr", "md-improved", "md-original"):
    result = create(name).evaluate(problem, "pull_off_force")
    print(f"  {name:12} {result.value * nN:.3f} nN, {100 * (result.value / reference.value - 1):+.2f} %")

# The same contact by finite elements, which contain neither the Tabor number nor the integral equation.
contact = fem_reference.Problem(
    fem_reference.Solid(E0=pad.E0, c0=pad.c0, k=pad.k, nu=pad.nu),
    fem_reference.PowerPunch(n=pad.n, Q=pad.Q),
    fem_reference.LennardJones(work_of_adhesion=pad.work_of_adhesion, z0=pad.z0),
)
second = fem_reference.solve(contact, "pull_off_force", accuracy="quick")
print(f"  finite elements {second.value * 1e9:.6f} nN, numerical uncertainty {second.u_num * 1e9:.0e} nN")

# The record of a testing machine that approaches and retreats at a prescribed displacement.
path = fscm.trace(problem)
cycle = fscm.displacement_cycle(path)
lost = fscm.solve(problem, "hysteresis_energy")
print(f"energy lost in one cycle {lost.value * pad.scales['energy'] * 1e18:.4f} aJ")

figure = Figure(figsize=(5.0, 3.6), layout="constrained")
axes = figure.subplots()
nm = pad.scales["displacement"] * 1e9
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
