"""Pull-off, jumps and hysteresis on solids that are no power law, by both references; not in the paper.

A sphere (n = 2, Poisson's ratio 0.3) on three kinds of solids, each over the depth that belongs to it:

* offset power law E0 ((z + z_s)/c0)^k, k = 0.4 and Tabor number 2 at z_s = 0,
* exponential, four times as stiff at depth as at the surface (Tabor number 2 with the modulus of the surface),
* sharp coating on a substrate of a quarter of its modulus (Tabor number 0.8 with the modulus of the coating).

Beside each value stand those of three simpler solids (see `graded_routes`) and their errors against the FSCM.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import pandas as pd

from comparisons.numerics.kappa import relative_difference
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.studies.graded_equivalent import of_equivalent
from comparisons.paper.studies.graded_routes import (
    EVENTS,
    QUANTITIES,
    by_elements,
    by_fscm,
    case_of,
    of_power_law,
)
from comparisons.paper.studies.graded_solids_figure import draw

__all__ = ["GRADED_SOLIDS", "SERIES", "SIMPLER"]

#: Depths of each kind in L, the finite elements have the pull-off of all; and those at which they have the jumps, too.
SERIES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "offset power law": ((0.01, 0.1, 1.0, 10.0), (0.1, 10.0)),
    "exponential": ((0.1, 0.5, 2.0, 10.0), (0.5, 2.0)),
    "coating": ((0.1, 0.3, 1.0, 3.0), (0.3, 1.0)),
}
#: Names of the simpler solids in the columns of the table.
SIMPLER = ("surface", "depth", "power_law")


def _cases() -> Iterator[tuple[str, float, bool]]:
    for kind, (parameters, with_jumps) in SERIES.items():
        for parameter in parameters:
            yield kind, parameter, parameter in with_jumps


def _simpler(kind: str, parameter: float) -> dict[str, CachedCall]:
    """Computations of the simpler solids; those of known k and mu have them as arguments."""
    case = case_of(kind, parameter)
    return {
        "surface": CachedCall.of(of_power_law, 0.0, case.mu),
        "depth": CachedCall.of(of_power_law, *case.depth),
        "power_law": CachedCall.of(of_equivalent, kind, parameter),
    }


def _elements(kind: str, parameter: float, jumps: bool) -> list[CachedCall]:
    return [CachedCall.of(by_elements, event, kind, parameter) for event in EVENTS if jumps or event == "pull-off"]


def _tasks() -> Sequence[CachedCall]:
    calls: list[CachedCall] = []
    for kind, parameter, jumps in _cases():
        calls += [*_elements(kind, parameter, jumps), CachedCall.of(by_fscm, kind, parameter)]
    for kind, parameter, _ in _cases():
        calls += _simpler(kind, parameter).values()
    return list(dict.fromkeys(calls))


def _number(found: dict[str, list[float] | str], name: str) -> tuple[float, float]:
    """Value and bound, NaN without the event."""
    pieces = ("jump_in_energy", "jump_out_energy") if name == "hysteresis_energy" and name not in found else (name,)
    known = [found.get(piece, "") for piece in pieces]
    if any(isinstance(piece, str) for piece in known):
        return math.nan, math.nan
    return sum(float(piece[0]) for piece in known), sum(float(piece[1]) for piece in known)


def _tables(results: Results) -> Tables:
    rows = []
    for kind, parameter, jumps in _cases():
        reference = results[CachedCall.of(by_fscm, kind, parameter)]
        elements = {k: v for call in _elements(kind, parameter, jumps) for k, v in results[call].items()}
        simpler = _simpler(kind, parameter)
        for name in QUANTITIES:
            row = {"solid": kind, "parameter": parameter, "quantity": name}
            value, row_u = _number(reference, name)
            row |= {"fscm": value, "u_fscm": row_u}
            row["fem"], row["u_fem"] = _number(elements, name)
            for other in SIMPLER:
                solved = results[simpler[other]]
                k, mu = (solved["k"], solved["mu"]) if other == "power_law" else simpler[other].arguments
                found, u_num = _number(solved, name)
                error = relative_difference(found, value)
                row |= {f"{other}_k": k, f"{other}_mu": mu, other: found, f"u_{other}": u_num, f"{other}_error": error}
            row["reason"] = reference[name] if isinstance(reference[name], str) else ""
            rows.append(row)
    return {"": pd.DataFrame(rows)}


GRADED_SOLIDS = PaperFigure(
    name="graded-solids",
    stem="graded_solids",
    title="Solids that are no power law: pull-off, jumps and hysteresis, and what simpler solids get wrong",
    tasks=_tasks,
    tables=_tables,
    draw=draw,
)
