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
    label,
)
from comparisons.external.limit_checks import check_calibration, check_limits
from comparisons.external.physical_model import SCALES
from comparisons.model import ComputationFailed, NotApplicable
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES

__all__ = ["examine"]

#: Shape, gradient and Tabor number of the cases that are evaluated; the first two for every quantity.
_CASES = (
    *((2.0, 0.0, 1.0), (2.0, 0.4, 2.0), (2.0, 0.0, 0.1), (2.0, 0.0, 5.0)),
    *((1.0, 0.2, 0.5), (1.5, 0.4, 0.01), (5.0, 0.6, 2.0)),
)
_ALL_QUANTITIES = 2

#: The most rows of a submission that are evaluated; all of them were validated when it was read.
_MOST_ROWS = 1000

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
    done = Evaluations(model)
    for key in _keys(model):
        done.get(key)
    # First, because they evaluate further cases, which the other checks include.
    sizes = [*check_limits(done), check_calibration(done)]
    checks = {
        "has version, citation and domain": _texts,
        "gives finite numbers": _finite,
        "keeps the sign rules": _signs,
        "gives the same result again": _repeated,
        "does not depend on units": _units,
    }
    return [*(Finding(name, *check(done)) for name, check in checks.items()), *sizes]


def _keys(model: AnyExternalModel) -> Iterator[Key]:
    if isinstance(model, DataModel):
        yield from ((quantity, Problem.dimensionless(*case)) for quantity, *case in list(model.rows)[:_MOST_ROWS])
        return
    for number, case in enumerate(_CASES):
        for quantity in QUANTITIES if number < _ALL_QUANTITIES else ("pull_off_force",):
            yield quantity, Problem.dimensionless(*case)


def _texts(done: Evaluations) -> tuple[str, str]:
    model = done.model
    if missing := [name for name in ("version", "citation", "domain") if not getattr(model, name).strip()]:
        return WRONG, f"{', '.join(missing)} is empty, but readers cite it"
    return OK, f"{model.name} {model.version}; {model.citation}; {model.domain}; hashed: {model.hashed}"


def _finite(done: Evaluations) -> tuple[str, str]:
    values, evaluated = len(done.results), len(done.outcomes)
    failures = {key: error for key, error in done.outcomes.items() if isinstance(error, ComputationFailed)}
    for key, reason in failures.items():
        return FAILED, f"{len(failures)} of {evaluated} evaluations failed, the first is {label(key)}: {reason}"
    if not values:
        return FAILED, f"none of {evaluated} evaluations gave a value"
    return OK, f"{values} values, {evaluated - values} evaluations not applicable"


def _signs(done: Evaluations) -> tuple[str, str]:
    for key, result in done.results.items():
        row = QUANTITIES[key[0]]
        if not row.admits(result.value):
            return WRONG, f"{label(key)} is {result.value:g}, but it is: {row.meaning}, {row.sign}"
    return _kept(done, "values")


def _repeated(done: Evaluations) -> tuple[str, str]:
    if isinstance(done.model, DataModel):
        return SKIPPED, "data do not change"
    # A new process and the opposite order: neither the clock, a seed nor an earlier evaluation may matter.
    done.model.close()
    again = Evaluations(done.model)
    for key, before in reversed(done.results.items()):
        result = again.get(key)
        if result is None or result.value != before.value:
            later = result.value if result else again.outcomes[key]
            return WRONG, (
                f"{label(key)} is {before.value!r} the first time and {later} in a new process with the "
                "evaluations in the opposite order: a random number, a clock, or something kept between evaluations"
            )
    return _kept(done, "values are the same to the last bit in a new process")


def _units(done: Evaluations) -> tuple[str, str]:
    model = done.model
    if isinstance(model, DataModel) or not model.physical:
        return SKIPPED, "it is evaluated for dimensionless problems, which have no units"
    for key, in_si in done.results.items():
        for scales in range(1, len(SCALES)):
            try:
                scaled = model.evaluate(key[1], key[0], scales=scales)
            except (NotApplicable, ComputationFailed) as error:
                return WRONG, f"{label(key)} is {in_si.value:g} in SI units, but in others: {error}"
            if abs(scaled.value - in_si.value) > _SCALING * abs(in_si.value) + in_si.u_num + scaled.u_num:
                return WRONG, (
                    f"{label(key)}, made dimensionless, is {in_si.value:g} in SI units and {scaled.value:g} "
                    "for the same problem in other units: a wrong power of a modulus, a length or a work of "
                    "adhesion, or a constant that has a unit"
                )
    return _kept(done, f"values in {len(SCALES)} systems of units")


def _kept(done: Evaluations, text: str) -> tuple[str, str]:
    return (OK, f"{len(done.results)} {text}") if done.results else (SKIPPED, "there is no value")
