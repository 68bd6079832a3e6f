"""First sentences of a page: what was found, over all gates or in the worst case of a model."""

from __future__ import annotations

from collections import Counter

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.report.stored_run import Stored
from comparisons.quantities import title_of

__all__ = ["headline", "headline_of_errors", "headline_of_gates"]

#: Verdicts on a gate that need no reaction: it passes, is declared to fail, or applies to no case.
_EXPECTED = (Verdict.PASS, Verdict.XFAIL, Verdict.NOT_APPLICABLE)


def headline(stored: Stored) -> str:
    """Return the finding of a folder in one sentence."""
    if stored.judged:
        return headline_of_gates(stored.summary["verdict"])
    return headline_of_errors(stored.kappa)


def headline_of_gates(verdicts: pd.Series) -> str:
    """Return what the gates have found.

    Examples
    --------
    >>> headline_of_gates(pd.Series(["PASS", "PASS", "XFAIL"]))
    '2 of 3 gates pass, 1 fails as declared, 0 unexpected'
    >>> headline_of_gates(pd.Series(["PASS", "FAIL", "ERROR", "NOT-APPLICABLE"]))
    '1 of 4 gates passes, 0 fail as declared, 1 applies to no case, 2 unexpected: 1 ERROR, 1 FAIL'
    """
    found = Counter(Verdict(one) for one in verdicts)
    if not found:
        return "No gate was evaluated"
    parts = [
        f"{found[Verdict.PASS]} of {found.total()} gates {_verb(found[Verdict.PASS], 'pass', 'passes')}",
        f"{found[Verdict.XFAIL]} {_verb(found[Verdict.XFAIL], 'fail', 'fails')} as declared",
    ]
    if empty := found[Verdict.NOT_APPLICABLE]:
        parts.append(f"{empty} {_verb(empty, 'apply', 'applies')} to no case")
    others = [(verdict, found[verdict]) for verdict in Verdict if verdict not in _EXPECTED and found[verdict]]
    parts.append(f"{sum(count for _, count in others)} unexpected")
    return ", ".join(parts) + (": " + ", ".join(f"{count} {verdict}" for verdict, count in others) if others else "")


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


def _verb(count: int, several: str, one: str) -> str:
    return one if count == 1 else several
