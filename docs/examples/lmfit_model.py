"""A record fitted with a model of `lmfit`, whose parameters may be bounded, tied or held.

python docs/examples/lmfit_model.py
"""

import lmfit
import numpy as np

import fscm

bead = fscm.PowerPunch(n=2, Q=1e-6)  # m: the radius


def approach(x, modulus, work, z0):
    """Load in nN over the displacement in m, before and after the jump-in; GPa, mJ/m^2, nm."""
    solid = fscm.PowerLaw(E0=modulus * 1e9, c0=1.0, k=0.0, nu=0.4)
    problem = fscm.Problem(solid, bead, fscm.LennardJones(work * 1e-3, z0 * 1e-9))
    curve = fscm.force_curve(problem.n, problem.k, problem.mu).in_units(problem.units)
    return curve.load_at(x, "approach").value * 1e9


model = lmfit.Model(approach)
parameters = model.make_params(modulus={"value": 2.0, "min": 0.1}, work={"value": 40.0, "min": 1.0}, z0=0.4)
parameters["z0"].vary = False
x = np.linspace(-5e-9, 10e-9, 150)
record = approach(x, 3.0, 50.0, 0.4) + np.random.default_rng(2).normal(0.0, 2.0, x.size)
result = model.fit(record, parameters, x=x)
for name, parameter in result.params.items():
    print(f"{name:8} {parameter.value:.4g} +- {parameter.stderr:.1g}")
