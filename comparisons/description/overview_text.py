"""Overview of a problem file as text and as JSON."""

from __future__ import annotations

from typing import Any

from comparisons.description.equivalent_power_law import EquivalentPowerLaw
from comparisons.description.overview import LIMITS, Overview, recommended
from comparisons.numerics.number_text import percent_text
from comparisons.problem.units import si_text

__all__ = ["content", "lines"]


def content(overview: Overview) -> dict[str, Any]:
    """Return the overview as an object of JSON; errors are fractions."""
    force = overview.force
    return {
        "problem": overview.problem.content,
        "tabor_number": overview.tabor_number,
        "critical_tabor_number": overview.critical_tabor_number,
        "regime": overview.regime,
        "pull_off_force": {
            "model": force.model,
            "value": force.value,
            "u_num": force.u_num,
            "unit": force.unit,
            "status": force.status,
            "reason": force.reason,
        },
        "errors": [{"model": found.model, "error": found.error, "u_num": found.bound} for found in overview.errors],
        "recommended": {f"{100 * limit:g} %": recommended(overview, limit) for limit in LIMITS},
    }


def lines(overview: Overview, equivalent: EquivalentPowerLaw | None = None) -> list[str]:
    """Return the overview as lines of text; for a solid that is no power law with its equivalent, if it has one."""
    problem, force, critical = overview.problem, overview.force, overview.critical_tabor_number
    found = [
        f"{problem.name}: {problem.solid.kind} solid, {problem.punch.kind} punch, {problem.law.kind} law",
        f"  {_tabor_number(overview, equivalent)}",
    ]
    if critical is not None:
        words = "jumps, with hysteresis" if overview.tabor_number > critical else "no jumps"
        found.append(f"  critical Tabor number {critical:.6g}: {words}")
    found.append(f"  regime: {overview.regime}")
    if force.value is None or force.u_num is None:
        return [*found, f"  pull-off force: {force.status}: {force.reason}"]
    found.append(f"  pull-off force {si_text(force.value, force.u_num, force.unit)}  ({force.model})")
    if overview.errors:
        found.append("  errors of the pull-off force of other models:")
        width = max(len(row.model) for row in overview.errors)
        found += [f"    {row.model:{width}}  {percent_text(row.error, row.bound)} %" for row in overview.errors]
    found += [f"  recommended for {100 * limit:g} %: {recommended(overview, limit)}" for limit in LIMITS]
    return found


def _tabor_number(overview: Overview, equivalent: EquivalentPowerLaw | None) -> str:
    """The Tabor number, where the modulus of the surface or a power law stands for the solid."""
    if overview.problem.has_power_law:
        return f"Tabor number {overview.tabor_number:.6g}"
    if equivalent is None:
        return "no Tabor number: the moduli that the contact meets are not known"
    if equivalent.is_surface_close:
        return f"Tabor number {overview.tabor_number:.6g}, with the modulus of the surface"
    if equivalent.is_close:
        return f"Tabor number {equivalent.tabor_number:.4g}, with the equivalent power law"
    return "no Tabor number: neither its surface nor a power law stands for the solid"
