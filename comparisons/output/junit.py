"""Verdicts as JUnit XML, which CI systems read: one test suite a gate, one test case a case."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import pandas as pd

from comparisons.judging.card_gates import overall
from comparisons.judging.decision import Verdict
from comparisons.judging.summary import coverage
from comparisons.numerics.number_text import limits_text
from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import keys_in
from comparisons.runs.rows import Key

__all__ = ["evaluation_seconds", "junit", "numbers_text"]

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


def evaluation_seconds(*tables: pd.DataFrame) -> dict[Key, float]:
    """Return the seconds of each evaluation of tables of results and curves, by the key of its row.

    Examples
    --------
    >>> case = {"model": ["jkr"], "quantity": ["pull_off_force"], "n": [2.0], "k": [0.0], "mu": [1.0], "nu": [None]}
    >>> evaluation_seconds(pd.DataFrame(case | {"seconds": [0.5]}))
    {('jkr', 'pull_off_force', 2.0, 0.0, 1.0, None, ''): 0.5}
    """
    timed = [table for table in tables if {"model", "quantity", *PARAMETERS, "seconds"} <= set(table)]
    return {key: float(s) for table in timed for key, s in zip(keys_in(table), table["seconds"], strict=True)}


def junit(
    judged: pd.DataFrame, command: Callable[[pd.Series], str], seconds: Mapping[Key, float] | None = None
) -> bytes:
    """Return a report with one test suite a gate.

    Parameters
    ----------
    judged : DataFrame
        What `comparisons.judging.judge.judge` returns.
    command : callable
        Gives the command that reproduces a row.
    seconds : mapping of key to float, optional
        The time of each evaluation, as of `evaluation_seconds`.  The time of a test case is that of the candidate, and
        a suite has the sum of its cases: an evaluation that two gates use counts in both.
    """
    times = [(seconds or {}).get(key, 0.0) for key in keys_in(judged.rename(columns={"candidate": "model"}))]
    judged = judged.assign(time=[time if math.isfinite(time) else 0.0 for time in times])
    root = Element("testsuites", {"name": "fscm-bench"} | _counts(judged))
    for gate, group in judged.groupby("gate", sort=False):
        suite = SubElement(root, "testsuite", {"name": _text(gate)} | _counts(group))
        properties = SubElement(suite, "properties")
        for candidate, rows in group.groupby("candidate", sort=False):
            for name, number in coverage(rows["status"]).items():
                SubElement(properties, "property", name=_text(f"{candidate} {name}"), value=str(number))
        for _, row in group.iterrows():
            _case(suite, row, command)
    if overall(judged) is Verdict.ERROR and not (judged["verdict"] == Verdict.ERROR).any():
        # A CI system that reads this file alone must not take it for a success.
        suite = SubElement(root, "testsuite", name="gates", tests="1", errors="1", failures="0", skipped="0")
        case = SubElement(suite, "testcase", classname="fscm-bench.gates", name="evaluated", time="0")
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
    classname, time = _text(f"fscm-bench.{row['gate']}"), _time(row["time"])
    case = SubElement(suite, "testcase", classname=classname, name=name, time=time)
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
    return {"tests": str(len(rows)), **counts, "time": _time(math.fsum(rows["time"]))}


def _time(seconds: float) -> str:
    """Return seconds as a decimal without exponent, which some readers of JUnit XML refuse."""
    return f"{seconds:.6f}"


def _text(text: object) -> str:
    return _UNPRINTABLE.sub("?", str(text))
