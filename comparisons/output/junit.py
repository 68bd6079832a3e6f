"""Verdicts as JUnit XML, which CI systems read: one test case a gate and case."""

from __future__ import annotations

import re
from collections.abc import Callable
from xml.etree import ElementTree

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.summary import coverage
from comparisons.numerics.number_text import limits_text

__all__ = ["junit"]

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
# XML 1.0 has no place for these characters, escaped or not.
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
    root = ElementTree.Element("testsuites", {"name": "fscm-bench"} | _counts(judged))
    for gate, group in judged.groupby("gate", sort=False):
        suite = ElementTree.SubElement(root, "testsuite", {"name": _text(gate)} | _counts(group))
        _coverage(suite, group)
        for _, row in group.iterrows():
            _case(suite, row, command)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _coverage(suite: ElementTree.Element, group: pd.DataFrame) -> None:
    """State in how many cases each candidate was evaluated and has a value."""
    properties = ElementTree.SubElement(suite, "properties")
    for candidate, rows in group.groupby("candidate", sort=False):
        for name, number in coverage(rows["status"]).items():
            ElementTree.SubElement(properties, "property", name=_text(f"{candidate} {name}"), value=str(number))


def _case(suite: ElementTree.Element, row: pd.Series, command: Callable[[pd.Series], str]) -> None:
    parameters = [f"{name}={row[name]:g}" for name in ("n", "k", "mu", "nu") if pd.notna(row[name])]
    case = ElementTree.SubElement(
        suite,
        "testcase",
        classname=_text(f"fscm-bench.{row['gate']}"),
        name=_text(f"{row['candidate']} {row['quantity']} {' '.join(parameters) or 'whole gate'}"),
    )
    numbers = f"E = {row['error']}, U = {row['uncertainty']}, limits {limits_text(row['lower'], row['upper'])}"
    element = _ELEMENTS.get(row["verdict"])
    if element:
        message = f"{row['verdict']}: {row['reason'] or numbers}"
        ElementTree.SubElement(case, element, message=_text(message)).text = _text(f"{numbers}\n{command(row)}")
    else:
        ElementTree.SubElement(case, "system-out").text = _text(numbers)


def _counts(rows: pd.DataFrame) -> dict[str, str]:
    kinds = rows["verdict"].map(_ELEMENTS).value_counts()
    return {"tests": str(len(rows))} | {
        name: str(int(kinds.get(kind, 0)))
        for name, kind in {"errors": "error", "failures": "failure", "skipped": "skipped"}.items()
    }


def _text(text: object) -> str:
    return _UNPRINTABLE.sub("?", str(text))
