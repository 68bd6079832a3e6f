"""What can go wrong, as types: no unconverged number leaves a solver."""

from __future__ import annotations

__all__ = ["NoSuchEvent", "NotConverged"]


class NotConverged(RuntimeError):  # noqa: N818  (reads as a statement)
    """A linear, nonlinear or mesh iteration missed its tolerance; the message says what to change."""


class NoSuchEvent(RuntimeError):  # noqa: N818  (reads as a statement)
    """The equilibrium path has no such point (no fold, say, for a stiff solid); the message says why."""
