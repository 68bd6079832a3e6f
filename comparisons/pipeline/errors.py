"""Relative errors of models against a reference, without a folder."""

from __future__ import annotations

from collections.abc import Iterable

import pandas as pd

from comparisons.model import Model
from comparisons.output.errors import relative_error
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.frames import frame
from comparisons.runs.tasks import evaluate


def errors(
    models: Iterable[Model | str], cases: Iterable[Problem], quantity: str = "pull_off_force", reference: str = "fscm"
) -> pd.DataFrame:
    """Return kappa = (model - reference) / abs(reference) of every model in every case, with its uncertainty.

    Parameters
    ----------
    models : iterable of Model or str
        Models, or the names of models; the reference may be one of them.
    cases : iterable of Problem
    quantity : str
        A key of `comparisons.quantities.QUANTITIES`.
    reference : str
        The name of the model that the others are compared with.

    Returns
    -------
    DataFrame
        As `comparisons.output.errors.relative_error`: one row for each model and case where both have a value.

    Raises
    ------
    ValueError
        If a model, a case or the quantity is not admissible.

    Examples
    --------
    >>> table = errors(["jkr"], [Problem.dimensionless(n=2, k=0, mu=1)], reference="bradley")
    >>> table["kappa"].round(6).tolist()
    [-0.25]
    """
    if quantity not in QUANTITIES:
        raise ValueError(f"unknown quantity {quantity!r}; the quantities are {', '.join(QUANTITIES)}")
    created = [create(model) if isinstance(model, str) else model for model in models]
    by_name = {model.name: model for model in created}
    if reference not in by_name:
        by_name[reference] = create(reference)
    rows = [evaluate(model, quantity, case) for case in cases for model in by_name.values()]
    return relative_error(frame(rows), reference)
