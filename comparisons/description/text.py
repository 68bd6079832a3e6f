"""Description of a problem as lines of text, from the objects of JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparisons.description.assumptions import SMALL
from comparisons.numerics.number_text import percent_text
from comparisons.problem import Problem
from comparisons.problem.equivalent_solid import LARGEST_DEVIATION
from comparisons.problem.units import si_text

__all__ = ["equivalent_lines", "overview_lines", "profile_lines", "uncertainty_lines"]

Json = dict[str, Any]

#: Where no model is within a limit.
NONE_WITHIN = "none, the assumptions alone are wrong by more"


def overview_lines(problem: Problem, overview: Json, equivalent: Json | None) -> list[str]:
    """Return the overview; for a solid that is no power law with its equivalent, if it has one."""
    force, critical = overview["pull_off_force"], overview["critical_tabor_number"]
    lines = [
        f"{problem.name}: {problem.solid.kind} solid, {problem.punch.kind} punch, {problem.law.kind} law",
        f"  {_tabor_number(problem, overview['tabor_number'], equivalent)}",
    ]
    if overview["assumptions"]:
        lines += _assumption_lines(problem, overview["assumptions"])
    if critical is not None:
        words = "jumps, with hysteresis" if overview["tabor_number"] > critical else "no jumps"
        lines.append(f"  critical Tabor number {critical:.6g}: {words}")
    lines += [f"  regime: {overview['regime']}", f"  pull-off force {_force_text(force)}"]
    if force["value"] is None:
        return lines
    if overview["errors"]:
        lines += ["  errors of the pull-off force of other models:", *_error_lines(overview["errors"], "    ")]
    if overview["total_errors"]:
        lines += ["  their errors with that of the assumptions:", *_error_lines(overview["total_errors"], "    ")]
    assumed, recommended = overview["assumptions"], overview["recommended"].items()
    if assumed and not assumed["recommendable"]:
        return [*lines, "  no model is recommended: the contact is larger than the sphere"]
    where = "" if assumed and assumed["total"]["error"] is not None else ", at small strains"
    return lines + [f"  recommended for {limit}{where}: {model or NONE_WITHIN}" for limit, model in recommended]


def _assumption_lines(problem: Problem, assumed: Json) -> list[str]:
    """The error of what all models assume, its two sources, and the measures that are not small."""
    names = {"geometry": "a paraboloid for the sphere", "strain": "small strains", "total": "together"}
    if problem.punch.kind != "sphere":
        names = {"strain": names["strain"]}
    width = max(map(len, names.values()))
    lines = ["  error of the pull-off force by the assumptions that all models share:"]
    for key, name in names.items():
        error = assumed[key]["error"]
        unknown = "unknown" if key == "total" else f"unknown: {assumed[key]['reason']}"
        text = unknown if error is None else f"{percent_text(error, assumed[key]['u_num'])} %"
        lines.append(f"    {name:{width}}  {text}")
    lines.append(
        f"  at pull-off, contact radius {_rounded(assumed['contact_radius'], 'm', 3)}; assumed to be below {SMALL:g}:"
    )
    width = max(len(measure["meaning"]) for measure in assumed["measures"])
    for measure in assumed["measures"]:
        verdict = "" if measure["value"] <= measure["limit"] else "  not small"
        lines.append(f"    {measure['meaning']:{width}}  {measure['value']:.3g}{verdict}")
    return lines


def _force_text(force: Json) -> str:
    if force["value"] is None:
        return f"{force['status']}: {force['reason']}"
    return f"{si_text(force['value'], force['u_num'], force['unit'])}  ({force['model']})"


def _error_lines(errors: Sequence[Json], indent: str) -> list[str]:
    width = max(len(row["model"]) for row in errors)
    return [f"{indent}{row['model']:{width}}  {percent_text(row['error'], row['u_num'])} %" for row in errors]


def _tabor_number(problem: Problem, of_surface: float, equivalent: Json | None) -> str:
    """The Tabor number, where the modulus of the surface or a power law stands for the solid."""
    if problem.is_of_the_paper("solid"):
        return f"Tabor number {of_surface:.6g}"
    if equivalent is None:
        return "no Tabor number: the moduli that the contact meets are not known"
    if equivalent["surface_compliance_deviation"] <= LARGEST_DEVIATION:
        return f"Tabor number {of_surface:.6g}, with the modulus of the surface"
    if equivalent["compliance_deviation"] <= LARGEST_DEVIATION:
        return f"Tabor number {equivalent['tabor_number']:.4g}, with the equivalent power law"
    return "no Tabor number: neither its surface nor a power law stands for the solid"


def equivalent_lines(equivalent: Json) -> list[str]:
    """Return the equivalent power law: one line if it does not stand for the solid."""
    deviation, force = 100.0 * equivalent["compliance_deviation"], equivalent["pull_off_force"]
    if deviation > 100.0 * LARGEST_DEVIATION:
        return [f"  no equivalent power law: the best one misses the compliance by {deviation:.0f} %"]
    E0, k, nu = _rounded(equivalent["E0"], "Pa", 4), equivalent["k"], equivalent["nu"]
    c0, shortest, longest = (_rounded(value, "m", 4) for value in (equivalent["c0"], *equivalent["lengths"]))
    limited = "" if equivalent["free_k"] == k else f" (nearest admissible; the fit has {equivalent['free_k']:.3g})"
    error = "" if force["error"] is None else f", error {percent_text(force['error'], force['error_u_num'])} %"
    lines = [
        f"  equivalent power law E0 (z/c0)^k: E0 = {E0}, c0 = {c0}, k = {k:.4g}{limited}, nu = {nu:.4g}",
        f"    fitted to the surface compliance over lengths from {shortest} to {longest},",
        f"    weighted by elastic energy; misses it by {deviation:.2g} % (r.m.s.)",
        f"    its pull-off force {_force_text(force)}{error}",
    ]
    if not equivalent["closed_forms"]:
        return [*lines, "    no closed form takes this punch or this law"]
    within = (f"within {limit}: {model or 'none'}" for limit, model in equivalent["closed_form_within"].items())
    errors = _error_lines(equivalent["closed_forms"], "      ")
    return [*lines, "    errors of the closed forms with this power law:", *errors, f"    {'; '.join(within)}"]


def profile_lines(changes: Sequence[Json]) -> list[str]:
    """Return the changes with other choices for a measured profile."""
    lines = ["  change of the pull-off force with another choice for the measured profile:"]
    for row in changes:
        value = _rounded(row["value"], "m" if row["key"] == "smoothing" else "1", 6)
        failure = f"{row['status']}: {row['reason']}"
        change = failure if row["change"] is None else f"{percent_text(row['change'], row['u_num'])} %"
        lines.append(f"    {row['key']} {value}: {change}")
    return lines


def uncertainty_lines(problem: Problem, stated: Json) -> list[str]:
    """Return what follows from the uncertainties of a file."""
    quantity = stated["quantity"]
    if stated["status"] != "ok":
        return [f"uncertainty of {quantity}: {stated['status']}: {stated['reason']}"]
    value, unit, deviation = stated["value"], stated["unit"], stated["standard_deviation"]
    rows = []
    for row, spread in zip(stated["parameters"], problem.uncertain.values(), strict=True):
        elasticity = "" if row["elasticity"] is None else f"{row['elasticity']:+.4f}"
        rows.append((row["parameter"], spread.written.strip(), elasticity, _rounded(row["contribution"], unit)))
    name, written, number, _ = (max(map(len, column)) for column in zip(*rows, strict=True))
    lines = [
        f"uncertainty of {quantity} = {si_text(value, stated['u_num'], unit)} (fscm) from those of the file",
        "  d ln(value)/d ln(p) and contribution of each parameter p:",
        *(f"    {a:{name}}  {b:{written}}  {c:>{number}}  {d}" for a, b, c, d in rows),
    ]
    if deviation is not None:
        share = f" ({100 * deviation / abs(value):.2g} %)" if value else ""
        lines.append(f"  standard deviation {_rounded(deviation, unit)}{share}, of independent parameters")
    return lines + (_range_lines(stated["range"], unit) if stated["range"] else [])


def _range_lines(stated: Json, unit: str) -> list[str]:
    of_first_order = f"  range over the intervals {_ends(stated['first_order'], unit)} to first order"
    if stated["solved"] is None:
        return [f"{of_first_order}; there is no value at its ends"]
    words = "" if stated["is_monotone"] else ", but the slopes change their signs: the range may be wider"
    return [of_first_order, f"  {_ends(stated['solved'], unit)} solved at its ends{words}"]


def _ends(ends: Sequence[float], unit: str) -> str:
    return " to ".join(_rounded(end, unit, 5) for end in ends)


def _rounded(value: float, unit: str, digits: int = 3) -> str:
    return si_text(float(f"{value:.{digits}g}"), 0.0, unit)
