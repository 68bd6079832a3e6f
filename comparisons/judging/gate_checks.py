"""Rules for the entries of a gate that its schema does not express: texts, limits, compared models."""

from __future__ import annotations

import math
import re
import unicodedata
from typing import TYPE_CHECKING

from comparisons.numerics.number_text import exact
from comparisons.problem import PARAMETERS, Problem

if TYPE_CHECKING:
    from comparisons.judging.gates import Gate

__all__ = ["LARGEST_MARGIN", "check_compared", "check_numbers", "plain_text"]

#: Unicode categories of characters that a terminal or a browser acts on and does not show: control and format
#: characters (among them those that reverse the direction of writing), and separators of lines and paragraphs.
_HIDDEN = ("Cc", "Cf", "Zl", "Zp")

#: The largest finite limit in size.  A model that is a thousand times the reference is wrong by any measure, so that a
#: limit beyond can only let such a model pass; values themselves, which "abs" limits, are below 100 in every standing
#: case, and a million leaves room for extreme ones.
_LARGEST_LIMIT = {"rel": 1e3, "abs": 1e6, "range-relative": 1e3, "en": 1e3, "curve": 1e3}

#: Size of the ends of a measured range over the worst error measured.  The difference of two accurate references is
#: numerical noise, of which another machine has several times as much; beyond ten times the code has changed.
LARGEST_MARGIN = 10.0


def plain_text(key: str, text: str, where: str) -> str:
    r"""Return a text of a gate on one line, its line ends and tabs replaced by a space.

    Raises
    ------
    ValueError
        If nothing is in it, or a character that would act on a terminal; the message shows it escaped.

    Examples
    --------
    >>> plain_text("grounds", "Eq. 51,\n  for k = 0\n", "gate A")
    'Eq. 51, for k = 0'
    """
    for character in text:
        if character not in "\t\r\n" and unicodedata.category(character) in _HIDDEN:
            raise ValueError(
                f"{where}: {key} holds the character {character!a}, which a terminal may take for a command; "
                "use printable characters"
            )
    if not text.strip():
        raise ValueError(f"{where}: {key} = {text!r} is empty; one sentence is needed, so that a reader can check it")
    return re.sub(r"\s*[\t\r\n]\s*", " ", text.strip())


def check_compared(gate: Gate, where: str) -> None:
    """Refuse a gate that compares something with itself, or by a metric without rival.

    Raises
    ------
    ValueError
        One sentence, which begins with `where`.
    """
    if gate.rival and gate.metric in ("en", "curve"):
        raise ValueError(f"{where}: the metric {gate.metric} compares with no rival; state rel, abs or range-relative")
    elsewhere = any(gate.cases.get(name) != [value, value] for name, value in gate.reference_at.items())
    if gate.candidate == gate.reference and not elsewhere:
        raise ValueError(
            f"{where}: candidate and reference are both {gate.candidate!r} in the same cases, so that the error is "
            "always 0 and the gate cannot fail; name another reference, or other parameters in reference_at"
        )
    if gate.candidate == gate.rival:
        raise ValueError(
            f"{where}: candidate and rival are both {gate.candidate!r}, so that the gate compares nothing; "
            "name another rival"
        )


def check_numbers(gate: Gate, where: str) -> None:
    """Refuse limits and uncertainties with which a gate could not fail, or never pass.

    Raises
    ------
    ValueError
        One sentence, which begins with `where`.
    """
    _check_limits(gate, where)
    _check_uncertainties(gate, where)
    _check_worst_measured(gate, where)
    if gate.min_coverage is not None and not 0.0 < gate.min_coverage <= 1.0:
        raise ValueError(
            f"{where}: min_coverage = {exact(gate.min_coverage)} is outside (0, 1]: it is the smallest share of the "
            "evaluated cases in which the candidate has a value"
        )
    _check_measured_range(gate, where)
    for name, limits in gate.cases.items():
        if name in PARAMETERS and not limits[0] <= limits[1]:
            raise ValueError(f"{where}: cases.{name} = {limits!r} must be [low, high], two numbers with low <= high")
    for name, value in gate.reference_at.items():
        if not math.isfinite(value):
            raise ValueError(f"{where}: reference_at.{name} = {value!r} must be a finite number")
    try:
        Problem.dimensionless(2.0, 0.0, 1.0).at(gate.reference_at)
    except ValueError as refusal:
        raise ValueError(f"{where}: reference_at: {refusal}") from None


def _check_limits(gate: Gate, where: str) -> None:
    if not gate.lower <= gate.upper or (math.isinf(gate.lower) and math.isinf(gate.upper)):
        raise ValueError(
            f"{where}: the limits {exact(gate.lower)} to {exact(gate.upper)} admit nothing or everything; "
            "one must be finite"
        )
    if gate.metric == "curve" and gate.lower != -math.inf:
        raise ValueError(f"{where}: a distance has no lower limit; state lower = -inf")
    if gate.metric == "curve" and gate.upper <= 0.0:
        raise ValueError(f"{where}: upper = {exact(gate.upper)} must be positive: no distance is smaller")
    largest = _LARGEST_LIMIT[gate.metric]
    for name, limit in (("lower", gate.lower), ("upper", gate.upper)):
        if math.isfinite(limit) and abs(limit) > largest:
            raise ValueError(
                f"{where}: {name} = {exact(limit)} is beyond {largest:g} in size, the largest limit of the metric "
                f"{gate.metric}: no model would fail; state a smaller limit, or {name} = {'-' * (name == 'lower')}inf "
                "for none"
            )


def _check_uncertainties(gate: Gate, where: str) -> None:
    if gate.metric == "en" and gate.max_candidate_uncertainty is None:
        raise ValueError(
            f"{where}: the metric en needs max_candidate_uncertainty, relative to the reference: a candidate that "
            "states a large uncertainty would pass with any value"
        )
    for key in ("max_reference_uncertainty", "max_candidate_uncertainty"):
        u = getattr(gate, key)
        if u is None:
            continue
        if not 0.0 < u < math.inf:
            raise ValueError(f"{where}: {key} = {exact(u)} must be positive and finite")
        if gate.metric == "en" and u >= 1.0:
            raise ValueError(
                f"{where}: {key} = {exact(u)} must be below 1 with the metric en: an uncertainty as large as the "
                "reference lets any value pass"
            )


def _check_worst_measured(gate: Gate, where: str) -> None:
    worst = gate.worst_measured
    if (gate.basis == "measured" or gate.measured_range is not None) != (worst is not None):
        raise ValueError(f"{where}: a measured basis or a measured_range, and nothing else, states its worst_measured")
    if worst is None:
        return
    limits = f"the limits {exact(gate.lower)} to {exact(gate.upper)}"
    if not math.isfinite(worst):
        raise ValueError(f"{where}: worst_measured = {exact(worst)} must be a finite number: it is a measured error")
    inside = gate.lower <= worst <= gate.upper
    if not inside and gate.expected_failure is None:
        raise ValueError(
            f"{where}: worst_measured = {exact(worst)} is not within {limits}: the gate would fail in the case "
            "that set its limits; correct one of them, or state expected_failure"
        )
    if inside and gate.expected_failure is not None:
        raise ValueError(
            f"{where}: worst_measured = {exact(worst)} is within {limits}, although expected_failure states that every "
            "case fails; correct one of them"
        )


def _check_measured_range(gate: Gate, where: str) -> None:
    if gate.measured_range is None:
        if gate.expected_failure is not None:
            raise ValueError(
                f"{where}: expected_failure needs measured_range = [low, high], the errors that were measured: without "
                "it every wrong value would be accepted as the known failure"
            )
        return
    low, high = gate.measured_range
    text = f"measured_range = [{exact(low)}, {exact(high)}]"
    worst = gate.worst_measured
    if worst is None or not low <= worst <= high:
        stated = "missing" if worst is None else exact(worst)
        raise ValueError(f"{where}: {text} must contain worst_measured, which is {stated}")
    if not max(abs(low), abs(high)) <= LARGEST_MARGIN * abs(worst):
        raise ValueError(
            f"{where}: {text} reaches beyond {LARGEST_MARGIN:g} times worst_measured = {exact(worst)}, so that it "
            "would notice no change; state the errors that were measured, with a margin"
        )
