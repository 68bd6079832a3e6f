"""Sentence on all gates of a run, for the terminal and for the report, and the form of a verb beside a number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import pandas as pd

from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import Verdict

__all__ = ["EXPECTED", "counted", "gates_sentence"]

#: Verdicts of gates that behave as declared: a gate passes, fails as it is declared to, or applies to no case.
EXPECTED = (Verdict.PASS, Verdict.XFAIL, Verdict.NOT_APPLICABLE)


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
    checks = Counter(Verdict(verdict) for verdict in gates["verdict"].drop(of_user.index) if verdict != Verdict.PASS)
    found = ", ".join(f"{checks[verdict]} {verdict}" for verdict in Verdict if checks[verdict])
    return _of_user(of_user, bases) + (f"; report cards: {found}" if found else "")


def _of_user(gates: pd.DataFrame, bases: Mapping[str, str]) -> str:
    verdicts = [Verdict(verdict) for verdict in gates["verdict"]]
    if not verdicts:
        return "No gate was evaluated"
    found = Counter(verdicts)
    parts = [_passed(found[Verdict.PASS], len(verdicts))]
    declared = [gate for gate, verdict in zip(gates["gate"], verdicts, strict=True) if verdict == Verdict.XFAIL]
    paper = sum(bases.get(gate) == "published" for gate in declared)
    if paper:
        parts.append(counted(paper, "differ", "differs") + " from the paper as declared")
    if len(declared) > paper or not paper:
        parts.append(counted(len(declared) - paper, "fail", "fails") + " as declared")
    if empty := found[Verdict.NOT_APPLICABLE]:
        parts.append(counted(empty, "apply", "applies") + " to no case")
    others = [f"{found[verdict]} {verdict}" for verdict in Verdict if verdict not in EXPECTED and found[verdict]]
    unexpected = len(verdicts) - sum(found[verdict] for verdict in EXPECTED)
    return f"{', '.join(parts)}, {unexpected} unexpected" + (f": {', '.join(others)}" if others else "")


def _passed(count: int, gates: int) -> str:
    return f"{count} of {counted(gates, 'gates', 'gate')} {'passes' if 1 in (count, gates) else 'pass'}"
