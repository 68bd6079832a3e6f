"""Numbers that a paper prints, and whether a computed one has their digits.

`published.toml` holds them as text, so that the number of digits is known.
"""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from decimal import Decimal
from importlib.resources import files

__all__ = ["Published", "published"]

# Of a formula written as a decimal here.
_ROUNDING = 2.0**-52


@dataclass(frozen=True, slots=True)
class Published:
    """A number a paper prints, and what it is of.

    Attributes
    ----------
    name : str
        Which number: a word for the program.
    source, quantity : str
        Where it is printed and what it is, for people.
    text : str
        As printed: a decimal, or a formula if `exact` is given.
    unit : str
        "%" or empty.
    model : str
        Model it is of, if of one.
    n, k : float
        Its case, NaN where it has none.
    index : int
        Which of several of one name.
    exact : float or None
        Value of a formula.
    """

    name: str
    source: str
    quantity: str
    text: str
    unit: str = ""
    model: str = ""
    n: float = math.nan
    k: float = math.nan
    index: int = 0
    exact: float | None = None

    @property
    def value(self) -> float:
        """The number itself, in its unit."""
        return float(self.text) if self.exact is None else self.exact

    def verdict(self, computed: float, u: float) -> str:
        """Say whether a computed number has the published digits, rounded or cut off.

        Nothing tells how a paper shortens its numbers, so 15.95 agrees with both 15.9 and 16.0.

        Parameters
        ----------
        computed, u : float
            The number, without the sign that the paper leaves out, and a bound on its error, in `unit`.

        Returns
        -------
        str
            "agrees", "differs", or "undecided" where `u` allows both.  A formula agrees with what `u` allows.

        Examples
        --------
        >>> Published("", "Sec. 4.3.2", "", "6.7", "%").verdict(6.68, 1e-4)
        'agrees'
        """
        if self.exact is not None:
            return "agrees" if abs(computed - self.exact) <= u + _ROUNDING * abs(self.exact) else "differs"
        low, high = Decimal(computed) - Decimal(u), Decimal(computed) + Decimal(u)
        stated = Decimal(self.text)
        step = Decimal(1).scaleb(stated.as_tuple().exponent)  # type: ignore[arg-type]
        # Rounding admits half a step to either side, cutting off a whole step above.
        least, most = stated - step / 2, stated + step
        if least <= low and high < most:
            return "agrees"
        return "undecided" if low < most and high >= least else "differs"


def published(name: str | None = None) -> list[Published]:
    """Return the published numbers, by default all, or those of one name.

    Examples
    --------
    >>> [number.text for number in published("eta")]
    ['0.347', '0.499', '0.588', '0.803', '1.026']
    """
    text = files("comparisons").joinpath("published.toml").read_text(encoding="utf-8")
    numbers = [Published(**table) for table in tomllib.loads(text)["number"]]
    return [number for number in numbers if name in (None, number.name)]
