"""Equivalent power law of a solid as text and as JSON."""

from __future__ import annotations

from typing import Any

from comparisons.description.equivalent_power_law import EquivalentPowerLaw
from comparisons.description.overview import LIMITS, simplest_within
from comparisons.numerics.number_text import percent_text
from comparisons.problem.units import si_text

__all__ = ["content", "lines"]


def content(found: EquivalentPowerLaw) -> dict[str, Any]:
    """Return the equivalent power law as an object of JSON, in SI; errors are fractions."""
    force = found.force
    return {
        **found.problem.solid.values,
        "free_k": found.free_k,
        "compliance_deviation": found.deviation,
        "surface_compliance_deviation": found.surface_deviation,
        "tabor_number": found.tabor_number,
        "lengths": list(found.lengths),
        "pull_off_force": {
            "model": force.model,
            "value": force.value,
            "u_num": force.u_num,
            "unit": force.unit,
            "status": force.status,
            "reason": force.reason,
            "error": found.error,
            "error_u_num": found.bound,
        },
        "closed_forms": [{"model": row.model, "error": row.error, "u_num": row.bound} for row in found.closed_forms],
        "closed_form_within": {f"{100 * limit:g} %": _recommended(found, limit) for limit in LIMITS},
    }


def lines(found: EquivalentPowerLaw) -> list[str]:
    """Return the equivalent power law as lines of text: one line if it does not stand for the solid."""
    if not found.is_close:
        return [f"  no equivalent power law: the best one misses the compliance by {100.0 * found.deviation:.0f} %"]
    solid, force = found.problem.solid, found.force
    first, last = (_rounded(length, "m") for length in found.lengths)
    limited = "" if found.free_k == solid["k"] else f" (its nearest admissible value; the fit has {found.free_k:.3g})"
    text = [
        f"  equivalent power law E0 (z/c0)^k: E0 = {_rounded(solid['E0'], 'Pa')}, c0 = {_rounded(solid['c0'], 'm')}, "
        f"k = {solid['k']:.4g}{limited}, nu = {solid['nu']:.4g}",
        f"    fitted to the surface compliance over lengths from {first} to {last},",
        f"    weighted by elastic energy; misses it by {100.0 * found.deviation:.2g} % (r.m.s.)",
    ]
    if force.value is None or force.u_num is None or found.error is None or found.bound is None:
        return [*text, f"    its pull-off force: {force.status}: {force.reason}", *_closed_forms(found)]
    return [
        *text,
        f"    its pull-off force {si_text(force.value, force.u_num, force.unit)}  ({force.model}), "
        f"error {percent_text(found.error, found.bound)} %",
        *_closed_forms(found),
    ]


def _closed_forms(found: EquivalentPowerLaw) -> list[str]:
    if not found.closed_forms:
        return ["    no closed form takes this punch or this law"]
    width = max(len(row.model) for row in found.closed_forms)
    near = "; ".join(f"within {100 * limit:g} %: {_recommended(found, limit) or 'none'}" for limit in LIMITS)
    return [
        "    errors of the closed forms with this power law:",
        *(f"      {row.model:{width}}  {percent_text(row.error, row.bound)} %" for row in found.closed_forms),
        f"    {near}",
    ]


def _recommended(found: EquivalentPowerLaw, limit: float) -> str | None:
    return simplest_within(found.closed_forms, limit) if found.is_close else None


def _rounded(value: float, unit: str) -> str:
    """Four digits: the fit has no more."""
    return si_text(float(f"{value:.4g}"), 0.0, unit)
