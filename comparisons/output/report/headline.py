"""First sentences of a page: what was found, over all gates or in the worst case of a model."""

from __future__ import annotations

import pandas as pd

from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.errors import worst_rows
from comparisons.output.gate_sentence import gates_sentence
from comparisons.output.report.plots import in_registry
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import Record
from comparisons.output.varied_keys import physical_text
from comparisons.problem.problem import split_name
from comparisons.quantities import title_of
from comparisons.runs.rows import CASE

__all__ = ["errors_of_models", "gates_of", "headline"]


def headline(stored: Stored) -> str:
    """Return the finding of a folder in one sentence: which model is how wrong, or without errors that on all gates."""
    if stored.judged and stored.kappa.empty:
        return gates_of(stored)
    return _of_errors(stored.kappa) or _of_values(stored.results) or "No model has a value where a reference has one"


def gates_of(stored: Stored) -> str:
    """Return the finding over all gates in one sentence; empty if nothing was judged."""
    bases = dict(zip(stored.gates["id"], stored.gates["basis"], strict=True))
    return gates_sentence(stored.summary, bases) if stored.judged else ""


def _of_values(results: pd.DataFrame) -> str:
    """Return the range of the first quantity of problem files by one model; empty where no case of one has a value.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "u_num": 1e-15, "unit": "N", "status": "ok"}
    >>> rows = [row | {"problem": f"pad.toml; punch.R={R} nm", "value": 2e-10 * R} for R in (100, 300)]
    >>> _of_values(pd.DataFrame(rows))
    'The pull-off force of fscm is between 20.0000000(11) nN (punch.R=100 nm) and 60.0000000(11) nN (punch.R=300 nm)'
    """
    rows = results[results["status"] == "ok"]
    if "problem" not in rows or not (rows := rows[rows["problem"] != ""]).size:
        return ""
    rows = rows[rows["model"] == rows["model"].iloc[0]]
    rows = rows[rows["quantity"] == min(rows["quantity"], key=in_registry)].sort_values("value", kind="stable")
    texts = []
    for row in (rows.iloc[0], rows.iloc[-1]):
        file, *keys = split_name(row["problem"])
        texts.append(f"{physical_text(row)} ({', '.join(keys) or file})")
    subject = f"The {title_of(rows['quantity'].iloc[0])} of {rows['model'].iloc[0]} is"
    return f"{subject} {texts[0]}" if len(rows) == 1 else f"{subject} between {texts[0]} and {texts[1]}"


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
    rank = kappa["quantity"].map(lambda name: in_registry(name)[0])
    worst = worst_rows(kappa[rank == rank.groupby(kappa["model"]).transform("min")], ["model"])
    worst = worst.sort_values("kappa", key=lambda errors: -errors.abs(), kind="stable")
    return [(str(row["model"]), _error_text(row)) for row in worst.to_dict("records")]


def _error_text(row: Record) -> str:
    where = case_text({name: row.get(name) for name in CASE})
    return f"{percent_text(row['kappa'], row['u_kappa'])} % in the {title_of(row['quantity'])} at {where}"


def _of_errors(kappa: pd.DataFrame) -> str:
    """Return which model differs most from its reference, and where; empty without errors.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "reference": "fscm"}
    >>> rows = [case | {"model": "jkr", "kappa": -0.05, "u_kappa": 1e-9}, case | {"model": "dmt", "kappa": 0.01}]
    >>> _of_errors(pd.DataFrame(rows))
    'Of 2 models jkr differs most from fscm: by -5.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1'
    """
    if kappa.empty:
        return ""
    worst = kappa.loc[kappa["kappa"].abs().idxmax()]
    models = kappa["model"].nunique()
    subject = f"Of {models} models {worst['model']} differs most" if models > 1 else f"{worst['model']} differs"
    most = "" if models > 1 else "at most "
    return f"{subject} from {worst['reference']}: by {most}{_error_text(worst)}"
