"""Statements of a paper in words of our own, with the test and the range by which each is judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any

from comparisons.data.toml_text import parse
from comparisons.data.validation import validated

__all__ = ["PaperStatement", "paper_statements", "read_statements"]

_FILE = "paper_statements.toml"


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
    own: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    general: bool = False

    def is_own(self, case: Mapping[str, float]) -> bool:
        """Whether the paper shows or names a case, given by its parameters; a missing one is free."""
        return bool(self.own) and all(case[name] in values for name, values in self.own.items() if name in case)

    def is_beyond(self, case: Mapping[str, float]) -> bool:
        """Whether the paper does not state it for a case."""
        return bool(self.own) and not self.general and not self.is_own(case)


def read_statements(text: str, source: str = _FILE) -> list[PaperStatement]:
    r"""Return the statements of a TOML text.

    Raises
    ------
    ValueError
        If a key or value is not admissible; the sentence names it.

    Examples
    --------
    >>> read_statements('[[statement]]\nid = "a"', "mine.toml")
    Traceback (most recent call last):
    ValueError: mine.toml: statement a: section, statement, tests, how, range, command missing; ...
    """
    document = parse(text, source)
    validated(document, "paper_statements", source)
    return [PaperStatement(**{**table, "own": _own(table)}) for table in document["statement"]]


def _own(table: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    return {name: tuple(map(float, values)) for name, values in table.get("own", {}).items()}


def paper_statements() -> list[PaperStatement]:
    """Return the statements of the paper, in its order.

    Examples
    --------
    >>> len(paper_statements()) >= 25
    True
    """
    return read_statements(files("comparisons.data").joinpath(_FILE).read_text(encoding="utf-8"))
