"""Rules for the entries of a gate that its schema does not express: texts, limits, compared models, selected cases."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
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


def defects(gate: Gate) -> Iterator[str]:
    """Yield why a gate compares nothing, could not fail or could never pass, each as the end of a sentence."""
    yield from _of_models(gate)
    yield from _of_limits(gate)
    yield from _of_uncertainties(gate)
    yield from _of_measurement(gate)


def _of_models(gate: Gate) -> Iterator[str]:
    if gate.rival and gate.metric in ("en", "curve"):
        yield f"the metric {gate.metric} compares with no rival; state rel, abs or range-relative"
    elsewhere = any(gate.cases.get(name) != [value, value] for name, value in gate.reference_at.items())
    same = {role for role, model in gate.models.items() if model == gate.candidate} - {"candidate"}
    for role in sorted(same - {"reference"} if elsewhere else same):
        yield (
            f"candidate and {role} are both {gate.candidate!r} in the same cases, so that the gate cannot fail; name "
            f"another {role}" + (", or other parameters in reference_at" if role == "reference" else "")
        )
    try:
        Problem.dimensionless(2.0, 0.0, 1.0).at(gate.reference_at)
    except ValueError as refusal:
        yield f"reference_at: {refusal}"


def _of_limits(gate: Gate) -> Iterator[str]:
    if not gate.lower <= gate.upper or (math.isinf(gate.lower) and math.isinf(gate.upper)):
        yield f"{_limits(gate)} admit nothing or everything; one must be finite, and the lower one smaller"
    if gate.metric == "curve" and not (gate.lower == -math.inf and gate.upper > 0.0):
        yield f"{_limits(gate)} must be -inf and a positive number: a distance has no lower limit"


def _of_uncertainties(gate: Gate) -> Iterator[str]:
    if gate.metric != "en":
        return
    if gate.max_candidate_uncertainty is None:
        yield (
            "the metric en needs max_candidate_uncertainty, relative to the reference: a candidate that states a large "
            "uncertainty would pass with any value"
        )
    for key in ("max_reference_uncertainty", "max_candidate_uncertainty"):
        if (getattr(gate, key) or 0.0) >= 1.0:
            yield (
                f"{key} = {exact(getattr(gate, key))} must be below 1 with the metric en: an uncertainty as large as "
                "the reference lets any value pass"
            )


def _of_measurement(gate: Gate) -> Iterator[str]:
    worst, measured = gate.worst_measured, gate.measured_range
    if (gate.basis == "measured" or measured is not None) != (worst is not None):
        yield "a measured basis or a measured_range, and nothing else, states its worst_measured"
    elif worst is not None and (gate.lower <= worst <= gate.upper) is not (gate.expected_failure is None):
        yield (
            f"worst_measured = {exact(worst)} must be within {_limits(gate)}, or beyond them with expected_failure: "
            "correct one of them"
        )
    if measured is None and gate.expected_failure is not None:
        yield (
            "expected_failure needs measured_range = [low, high], the errors that were measured: without it every "
            "wrong value would be accepted as the known failure"
        )
    if measured is None or worst is None:
        return
    low, high = measured
    if not low <= worst <= high or max(abs(low), abs(high)) > LARGEST_MARGIN * abs(worst):
        yield (
            f"measured_range = [{exact(low)}, {exact(high)}] must contain worst_measured = {exact(worst)} and reach at "
            f"most {LARGEST_MARGIN:g} times as far, or it would notice no change"
        )


def _limits(gate: Gate) -> str:
    return f"the limits {exact(gate.lower)} to {exact(gate.upper)}"
