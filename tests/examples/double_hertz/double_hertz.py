"""The double-Hertz model of a paraboloid on a power-law graded half-space.

Greenwood and Johnson (1998) let the adhesive traction be the difference of two Hertz distributions, of radii
a (contact) and c > a (cohesive zone), K times as strong as Hertz's at a.  Jin, Guo and Gao (2013) took that
over to graded solids.  The equations below were derived anew for this example, as follows.

Variables as in fscm-bench with mu = 1 ("tilde": delta = mu delta~, P = P~ for n = 2).  A Hertz contact of
radius a is a stack of flat punches of radius x < a with the displacements D'(x) dx, D = x^2 / (1 + k); each
carries the pressure (S/2) (x^2 - r^2)^((k-1)/2), S = sin(pi s) / (pi s), s = (1 - k)/2.  Hence

    p_a(r) = S (a^2 - r^2)^((1+k)/2) / (1 + k)^2,            load h a^(3+k),   h = 2 S / ((1+k)^2 (3+k)).

The pressure p_a - K (p_c - p_a) gives inside r < a a uniform shift, and outside 1 + K times the gap of Hertz:

    delta = D(a) - K (D(c) - D(a)),    P = h [a^(3+k) - K (c^(3+k) - a^(3+k))],    H(r) = (1 + K) H_a(r).

A flat punch at the edge works on the gap of Hertz as integral_a^c (c^2-r^2)^(-s) dH_a = c^(k-1) (D(c) - D(a))
(an Abel inversion), so the work of adhesion 1 = integral of the traction over the gap is

    1 = K (1+K) W,    W = (S/2) integral_a^c D'(x) x^(k-1) (D(x) - D(a)) dx
                        = S (1+k)^-2 [ (c^(3+k) - a^(3+k)) / (3+k) - a^2 (c^(1+k) - a^(1+k)) / (1+k) ],

which for k = 0 is (2 / (3 pi)) K (K+1) (c-a)^2 (c+2a), as in Greenwood and Johnson.  The largest tension,
K p_c(a), is
that of the 9-3 law, sigma = 16 sqrt(3)/27: K S (c^2-a^2)^((1+k)/2) / (1+k)^2 = sigma mu.
"""

import math

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from comparisons import ComputationFailed, Curve, NotApplicable, Result

STRENGTH = 16.0 * math.sqrt(3.0) / 27.0

#: The states are followed by t = -log(1 - a/c) from first contact, t = 0.  The width of the cohesive zone
#: falls as mu^(-2/(1-k)): 1e-40 of the radius at k = 0.9, mu = 100, so nothing below may subtract a from c.
T_MAX, STEPS = 150.0, 301
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)

#: It is not evaluated elsewhere; inside, "not applicable" would count as a failure.
DOMAIN = {"quantities": ["pull_off_force", "force_curve"], "n": [2, 2], "k": [0, 0.9], "mu": [1e-3, 100]}


class DoubleHertz:
    """The contract of fscm-bench: four texts, `evaluate`, and `curve` if the model has one."""

    name = "double-hertz"
    version = "1.0"
    citation = (
        "Greenwood & Johnson, J. Phys. D 31 (1998) 3279-3290; Jin, Guo & Gao, J. Mech. Phys. Solids 61 (2013) 2473-2492"
    )
    domain = "n = 2, 0 <= k <= 0.9, mu <= 100; in contact"
    applies_to = DOMAIN
    limits = ("rigid", "jkr")

    def evaluate(self, problem, quantity):
        """Return the quantity as a Result, or raise NotApplicable."""
        if quantity != "pull_off_force":
            raise NotApplicable("the example has the pull-off force and the curve")
        _, least = States(problem).least_load()
        return Result(-float(least), u_num=1e-10 * max(1.0, problem.mu))

    def curve(self, problem):
        """Return the contact branch from first contact on."""
        states = States(problem)
        displacement, load = np.transpose([states.at(t) for t in np.linspace(0.0, states.end(), 201)])
        return Curve(displacement, load)


class States:
    """The contacts of one problem."""

    def __init__(self, problem):
        if problem.n != 2 or problem.k > 0.9 or problem.mu > 100:
            raise NotApplicable("the model is for n = 2, 0 <= k <= 0.9 and mu <= 100")
        self.k, self.mu = problem.k, problem.mu
        s = (1.0 - problem.k) / 2.0
        self.S = math.sin(math.pi * s) / (math.pi * s)

    def at(self, t):
        """Return (displacement, load), dimensionless, of the state a / c = 1 - exp(-t)."""
        k, S, strength = self.k, self.S, STRENGTH * self.mu
        width = math.exp(-t)
        a = -math.expm1(-t)
        work = S / (1 + k) ** 2 * self._work(a, width)
        edge = S / (1 + k) ** 2 * (width * (1 + a)) ** ((1 + k) / 2)
        # K = strength / (edge c^(1+k)) in K (1+K) work c^(3+k) = 1, for log c; convex, so Newton cannot miss.
        log_c = -0.5 * math.log(strength * work / edge)
        for _ in range(100):
            first = work * strength / edge * math.exp(2 * log_c)
            second = work * (strength / edge) ** 2 * math.exp((1 - k) * log_c)
            step = (first + second) * math.log(first + second) / (2 * first + (1 - k) * second)
            log_c -= step
            if abs(step) < 1e-14 * (1 + abs(log_c)):
                break
        else:
            raise ComputationFailed(f"Griffith's balance was not solved at k = {k}, mu = {self.mu}")
        c = math.exp(log_c)
        K = strength / edge * c ** -(1 + k)
        lost = -math.expm1((3 + k) * math.log1p(-width)) if t > 0 else 1.0
        h = 2 * S / ((1 + k) ** 2 * (3 + k))
        load = h * c ** (3 + k) * (a ** (3 + k) - K * lost)
        displacement = c**2 / (1 + k) * (a**2 - K * width * (1 + a))
        return self.mu * displacement, load

    def _work(self, a, width):
        """W (1+k)^2 / S at c = 1; by quadrature of x^k (x^2 - a^2) where the closed form cancels."""
        k = self.k
        if a < 0.5:
            return (1 - a ** (3 + k)) / (3 + k) - a**2 * (1 - a ** (1 + k)) / (1 + k)
        beyond = width / 2 * (1 + _NODES)
        x = a + beyond
        return width / 2 * float(_WEIGHTS @ (x**k * beyond * (x + a)))

    def least_load(self):
        """Return (t, load) where the load is smallest."""
        grid = np.linspace(0.0, T_MAX, STEPS)
        loads = [self.at(t)[1] for t in grid]
        best = int(np.argmin(loads))
        bounds = (grid[max(best - 1, 0)], grid[min(best + 1, STEPS - 1)])
        least = minimize_scalar(lambda t: self.at(t)[1], bounds=bounds, method="bounded", options={"xatol": 1e-9})
        return (least.x, least.fun) if least.fun < loads[best] else (grid[best], loads[best])

    def end(self):
        """Return the t at which the load is as compressive as the pull-off is tensile."""
        start, least = self.least_load()
        if self.at(T_MAX)[1] < -least:
            raise ComputationFailed("the load stays below that up to the thinnest cohesive zone followed")
        return brentq(lambda t: self.at(t)[1] + least, start, T_MAX, xtol=1e-13)
