"""Made up rows of results."""

from comparisons.runs.rows import Row

_TEXTS = {"model_version": "1", "problem": "", "digest": "", "unit": "1", "status": "ok", "reason": ""}
_NUMBERS = {"value": 1.5, "u_num": 1e-15, "size": 0, "iterations": 0, "residual": 0.0, "seconds": 0.25}


def row(model="jkr", quantity="pull_off_force", *, n=2.0, k=0.4, mu=1.0, nu=None, parameters=None, **other):
    """A row of a dimensionless problem; `parameters` take the place of n, k, mu and nu."""
    numbers = {name: value for name, value in (("n", n), ("k", k), ("mu", mu), ("nu", nu)) if value is not None}
    given = {"model": model, "quantity": quantity, "parameters": numbers if parameters is None else parameters}
    return Row(**(_TEXTS | _NUMBERS | given | other))
