"""Report cards of the external models of a run: evaluations again, and `check-model`."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from random import SystemRandom
from typing import Any

from comparisons.console.progress import note, waiting
from comparisons.external.contract_checks import AnyExternalModel, examine
from comparisons.external.data_model import DataModel
from comparisons.external.model_source import load_again
from comparisons.problem import Problem
from comparisons.registry import ExternalIdentity
from comparisons.runs.environment import computing_environment
from comparisons.runs.rows import Key, Row
from comparisons.runs.tasks import evaluate

__all__ = ["AGAIN", "make_cards"]

#: Results of each external model that are evaluated again, at most; and for how long, by the times of the first ones.
AGAIN, _SECONDS = 8, 60.0
#: So many are evaluated again however long they take: two can change places.
_LEAST = 2

_RANDOM = "a random number or a clock: even the first evaluation of a new process gives another number"
_STATE = "the result depends on earlier evaluations: it is another one when the evaluations come in another order"


def make_cards(
    external: Mapping[str, ExternalIdentity],
    rows: Sequence[Row],
    parts: Sequence[Mapping[str, Any]],
    cases: Mapping[Key, Problem],
) -> dict[str, Any]:
    """Return the report card of each external model, as the record of the run holds it.

    Parameters
    ----------
    external : mapping of str to ExternalIdentity
    rows : sequence of Row
        Of the run.
    parts : sequence of mapping
        The commands that computed them, with their environments.
    cases : mapping of Key to Problem
        The case of each row, by its key.
    """
    here = computing_environment()
    exact = all(part.get(name) == value for part in parts for name, value in here.items())
    cards = {}
    for name, identity in external.items():
        own = [row for row in rows if row.model == name and row.status == "ok"]
        note(f"checking {name}: some results are evaluated again in a new process, and check-model is called")
        with waiting(f"checking {name}"):
            cards[name] = _card(identity, own, exact, cases)
    return cards


def _card(identity: ExternalIdentity, rows: Sequence[Row], exact: bool, cases: Mapping[Key, Problem]) -> dict[str, Any]:
    model = load_again(identity.spec)
    try:
        if isinstance(model, DataModel):
            return {"kind": "data", "check_model": _findings(model)}
        card: dict[str, Any] = {"kind": "program" if model.is_program else "code"}
        # First, so that the process has evaluated nothing before.
        if numbers := [row for row in rows if row.value is not None]:
            card["repeated"] = _repeated(identity, model, numbers, exact, cases)
        card["check_model"] = _findings(model)
        return card
    finally:
        model.close()


def _findings(model: AnyExternalModel) -> list[dict[str, str]]:
    return [asdict(finding) for finding in examine(model)]


def _repeated(
    identity: ExternalIdentity,
    model: AnyExternalModel,
    rows: Sequence[Row],
    exact: bool,
    cases: Mapping[Key, Problem],
) -> dict[str, Any]:
    """Evaluate some results again, the last first; the seed of the choice is nothing that a model can know."""
    seed = SystemRandom().randrange(2**32)
    repeated = []
    changed: list[Row] = []
    for row in reversed(_chosen(rows, seed)):
        again = evaluate(model, row.quantity, cases[row.key])
        allowed = 0.0 if exact else (row.u_num or 0.0) + (again.u_num or 0.0)
        facts = {"quantity": row.quantity, **row.numbers, "problem": row.problem}
        repeated.append({**facts, "first": row.value, "again": again.value, "allowed": allowed})
        if again.value is None or row.value is None or abs(again.value - row.value) > allowed:
            changed.append(row)
    cause = _cause(identity, changed[0].quantity, cases[changed[0].key]) if changed else ""
    return {"seed": seed, "cause": cause, "cases": repeated}


def _chosen(rows: Sequence[Row], seed: int) -> list[Row]:
    """Return some rows in their order, not more than take a minute."""
    order = list(range(len(rows)))
    random.Random(seed).shuffle(order)
    chosen: list[int] = []
    seconds = 0.0
    for number in order:
        seconds += rows[number].seconds
        if len(chosen) >= AGAIN or (len(chosen) >= _LEAST and seconds > _SECONDS):
            break
        chosen.append(number)
    return [rows[number] for number in sorted(chosen)]


def _cause(identity: ExternalIdentity, quantity: str, case: Problem) -> str:
    """Return why a result changes: it is evaluated as the first one of two new processes."""
    values = []
    for _ in range(2):
        model = load_again(identity.spec)
        try:
            row = evaluate(model, quantity, case)
            values.append(row.value)
        finally:
            model.close()
    return _STATE if values[0] == values[1] else _RANDOM
