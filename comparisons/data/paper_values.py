"""Numbers printed in a paper, and the comparison of computed numbers with their digits.

`paper_values.toml` holds them as text, so that the number of digits is known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal

from comparisons.data.toml_text import shipped

#: Verdict on a number that has the printed digits only if its further digits are dropped.
TRUNCATED = "agrees if truncated"

#: Of a formula written as a decimal here.
_ROUNDING = 2.0**-52


@dataclass(frozen=True, slots=True, eq=False)
class PaperValue:
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
    term : str
        The measure that computes it (`comparisons.paper.statements.measures`), if one does.
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
    term: str = ""

    @property
    def value(self) -> float:
        """The number itself, in its unit."""
        return float(self.text) if self.exact is None else self.exact

    def verdict(self, computed: float, u: float) -> str:
        """Return whether a computed number has the printed digits.

        The paper does not state how it shortens numbers: most are rounded, and 6.78 printed as 6.7 was truncated.

        Parameters
        ----------
        computed, u : float
            The number, without the sign that the paper leaves out, and a bound on its error, in `unit`.

        Returns
        -------
        str
            "agrees" where it rounds to them, "agrees if truncated" where it has them only if its further digits are
            dropped, "differs", or "undecided" where `u` allows more than one of these.  A formula agrees with what
            `u` allows.

        Examples
        --------
        >>> [PaperValue("", "Sec. 4.3.2", "", "6.7", "%").verdict(value, 1e-4) for value in (6.68, 6.78, 6.82)]
        ['agrees', 'agrees if truncated', 'differs']
        """
        if self.exact is not None:
            return "agrees" if abs(computed - self.exact) <= u + _ROUNDING * abs(self.exact) else "differs"
        low, high = Decimal(computed) - Decimal(u), Decimal(computed) + Decimal(u)
        stated = Decimal(self.text)
        verdicts = {_of_digits(value, stated) for value in (low, high)}
        if low <= stated <= high:
            verdicts.add("agrees")
        return verdicts.pop() if len(verdicts) == 1 else "undecided"


def _of_digits(value: Decimal, stated: Decimal) -> str:
    """Return how an exact value relates to the digits stated; a tie may be rounded either way."""
    step = Decimal(1).scaleb(stated.as_tuple().exponent)  # type: ignore[arg-type]  # a finite number
    if abs(value - stated) <= step / 2:
        return "agrees"
    return TRUNCATED if stated < value < stated + step else "differs"


def paper_values(name: str | None = None) -> list[PaperValue]:
    """Return the paper values, by default all, or those of one name.

    Examples
    --------
    >>> [number.text for number in paper_values("eta")]
    ['0.347', '0.499', '0.588', '0.803', '1.026']
    """
    numbers = [PaperValue(**table) for table in shipped("paper_values.toml")["number"]]
    return [number for number in numbers if name in (None, number.name)]
