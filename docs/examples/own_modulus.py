"""A modulus of one's own, by finite elements: a non-zero modulus of the surface, a stiff skin, a coating.

python docs/examples/own_modulus.py
"""

import numpy as np

from fem_reference import (
    Coating,
    CustomSolid,
    LennardJones,
    OffsetPowerLaw,
    PowerLaw,
    PowerPunch,
    Problem,
    solve,
)

sphere = PowerPunch(n=2, Q=100e-9)  # m: the radius
law = LennardJones(work_of_adhesion=0.05, z0=0.5e-9)  # J/m^2, m
E0, c0, k, nu = 2e9, 1e-6, 0.4, 0.3  # E = E0 (z/c0)^k: 2 GPa at a depth of one micrometre

# 2 GPa at the surface and 1 GPa below; the modulus changes over `length`.
skin = CustomSolid(lambda z: 1e9 * (1.0 + np.exp(-z / 10e-9)), nu, length=10e-9)
# A sharp interface: the mesh has a line there.  A CustomSolid declares it with `interfaces=[depth]`.
coating = Coating(E_coating=1e9, E_substrate=10e9, thickness=20e-9, transition=0.0, nu_coating=nu)

for name, solid in (
    ("E0 (z/c0)^k", PowerLaw(E0, c0, k, nu)),
    ("E0 ((z + 5 nm)/c0)^k", OffsetPowerLaw(E0, c0, k, 5e-9, nu)),
    ("1 GPa under a skin of 2 GPa", skin),
    ("20 nm of 1 GPa on 10 GPa", coating),
):
    force = solve(Problem(solid, sphere, law), "pull_off_force", accuracy="quick")
    print(f"{name:28} pull-off force {force.value * 1e9:.5f} nN, u_num {force.u_num * 1e9:.0e} nN")
