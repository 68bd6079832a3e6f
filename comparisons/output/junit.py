"""Verdicts as JUnit XML, which CI systems read: a test suite a gate and one for the report cards."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import pandas as pd

from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.report_card import ModelCheck
from comparisons.numerics.number_text import limits_text
from comparisons.problem import PARAMETERS

#: Verdict -> element inside the test case; those not here are passes.  An inconclusive gate did not show
#: what it requires, and is a failure; an expected failure counts as skipped, as in pytest.
_ELEMENTS = {
    Verdict.ERROR: "error",
    Verdict.FAIL: "failure",
    Verdict.XPASS: "failure",
    Verdict.INCONCLUSIVE: "failure",
    Verdict.XFAIL: "skipped",
    Verdict.NOT_APPLICABLE: "skipped",
}
#: XML 1.0 has no place for these characters, escaped or not.
_UNPRINTABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def junit(judged: pd.DataFrame, checks: Sequence[ModelCheck], command: Callable[[pd.Series], str]) -> bytes:
    """Return a report with one test suite a gate, and one for the report cards if there are some.

    Parameters
    ----------
    judged : DataFrame
        What `comparisons.judging.judge.judge` returns.
    checks : sequence of ModelCheck
        Of the report cards.
    command : callable
        Gives the command that reproduces a row.
    """
    of_cards = [check.verdict for check in checks]
    root = Element("testsuites", {"name": "fscm-bench"} | _counts([*judged["verdict"], *of_cards]))
    for gate, group in judged.groupby("gate", sort=False):
        suite = SubElement(root, "testsuite", {"name": _text(gate)} | _counts(group["verdict"]))
        for _, row in group.iterrows():
            _case(suite, row, command)
    if checks:
        suite = SubElement(root, "testsuite", {"name": "report card"} | _counts(of_cards))
        for check in checks:
            name = _text(f"{check.model} {check.line}")
            case = SubElement(suite, "testcase", classname="fscm-bench.report card", name=name)
            _outcome(case, check.verdict, check.reason, check.reason)
    if roll_up(judged["verdict"]) is Verdict.ERROR and not (judged["verdict"] == Verdict.ERROR).any():
        # A CI system that reads this file alone must not take it for a success.
        suite = SubElement(root, "testsuite", name="gates", tests="1", errors="1", failures="0", skipped="0")
        case = SubElement(suite, "testcase", classname="fscm-bench.gates", name="evaluated")
        SubElement(case, "error", message="no gate was evaluated")
        root.attrib |= {"tests": str(len(judged) + len(checks) + 1), "errors": "1"}
    indent(root)
    return tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def numbers_text(row: pd.Series) -> str:
    """Return the error of a verdict with its uncertainty and the limits.

    Examples
    --------
    >>> numbers_text(pd.Series({"error": 0.05, "uncertainty": 1e-09, "lower": -0.1, "upper": 0.1}))
    'E = 0.05, U = 1e-09, limits -0.1 to 0.1'
    """
    return f"E = {row['error']}, U = {row['uncertainty']}, limits {limits_text(row['lower'], row['upper'])}"


def _case(suite: Element, row: pd.Series, command: Callable[[pd.Series], str]) -> None:
    parameters = [f"{name}={row[name]:g}" for name in PARAMETERS if pd.notna(row[name])]
    label = " ".join(filter(None, [*parameters, row.get("problem")])) or "whole gate"
    name = _text(f"{row['candidate']} {row['quantity']} {label}")
    case = SubElement(suite, "testcase", classname=_text(f"fscm-bench.{row['gate']}"), name=name)
    numbers = numbers_text(row)
    is_pass = row["verdict"] not in _ELEMENTS
    _outcome(case, row["verdict"], row["reason"] or numbers, numbers if is_pass else f"{numbers}\n{command(row)}")


def _outcome(case: Element, verdict: str, reason: str, text: str) -> None:
    if element := _ELEMENTS.get(Verdict(verdict)):
        SubElement(case, element, message=_text(f"{verdict}: {reason}")).text = _text(text)
    else:
        SubElement(case, "system-out").text = _text(text)


def _counts(verdicts: Iterable[str]) -> dict[str, str]:
    kinds = [_ELEMENTS.get(Verdict(verdict)) for verdict in verdicts]
    attributes = {"errors": "error", "failures": "failure", "skipped": "skipped"}
    counts = {name: str(kinds.count(kind)) for name, kind in attributes.items()}
    return {"tests": str(len(kinds)), **counts}


def _text(text: object) -> str:
    return _UNPRINTABLE.sub("?", str(text))
