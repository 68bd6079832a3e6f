"""A modulus of one's own: finite elements for a surface that is not infinitely soft, and for a stiff skin.

python docs/examples/own_modulus.py
"""

import numpy as np

import fem_reference as fe

sphere = fe.PowerPunch(n=2, Q=100e-9)  # m: the radius
law = fe.LennardJones(work_of_adhesion=0.05, z0=0.5e-9)  # J/m^2, m
E0, c0, k, nu = 2e9, 1e-6, 0.4, 0.3  # E = E0 (z/c0)^k: 2 GPa at a depth of one micrometre

# E(z) that is 1 GPa stiffer at the surface than below; it needs the exponents of the power laws it begins and ends
# with, and the depth over which it leaves the first.
skin = fe.CustomModulus(
    lambda z: 1e9 * (1.0 + np.exp(-z / 10e-9)), surface_exponent=0.0, depth_exponent=0.0, surface_depth=10e-9
)
for name, solid in (
    ("E0 (z/c0)^k", fe.Solid(E0, c0, k, nu)),
    ("E0 ((z + 5 nm)/c0)^k", fe.Solid(E0, c0, k, nu, z_s=5e-9)),
    ("1 GPa under a skin of 2 GPa", fe.CustomSolid(skin, nu)),
):
    force = fe.solve(fe.Problem(solid, sphere, law), "pull_off_force", accuracy="quick")
    print(f"{name:28} pull-off force {force.value * 1e9:.5f} nN, u_num {force.u_num * 1e9:.0e} nN")
