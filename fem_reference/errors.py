"""What can go wrong, as types: no unconverged number leaves a solver."""

from __future__ import annotations

__all__ = ["NoSuchEvent", "NotConverged"]


class NotConverged(RuntimeError):
    """A linear, nonlinear or mesh iteration missed its tolerance; the message says what to change."""


class NoSuchEvent(RuntimeError):
    """The equilibrium path has no such point (no fold, say, for a stiff solid); the message says why."""
