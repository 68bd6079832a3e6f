"""Sentences on the gates of a run for the terminal and for the report, and the form of a verb beside a number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import pandas as pd

from comparisons.console.folding import hanging, wrapped_command
from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import error_text, limits_text
from comparisons.output.verdicts import command

__all__ = ["counted", "declared_sentence", "gate_lines", "gates_line", "gates_sentence", "unexpected"]

#: Verdicts of gates that behave as declared: a gate passes, fails as it is declared to, or applies to no case.
_EXPECTED = (Verdict.PASS, Verdict.XFAIL, Verdict.NOT_APPLICABLE)

#: Names of gates that are listed in one sentence.
_NAMES = 12


def counted(count: int, several: str, one: str) -> str:
    """Return a number with the form of the words that belongs to it.

    Examples
    --------
    >>> counted(1, "gates", "gate"), counted(0, "fail", "fails")
    ('1 gate', '0 fail')
    """
    return f"{count} {one if count == 1 else several}"


def gates_sentence(gates: pd.DataFrame, bases: Mapping[str, str]) -> str:
    """Return how many gates of the user pass, fail as declared, and do neither, and what else a report card found.

    Parameters
    ----------
    gates : DataFrame
        One row for each gate and candidate, as of `comparisons.judging.summary.summarise`.
    bases : mapping of str to str
        What each gate is based on: a declared failure of a gate on "published" numbers is a difference from the paper.

    Examples
    --------
    >>> gates = pd.DataFrame({"gate": ["A", "B", "C"], "verdict": ["PASS", "XFAIL", "FAIL"]})
    >>> gates_sentence(gates, {"B": "published"})
    '1 of 3 gates passes, 1 differs from the paper as declared, 1 unexpected: 1 FAIL'
    >>> gates_sentence(gates[:2], {})
    '1 of 2 gates passes, 1 fails as declared, 0 unexpected'
    >>> gates_sentence(pd.DataFrame({"gate": ["A", "CARD-DIFFERS"], "verdict": ["PASS", "INCONCLUSIVE"]}), {})
    '1 of 1 gate passes, 0 fail as declared, 0 unexpected; report cards: 1 INCONCLUSIVE'
    """
    of_user = without_card_gates(gates)
    failed_cards = Counter(verdict for verdict in gates["verdict"].drop(of_user.index) if verdict != Verdict.PASS)
    cards = f"; report cards: {_counts(failed_cards)}" if failed_cards else ""
    if of_user.empty:
        return f"No gate was evaluated{cards}"
    count, total = Counter(of_user["verdict"]), len(of_user)
    declared = count[Verdict.XFAIL]
    paper = sum(bases.get(gate) == "published" for gate in of_user.loc[of_user["verdict"] == Verdict.XFAIL, "gate"])
    passed = count[Verdict.PASS]
    parts = [f"{passed} of {counted(total, 'gates', 'gate')} {'passes' if 1 in (passed, total) else 'pass'}"]
    if paper:
        parts.append(counted(paper, "differ", "differs") + " from the paper as declared")
    if declared > paper or not paper:
        parts.append(counted(declared - paper, "fail", "fails") + " as declared")
    if empty := count[Verdict.NOT_APPLICABLE]:
        parts.append(counted(empty, "apply", "applies") + " to no case")
    surprises = Counter(unexpected(of_user)["verdict"])
    parts.append(f"{surprises.total()} unexpected" + (f": {_counts(surprises)}" if surprises else ""))
    return ", ".join(parts) + cards


def _counts(verdicts: Counter[str]) -> str:
    return ", ".join(f"{verdicts[verdict]} {verdict}" for verdict in Verdict if verdicts[verdict])


def gates_line(gates: pd.DataFrame, verdicts: pd.DataFrame, bases: Mapping[str, str]) -> str:
    """Return the sentence on all gates, and how many cases have each verdict.

    Parameters
    ----------
    gates : DataFrame
        As of `comparisons.judging.summary.summarise`.
    verdicts : DataFrame
        As of `comparisons.judging.judge.judge`.
    bases : mapping of str to str
        What each gate is based on.

    Examples
    --------
    >>> gates = pd.DataFrame({"gate": ["A", "B", "C"], "verdict": ["PASS", "XFAIL", "FAIL"]})
    >>> gates_line(gates, gates, {"B": "published"}).partition(" (")[2]
    '3 cases: 1 FAIL, 1 XFAIL, 1 PASS)'
    """
    judged = without_card_gates(verdicts)
    sentence = gates_sentence(gates, bases)
    if judged.empty:
        return sentence
    return f"{sentence} ({counted(len(judged), 'cases', 'case')}: {_counts(Counter(judged['verdict']))})"


def unexpected(gates: pd.DataFrame) -> pd.DataFrame:
    """Return the gates of a summary that do not behave as declared, worst first."""
    return gates[~gates["verdict"].isin(_EXPECTED)]


def gate_lines(gates: pd.DataFrame, specs: Mapping[str, str], width: int, most: int | None = None) -> list[str]:
    """Return for each gate its verdict, the error of the worst case, and the command that computes that case again.

    Parameters
    ----------
    gates : DataFrame
        As of `comparisons.judging.summary.summarise`.
    specs : mapping of str to str
        The SPEC that finds each external model.
    width : int
        Columns of the terminal.
    most : int, optional
        Gates that are shown; the last line counts the others.
    """
    lines: list[str] = []
    for row in gates.head(most or len(gates)).to_dict("records"):
        error = error_text(row["error"], row["uncertainty"])
        against = f" against {row['reference']}" if row["reference"] else ""
        found = f": E = {error}, limits {limits_text(row['lower'], row['upper'])}" if error else ""
        covered = f", a value in {text}" if (text := coverage_text(row)) else ""
        lines += hanging(f"{row['verdict']} {row['gate']} of {row['candidate']}{against}{found}{covered}", width)
        lines += hanging(f"  {row['reason']}", width) if row["reason"] else []
        lines += wrapped_command(command(row, specs), width)
    if most and len(gates) > most:
        lines += hanging(f"{len(gates) - most} more do not pass; --verbose prints all", width)
    return lines


def declared_sentence(gates: pd.DataFrame) -> str:
    """Return the names of the gates that fail as declared, the first ones and the number of the others.

    Examples
    --------
    >>> declared_sentence(pd.DataFrame({"gate": ["A", "B"], "verdict": ["PASS", "XFAIL"]}))
    'as declared (XFAIL; --verbose prints the commands): B'
    """
    names = list(dict.fromkeys(gates.loc[gates["verdict"] == Verdict.XFAIL, "gate"]))
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return f"as declared (XFAIL; --verbose prints the commands): {', '.join(names[:_NAMES])}{more}" if names else ""
