"""Fresh cases of a run: drawn at random from the domain of each given model, and judged by the limits of its gates.

A model can know the standing cases by heart, but not these.  A gate is INCONCLUSIVE where the domain of the
model has no room for them beside the standing cases.  Inside the box of the atlas the atlas is the reference where its
bound is small beside the limits, elsewhere the reference of the gate.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple, cast
from zlib import crc32

from comparisons.console.progress import log
from comparisons.data.contained_paths import path_inside
from comparisons.judging.fresh_points import REACH, named_problem, sample
from comparisons.judging.gates import GIVEN, Gate
from comparisons.judging.selection import cases_of, promised, relevant
from comparisons.model import HasSkip
from comparisons.problem import Problem
from comparisons.problem.problem import split_name
from comparisons.registry import create
from comparisons.runs.cases import TIERS, Grid

#: The end of the id of a gate that is judged in fresh cases, and the tag of their grids.
RANDOM = "-RANDOM"
_TAG = "random"

#: The end of the reason why standing cases of a model have no fresh ones.
_NO_ROOM = (
    "standing cases are in parts of the domain of {} that have no fresh cases beside them: they are more parts than "
    "cases were asked for, or have no room as points, ranges hardly wider than a point, no varied key, or outside "
    + ", ".join(f"{low:g} <= {name} <= {high:g}" for name, (low, high) in REACH.items())
)

#: The metrics of gates that are judged in fresh cases: those of one value beside one reference.
_METRICS = ("rel", "abs", "en")

_ATLAS, _FSCM = "atlas", "fscm"
#: The largest bound of the atlas (docs/atlas.md), and how many times wider the limits of a gate are where it is used.
_ATLAS_BOUND, _WIDER = 1e-4, 100.0


class Part(NamedTuple):
    """Fresh cases of one model for one gate, whose id ends in `RANDOM`, with one reference."""

    gate: Gate
    grid: Grid


@dataclass(frozen=True, slots=True)
class FreshCases:
    """The fresh cases of a run.

    Attributes
    ----------
    count : int
        Cases for each model and gate.
    seed : int
        From which the same cases follow again.
    parts : tuple of Part
    undrawn : tuple of dict
        `gate`, `candidate`, `quantity` and `reason` where standing cases of a gate are in a part of the domain of a
        model that has no fresh ones.
    """

    count: int
    seed: int
    parts: tuple[Part, ...]
    undrawn: tuple[dict[str, str], ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Return the form in the record of a run: the cases themselves, since other versions may draw others."""
        parts = [
            {
                "gate": gate.id.removesuffix(RANDOM),
                "candidate": gate.candidate,
                "reference": gate.reference,
                "cases": [case.name or list(case.parameters.values()) for case in grid.cases],
            }
            for gate, grid in self.parts
        ]
        return {"count": self.count, "seed": self.seed, "parts": parts, "undrawn": list(self.undrawn)}

    @classmethod
    def of_json(cls, stored: Mapping[str, Any], gates: Iterable[Gate], folder: Path) -> FreshCases:
        """Return the fresh cases of a record, as far as they are about some gates; the folder has the problem files."""
        gates_by_id = {gate.id: gate for gate in gates}
        parts: list[Part] = []
        for entry in stored["parts"]:
            if gate := gates_by_id.get(entry["gate"]):
                cases = [_stored_problem(case, folder) for case in entry["cases"]]
                parts.append(_part(gate, entry["candidate"], entry["reference"], cases))
        undrawn = tuple(entry for entry in stored["undrawn"] if entry["gate"] in gates_by_id)
        return cls(stored["count"], stored["seed"], tuple(parts), undrawn)


def _stored_problem(case: list[float] | str, folder: Path) -> Problem:
    if not isinstance(case, str):
        return Problem.dimensionless(*case[:3])
    name = split_name(case)
    return named_problem(path_inside(folder, name[0]), name)


def draw(
    gates: Sequence[Gate],
    grids: Sequence[Grid],
    models: Sequence[str],
    taken: Mapping[str, HasSkip],
    count: int,
    seed: int,
) -> FreshCases:
    """Draw fresh cases for every gate of every model that compares one value with one reference.

    A gate of one model whose cases have tags has none, nor has a gate whose own ranges have no room for them.  Those of
    problem files are drawn between the values of their varied keys.

    Parameters
    ----------
    gates, grids, models
        Of the run.
    taken : mapping of str to HasSkip
        What models take, as of `promised`; for others the cases are between the standing ones.
    count : int
        Cases for each model and gate.
    seed : int

    Examples
    --------
    >>> from comparisons.judging.gates import gates_text, load_gates
    >>> from comparisons.runs.cases import grids
    >>> fresh = draw(load_gates(gates_text()), grids("quick"), ["dmt"], {}, 3, 1)
    >>> [(part.gate.id, part.gate.reference, len(part.grid.cases)) for part in fresh.parts]
    [('GIVEN-PULL-OFF-FORCE-RANDOM', 'atlas', 3)]
    """
    parts: list[Part] = []
    undrawn: list[dict[str, str]] = []
    passed_over = 0
    # Tags select cases that were chosen for a gate of one model, as those near a limit: no others are like them.
    drawn_for = [gate for gate in gates if gate.candidate == GIVEN or "tags" not in gate.cases]
    for gate in relevant(drawn_for, grids, models):
        if gate.candidate not in models:
            continue
        standing = cases_of(gate, grids, models)
        avoided = [case for grid in grids if gate.quantity in grid.quantities for case in grid.cases]
        seeds = [seed, crc32(f"{gate.id} {gate.candidate}".encode())]
        is_of_values = gate.metric in _METRICS and not gate.rival and not gate.reference_at
        drawn = sample(gate, taken.get(gate.candidate), standing, avoided, count, seeds) if is_of_values else None
        if drawn is None:
            passed_over += 1
            continue
        cases, untested = drawn
        if untested:
            reason = f"{len(untested)} of {len(standing)} {_NO_ROOM.format(gate.candidate)}"
            entry = {"gate": gate.id, "candidate": gate.candidate, "quantity": gate.quantity, "reason": reason}
            undrawn.append(entry)
        elif not cases:
            log(f"{gate.id} has no fresh cases: the domain of {gate.candidate} has none that it can be judged in")
        references = [_reference(gate, case) for case in cases]
        for name in sorted({*references}):
            of_name = [case for case, reference in zip(cases, references, strict=True) if reference == name]
            parts.append(_part(gate, gate.candidate, name, of_name))
    if passed_over:
        log(f"{passed_over} gates have no fresh cases: of curves, with a rival or a reference_at, or of single cases")
    return FreshCases(count, seed, tuple(parts), tuple(undrawn))


def _part(gate: Gate, candidate: str, reference: str, cases: Sequence[Problem]) -> Part:
    least = _ATLAS_BOUND if reference == _ATLAS else 0.0
    fresh = replace(
        gate,
        id=f"{gate.id}{RANDOM}",
        requirement=f"In fresh random cases: {gate.requirement}",
        candidate=candidate,
        reference=reference,
        cases={},
        min_cases=0,
        max_reference_uncertainty=max(gate.max_reference_uncertainty, least),
        expected_failure=None,
        measured_range=None,
        not_applicable="leave-out",
    )
    title = f"Fresh cases of {candidate} for {gate.id}"
    return Part(
        fresh, Grid(fresh.id, title, TIERS[0], reference, (candidate,), (gate.quantity,), tuple(cases), (_TAG,))
    )


def _reference(gate: Gate, case: Problem) -> str:
    """Return the reference of a fresh case."""
    width = min(abs(limit) for limit in (gate.lower, gate.upper) if math.isfinite(limit))
    if gate.reference != _FSCM or gate.candidate == _ATLAS or gate.metric == "en" or width < _WIDER * _ATLAS_BOUND:
        return gate.reference
    return _ATLAS if promised(cast(HasSkip, create(_ATLAS)), gate.quantity, case) else gate.reference
