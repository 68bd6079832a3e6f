"""First sentences of a page: what was found, over all gates or in the worst case of a model."""

from __future__ import annotations

import pandas as pd

from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.gate_sentence import gates_sentence
from comparisons.output.report.stored_run import Stored
from comparisons.quantities import title_of

__all__ = ["headline", "headline_of_errors"]


def headline(stored: Stored) -> str:
    """Return the finding of a folder in one sentence."""
    if stored.judged:
        return gates_sentence(stored.summary, _bases(stored))
    return headline_of_errors(stored.kappa)


def headline_of_errors(kappa: pd.DataFrame) -> str:
    """Return which model differs most from its reference, and where.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "reference": "fscm"}
    >>> rows = [case | {"model": "jkr", "kappa": -0.05, "u_kappa": 1e-9}, case | {"model": "dmt", "kappa": 0.01}]
    >>> headline_of_errors(pd.DataFrame(rows))
    'Of 2 models jkr differs most from fscm: by -5.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1'
    """
    if kappa.empty:
        return "No relative error is stored: no model has a value where a reference has one"
    worst = kappa.iloc[int(kappa["kappa"].abs().to_numpy().argmax())]
    models = kappa["model"].nunique()
    first = f"Of {models} models {worst['model']} differs most" if models > 1 else f"{worst['model']} differs"
    where = case_text({name: worst[name] for name in ("n", "k", "mu", "nu")})
    size = percent_text(worst["kappa"], worst["u_kappa"])
    most = "" if models > 1 else "at most "
    return f"{first} from {worst['reference']}: by {most}{size} % in the {title_of(worst['quantity'])} at {where}"


def _bases(stored: Stored) -> dict[str, str]:
    """Return what each gate is based on; empty for a folder that was judged before gates were stored in it."""
    return {} if stored.gates is None else dict(zip(stored.gates["id"], stored.gates["basis"], strict=True))
