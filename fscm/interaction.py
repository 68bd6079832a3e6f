"""Surface forces between a punch and the points of the surface, in any consistent units.

A point of the surface at the radius r has the vertical gap H to the punch.

* `Derjaguin`: the traction is the law at H, as if the facing parts were parallel.  The work of adhesion counts for the
  projected area.
* `fscm._whole_punch.WholePunch`: the traction is the potential of all atoms of the punch at the point.  It counts for
  the true area.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fscm._ball import BallUnderLaw, BallUnderMie
from fscm._body_of_revolution import BodyOfRevolution
from fscm._curved_face import CurvedFace, check_face
from fscm._typing import Array
from fscm.laws import LennardJones, Mie, SurfaceLaw
from fscm.punch import Ball, PunchShape, ScaledPunch

__all__ = ["INTERACTIONS", "Derjaguin", "Interaction", "check_interaction", "interaction_of"]

#: Names of the interactions.
INTERACTIONS = ("derjaguin", "body")


class Interaction(Protocol):
    """Traction on the surface of the solid; compression is positive.

    All functions have the shape of their arguments, radius and vertical gap.
    """

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        ...

    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""
        ...

    def drift(self, r: Array, H: Array) -> Array | None:
        """r dp/dr at a fixed gap; None if p depends on the gap alone."""
        ...

    def size(self, r: Array, H: Array) -> Array:
        """Sizes of the terms of p, to which its rounding is relative."""
        ...

    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius."""
        ...

    def remainder(self, r: Array, H: Array) -> Array | None:
        """Estimate of the size of what p leaves out; None if nothing."""
        ...

    def opening(self, r: Array, H: Array) -> Array:
        """Change of the distance to the punch along the surface between points, of shape (2, N)."""
        ...

    def peak_gap(self, r: Array) -> Array | float:
        """Gap of the largest tension at a radius: the one at a contact edge."""
        ...

    def peak_drift(self, r: float) -> float:
        """Its derivative by the logarithm of the radius."""
        ...


@dataclass(frozen=True, slots=True)
class Derjaguin:
    """The law at the vertical gap.

    Parameters
    ----------
    law : SurfaceLaw

    Examples
    --------
    >>> float(Derjaguin(LennardJones()).traction(np.array(3.0), np.array(0.0)))
    -0.0
    """

    law: SurfaceLaw

    def traction(self, r: Array, H: Array) -> Array:
        """p(H)."""
        return self.law.traction(H)

    def slope(self, r: Array, H: Array) -> Array:
        """p'(H)."""
        return self.law.slope(H)

    def drift(self, r: Array, H: Array) -> None:
        """None."""
        return

    def size(self, r: Array, H: Array) -> Array:
        """|p|: laws have full relative accuracy."""
        return np.abs(self.law.traction(H))

    def energy(self, r: Array, H: Array) -> Array:
        """e(H)."""
        return self.law.energy(H)

    def remainder(self, r: Array, H: Array) -> None:
        """None."""
        return

    def opening(self, r: Array, H: Array) -> Array:
        """Change of the gap."""
        return np.abs(H[1] - H[0])

    def peak_gap(self, r: Array) -> float:
        """That of the law."""
        return self.law.peak_gap

    def peak_drift(self, r: float) -> float:
        """Zero."""
        return 0.0


def check_interaction(name: object) -> None:
    """Raise ValueError unless it is one of `INTERACTIONS`."""
    if name not in INTERACTIONS:
        raise ValueError(f"interaction {name!r} is unknown; it is one of {', '.join(INTERACTIONS)}")


def interaction_of(punch: PunchShape, law: SurfaceLaw, name: str) -> Interaction:
    """The interaction of a punch and a law.

    Parameters
    ----------
    punch : PunchShape
    law : SurfaceLaw
    name : str
        One of `INTERACTIONS`.

    Raises
    ------
    ValueError
        For an unknown name, and for "body" where it is not known: for a punch that is less slender than a cone far
        away, and under a law from a table for a face with kinks, hollows or a sharp tip.

    Examples
    --------
    >>> interaction_of(Ball(R=20.0), LennardJones(), "derjaguin")
    Derjaguin(law=LennardJones(work_of_adhesion=1.0, z0=1.0))
    """
    check_interaction(name)
    if name == "derjaguin":
        return Derjaguin(law)
    shape = punch.punch if isinstance(punch, ScaledPunch) else punch
    if isinstance(shape, Ball) and type(law) in (LennardJones, Mie):
        return BallUnderMie(punch, law)  # type: ignore[arg-type]  # checked above
    if isinstance(shape, Ball):
        return BallUnderLaw(punch, law)  # type: ignore[arg-type]  # any law, see there
    if shape.growth < 1.0:
        raise ValueError(
            f"growth f ~ r^{shape.growth:g} of the punch is outside [1, inf): for interaction 'body' the punch has to "
            "be as slender as a cone far away; take 'derjaguin'"
        )
    if type(law) not in (LennardJones, Mie):
        check_face(punch, law)
        return CurvedFace(punch, law)
    return BodyOfRevolution(punch, law)  # type: ignore[arg-type]  # checked above
