"""Summary of a run for the terminal: the largest errors, what does not pass, and one sentence on all gates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pandas as pd

from comparisons.console.folding import hanging
from comparisons.console.shell_text import wrapped_command
from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.numerics.number_text import error_text, exact, limits_text, value_text
from comparisons.output.fitted_table import FittedTable
from comparisons.output.gate_sentence import EXPECTED, counted, gates_sentence
from comparisons.output.verdicts import command

__all__ = [
    "computations_sentence",
    "declared_lines",
    "gates_line",
    "largest_table",
    "not_passed",
    "paper_sentence",
]

#: An error in percent is shown to this digit, or to the digit that its uncertainty leaves it.
_LEAST_PERCENT = 5e-3

#: Lines of a table that are no rows: title, columns and rule, and the line on the rows that are not shown.
_FRAME = 4

#: Names of gates that are listed in one block.
_NAMES = 12

#: Verdict on a number of the paper -> its verb where it is said of several.
_SEVERAL = {"agrees": "agree", "differs": "differ"}


def largest_table(maxima: pd.DataFrame, width: int, lines: int) -> FittedTable | None:
    r"""Return the largest abs(kappa) of each model, for each n if the table then has no more lines and columns.

    Parameters
    ----------
    maxima : DataFrame
        As of `comparisons.output.tables.largest`.
    width, lines : int
        Columns of the terminal, and how many lines there are for the table.

    Returns
    -------
    FittedTable or None
        One column for each n, with k and mu below each error; or one row for each model with the largest over all n,
        the first ones and their number if the lines are too few.  None if there is no kappa.

    Examples
    --------
    >>> row = {"quantity": "pull_off_force", "model": "jkr", "k": 0.4, "mu": 1.0, "u_kappa": 1e-9}
    >>> maxima = pd.DataFrame([row | {"n": 1.0, "kappa": -0.05}, row | {"n": 2.0, "kappa": 0.02}])
    >>> largest_table(maxima, 80, 9).texts.values.tolist()
    [['jkr', '-5.000(5)\n0.4, 1', '2.000(5)\n0.4, 1']]
    >>> largest_table(maxima, 80, 4).texts.values.tolist()
    [['jkr', '-5.000(5)', '1', '0.4', '1']]
    """
    if maxima.empty:
        return None
    worst = maxima.loc[maxima.groupby(["quantity", "model", "n"])["kappa"].transform(_is_largest)]
    cells = [value_text(100 * kappa, max(100 * u, _LEAST_PERCENT)) for kappa, u in _pairs(worst)]
    worst = worst.assign(shown=cells)
    series = ["quantity", "model"] if worst["quantity"].nunique() > 1 else ["model"]
    quantity = "" if len(series) > 1 else f"{worst['quantity'].iloc[0]}: "
    by_shape = worst.assign(
        n=[f"n = {exact(n)}" for n in worst["n"]],
        shown=[f"{cell}\n{exact(k)}, {_short(mu)}" for cell, k, mu in zip(cells, worst["k"], worst["mu"], strict=True)],
    )
    wide = by_shape.pivot(index=series, columns="n", values="shown")
    wide = wide[list(dict.fromkeys(by_shape.sort_values("n", key=lambda n: n.str[4:].astype(float))["n"]))]
    table = FittedTable(
        wide.fillna("").reset_index(),
        f"{quantity}largest abs(kappa) in percent for each n; below it k and mu",
        frozenset(wide.columns),
        "quantity" if len(series) > 1 else "",
    )
    if table.is_table(width) and 1 + len(table.lines(width)) <= lines:
        return table
    return _by_model(worst, series, quantity, lines)


def _by_model(worst: pd.DataFrame, series: list[str], quantity: str, lines: int) -> FittedTable:
    rows = worst.loc[worst.groupby(series)["kappa"].transform(_is_largest)].sort_values(series)
    texts = pd.DataFrame(
        {
            **{name: rows[name] for name in series},
            "largest": rows["shown"],
            "n": [exact(n) for n in rows["n"]],
            "k": [exact(k) for k in rows["k"]],
            "mu": [_short(mu) for mu in rows["mu"]],
        },
        dtype=object,
    )
    title = f"{quantity}largest abs(kappa) in percent over all n"
    most = max(lines - _FRAME, 1)
    shown = "" if len(texts) <= most else f"the first {most} of {len(texts)} rows; "
    title += f" ({shown}--verbose prints every n)"
    return FittedTable(
        texts.head(most), title, frozenset(("largest", "n", "k", "mu")), "quantity" if len(series) > 1 else ""
    )


def _is_largest(kappa: pd.Series) -> pd.Series:
    """Return True for the first of the largest sizes."""
    return pd.Series(kappa.index == kappa.abs().idxmax(), index=kappa.index)


def _pairs(rows: pd.DataFrame) -> Iterator[tuple[float, float]]:
    return zip(rows["kappa"], rows["u_kappa"], strict=True)


def _short(mu: float) -> str:
    return f"{mu:.4g}"


def not_passed(gates: pd.DataFrame, specs: Mapping[str, str], width: int, most: int) -> list[str]:
    """Return the gates that do not behave as declared, worst first: the error of the worst case, and its command.

    Parameters
    ----------
    gates : DataFrame
        As of `comparisons.judging.summary.summarise`.
    specs : mapping of str to str
        The SPEC that finds each external model.
    width : int
        Columns of the terminal.
    most : int
        Gates that are shown; the last line counts the others.
    """
    wrong = gates[~gates["verdict"].isin(EXPECTED)]
    lines: list[str] = []
    for _, row in wrong.head(most).iterrows():
        error = error_text(row["error"], row["uncertainty"])
        found = f": E = {error}, limits {limits_text(row['lower'], row['upper'])}" if error else ""
        against = f" against {row['reference']}" if row["reference"] else ""
        lines += hanging(f"{row['verdict']} {row['gate']} of {row['candidate']}{against}{found}", width)
        lines += hanging(f"  {row['reason']}", width) if row["reason"] else []
        lines += wrapped_command(command(row, specs), width)
    if len(wrong) > most:
        lines += hanging(f"{len(wrong) - most} more do not pass; --verbose prints all", width)
    return lines


def declared_lines(gates: pd.DataFrame, width: int) -> list[str]:
    """Return the names of the gates that fail as declared, the first ones and the number of the others."""
    names = list(dict.fromkeys(gates.loc[gates["verdict"] == Verdict.XFAIL, "gate"]))
    if not names:
        return []
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return hanging(f"as declared (XFAIL; --verbose prints the commands): {', '.join(names[:_NAMES])}{more}", width)


def gates_line(gates: pd.DataFrame, verdicts: pd.DataFrame, bases: Mapping[str, str]) -> str:
    """Return the sentence on all gates, and how many cases have each verdict.

    Parameters
    ----------
    gates : DataFrame
        As of `comparisons.judging.summary.summarise`.
    verdicts : DataFrame
        As of `comparisons.judging.judge.judge`.
    bases : mapping of str to str
        What each gate is based on; "published" for numbers of the paper.

    Examples
    --------
    >>> gates = pd.DataFrame({"gate": ["A", "B", "C"], "verdict": ["PASS", "XFAIL", "FAIL"]})
    >>> gates_line(gates, gates, {"B": "published"}).partition(" (")[2]
    '3 cases: 1 PASS, 1 XFAIL, 1 FAIL)'
    """
    judged = without_card_gates(verdicts)
    if judged.empty:
        return gates_sentence(gates, bases)
    cases = judged["verdict"].map(str).value_counts()
    every = ", ".join(f"{cases[str(verdict)]} {verdict}" for verdict in reversed(Verdict) if str(verdict) in cases)
    return f"{gates_sentence(gates, bases)} ({counted(len(judged), 'cases', 'case')}: {every})"


def computations_sentence(counts: Mapping[str, int]) -> str:
    """Return how many computations ended with which status.

    Examples
    --------
    >>> computations_sentence({"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4})
    '12 results: 8 ok, 4 not-applicable'
    """
    others = ("all", "resumed", "shipped")
    statuses = ", ".join(f"{count} {name}" for name, count in counts.items() if name not in others)
    return f"{counts['all']} results: {statuses}" if statuses else "no results"


def paper_sentence(maxima: pd.DataFrame) -> str:
    """Return how many of the maxima that the paper prints agree; empty if there are none.

    Examples
    --------
    >>> rows = {"k": [0.4] * 3, "paper_percent": ["0.73", "3.5", "5"], "verdict": ["differs", "agrees", "differs"]}
    >>> paper_sentence(pd.DataFrame(rows))
    'the paper prints 3 maxima, for k = 0.4: 1 agrees, 2 differ'
    """
    stated = maxima[maxima["paper_percent"] != ""]
    if stated.empty:
        return ""
    gradients = ", ".join(exact(k) for k in sorted(set(stated["k"])))
    verdicts = sorted(stated["verdict"].value_counts().items())
    listed = ", ".join(counted(count, _said_of_several(verdict), verdict) for verdict, count in verdicts)
    return f"the paper prints {counted(len(stated), 'maxima', 'maximum')}, for k = {gradients}: {listed}"


def _said_of_several(verdict: str) -> str:
    verb, _, rest = verdict.partition(" ")
    return " ".join([_SEVERAL.get(verb, verb), rest]).rstrip()
