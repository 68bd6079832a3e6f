"""A punch and a surface law of one's own: a rounded cone, attracted by a steeper 10-4 law.

python docs/examples/own_shape_and_law.py
"""

import numpy as np

from fscm import CustomPunch, LennardJones, Mie, PowerPunch, Problem, solve

# Heights in z0, radii in (Q z0)^(1/n) of the paraboloid that it is near its tip: r^2/2 there, a cone far from it.
rounded_cone = CustomPunch(lambda r: np.sqrt(1.0 + r**2) - 1.0, growth=1.0)

for shape, punch in (("paraboloid", PowerPunch(2)), ("rounded cone", rounded_cone)):
    for exponents, law in (("9-3", LennardJones()), ("10-4", Mie(m=10, n=4))):
        force = solve(Problem(n=2, k=0.4, mu=1.0, punch=punch, law=law), "pull_off_force")
        print(f"{shape:12}  {exponents:4}  pull-off force {force.value:.8f}  u_num {force.u_num:.0e}")
