"""Verdicts PASS, FAIL and INCONCLUSIVE on an error and its bound, after ASME V&V 20.

With the error E of a candidate and the bound U of `comparisons.numerics.bounds`, the exact error is in
[E - U, E + U].  A gate passes if all of this interval is within its limits, fails if none of it is, and is inconclusive
otherwise.  A pass becomes inconclusive where an uncertainty is larger than the gate admits.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from enum import StrEnum

from comparisons.numerics.number_text import exact


class Verdict(StrEnum):
    """Outcome of a gate in one case, or rolled up over its cases; the first is the worst.

    ``NOT_APPLICABLE`` is a case that a gate leaves out by its own declaration; it counts for nothing.
    """

    ERROR = "ERROR"
    FAIL = "FAIL"
    XPASS = "XPASS"
    INCONCLUSIVE = "INCONCLUSIVE"
    XFAIL = "XFAIL"
    PASS = "PASS"
    NOT_APPLICABLE = "NOT-APPLICABLE"

    @property
    def rank(self) -> int:
        """0 for the worst."""
        return list(Verdict).index(self)


def decide(error: float, uncertainty: float, lower: float, upper: float) -> Verdict:
    """Judge one error; anything that is not a finite number is an ERROR.

    Parameters
    ----------
    error, uncertainty : float
        E and U, in the unit of the limits.
    lower, upper : float
        Signed limits, lower <= upper; infinite for none.

    Examples
    --------
    >>> [str(decide(error, 0.1, -1.0, 1.0)) for error in (0.85, 0.95, 1.05, 1.15, math.nan)]
    ['PASS', 'INCONCLUSIVE', 'INCONCLUSIVE', 'FAIL', 'ERROR']
    """
    if not (math.isfinite(error) and math.isfinite(uncertainty) and uncertainty >= 0.0):
        return Verdict.ERROR
    low, high = error - uncertainty, error + uncertainty
    if lower <= low and high <= upper:
        return Verdict.PASS
    if high < lower or low > upper:
        return Verdict.FAIL
    return Verdict.INCONCLUSIVE


def crossing(error: float, uncertainty: float, lower: float, upper: float, shares: Mapping[str, float]) -> str:
    """Return why an error is inconclusive: the limits that its interval reaches across, and whose uncertainty it is.

    Parameters
    ----------
    error, uncertainty, lower, upper : float
        As of `decide`, which finds them inconclusive.
    shares : mapping of str to float
        The part of u of each model, in the unit of the limits, by words such as "the candidate jkr".

    Examples
    --------
    >>> crossing(0.95, 0.1, -1.0, 1.0, {"the reference fscm": 1e-9, "the candidate jkr": 0.05})
    'E = 0.95 +- 0.1 reaches across the limit 1, mostly by u of the candidate jkr: 0.05 (the reference fscm: 1e-09)'
    """
    limits = [limit for limit in (lower, upper) if error - uncertainty <= limit <= error + uncertainty]
    (largest, share), *smaller = sorted(shares.items(), key=lambda item: -item[1])
    remainder = f" ({', '.join(f'{name}: {u:.2g}' for name, u in smaller)})" if smaller else ""
    return (
        f"E = {error:.4g} +- {uncertainty:.2g} reaches across the limit{'s' * (len(limits) > 1)} "
        f"{' and '.join(map(exact, limits))}, mostly by u of {largest}: {share:.2g}{remainder}"
    )


def expecting_failure(verdict: Verdict) -> Verdict:
    """Return the verdict of a gate that is declared to fail: XFAIL for a failure, XPASS for a pass.

    Examples
    --------
    >>> [str(expecting_failure(verdict)) for verdict in (Verdict.FAIL, Verdict.PASS, Verdict.ERROR)]
    ['XFAIL', 'XPASS', 'ERROR']
    """
    return {Verdict.FAIL: Verdict.XFAIL, Verdict.PASS: Verdict.XPASS}.get(verdict, verdict)


def roll_up(verdicts: Iterable[str]) -> Verdict:
    """Return the worst of verdicts, or their names; ERROR if nothing was evaluated.

    Examples
    --------
    >>> str(roll_up([Verdict.PASS, Verdict.FAIL, Verdict.XPASS])), str(roll_up([]))
    ('FAIL', 'ERROR')
    """
    evaluated = {Verdict(verdict) for verdict in verdicts} - {Verdict.NOT_APPLICABLE}
    return min(evaluated, key=lambda verdict: verdict.rank, default=Verdict.ERROR)
