"""Verdicts as JUnit XML, which CI systems read: one test suite a gate, one test case a case."""

from __future__ import annotations

import re
from collections.abc import Callable
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.report_card import overall
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


def junit(judged: pd.DataFrame, command: Callable[[pd.Series], str]) -> bytes:
    """Return a report with one test suite a gate.

    Parameters
    ----------
    judged : DataFrame
        What `comparisons.judging.judge.judge` returns.
    command : callable
        Gives the command that reproduces a row.
    """
    root = Element("testsuites", {"name": "fscm-bench"} | _counts(judged))
    for gate, group in judged.groupby("gate", sort=False):
        suite = SubElement(root, "testsuite", {"name": _text(gate)} | _counts(group))
        for _, row in group.iterrows():
            _case(suite, row, command)
    if overall(judged) is Verdict.ERROR and not (judged["verdict"] == Verdict.ERROR).any():
        # A CI system that reads this file alone must not take it for a success.
        suite = SubElement(root, "testsuite", name="gates", tests="1", errors="1", failures="0", skipped="0")
        case = SubElement(suite, "testcase", classname="fscm-bench.gates", name="evaluated")
        SubElement(case, "error", message="no gate was evaluated")
        root.attrib |= {"tests": str(len(judged) + 1), "errors": "1"}
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
    if element := _ELEMENTS.get(row["verdict"]):
        message = _text(f"{row['verdict']}: {row['reason'] or numbers}")
        SubElement(case, element, message=message).text = _text(f"{numbers}\n{command(row)}")
    else:
        SubElement(case, "system-out").text = _text(numbers)


def _counts(rows: pd.DataFrame) -> dict[str, str]:
    kinds = list(rows["verdict"].map(_ELEMENTS))
    attributes = {"errors": "error", "failures": "failure", "skipped": "skipped"}
    counts = {name: str(kinds.count(kind)) for name, kind in attributes.items()}
    return {"tests": str(len(rows)), **counts}


def _text(text: object) -> str:
    return _UNPRINTABLE.sub("?", str(text))
