"""A branch of a path that is made of functions, for what reads paths alone."""

import math
from types import SimpleNamespace

import numpy as np
from numpy.polynomial import Polynomial

from fem_reference import LennardJones, PowerPunch
from fem_reference._contact.states import Point


class AnalyticBranch:
    """A branch whose displacement and load are functions of the parameter, which is its only unknown."""

    def __init__(self, displacement, load, touching=True):
        self.displacement, self.load, self.touching = displacement, Polynomial(load), touching
        self.rate = displacement.deriv() if isinstance(displacement, Polynomial) else displacement.derivative()
        parts = {"law": LennardJones(1.0, 1.0), "punch": PowerPunch(2.0, 1.0)}
        self.contact = SimpleNamespace(**parts, energy=lambda y: self.work(y[0]))

    def largest_step(self, parameter):
        return math.inf

    def work(self, t):
        """Integral of the load over the displacement."""
        grid = np.linspace(0.0, t, 20001)
        return float(np.trapezoid(self.load(grid) * self.rate(grid), grid))

    def solve(self, t, y):
        state = SimpleNamespace(
            displacement=float(self.displacement(t)),
            displacement_rate=float(self.rate(t)),
            load=self.load(t),
            load_rate=self.load.deriv()(t),
            y=np.array([t, 0.0]),
            rate=np.array([1.0, 0.0]),
            size=1.0,
            iterations=1,
        )
        return Point(self, float(t), state)

    def points(self, parameters):
        return [self.solve(t, None) for t in parameters]
