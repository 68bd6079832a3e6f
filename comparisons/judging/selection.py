"""Selection of the gates that a run can judge, of their cases, and of the results that they need."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from comparisons.console.progress import log
from comparisons.domain import Domain
from comparisons.judging.gates import GIVEN, Gate, load_gates, of_tier
from comparisons.model import HasSkip
from comparisons.problem import Problem
from comparisons.runs.cases import FOR_GIVEN_MODELS, Grid
from comparisons.runs.rows import Key
from comparisons.runs.tasks import plan, problem_for


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
    computed = (
        grid
        for grid in grids
        if gate.quantity in grid.quantities
        and gate.candidate in {*(grid.models if models is None else models), grid.reference}
    )
    return sorted({case for grid in computed for case in grid.cases if gate.selects(grid, case)})


def key_of(gate: Gate, role: str, case: Problem) -> Key:
    """Return the key of the result that a gate takes from its "candidate", "reference" or "rival" in a case."""
    model = gate.models[role]
    problem = problem_for(model, gate.reference_case(case) if role == "reference" else case)
    return model, gate.quantity, *problem.key


def promised(taken: HasSkip | None, quantity: str, case: Problem) -> bool | None:
    """Whether a model promises a quantity in a case; None where it does not state it.

    `taken` is the domain that an external model declares, or a model of this package.  It does not state it where the
    domain is a list of cases that the model itself has, or where n, k and mu do not state the problem.

    Examples
    --------
    >>> domain = Domain.of({"quantities": ["pull_off_force"], "n": [2, 2]})
    >>> promised(domain, "pull_off_force", Problem.dimensionless(1, 0, 1))
    False
    """
    if taken is None or (isinstance(taken, Domain) and taken.is_list) or not case.is_of_the_paper():
        return None
    return taken.skip(case, quantity) is None


def needed_keys(gates: Iterable[Gate], grids: Sequence[Grid], models: Sequence[str] | None) -> set[Key]:
    """Return the keys of the results that gates need: of candidates, references and rivals in the cases of the gates.

    The tables of errors also show the grids that are for given models, and of a given model that no gate compares in
    any case all grids, with the reference of each.

    Parameters
    ----------
    gates, grids, models
        As of `relevant`.

    Examples
    --------
    >>> from comparisons.judging.gates import gates_text
    >>> from comparisons.runs.cases import grids
    >>> sorted({key[0] for key in needed_keys(load_gates(gates_text()), grids("quick"), ["dmt"])})
    ['dmt', 'fscm']
    """
    needed: set[Key] = set()
    compared: set[str] = set()
    for gate in relevant(gates, grids, models):
        for case in cases_of(gate, grids, models):
            compared |= set(gate.models.values())
            needed |= {key_of(gate, role, case) for role in gate.models}
    if models:
        needed |= {task.key for task in plan([grid for grid in grids if FOR_GIVEN_MODELS in grid.tags], list(models))}
    if unjudged := [model for model in models or () if model not in compared]:
        needed |= {task.key for task in plan(grids, unjudged)}
    return needed


def _not_computed(gate: Gate, grids: Sequence[Grid], models: Sequence[str]) -> set[str]:
    """Return which of the models that a gate compares with are neither given nor the reference of a grid."""
    compared = {model for role, model in gate.models.items() if role != "candidate"}
    return compared - {grid.reference for grid in grids} - set(models)


def load_user_gates(
    text: str, source: str, tier: str, grids: Sequence[Grid], models: Sequence[str] | None
) -> list[Gate]:
    """Return the gates of a user's file that a run can judge, and log how many it leaves out.

    Parameters
    ----------
    text, source : str
        Of the file.
    tier : str
        Of the run.
    grids, models
        As of `relevant`.

    Raises
    ------
    ValueError
        If a gate is wrong, or its candidate is given but its reference or rival not computed: left out as well, it
        would let the run pass without having been judged.
    """
    of_file = load_gates(text, models or (), source)
    gates = of_tier(of_file, tier)
    skipped = 0
    for gate in gates:
        if gate.candidate == GIVEN if models is None else gate.candidate not in {GIVEN, *models}:
            skipped += 1
        elif models is not None and (missing := sorted(_not_computed(gate, grids, models))):
            needed = " and ".join(missing)
            raise ValueError(f"gate {gate.id} needs {needed}, not computed here: add --model {' '.join(missing)}")
    if skipped:
        log(f"{skipped} of {len(of_file)} gates of {source} are left out: their candidate is not given to this run")
    if later := len(of_file) - len(gates):
        log(f"{later} of {len(of_file)} gates of {source} are left out: they are of the tier full")
    return gates
