"""Checks of the contract by `check-model`: texts, finite numbers, signs, repeatability, units, limits, size.

A check that fails names a defect for the author to find; it is no verdict on how good the model is.
"""

from __future__ import annotations

from collections.abc import Iterator

from comparisons.external.data_model import DataModel
from comparisons.external.evaluations import (
    FAILED,
    OK,
    SKIPPED,
    WRONG,
    AnyExternalModel,
    Evaluations,
    Finding,
    Key,
)
from comparisons.external.limit_checks import check_calibration, check_limits
from comparisons.external.physical_model import SCALES
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.quantities import QUANTITIES

__all__ = ["examine"]

#: Shape, gradient and Tabor number of the cases that are evaluated; the first two for every quantity.
_CASES = (
    (2.0, 0.0, 1.0),
    (2.0, 0.4, 2.0),
    (2.0, 0.0, 0.1),
    (2.0, 0.0, 5.0),
    (1.0, 0.2, 0.5),
    (1.5, 0.4, 0.01),
    (5.0, 0.6, 2.0),
)
_ALL_QUANTITIES = 2

#: The most rows of a submission that are evaluated; all of them were validated when it was read.
_MOST_ROWS = 1000

#: What the error towards a limit may grow by: a model that is exact there has rounding for errors.
_STANDSTILL = 1e-6

#: Relative change on a change of units that rounding explains: scales are powers with exponents up to 2/n, of
#: logarithms up to 50, and a model's own roots are rarely better than 1e-10.
_SCALING = 1e-8


def examine(model: AnyExternalModel) -> list[Finding]:
    """Return the findings of all checks.

    Parameters
    ----------
    model : ExternalModel or DataModel
        As `comparisons.external.model_source.load_model` returns it.
    """
    evaluations = Evaluations(model)
    for key in _keys(model):
        evaluations.get(key)
    # First, because they evaluate further cases, which the other checks include.
    sizes = [*check_limits(evaluations), check_calibration(evaluations)]
    return [
        _check_texts(model),
        _check_finite(evaluations),
        _check_signs(evaluations),
        _check_repeated(evaluations),
        _check_units(evaluations),
        *sizes,
    ]


def _keys(model: AnyExternalModel) -> Iterator[Key]:
    if isinstance(model, DataModel):
        yield from (Key(*row) for row in list(model.submission.rows)[:_MOST_ROWS])
        return
    for number, case in enumerate(_CASES):
        for quantity in QUANTITIES if number < _ALL_QUANTITIES else ("pull_off_force",):
            yield Key(quantity, *case)


def _check_texts(model: AnyExternalModel) -> Finding:
    check = "has version, citation and domain"
    missing = [name for name in ("version", "citation", "domain") if not getattr(model, name).strip()]
    if missing:
        return Finding(check, WRONG, f"{', '.join(missing)} is empty, but readers cite it")
    text = f"{model.name} {model.version}; {model.citation}; {model.domain}; hashed: {model.hashed}"
    return Finding(check, OK, text)


def _check_finite(evaluations: Evaluations) -> Finding:
    check = "gives finite numbers"
    if evaluations.failures:
        key, reason = next(iter(evaluations.failures.items()))
        text = f"{len(evaluations.failures)} of {len(evaluations)} evaluations failed, the first is {key}: {reason}"
        return Finding(check, FAILED, text)
    values = len(evaluations.results)
    if not values:
        return Finding(check, FAILED, f"none of {len(evaluations)} evaluations gave a value")
    return Finding(check, OK, f"{values} values, {len(evaluations) - values} evaluations not applicable")


def _check_signs(evaluations: Evaluations) -> Finding:
    check = "keeps the sign rules"
    for key, result in evaluations.results.items():
        row = QUANTITIES[key.quantity]
        if not row.admits(result.value):
            return Finding(check, WRONG, f"{key} is {result.value:g}, but it is: {row.meaning}, {row.sign}")
    if not evaluations.results:
        return Finding(check, SKIPPED, "there is no value")
    return Finding(check, OK, f"{len(evaluations.results)} values")


def _check_repeated(evaluations: Evaluations) -> Finding:
    check = "gives the same result again"
    model = evaluations.model
    if isinstance(model, DataModel):
        return Finding(check, SKIPPED, "data do not change")
    if not evaluations.results:
        return Finding(check, SKIPPED, "there is no value")
    before = {key: result.value for key, result in evaluations.results.items()}
    # A new process and the opposite order: neither the clock, a seed nor an earlier evaluation may matter.
    model.close()
    again = Evaluations(model)
    for key in reversed(before):
        result = again.get(key)
        if result is None or result.value != before[key]:
            later = repr(result.value) if result else again.failures.get(key, "not applicable")
            return Finding(
                check,
                WRONG,
                f"{key} is {before[key]!r} the first time and {later} in a new process with the "
                "evaluations in the opposite order: a random number, a clock, or something kept between evaluations",
            )
    return Finding(check, OK, f"{len(before)} values are the same to the last bit in a new process")


def _check_units(evaluations: Evaluations) -> Finding:
    check = "does not depend on units"
    model = evaluations.model
    if isinstance(model, DataModel) or not model.physical:
        return Finding(check, SKIPPED, "it is evaluated for dimensionless problems, which have no units")
    if not evaluations.results:
        return Finding(check, SKIPPED, "there is no value")
    for key, first in evaluations.results.items():
        for scales in range(1, len(SCALES)):
            try:
                other = model.evaluate(key.problem(), key.quantity, scales=scales)
            except (NotApplicable, ComputationFailed) as error:
                return Finding(check, WRONG, f"{key} is {first.value:g} in SI units, but in others: {error}")
            allowed = _SCALING * abs(first.value) + first.u_num + other.u_num
            if abs(other.value - first.value) > allowed:
                return Finding(
                    check,
                    WRONG,
                    f"{key}, made dimensionless, is {first.value:g} in SI units and {other.value:g} "
                    "for the same problem in other units: a wrong power of a modulus, a length or a work of "
                    "adhesion, or a constant that has a unit",
                )
    return Finding(check, OK, f"{len(evaluations.results)} values in {len(SCALES)} systems of units")
