"""Tables of the study of the surface modulus: values, approach to both limits, depths that change a quantity."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

import pandas as pd

from comparisons.numerics.bounds import combined

__all__ = ["THRESHOLDS", "Sample", "limits", "samples", "thresholds"]

Number = tuple[float, float]

#: Relative changes of a quantity whose depth is tabulated.
THRESHOLDS = (0.01, 0.05)

#: Greatest factor in the change over which the law of thin skins is extrapolated.
STRETCH = 5.0


@dataclass(frozen=True, slots=True)
class Sample:
    """One quantity of one solid, beside both limits; numbers are (value, u_num), None where there is none.

    Attributes
    ----------
    k, mu : float
        The graded solid, z_s = 0.
    depth : float
        z_s / L.
    mu_homogeneous : float
        Tabor number of the uniform solid with the surface modulus.
    quantity : str
        Name in `comparisons.quantities.QUANTITIES`.
    elements, fscm, graded, homogeneous : tuple or None
        By finite elements and by FSCM at z_s; by FSCM at z_s = 0, and for the uniform solid.
    reason : str
        Why the elements have no value, empty if they have.
    """

    k: float
    mu: float
    depth: float
    mu_homogeneous: float
    quantity: str
    elements: Number | None
    fscm: Number | None
    reason: str
    graded: Number | None
    homogeneous: Number | None


def samples(found: Iterable[Sample]) -> pd.DataFrame:
    """Return one row a sample."""
    rows = []
    for s in found:
        row = {
            "k": s.k,
            "mu": s.mu,
            "depth": s.depth,
            "mu_homogeneous": s.mu_homogeneous,
            "quantity": s.quantity,
        }
        for name, number in (("", s.elements), ("graded_", s.graded), ("homogeneous_", s.homogeneous)):
            row[f"{name}value"], row[f"{name}u_num"] = number or (math.nan, math.nan)
        row["fscm_value"], row["u_fscm"] = s.fscm or (math.nan, math.nan)
        rows.append(row | {"reason": s.reason})
    return pd.DataFrame(rows)


def _series(found: Iterable[Sample]) -> Iterable[list[Sample]]:
    """Samples of one quantity of one material, thin skins first."""
    for _, group in groupby(found, key=lambda s: (s.k, s.mu, s.quantity)):
        yield sorted(group, key=lambda s: s.depth)


def limits(found: Sequence[Sample]) -> pd.DataFrame:
    """Return how the finite elements approach the integral equation in both limits.

    The two thinnest and the two thickest skins with a value; `difference` is elements minus limit, `u_num` bounds
    it, `rate` is the observed exponent of its decay in z_s (negative) or 1 / z_s (positive), NaN in the first row
    of each pair and where the difference is not four times its uncertainty; `expected` is 1 - k for a thin skin.  A
    thick one stiffens its solid by a share of a / z_s, a the contact radius, and as the solid becomes rigid what is
    left to change dies out too: the rate is one or more.
    """
    rows = []
    for series in _series(found):
        for name in ("graded", "homogeneous"):
            # A jump that ends before its solid is uniform has no such limit.
            ended = name == "homogeneous" and series[-1].elements is None
            known = [s for s in series if s.elements is not None and getattr(s, name) is not None and not ended]
            ends = known[1::-1] if name == "graded" else known[-2:]
            previous: tuple[float, float] | None = None
            for s in ends:
                elements, limit = s.elements or (math.nan, math.nan), getattr(s, name)
                difference = elements[0] - limit[0]
                u_num = combined(elements[1], limit[1])
                rate = math.nan
                if previous and abs(difference) > 4.0 * u_num:
                    rate = abs(math.log(abs(difference / previous[1])) / math.log(s.depth / previous[0]))
                previous = s.depth, difference
                rows.append(
                    {
                        "k": s.k,
                        "mu": s.mu,
                        "quantity": s.quantity,
                        "limit": name,
                        "depth": s.depth,
                        "value": elements[0],
                        "limit_value": limit[0],
                        "difference": difference,
                        "u_num": u_num,
                        "rate": rate,
                        "expected": 1.0 - s.k if name == "graded" else 1.0,
                    }
                )
    return pd.DataFrame(rows)


def thresholds(found: Sequence[Sample]) -> pd.DataFrame:
    """Return the depth of the first skin that changes a quantity by 1 % and by 5 % of its graded value.

    `below` and `above` are the computed depths that bracket it, `depth` is interpolated between them in the logarithms
    of both.  Below the thinnest computed skin, where `below` is 0, the change goes as z_s^(1-k) (see `limits`); that
    law is not extrapolated beyond a factor of `STRETCH` in the change; `depth` is then NaN.  No row where it stays
    smaller or the quantity ends first.
    """
    rows = []
    for series in _series(found):
        changes = [
            (s.depth, s.elements[0] / s.graded[0] - 1.0)
            for s in series
            if s.elements is not None and s.graded is not None
        ]
        for share in THRESHOLDS:
            crossed = _crossed(changes, share, 1.0 - series[0].k)
            if crossed:
                key = {"k": series[0].k, "mu": series[0].mu, "quantity": series[0].quantity}
                rows.append(key | crossed)
    return pd.DataFrame(rows)


def _crossed(changes: Sequence[tuple[float, float]], share: float, exponent: float) -> dict[str, float] | None:
    """Where the change first exceeds a share."""
    for index, (above, large) in enumerate(changes):
        if abs(large) < share:
            continue
        if index:
            below, small = changes[index - 1]
            slope = math.log(abs(large / small)) / math.log(above / below)
        else:
            below, slope = 0.0, exponent
        known = index or abs(large) < STRETCH * share
        depth = above * (share / abs(large)) ** (1.0 / slope) if known else math.nan
        change = math.copysign(share, large)
        return {"change": change, "below": below, "above": above, "depth": float(f"{depth:.2g}")}
    return None
