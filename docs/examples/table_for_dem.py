"""A table of the normal force between two particles for a code of discrete elements, between DMT and JKR.

LAMMPS and Lethe have Hertz, DMT and JKR.  In both the overlap is positive in contact, and a force is positive where
it pushes the particles apart: displacement and load here.  The work of adhesion w is 2 gamma in LAMMPS, whose pull-off
force of JKR is 3 pi gamma R, and gamma in Lethe, where it is 3/2 pi gamma R; R is the effective radius of the pair.
The columns differ between jump-out and jump-in: the force depends on whether the pair has touched.  Particles attract
each other before they overlap, so that the search for neighbours has to begin at the first displacement of the table.

python docs/examples/table_for_dem.py
"""

import csv
import sys

import numpy as np

import fscm

R, modulus, nu, work, z0 = 50e-6, 5e9, 0.3, 0.02, 0.4e-9  # m, Pa, J/m^2, m: two equal spheres
# Compliances add: one body of half the modulus on a rigid one.
solid = fscm.PowerLaw(E0=modulus / 2.0, c0=1.0, k=0.0, nu=nu)
problem = fscm.Problem(solid, fscm.PowerPunch(n=2, Q=R / 2.0), fscm.LennardJones(work, z0))
curve = fscm.force_curve(problem.n, problem.k, problem.mu).in_units(problem.units)

first = curve.displacement[curve.load < 0.01 * curve.load.min()][0]  # the attraction is a hundredth of the pull-off
overlap = np.linspace(first, 20.0 * abs(first), 400)
approach, retreat = (curve.load_at(overlap, branch) for branch in ("approach", "retreat"))
table = csv.writer(sys.stdout, lineterminator="\n")
table.writerow(["overlap_m", "force_on_approach_N", "force_on_retreat_N", "bound_N"])
bound = np.maximum(approach.bound, retreat.bound)
for row in zip(overlap, approach.value, retreat.value, bound, strict=True):
    table.writerow([f"{number:.6e}" for number in row])
print(
    f"mu = {problem.mu:.3f}, pull-off {-curve.load.min() / (np.pi * work * R / 2):.3f} pi w R (DMT 2, JKR 1.5)",
    file=sys.stderr,
)
