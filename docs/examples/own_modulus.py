"""A modulus of one's own, by finite elements: a non-zero modulus of the surface, a stiff skin, a coating.

python docs/examples/own_modulus.py
"""

import numpy as np

from fem_reference import CoatingModulus, CustomModulus, CustomSolid, LennardJones, PowerPunch, Problem, Solid, solve

sphere = PowerPunch(n=2, Q=100e-9)  # m: the radius
law = LennardJones(work_of_adhesion=0.05, z0=0.5e-9)  # J/m^2, m
E0, c0, k, nu = 2e9, 1e-6, 0.4, 0.3  # E = E0 (z/c0)^k: 2 GPa at a depth of one micrometre

# 2 GPa at the surface and 1 GPa below.  The exponents are those of the power laws at the surface and at great depth;
# over `surface_depth` the modulus leaves the first one.
skin = CustomModulus(
    lambda z: 1e9 * (1.0 + np.exp(-z / 10e-9)), surface_exponent=0.0, depth_exponent=0.0, surface_depth=10e-9
)
# A sharp interface: the mesh has a line there.  A CustomModulus declares it with `interfaces=(Interface(depth),)`.
coating = CoatingModulus(E_coating=1e9, E_substrate=10e9, thickness=20e-9)

for name, solid in (
    ("E0 (z/c0)^k", Solid(E0, c0, k, nu)),
    ("E0 ((z + 5 nm)/c0)^k", Solid(E0, c0, k, nu, z_s=5e-9)),
    ("1 GPa under a skin of 2 GPa", CustomSolid(skin, nu)),
    ("20 nm of 1 GPa on 10 GPa", CustomSolid(coating, nu)),
):
    force = solve(Problem(solid, sphere, law), "pull_off_force", accuracy="quick")
    print(f"{name:28} pull-off force {force.value * 1e9:.5f} nN, u_num {force.u_num * 1e9:.0e} nN")
