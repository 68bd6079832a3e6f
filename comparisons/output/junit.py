"""Verdicts as JUnit XML, which CI systems read: one test case a gate and case."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from xml.etree import ElementTree

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
    return {
        key: float(seconds)
        for table in tables
        if {"model", "quantity", *PARAMETERS, "seconds"} <= set(table.columns)
        for key, seconds in zip(keys_in(table), table["seconds"], strict=True)
    }


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
    times = pd.Series([_seconds(row, seconds or {}) for _, row in judged.iterrows()], index=judged.index, dtype=float)
    root = ElementTree.Element("testsuites", {"name": "fscm-bench"} | _counts(judged, times))
    for gate, group in judged.groupby("gate", sort=False):
        suite = ElementTree.SubElement(root, "testsuite", {"name": _text(gate)} | _counts(group, times[group.index]))
        _coverage(suite, group)
        for index, row in group.iterrows():
            _case(suite, row, command, times[index])
    if overall(judged) is Verdict.ERROR and not (judged["verdict"] == Verdict.ERROR).any():
        _nothing_evaluated(root)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _nothing_evaluated(root: ElementTree.Element) -> None:
    """Add an error, so that a CI system that reads this file alone does not take it for a success."""
    suite = ElementTree.SubElement(root, "testsuite", name="gates", tests="1", errors="1", failures="0", skipped="0")
    case = ElementTree.SubElement(suite, "testcase", classname="fscm-bench.gates", name="evaluated", time=_time(0.0))
    ElementTree.SubElement(case, "error", message="no gate was evaluated")
    for name in ("tests", "errors"):
        root.set(name, str(int(root.get(name, "0")) + 1))


def _coverage(suite: ElementTree.Element, group: pd.DataFrame) -> None:
    """State in how many cases each candidate was evaluated and has a value."""
    properties = ElementTree.SubElement(suite, "properties")
    for candidate, rows in group.groupby("candidate", sort=False):
        for name, number in coverage(rows["status"]).items():
            ElementTree.SubElement(properties, "property", name=_text(f"{candidate} {name}"), value=str(number))


def _seconds(row: pd.Series, seconds: Mapping[Key, float]) -> float:
    """Return the time of the evaluation of a verdict's candidate; 0 where nothing was evaluated."""
    (key,) = keys_in(row.to_frame().T.assign(model=row["candidate"]))
    found = seconds.get(key, 0.0)
    return found if math.isfinite(found) else 0.0


def numbers_text(row: pd.Series) -> str:
    """Return the error of a verdict with its uncertainty and the limits.

    Examples
    --------
    >>> numbers_text(pd.Series({"error": 0.05, "uncertainty": 1e-09, "lower": -0.1, "upper": 0.1}))
    'E = 0.05, U = 1e-09, limits -0.1 to 0.1'
    """
    return f"E = {row['error']}, U = {row['uncertainty']}, limits {limits_text(row['lower'], row['upper'])}"


def _case(suite: ElementTree.Element, row: pd.Series, command: Callable[[pd.Series], str], seconds: float) -> None:
    parameters = [f"{name}={row[name]:g}" for name in PARAMETERS if pd.notna(row[name])]
    parameters += [row["problem"]] if row.get("problem") else []
    case = ElementTree.SubElement(
        suite,
        "testcase",
        classname=_text(f"fscm-bench.{row['gate']}"),
        name=_text(f"{row['candidate']} {row['quantity']} {' '.join(parameters) or 'whole gate'}"),
        time=_time(seconds),
    )
    numbers = numbers_text(row)
    element = _ELEMENTS.get(row["verdict"])
    if element:
        message = f"{row['verdict']}: {row['reason'] or numbers}"
        ElementTree.SubElement(case, element, message=_text(message)).text = _text(f"{numbers}\n{command(row)}")
    else:
        ElementTree.SubElement(case, "system-out").text = _text(numbers)


def _counts(rows: pd.DataFrame, times: pd.Series) -> dict[str, str]:
    kinds = rows["verdict"].map(_ELEMENTS).value_counts()
    counts = {
        name: str(int(kinds.get(kind, 0)))
        for name, kind in {"errors": "error", "failures": "failure", "skipped": "skipped"}.items()
    }
    return {"tests": str(len(rows))} | counts | {"time": _time(math.fsum(times))}


def _time(seconds: float) -> str:
    """Return seconds as a decimal without exponent, which some readers of JUnit XML refuse."""
    return f"{seconds:.6f}"


def _text(text: object) -> str:
    return _UNPRINTABLE.sub("?", str(text))
