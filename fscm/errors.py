"""How a computation says that it has no number to give."""

from __future__ import annotations

__all__ = ["NoSuchEvent", "NotConverged"]


class NotConverged(RuntimeError):
    """The computation did not reach its tolerance; the message says what was tried and what to change."""


class NoSuchEvent(LookupError):
    """The equilibrium path has no such event (no jump below the critical Tabor number, say)."""
