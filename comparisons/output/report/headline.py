"""First sentences of a page: what was found, over all gates or in the worst case of a model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd

from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.gate_sentence import gates_sentence
from comparisons.output.report.stored_run import Stored
from comparisons.output.tables import worst_rows
from comparisons.problem.problem import split_name
from comparisons.problem.units import si_text
from comparisons.quantities import ALL_QUANTITIES, QUANTITIES, title_of
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = ["errors_of_models", "gates_of", "headline", "headline_of_errors", "headline_of_values"]


def headline(stored: Stored) -> str:
    """Return the finding of a folder in one sentence: which model is how wrong, or without errors that on all gates."""
    if stored.judged and stored.kappa.empty:
        return gates_of(stored)
    return (headline_of_values(stored.results) if stored.kappa.empty else "") or headline_of_errors(stored.kappa)


def headline_of_values(results: pd.DataFrame) -> str:
    """Return the range of the first quantity of problem files by one model; empty where no case of one has a value.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "u_num": 1e-15, "unit": "N", "status": "ok"}
    >>> rows = [row | {"problem": f"pad.toml; punch.R={R} nm", "value": 2e-10 * R} for R in (100, 300)]
    >>> headline_of_values(pd.DataFrame(rows))
    'The pull-off force of fscm is between 20.0000000(11) nN (punch.R=100 nm) and 60.0000000(11) nN (punch.R=300 nm)'
    """
    known = results[(results["status"] == "ok") & (with_problem(results)["problem"] != "")]
    if known.empty:
        return ""
    of_model = known[known["model"] == known["model"].iloc[0]]
    quantity = min(of_model["quantity"], key=list(QUANTITIES).index)
    rows = of_model[of_model["quantity"] == quantity]
    ends = [rows.loc[place] for place in (rows["value"].idxmin(), rows["value"].idxmax())]
    texts = [f"{si_text(row['value'], row['u_num'], row['unit'])} ({_keys(row['problem'])})" for row in ends]
    first = f"The {title_of(quantity)} of {of_model['model'].iloc[0]} is"
    return f"{first} {texts[0]}" if len(rows) == 1 else f"{first} between {texts[0]} and {texts[1]}"


def _keys(label: str) -> str:
    file, *values = split_name(label)
    return ", ".join(values) or file


def gates_of(stored: Stored) -> str:
    """Return the finding over all gates in one sentence; empty if nothing was judged."""
    return gates_sentence(stored.summary, _bases(stored)) if stored.judged else ""


def errors_of_models(kappa: pd.DataFrame) -> list[tuple[str, str]]:
    """Return each model with its largest relative error in words, largest first.

    The error is that of the first quantity of the registry in which the model has one: a pull-off force, as a rule.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "reference": "fscm"}
    >>> rows = [case | {"model": "dmt", "kappa": 0.01, "u_kappa": 1e-9}]
    >>> errors_of_models(pd.DataFrame(rows))
    [('dmt', '1.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1')]
    """
    order = list(ALL_QUANTITIES)
    rank = kappa["quantity"].map(lambda name: order.index(name) if name in order else len(order))
    first = kappa[rank == rank.groupby(kappa["model"]).transform("min")]
    worst = worst_rows(first, ["model"])
    worst = worst.iloc[(-worst["kappa"].abs()).argsort(kind="stable")]
    return [(str(row["model"]), _error_text(row)) for row in worst.to_dict("records")]


def _error_text(row: Mapping[str, Any]) -> str:
    where = case_text({name: row.get(name) for name in CASE})
    return f"{percent_text(row['kappa'], row['u_kappa'])} % in the {title_of(row['quantity'])} at {where}"


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
    most = "" if models > 1 else "at most "
    return f"{first} from {worst['reference']}: by {most}{_error_text(worst)}"


def _bases(stored: Stored) -> dict[str, str]:
    """Return what each gate is based on; empty for a folder that was judged before gates were stored in it."""
    return {} if stored.gates is None else dict(zip(stored.gates["id"], stored.gates["basis"], strict=True))
