"""Check of stored rows of external models: a few of their tasks are evaluated again and compared.

The version of an external model covers the files that are hashed.  A file that it reads besides, or a program that it
calls, may change without that; then the stored numbers are no longer those of the model.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

import numpy as np

from comparisons.console.progress import log
from comparisons.runs.rows import Key, Row
from comparisons.runs.store import Store
from comparisons.runs.tasks import Task, evaluate_task

#: Stored tasks of each external model that are evaluated again.
AT_MOST = 3


def drop_changed(planned: Mapping[Key, Task], store: Store[Row]) -> dict[str, Any] | None:
    """Evaluate a few stored tasks of each external model again; drop the rows of a model whose results have changed.

    Returns
    -------
    dict or None
        Model -> how many tasks were evaluated again and whether all agree, as the record of a run holds it; None
        without external models.
    """
    stored = {row.key: row for row in store.items if row.key in planned and planned[row.key].external}
    rng = random.SystemRandom()
    models = {}
    for model in sorted({row.model for row in stored.values()}):
        tasks = sorted((planned[key] for key in stored if key[0] == model), key=lambda task: str(task.key))
        sample = rng.sample(tasks, min(AT_MOST, len(tasks)))
        again = {task: evaluate_task(task) for task in sample}
        differing = [task for task, row in again.items() if not same(stored[task.key], row)]
        for task in differing[:1]:
            dropped = store.drop(lambda row, model=model: row.model == model)  # type: ignore[misc]  # bound now
            log(
                f"{model} has changed ({task.quantity} at {task.problem.label} was {_text(stored[task.key])} and is "
                f"{_text(again[task])}): its stored results ({dropped}) are all computed again"
            )
        models[model] = {"same": not differing, "tasks": len(sample)}
    return models or None


def same(stored: Row, now: Row) -> bool:
    """Whether two rows of one task agree: in their status, and within the sum of both uncertainties.

    The points of a curve are compared one by one, as fractions of its ranges, as its uncertainty is.
    """
    if stored.status != now.status:
        return False
    if stored.points is not None and now.points is not None:
        return _same_curve(stored.points, now.points)
    if stored.value is None or now.value is None:
        return stored.value is now.value
    return abs(stored.value - now.value) <= (stored.u_num or 0.0) + (now.u_num or 0.0)


def _same_curve(stored: tuple[list[float], list[float], float], now: tuple[list[float], list[float], float]) -> bool:
    if len(stored[0]) != len(now[0]):
        return False
    before, after = np.array(stored[:2]), np.array(now[:2])
    ranges = np.ptp(before, axis=1, keepdims=True)
    distances = np.hypot(*((after - before) / np.where(ranges == 0, 1.0, ranges)))
    return bool((distances <= stored[2] + now[2]).all())


def _text(row: Row) -> str:
    if row.points is not None:
        return f"a curve of {len(row.points[0])} points"
    return row.status if row.value is None else f"{row.value:.9g}"
