"""Rules for the entries of a gate that its schema does not express: texts, limits, compared models, selected cases."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from comparisons.data.validation import known_name
from comparisons.numerics.number_text import exact
from comparisons.problem import PARAMETERS, Problem
from comparisons.problem.kinds import KINDS
from comparisons.problem.units import NotAValue, in_si

#: The number of an entry of a list: "solid.thickness.2" is the second thickness.
_ENTRY = re.compile(r"\.[1-9]\d{0,2}$")


def in_si_units(cases: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return the cases of a gate with their values in SI.

    Raises
    ------
    ValueError
        One sentence, which begins with `where`, if a parameter is unknown or a value has another dimension.

    Examples
    --------
    >>> in_si_units({"solid.kind": "coating", "solid.thickness": ["10 nm", "50 nm"], "n": [2, 2]}, "gate A")
    {'solid.kind': 'coating', 'solid.thickness': [1e-08, 5e-08], 'n': [2, 2]}
    """
    words = {f"{section}.kind": list(kinds) for section, kinds in KINDS.items()}
    of_kinds = ((section, kind.keys) for section, kinds in KINDS.items() for kind in kinds.values())
    forms = {f"{section}.{key}": form for section, keys in of_kinds for key, form in keys.items()}
    units = {name: form.unit for name, form in forms.items()}
    values: dict[str, Any] = {}
    for name, value in cases.items():
        key = _ENTRY.sub("", name)
        known_name("key of cases", key, [*PARAMETERS, "tags", *words, *units], where)
        if key in words:
            known_name(f"cases.{name}", str(value), words[key], where)
        is_range = name != "tags" and not isinstance(value, str)
        values[name] = _range_in_si(name, value, units.get(key), where) if is_range else value
    return values


def has_parameters(problem: Problem, cases: Mapping[str, Any]) -> bool:
    """Whether a problem has the words, and values inside the ranges, that a gate selects; not if it has no value.

    Examples
    --------
    >>> has_parameters(Problem.dimensionless(2, 0.4, 1), {"k": [0.0, 1.0]})
    True
    """
    return all(_matches(wanted, problem[name]) for name, wanted in cases.items() if name != "tags")


def _matches(wanted: Any, value: Any) -> bool:
    if isinstance(wanted, str) or not isinstance(value, float | int):
        return bool(value == wanted)
    low, high = wanted
    return bool(low <= value <= high)


def _range_in_si(name: str, ends: Any, unit: str | None, where: str) -> list[float]:
    form = "[low, high], two values with low <= high, with their unit if they have one"
    try:
        low, high = ends if unit is None else [in_si(end, unit) for end in ends]
    except NotAValue as error:
        raise ValueError(f"{where}: cases.{name} has a value that {error}; it must be {form}") from None
    if not low <= high:
        raise ValueError(f"{where}: cases.{name} = [{low:g}, {high:g}] must be {form}")
    return [low, high]


if TYPE_CHECKING:
    from comparisons.judging.gates import Gate

#: Size of the ends of a measured range over the worst error measured. The difference of two accurate references is
#: numerical noise, of which another machine has several times as much; beyond ten times the code has changed.
LARGEST_MARGIN = 10.0


def plain_text(key: str, text: str, where: str) -> str:
    r"""Return a text of a gate on one line, its line ends and tabs replaced by a space.

    Raises
    ------
    ValueError
        If nothing is in it, or a character that would act on a terminal.

    Examples
    --------
    >>> plain_text("grounds", "Eq. 51,\n  for k = 0\n", "gate A")
    'Eq. 51, for k = 0'
    """
    line = " ".join(text.split())
    if not line or not line.isprintable():
        raise ValueError(f"{where}: {key} = {line[:80]!a} must be one sentence of printable characters")
    return line


def defects(gate: Gate) -> list[str]:
    """Return why a gate compares nothing, could not fail or could never pass, each as the end of a sentence."""
    limits = f"the limits {exact(gate.lower)} to {exact(gate.upper)}"
    elsewhere = any(gate.cases.get(name) != [value, value] for name, value in gate.reference_at.items())
    compared = [gate.rival] if elsewhere else [gate.rival, gate.reference]
    largest_uncertainty = max(gate.max_reference_uncertainty, gate.max_candidate_uncertainty or 0.0)
    worst, measured, is_en = gate.worst_measured, gate.measured_range, gate.metric == "en"
    is_within = worst is not None and gate.lower <= worst <= gate.upper
    rules = [
        (
            gate.rival is not None and gate.metric in ("en", "curve"),
            f"the metric {gate.metric} compares with no rival; state rel, abs or range-relative",
        ),
        (
            gate.candidate in compared,
            f"the candidate {gate.candidate!r} is compared with itself in the same cases, so that the gate cannot "
            "fail; name another reference or rival, or other parameters in reference_at",
        ),
        (
            not gate.lower <= gate.upper or (math.isinf(gate.lower) and math.isinf(gate.upper)),
            f"{limits} admit nothing or everything; one must be finite, and the lower one smaller",
        ),
        (
            gate.metric == "curve" and not (gate.lower == -math.inf and gate.upper > 0.0),
            f"{limits} must be -inf and a positive number: a distance has no lower limit",
        ),
        (
            is_en and (gate.max_candidate_uncertainty is None or largest_uncertainty >= 1.0),
            "the metric en needs max_candidate_uncertainty and max_reference_uncertainty below 1, relative to the "
            "reference: a candidate or a reference that states a large uncertainty would pass with any value",
        ),
        (
            (gate.basis == "measured" or measured is not None) != (worst is not None),
            "a measured basis or a measured_range, and nothing else, states its worst_measured",
        ),
        (
            worst is not None and is_within is not (gate.expected_failure is None),
            f"worst_measured = {worst} must be within {limits}, or beyond them with expected_failure",
        ),
        (
            measured is None and gate.expected_failure is not None,
            "expected_failure needs measured_range = [low, high], the errors that were measured: without it every "
            "wrong value would be accepted as the known failure",
        ),
        (
            measured is not None and worst is not None and not _contains(measured, worst),
            f"measured_range = {measured} must contain worst_measured = {worst} and reach at most "
            f"{LARGEST_MARGIN:g} times as far, or it would notice no change",
        ),
    ]
    return [sentence for is_wrong, sentence in rules if is_wrong]


def _contains(measured: tuple[float, float], worst: float) -> bool:
    low, high = measured
    return low <= worst <= high and max(abs(low), abs(high)) <= LARGEST_MARGIN * abs(worst)
