"""The JKR model of a punch of any axisymmetric profile on a graded half-space, by dimensionality reduction.

With G of `profile_branch`, the profile g and the moment m of `plane_profile` and the constants of `graded_punch`, the
contact of the radius a has

    lift = adhesion sqrt(G) a^s,    delta = g - lift,    P = (stiffness / G) [ (g - lift) a^(1+k) / (1+k) - m ],

Griffith's balance at the edge.  The flat punch that is subtracted is the same for every profile (Jin, Guo & Zhang, J.
Appl. Mech. 80 (2013) 061024; Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18, in the limit of a large cohesive stress;
the handbook of Popov, Hess and Willert).  For a power law it is `jkr`, for a ball `jkr-sphere-projected`.
"""

from __future__ import annotations

import math
from typing import ClassVar

from comparisons.models.closed_form import SOFT
from comparisons.models.profile_branch import ROUNDING, Branch, ProfileModel, State


class _JKRBranch(Branch):
    """The states of JKR."""

    def at(self, radius: float) -> State:
        """Return the state of a contact radius."""
        profile, moment = self.profile.at(radius)
        lift = self.punch.adhesion * math.sqrt(self.compliance) * radius**self.punch.s
        area, stiffness = radius ** (1.0 + self.punch.k) / (1.0 + self.punch.k), self.punch.stiffness / self.compliance
        load = stiffness * ((profile - lift) * area - moment)
        terms = stiffness * ((profile + lift) * area + moment)
        return State(profile - lift, load, ROUNDING * (profile + lift), ROUNDING * terms)


class JKRProfile(ProfileModel):
    """JKR of any profile without waves.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> ball = Problem.of(
    ...     solid={"kind": "homogeneous", "E": "0.75 MPa", "nu": 0.5},
    ...     punch={"kind": "ball", "R": "10 um"},
    ...     law={"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "0.3 nm"},
    ... )
    >>> from comparisons.models.jkr_sphere import JKRSphereProjected
    >>> model, exact = JKRProfile(), JKRSphereProjected()
    >>> abs(model.evaluate(ball, "pull_off_force").value - exact.evaluate(ball, "pull_off_force").value) < 1e-12
    True
    """

    name = "jkr-profile"
    citation = (
        "Willert, Facta Univ. Mech. Eng. 16 (2018) 9-18; Jin, Guo & Zhang, J. Appl. Mech. 80 (2013) 061024; "
        "Popov, Hess & Willert, Handbook of Contact Mechanics (2019)"
    )
    domain = "problems in physical units, power-law solid, punch without waves, law without barrier; mu -> infinity"
    validity = SOFT
    _branch_type: ClassVar[type[Branch]] = _JKRBranch
