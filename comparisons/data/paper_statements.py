"""Statements of a paper in words of our own, with the test and the range by which each is judged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from comparisons.data.toml_text import shipped


@dataclass(frozen=True, slots=True)
class PaperStatement:
    """A statement of the paper.

    Attributes
    ----------
    id, section : str
        Name, and where the paper states it.
    statement : str
        What it states, in words of our own.
    tests : list of mapping
        Kinds of tests, as in `comparisons.paper.statements.kinds`, each with its terms and what it needs.
    how : str
        How it is tested: what is compared, and how a word without a number ("small") is read.
    range : str
        Shapes, gradient exponents and Tabor numbers of the comparisons, and which of them are beyond the paper.
    command : str
        Repeats the decisive numbers.
    arguments : mapping
        Of all tests: cases, and the number as which a word is read.
    own : mapping
        The cases that the paper shows or names: admissible values by parameter (n, k, mu).  Empty: none.
    general : bool
        Whether the paper states it beyond its own cases.  If not, the other cases are beyond the paper.
    """

    id: str
    section: str
    statement: str
    tests: list[Mapping[str, Any]]
    how: str
    range: str
    command: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    own: Mapping[str, Sequence[float]] = field(default_factory=dict)
    general: bool = False

    def is_own(self, case: Mapping[str, float]) -> bool:
        """Whether the paper shows or names a case, given by its parameters; a missing one is free."""
        return bool(self.own) and all(case[name] in values for name, values in self.own.items() if name in case)

    def is_beyond(self, case: Mapping[str, float]) -> bool:
        """Whether the paper does not state it for a case."""
        return bool(self.own) and not self.general and not self.is_own(case)


def paper_statements() -> list[PaperStatement]:
    """Return the statements of the paper, in its order.

    Examples
    --------
    >>> len(paper_statements()) >= 25
    True
    """
    return [PaperStatement(**table) for table in shipped("paper_statements.toml")["statement"]]
