"""A measured force-displacement curve: modulus and work of adhesion, and the models beside the record.

python docs/examples/measured_curve.py        # writes measured_curve.png into the current folder
"""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq

import fscm
from comparisons import create

# One cycle at a prescribed displacement; the zeros of both axes are unknown.  Columns: branch (approach or retreat),
# displacement_nm (larger where the punch is deeper) and load_nN (tension negative).  Change these lines for your own.
record = pd.read_csv(Path(__file__).with_name("measured_curve.csv"))
RADIUS, NU, Z0 = 200e-9, 0.45, 0.4e-9  # a sphere on a homogeneous solid
UNLOADED_NM = 3  # so far from the farthest point there is no load
U_FORCE, U_DRAWN = 0.1e-9, 0.03e-9  # standard deviations of the two numbers of step 2, in N and m

# 1. The load is zero where the surfaces are far apart; the displacement where the load of the retreat is zero.
far = record["displacement_nm"] < record["displacement_nm"].min() + UNLOADED_NM
record["load"] = record["load_nN"] - record.loc[far, "load_nN"].median()
retreat = record[record["branch"] == "retreat"].sort_values("displacement_nm", ignore_index=True)
lowest = int(retreat["load"].idxmin())
crossing = retreat[(retreat["load"].abs() < -0.2 * retreat["load"][lowest]) & (retreat.index > lowest)]
zero = np.polynomial.Polynomial.fit(crossing["load"], crossing["displacement_nm"], 2)(0.0)

# 2. Three numbers of the record: the pull-off force, and how far the surfaces are drawn before they part.
parted = int(retreat["load"].diff().idxmin())  # the first point in contact after the jump
drawn = (zero - retreat["displacement_nm"][parted]) * 1e-9
bottom = retreat[(retreat["load"] < 0.9 * retreat["load"][lowest]) & (retreat.index > parted)]
curve = np.polynomial.Polynomial.fit(bottom["displacement_nm"], bottom["load"], 3)
force = -curve(np.linspace(*curve.domain, 200)).min() * 1e-9
print(f"pull-off force {force * 1e9:.2f} nN, drawn over {drawn * 1e9:.2f} nm")


def sphere(E, work, z0):
    """The contact of a modulus, a work of adhesion and a range of the forces."""
    return fscm.Problem(fscm.Homogeneous(E, NU), fscm.PowerPunch(2, RADIUS), fscm.LennardJones(work, z0))


def solid(force, drawn, z0):
    """Tabor number, work of adhesion and modulus that give both numbers, by the atlas."""

    def stretch(mu):
        return (
            fscm.atlas(2, 0, mu, "zero_load_displacement").value - fscm.atlas(2, 0, mu, "jump_out_displacement").value
        )

    mu = brentq(lambda mu: stretch(mu) - drawn / z0, 1.0, 10.0)
    work = force / (np.pi * RADIUS * fscm.atlas(2, 0, mu, "pull_off_force").value)
    unit = sphere(1.0, work, z0)
    return mu, work, (unit.mu / mu) ** 1.5  # mu falls with E^(2/3)


mu, work, E0 = solid(force, drawn, Z0)
print(f"Tabor number {mu:.2f}, work of adhesion {work * 1e3:.1f} mJ/m^2, modulus {E0 / 1e6:.0f} MPa")

# 3. What the errors of the record and the assumed range of the forces mean for the result.
rng = np.random.default_rng(1)
samples = [solid(force + rng.normal(0, U_FORCE), drawn + rng.normal(0, U_DRAWN), Z0) for _ in range(50)]
_, u_work, u_E0 = 2 * np.std(samples, axis=0)
print(f"from the record: +- {u_work * 1e3:.1f} mJ/m^2, +- {u_E0 / 1e6:.0f} MPa (two standard deviations)")
for z0 in (0.3e-9, 0.5e-9):
    _, other_work, other_E0 = solid(force, drawn, z0)
    print(f"with z0 = {z0 * 1e9} nm: {other_work * 1e3:.1f} mJ/m^2, {other_E0 / 1e6:.0f} MPa")
print(f"JKR from the force alone: {force / (1.5 * np.pi * RADIUS) * 1e3:.1f} mJ/m^2")

# 4. The whole record beside the model: one path of the fitted problem, as a machine records it.
fitted = sphere(E0, work, Z0)
problem = fitted.dimensionless
cycle = fscm.displacement_cycle(fscm.trace(problem, "quick", max_load=1.0, longest_step=0.1))
nm, nN = fitted.units["displacement"] * 1e9, fitted.units["load"] * 1e9
origin = zero - fscm.atlas(2, 0, mu, "zero_load_displacement").value * nm
held = retreat[retreat["displacement_nm"] > retreat["displacement_nm"][parted] + 0.2]  # the curve is steep at the jump
computed = np.interp(held["displacement_nm"] - origin, (cycle.unloading[0] * nm)[::-1], (cycle.unloading[1] * nN)[::-1])
print(f"retreat in contact: r.m.s. distance of record and model {np.std(held['load'] - computed):.1f} nN")

figure = Figure(figsize=(6.0, 4.0), layout="constrained")
axes = figure.subplots()
axes.plot(record["displacement_nm"] - origin, record["load"], ".", color="0.7", ms=3, label="record")
for columns, name in ((cycle.loading, "approach, model"), (cycle.unloading, "retreat, model")):
    axes.plot(columns[0] * nm, columns[1] * nN, label=name)
jkr = create("jkr").curve(problem)
axes.plot(jkr.displacement * nm, jkr.load * nN, "k:", label="JKR, same solid")
axes.set(xlabel="displacement (nm)", ylabel="load (nN)", xlim=(-6.5 * Z0 * 1e9, 3.5 * Z0 * 1e9))
axes.set_ylim(-1.15 * force * 1e9, 0.15 * force * 1e9)
axes.legend(frameon=False)
figure.savefig("measured_curve.png", dpi=120)
