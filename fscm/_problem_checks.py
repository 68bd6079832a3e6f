"""Checks of the parts of a problem: each refuses with the value, the admissible range and the reason."""

from __future__ import annotations

import math
from typing import Any

from fscm._validation import real_number
from fscm.bodies import Bodies, tension_length, tension_of
from fscm.laws import SurfaceLaw
from fscm.punch import PunchShape
from fscm.solids import GradedHalfSpace

__all__ = ["check_bodies", "check_exponents", "check_parts", "check_tabor_number", "checked_numbers"]

#: Steeper punches overflow within a few contact radii: 10^300 is near the largest double.
_LARGEST_N = 300.0

#: Range of M = 2 mu^((2n+k-1)/n).  Below, the solid is rigid to every digit of a double; above, the cohesive edge, of a
#: relative width of at most 1 / M, is as narrow as the rounding of a radius.
_LEAST_M, _LARGEST_M = 1e-30, 1e15

#: m * growth has to exceed this for the load integral of p ~ r^(-m growth) times r dr to converge.
_LOAD_INTEGRAL = 2.0
#: Shortest length at which surface tension acts, in (Q z0)^(1/n), and the inverse of the longest: shorter waves than
#: 1e-20 carry none of the pressure, and at 1e20 the surface is a rigid plane to all digits.
_SHORTEST = 1e-20


def checked_numbers(n: Any, k: Any, mu: Any) -> tuple[float, float, float]:
    """Shape index, gradient exponent and Tabor number as floats."""
    inf = math.inf
    n = real_number("shape index n", n, low=0.0, high=inf, reason="f = r^n / n must grow with r")
    k = real_number(
        "gradient exponent k",
        k,
        low=0.0,
        high=1.0,
        reason="E = E0 (z/c0)^k has no finite surface response there",
        closed_low=True,
        closed_high=True,
    )
    mu = real_number("Tabor number mu", mu, low=0.0, high=inf, reason="it is a positive ratio of lengths")
    if n > _LARGEST_N:
        raise ValueError(
            f"shape index n = {n:g} is outside (0, {_LARGEST_N:g}]: f = r^n / n overflows near the contact"
        )
    return n, k, mu


def check_tabor_number(n: float, k: float, mu: float) -> None:
    """Refuse a Tabor number at which doubles end."""
    # By logarithms: the power itself may overflow.
    log_M = math.log(2.0) + (2.0 * n + k - 1.0) / n * math.log(mu)
    if not math.log(_LEAST_M) <= log_M <= math.log(_LARGEST_M):
        raise ValueError(
            f"Tabor number mu = {mu:g} gives M = 2 mu^((2n+k-1)/n) = 10^{log_M / math.log(10.0):.0f}, outside "
            f"[{_LEAST_M:g}, {_LARGEST_M:g}]: the solid is rigid, or its cohesive edge a point, to all digits"
        )


def check_parts(punch: Any, law: Any) -> None:
    """Refuse what is no punch or no law."""
    if not isinstance(punch, PunchShape):
        raise ValueError(f"punch = {punch!r} is not a punch shape: it needs growth, height(r) and slope(r)")
    if not isinstance(law, SurfaceLaw):
        raise ValueError(
            f"law = {law!r} is not a surface law: it needs traction, slope, curvature and energy "
            "of the gap and work_of_adhesion, z0, singular_gap, peak_gap and decay"
        )


def check_bodies(graded: Any, k: float) -> None:
    """Refuse bodies whose k is not that of the problem, and the Gibson solid among several."""
    if not isinstance(graded, GradedHalfSpace | Bodies):
        raise ValueError(f"graded = {graded!r} is no graded solid: it needs modulus(z), poisson(z), length, interfaces")
    bodies = graded if isinstance(graded, Bodies) else Bodies((graded,))
    k_surface = bodies.surface.k
    if k != k_surface:
        raise ValueError(
            f"gradient exponent k = {k} is outside [{k_surface:g}, {k_surface:g}]: the modulus at the surface is finite"
            if k_surface == 0.0
            else f"gradient exponent k = {k} is outside [{k_surface:g}, {k_surface:g}]: it is that of the bodies"
        )
    if k == 1.0:
        raise ValueError(
            "gradient exponent k = 1 is outside [0, 1): the response of the Gibson solid is local, and known for this "
            "solid alone without surface tension"
        )
    for body in bodies.solids:
        length = tension_length(body)
        if tension_of(body) and not _SHORTEST <= length <= 1.0 / _SHORTEST:
            raise ValueError(
                f"the surface tension of {body!r} is as stiff as the solid at the length {length:.3g} (Q z0)^(1/n), "
                f"outside [{_SHORTEST:g}, {1.0 / _SHORTEST:g}]: a smaller one changes no digit, a larger one leaves a "
                "rigid plane"
            )


def check_exponents(n: float, k: float, punch: PunchShape, law: SurfaceLaw) -> None:
    """Refuse a punch that is too slender for the law, which is stricter for the 9-3 law, or for the Tabor number."""
    C, m = law.decay
    if C != 0.0 and not m * punch.growth > _LOAD_INTEGRAL:
        raise ValueError(
            f"growth f ~ r^{punch.growth} of the punch is outside ({_LOAD_INTEGRAL:g}/{m:g}, inf): "
            f"with p ~ H^-{m:g} far away, the load integral of p r dr diverges at infinity"
        )
    if 2.0 * n + k <= 1.0:
        raise ValueError(
            f"shape index n = {n} is outside ({(1.0 - k) / 2.0:.12g}, inf) for k = {k}: "
            "the Tabor number of Eq. 29 is a power 1 / (2n + k - 1)"
        )
