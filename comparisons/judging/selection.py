"""Selection of the gates that a run can judge."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from comparisons.console.progress import log
from comparisons.judging.gates import GIVEN, Gate, load_gates, of_tier
from comparisons.runs.cases import Grid

__all__ = ["load_user_gates", "relevant", "skipped_gates"]


def relevant(gates: Iterable[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> list[Gate]:
    """Return the gates a run can judge, one for each given model where a gate is for all of them.

    Parameters
    ----------
    gates : iterable of Gate
    grids : sequence of Grid
        The cases that are computed.
    models : sequence of str or None
        Models given in place of those each grid names; None for those.
    """
    chosen: list[Gate] = []
    for gate in gates:
        if gate.candidate == GIVEN:
            # A model is compared with itself neither as the rival nor, in the same cases, as the reference.
            others = {gate.rival} if gate.reference_at else {gate.rival, gate.reference}
            chosen += [replace(gate, candidate=name) for name in models or () if name not in others]
        elif models is None or (gate.candidate in models and not _not_computed(gate, grids, models)):
            chosen.append(gate)
    return chosen


def skipped_gates(gates: Iterable[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> list[Gate]:
    """Return the gates about models that are not given, which a run leaves out.

    Parameters
    ----------
    gates, grids, models
        As of `relevant`.

    Raises
    ------
    ValueError
        If a gate is about a model that is given, but its reference or rival is not computed: left out as well, it
        would let the run pass without having been judged.
    """
    if models is None:
        return [gate for gate in gates if gate.candidate == GIVEN]
    others = []
    for gate in gates:
        missing = sorted(_not_computed(gate, grids, models))
        if gate.candidate not in {GIVEN, *models}:
            others.append(gate)
        elif missing:
            raise ValueError(
                f"gate {gate.id} needs {' and '.join(missing)}, which this run does not compute: "
                f"add --model {' '.join(missing)}"
            )
    return others


def _not_computed(gate: Gate, grids: Sequence[Grid], models: Sequence[str]) -> set[str]:
    """Return which of the models that a gate compares with are neither given nor the reference of a grid."""
    needed = {gate.reference} if gate.rival is None else {gate.reference, gate.rival}
    return needed - {grid.reference for grid in grids} - set(models)


def load_user_gates(
    text: str, source: str, tier: str, chosen: Sequence[Grid], models: Sequence[str] | None
) -> list[Gate]:
    """Return the gates of a user's file that a run can judge, and log how many it leaves out.

    Parameters
    ----------
    text, source : str
        Of the file.
    tier : str
        Of the run.
    chosen : sequence of Grid
        What the run computes.
    models : sequence of str or None
        Models given in place of those each grid names.

    Raises
    ------
    ValueError
        If a gate is wrong or needs a model that is not computed; one sentence names it.
    """
    every = load_gates(text, models or (), source)
    gates = of_tier(every, tier)
    others = skipped_gates(gates, chosen, models)
    if others:
        log(f"{len(others)} of {len(every)} gates of {source} are left out: their candidate is not given to this run")
    if len(gates) < len(every):
        log(f"{len(every) - len(gates)} of {len(every)} gates of {source} are left out: they are of the tier full")
    return gates
