"""Models that other packages have installed, by their entry points."""

from __future__ import annotations

from importlib.metadata import entry_points

from comparisons.external.text_rules import one_line

__all__ = ["GROUP", "installed"]

#: Group of the entry points by which an installed package offers models.
GROUP = "fscm_bench.models"


def installed() -> list[tuple[str, str, str]]:
    """Return name, package and version of the installed models, sorted; none of their code is run."""
    entries = {(entry.name, entry.dist) for entry in entry_points(group=GROUP)}
    return sorted(
        (one_line(name, 60), one_line(package.name, 60), one_line(package.version, 60))
        for name, package in entries
        if package is not None
    )
