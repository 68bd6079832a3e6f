"""Selection of the gates that a run can judge, of their cases, and of the results that they need."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

from comparisons.console.progress import log
from comparisons.domain import Domain
from comparisons.judging.gates import GIVEN, Gate, load_gates, of_tier
from comparisons.problem import Problem
from comparisons.runs.cases import Grid
from comparisons.runs.rows import Key
from comparisons.runs.tasks import Task, plan, problem_for

__all__ = ["cases_of", "key_of", "load_user_gates", "names_in", "needed_keys", "relevant", "skipped_gates"]


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
    selected: list[Gate] = []
    for gate in gates:
        if gate.candidate == GIVEN:
            # A model is compared with itself neither as the rival nor, in the same cases, as the reference.
            excluded = {gate.rival} if gate.reference_at else {gate.rival, gate.reference}
            selected += [replace(gate, candidate=name) for name in models or () if name not in excluded]
        elif models is None or (gate.candidate in models and not _not_computed(gate, grids, models)):
            selected.append(gate)
    return selected


def cases_of(gate: Gate, grids: Sequence[Grid], models: Collection[str] | None) -> list[Problem]:
    """Return the cases that the candidate of a gate computes and the gate selects, sorted."""
    cases = {
        case
        for grid in grids
        if gate.quantity in grid.quantities
        and gate.candidate in {*(models if models is not None else grid.models), grid.reference}
        for case in grid.cases
        if gate.selects(grid, case)
    }
    return sorted(cases)


def key_of(model: str, gate: Gate, case: Problem) -> Key:
    """Return the key of the result of a model that a gate uses in a case."""
    evaluated = problem_for(model, case)
    return Task(model, gate.quantity, evaluated).key


def names_in(gates: Iterable[Gate]) -> set[tuple[str, str]]:
    """Return model and quantity of the results that gates compare.

    Examples
    --------
    >>> from comparisons.judging.gates import gates_text
    >>> gate = next(gate for gate in load_gates(gates_text()) if gate.rival)
    >>> names_in([gate]) == {(model, gate.quantity) for model in (gate.candidate, gate.reference, gate.rival)}
    True
    """
    return {
        (model, gate.quantity)
        for gate in gates
        for model in (gate.candidate, gate.reference, gate.rival)
        if model is not None
    }


def needed_keys(
    gates: Iterable[Gate],
    grids: Sequence[Grid],
    models: Sequence[str] | None,
    statuses: Mapping[Key, str],
    domains: Mapping[str, Domain] | None = None,
) -> set[Key]:
    """Return the keys of the results that gates need.

    These are the results of the candidates, and in the cases in which a candidate has a value also those with which it
    is compared.  A given model that no gate compares in any case is in the tables of errors alone: it needs all its
    results, with the reference of each grid.

    Parameters
    ----------
    gates, grids, models
        As of `relevant`.
    statuses : mapping of key to str
        The status of each result that is known.
    domains : mapping of str to Domain, optional
        The domains that models declare: whether "not applicable" is right there is for the reference to show.

    Examples
    --------
    >>> from comparisons.judging.gates import gates_text
    >>> from comparisons.runs.cases import grids
    >>> first = needed_keys(load_gates(gates_text()), grids("quick"), ["dmt"], {})
    >>> {key[0] for key in first}, len(first)
    ({'dmt'}, 192)
    >>> second = needed_keys(load_gates(gates_text()), grids("quick"), ["dmt"], {sorted(first)[0]: "ok"})
    >>> second - first
    {('fscm', 'pull_off_force', 1.0, 0.0, 0.01, None, '')}
    """
    needed: set[Key] = set()
    named: set[str] = set()
    for gate in relevant(gates, grids, models):
        for case in cases_of(gate, grids, models):
            named |= {gate.candidate, gate.reference} | ({gate.rival} if gate.rival else set())
            candidate = key_of(gate.candidate, gate, case)
            needed.add(candidate)
            status, domain = statuses.get(candidate), (domains or {}).get(gate.candidate)
            promised = domain is not None and not domain.is_list and domain.contains(gate.quantity, case.parameters)
            # The range of the reference is over all cases.
            if status == "ok" or (status == "not-applicable" and promised) or gate.metric == "range-relative":
                needed.add(key_of(gate.reference, gate, gate.reference_case(case)))
                needed |= {key_of(gate.rival, gate, case)} if gate.rival else set()
    if unjudged := [model for model in models or () if model not in named]:
        needed |= {task.key for task in plan(grids, unjudged)}
    return needed


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
    skipped = []
    for gate in gates:
        missing = sorted(_not_computed(gate, grids, models))
        if gate.candidate not in {GIVEN, *models}:
            skipped.append(gate)
        elif missing:
            raise ValueError(
                f"gate {gate.id} needs {' and '.join(missing)}, which this run does not compute: "
                f"add --model {' '.join(missing)}"
            )
    return skipped


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
    read = load_gates(text, models or (), source)
    gates = of_tier(read, tier)
    skipped = skipped_gates(gates, chosen, models)
    if skipped:
        log(f"{len(skipped)} of {len(read)} gates of {source} are left out: their candidate is not given to this run")
    if len(gates) < len(read):
        log(f"{len(read) - len(gates)} of {len(read)} gates of {source} are left out: they are of the tier full")
    return gates
