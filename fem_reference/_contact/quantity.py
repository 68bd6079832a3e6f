"""A quantity of a path: a sum of functionals of its states, each with a weight and at an event."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from fem_reference._contact.states import Point

__all__ = ["Quantity", "Term"]


@dataclass(frozen=True, slots=True)
class Term:
    """A weight, a functional of a state, and the event of the state."""

    weight: float
    functional: Callable[[Point], float]
    event: str


@dataclass(frozen=True, slots=True)
class Quantity:
    """A sum of terms.

    Attributes
    ----------
    terms : tuple of Term
        The mesh is finest at the contact edge of the first event.
    kind : {"force", "length", "energy", "modulus"}
        A length near zero is measured by the length of the surface law.
    addends : tuple of str
        Quantities whose sum it is, each with the contact edge at one radius.
    """

    terms: tuple[Term, ...]
    kind: Literal["force", "length", "energy", "modulus"]
    addends: tuple[str, ...] = ()

    @property
    def unit(self) -> str:
        """The unit of a problem in SI."""
        return {"force": "N", "length": "m", "energy": "J", "modulus": "Pa"}[self.kind] + " in SI"

    @property
    def events(self) -> tuple[str, ...]:
        """The events that it needs."""
        return tuple(dict.fromkeys(term.event for term in self.terms))

    def value(self, at: Callable[[str], Point]) -> float:
        """Return the value in the units of the problem, from the state at each event."""
        return math.fsum(term.weight * term.functional(at(term.event)) for term in self.terms)
