"""Error of a mesh from elements of three degrees on it.

Functions of a degree contain those of all lower ones.  Where they resolve a solution, each degree divides the error by
a gain that is nearly constant; where the solution is singular, the gain falls like a power of the degree.
"""

from __future__ import annotations

import math

__all__ = ["LARGEST_GAIN", "SMALLEST_GAIN", "degree_error"]

#: Ratio of the errors of two neighbouring degrees: the smallest is assumed everywhere, and the largest is believed.
#: Half of the gain from degree 4 to 7 is at most that from 7 to 8 for errors that fall like any power of the degree
#: while it is below 4.6.  With 3 the error may also change its sign between the last two degrees, as that of the
#: central gap at the jump into contact of n = 5, k = 0, mu = 1 (3.1e-8, 0.76 of its bound; with 4 it was 1.05).
SMALLEST_GAIN, LARGEST_GAIN = 2.0, 3.0

#: Ratio of a measured gain to the one that is believed: the next gain may be smaller.
CAUTION = 2.0

#: Values of three neighbouring degrees that rise and fall do not converge regularly: the last step is taken to be at
#: least this share of the one before (the gap at the jump out of n = 1.86, k = 0.87, mu = 0.86, quick meshes: 0.31).
IRREGULAR = 0.4

#: Largest gain of a degree, and the largest number of degrees in succession that have it.  Two values that agree to
#: more than the third one lets expect agree by chance.  Measured against the integral equation with degrees 4, 7 and 8:
#: no error of 238 values on graded solids is above 0.32 of the sum of both bounds; without the limit of the number one
#: is 0.76 of them, and that of the force on a stack of layers, where the gain seems to be 26 three times, is 1.6 times
#: them (5e-11 of the force).
PLAUSIBLE_GAIN, PLAUSIBLE_DEGREES = 30.0, 2


def degree_error(
    degrees: tuple[int, int, int], values: tuple[float, float, float], largest_gain: float = LARGEST_GAIN
) -> float:
    """Return the error of the value of the highest degree p, from those of p - 1 and of a lower one.

    With a gain g, the values of p - 1 and p differ by at least g - 1 times the error of the latter.

    Parameters
    ----------
    degrees : tuple of int
        Rising, the last two neighbours.
    values : tuple of float
        The lowest one may be nan: the smallest gain is assumed then.
    largest_gain : float
        That is believed.

    Examples
    --------
    >>> degree_error((4, 5, 6), (2.0, 1.0625, 1.0))  # a gain of 15, of which 3 is believed
    0.03125
    >>> degree_error((4, 5, 6), (2.0, 1.5, 1.0)), degree_error((4, 5, 6), (math.nan, 1.5, 1.0))
    (0.5, 0.5)
    >>> degree_error((4, 5, 6), (31.0, 1.0, 1.0))  # two agree by chance
    0.5
    >>> degree_error((4, 5, 6), (1.0, 2.0, 1.9))  # irregular
    0.4
    """
    lowest, lower, value = values
    step, steps = abs(lower - value), degrees[1] - degrees[0]
    gain = SMALLEST_GAIN
    if not math.isnan(lowest):
        before = abs(lowest - lower)
        step = max(step, before / PLAUSIBLE_GAIN ** min(steps, PLAUSIBLE_DEGREES))
        if steps == 1 and (lower - lowest) * (value - lower) < 0.0:
            step = max(step, IRREGULAR * before)
        if step > 0.0:
            gain = min(max((before / step) ** (1.0 / steps) / CAUTION, SMALLEST_GAIN), largest_gain)
    return step / (gain - 1.0)
