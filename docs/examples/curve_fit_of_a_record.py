"""A record fitted with `scipy.optimize.curve_fit`: modulus, work of adhesion and the zero of the displacement.

python docs/examples/curve_fit_of_a_record.py
"""

import numpy as np
from scipy.optimize import curve_fit

import fscm

nu, z0 = 0.5, 0.4e-9  # m
bead = fscm.PowerPunch(n=2, Q=5e-6)  # m: the radius


def retreat(displacement, modulus, work, zero):
    """Load in N over the displacement in m, from contact to beyond the jump-off; modulus in MPa, work in mJ/m^2."""
    solid = fscm.PowerLaw(E0=modulus * 1e6, c0=1.0, k=0.0, nu=nu)
    problem = fscm.Problem(solid, bead, fscm.LennardJones(work * 1e-3, z0))
    curve = fscm.force_curve(problem.n, problem.k, problem.mu).in_units(problem.units)
    return curve.load_at(displacement - zero * 1e-9, "retreat").value * 1e9  # nN


x = np.linspace(60e-9, -30e-9, 200)
record = retreat(x, 800.0, 50.0, 2.0) + np.random.default_rng(1).normal(0.0, 5.0, x.size)
values, covariance = curve_fit(retreat, x, record, p0=(700.0, 45.0, 0.0))
for name, value, u in zip(
    ("modulus (MPa)", "work (mJ/m^2)", "zero (nm)"), values, np.sqrt(np.diag(covariance)), strict=True
):
    print(f"{name:14} {value:.4g} +- {u:.1g}")
