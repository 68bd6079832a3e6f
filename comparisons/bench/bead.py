"""A bead on rubber, and the records that a machine of prescribed displacement would make of it."""

from __future__ import annotations

import numpy as np

import fscm
from comparisons.fitting.record import Record
from comparisons.problem import Problem, Section

#: The problem as a file.
BEAD = """
[solid]
kind = "homogeneous"
E = "1.5 MPa"
nu = 0.5

[punch]
kind = "sphere"
R = "5 um"

[law]
kind = "lennard-jones-9-3"
work_of_adhesion = "50 mJ/m^2"
z0 = "0.4 nm"
"""

#: Points of each branch of a record, and its noise in the pull-off force.
_POINTS, _NOISE = 250, 0.01


def bead(modulus: float = 1.5e6, work_of_adhesion: float = 0.05) -> Problem:
    """Return the problem of the file, with a modulus in Pa and a work of adhesion in J/m^2.

    Examples
    --------
    >>> bead().posed.mu > 50
    True
    """
    law = Section("lennard-jones-9-3", {"work_of_adhesion": work_of_adhesion, "z0": 4e-10})
    return Problem(Section("homogeneous", {"E": modulus, "nu": 0.5}), Section("sphere", {"R": 5e-6}), law)


def record(problem: Problem, seed: int = 1) -> Record:
    """Return a record of both branches, with the noise of a seed."""
    posed = problem.build(fscm)
    curve = fscm.force_curve(posed.n, posed.k, posed.mu).in_units(posed.units)
    x = np.linspace(2.0 * curve.displacement.min(), -2.0 * curve.displacement.min(), _POINTS)
    noise = np.random.default_rng(seed).normal(0.0, -_NOISE * curve.load.min(), (2, _POINTS))
    load = [curve.load_at(x, "approach").value + noise[0], curve.load_at(x[::-1], "retreat").value + noise[1]]
    return Record("bead", np.concatenate([x, x[::-1]]), np.concatenate(load), np.arange(2 * _POINTS) < _POINTS)
