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
    """A weight, a functional of a state, and the event of the state.

    Attributes
    ----------
    weight : float
    functional : callable
    event : str
    stationary : bool
        Whether the functional does not change along the path there: an error of the place of the event changes it by
        its square only.
    """

    weight: float
    functional: Callable[[Point], float]
    event: str
    stationary: bool = False


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

    @property
    def placed(self) -> tuple[str, ...]:
        """The events whose place matters."""
        return tuple(dict.fromkeys(term.event for term in self.terms if not term.stationary))

    def value(self, at: Callable[[str], Point]) -> float:
        """Return the value in the units of the problem, from the state at each event."""
        return math.fsum(term.weight * term.functional(at(term.event)) for term in self.terms)
