"""Report cards of the external models of a run: evaluations again, and `check-model`."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import asdict
from itertools import accumulate
from random import SystemRandom
from typing import Any

from comparisons.console.progress import note, waiting
from comparisons.external.contract_checks import examine
from comparisons.external.data_model import DataModel
from comparisons.external.model_source import AnyExternalModel, load_again
from comparisons.problem import Problem
from comparisons.registry import ExternalIdentity
from comparisons.runs.environment import computing_environment
from comparisons.runs.rows import Key, Row
from comparisons.runs.tasks import evaluate

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
    environment = computing_environment()
    exact = all(computation.get(name) == value for computation in parts for name, value in environment.items())
    cards = {}
    for name, identity in external.items():
        rows_of_model = [row for row in rows if row.model == name and row.value is not None]
        note(f"checking {name}: some results are evaluated again in a new process, and check-model is called")
        with waiting(f"checking {name}"):
            cards[name] = _card(identity, rows_of_model, exact, cases)
    return cards


def _card(identity: ExternalIdentity, rows: Sequence[Row], exact: bool, cases: Mapping[Key, Problem]) -> dict[str, Any]:
    with closing(load_again(identity.spec)) as model:
        card: dict[str, Any] = {"kind": "data"}
        if not isinstance(model, DataModel):
            card["kind"] = "program" if model.is_program else "code"
            # The evaluations first, so that the process has made none before.
            if rows:
                card["repeated"] = _repeated(identity, model, rows, exact, cases)
        return card | {"check_model": [asdict(finding) for finding in examine(model)]}


def _repeated(
    identity: ExternalIdentity,
    model: AnyExternalModel,
    rows: Sequence[Row],
    exact: bool,
    cases: Mapping[Key, Problem],
) -> dict[str, Any]:
    """Evaluate some results again, the last first; the seed of the choice is nothing that a model can know."""
    seed = SystemRandom().randrange(2**32)
    repeated, cause = [], ""
    for row in reversed(_sample(rows, seed)):
        again = evaluate(model, row.quantity, cases[row.key])
        allowed = 0.0 if exact else (row.u_num or 0.0) + (again.u_num or 0.0)
        facts = {"quantity": row.quantity, **row.numbers, "problem": row.problem}
        repeated.append({**facts, "first": row.value, "again": again.value, "allowed": allowed})
        same = again.value is not None and abs(again.value - (row.value or 0.0)) <= allowed
        if not same and not cause:
            cause = _cause(identity, row.quantity, cases[row.key])
    return {"seed": seed, "cause": cause, "cases": repeated}


def _sample(rows: Sequence[Row], seed: int) -> list[Row]:
    """Return some rows in their order, not more than take a minute."""
    order = random.Random(seed).sample(range(len(rows)), min(AGAIN, len(rows)))
    in_time = sum(seconds <= _SECONDS for seconds in accumulate(rows[number].seconds for number in order))
    return [rows[number] for number in sorted(order[: max(in_time, _LEAST)])]


def _cause(identity: ExternalIdentity, quantity: str, case: Problem) -> str:
    """Return why a result changes: it is evaluated as the first one of two new processes."""
    values = []
    for _ in range(2):
        with closing(load_again(identity.spec)) as model:
            values.append(evaluate(model, quantity, case).value)
    return _STATE if values[0] == values[1] else _RANDOM
