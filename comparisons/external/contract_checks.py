"""Checks of the contract by `check-model`: texts, finite numbers, signs, repeatability, limits, size.

A check that fails names a defect for the author to find; it is no verdict on how good the model is.  The tolerances of
limits and size are wide: they find a missing pi, a sign, a swapped pair of arguments or a wrong unit.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

from comparisons.external.data_model import DataModel
from comparisons.external.model_source import AnyExternalModel
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.models.bradley import Bradley
from comparisons.models.jkr import JKR
from comparisons.problem import Problem
from comparisons.quantities import QUANTITIES

#: A quantity in a case, and what its evaluation gave.
_Key = tuple[str, Problem]
_Outcomes = dict[_Key, Result | NotApplicable | ComputationFailed]

#: Statuses of findings: the rule is kept or broken, could not be computed, or was not checked.
OK, WRONG, FAILED, SKIPPED = "ok", "wrong", "failed", "not checked"

_FORCE = "pull_off_force"

#: Accurate pull-off forces of the full self-consistent model by n, k and mu, all digits shown believed correct.
_CALIBRATION = {(2.0, 0.0, 0.1): 1.96895638, (2.0, 0.0, 2.0): 1.58359530, (2.0, 0.4, 1.0): 1.78848171}
#: JKR is wrong by a factor of 1.313 in the first of them, Bradley by 1.263 in the second; pi, 2 and 3/2
#: are beyond.
_CALIBRATION_FACTOR = 1.4

#: Shape, gradient and Tabor number of the other cases that are evaluated; the first two for every quantity.
_CASES = (
    *((2.0, 0.0, 1.0), (2.0, 0.4, 2.0), (2.0, 0.0, 5.0)),
    *((1.0, 0.2, 0.5), (1.5, 0.4, 0.01), (5.0, 0.6, 2.0)),
)
_ALL_QUANTITIES = 2

#: Name of the limit in `limits` of a model -> its name in a sentence, its model, Tabor numbers towards it.
_LIMITS = {
    "rigid": ("Bradley, mu -> 0", Bradley(), (0.1, 0.01, 0.001)),
    "jkr": ("JKR, mu -> infinity", JKR(), (2.0, 5.0, 10.0, 30.0, 100.0)),
}
_LIMIT_CASES = ((2.0, 0.0), (2.0, 0.4), (1.0, 0.2), (5.0, 0.6))
#: The approach to a limit is a power of mu that differs between models; at the ends of the lists above those
#: known here (double-Hertz, Maugis-Dugdale) are within 1 %.
_LIMIT_TOLERANCE = 0.05
#: Admissible growth of the error towards a limit: a model that is exact there has only rounding errors.
_STANDSTILL = 1e-6

#: The most rows of a submission that are evaluated; all of them were validated when it was read.
_MOST_ROWS = 1000


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check: the rule, one of the statuses above, and the reason or the extent of the check."""

    check: str
    status: str
    text: str


def examine(model: AnyExternalModel) -> list[Finding]:
    """Return the findings of all checks.

    Parameters
    ----------
    model : ExternalModel or DataModel
        As `comparisons.external.model_source.load_model` returns it.
    """
    outcomes = _evaluated(model, _keys(model))
    results = {key: outcome for key, outcome in outcomes.items() if isinstance(outcome, Result)}
    findings = [
        Finding("has version, citation and domain", *_texts(model)),
        Finding("gives finite numbers", *_finite(outcomes, len(results))),
        Finding("keeps the sign rules", *_signs(results)),
        Finding("gives the same result again", *_repeated(model, results)),
    ]
    for limit in model.limits:
        findings.append(Finding(f"is right in the limit {limit}", *_in_limit(results, limit)))
    return [*findings, Finding("is of the right size", *_size(results))]


def _keys(model: AnyExternalModel) -> list[_Key]:
    if isinstance(model, DataModel):
        return list(islice(model.rows, _MOST_ROWS))
    keys = [_key(*case, quantity) for case in _CASES[:_ALL_QUANTITIES] for quantity in QUANTITIES]
    keys += [_key(*case) for case in (*_CASES, *_CALIBRATION)]
    towards = [_LIMITS[limit][-1] for limit in model.limits if limit in _LIMITS]
    return keys + [_key(*case, mu) for numbers in towards for case in _LIMIT_CASES for mu in numbers]


def _key(n: float, k: float, mu: float, quantity: str = _FORCE) -> _Key:
    return quantity, Problem.dimensionless(n, k, mu)


def _label(key: _Key) -> str:
    return f"{key[0]} at {key[1].label}"


def _evaluated(model: AnyExternalModel, keys: Iterable[_Key]) -> _Outcomes:
    outcomes: _Outcomes = {}
    for quantity, problem in dict.fromkeys(keys):
        try:
            outcomes[quantity, problem] = model.evaluate(problem, quantity)
        except (NotApplicable, ComputationFailed) as refusal:
            outcomes[quantity, problem] = refusal
    return outcomes


def _texts(model: AnyExternalModel) -> tuple[str, str]:
    if missing := [name for name in ("version", "citation", "domain") if not getattr(model, name).strip()]:
        return WRONG, f"{', '.join(missing)} is empty, but readers cite it"
    return OK, f"{model.name} {model.version}; {model.citation}; {model.domain}; hashed: {model.hashed}"


def _finite(outcomes: _Outcomes, values: int) -> tuple[str, str]:
    if failures := [(key, error) for key, error in outcomes.items() if isinstance(error, ComputationFailed)]:
        key, reason = failures[0]
        return FAILED, f"{len(failures)} of {len(outcomes)} evaluations failed, the first is {_label(key)}: {reason}"
    if not values:
        return FAILED, f"none of {len(outcomes)} evaluations gave a value"
    return OK, f"{values} values, {len(outcomes) - values} evaluations not applicable"


def _signs(results: dict[_Key, Result]) -> tuple[str, str]:
    for key, result in results.items():
        quantity = QUANTITIES[key[0]]
        if not quantity.admits(result.value):
            return WRONG, f"{_label(key)} is {result.value:g}, but it is: {quantity.meaning}, {quantity.sign}"
    return _kept(results, "values")


def _repeated(model: AnyExternalModel, results: dict[_Key, Result]) -> tuple[str, str]:
    if isinstance(model, DataModel):
        return SKIPPED, "data do not change"
    # A new process and the opposite order: neither the clock, a seed nor an earlier evaluation may matter.
    model.close()
    for key, again in _evaluated(model, reversed(results)).items():
        value = again.value if isinstance(again, Result) else again
        if value != results[key].value:
            return WRONG, (
                f"{_label(key)} is {results[key].value!r} the first time and {value} in a new process with the "
                "evaluations in the opposite order: a random number, a clock, or something kept between evaluations"
            )
    return _kept(results, "values are the same to the last bit in a new process")


def _kept(results: dict[_Key, Result], text: str) -> tuple[str, str]:
    return (OK, f"{len(results)} {text}") if results else (SKIPPED, "there is no value")


def _in_limit(results: dict[_Key, Result], name: str) -> tuple[str, str]:
    """Compare the pull-off force with a limit that the author states: it must come nearer, and near at last."""
    if name not in _LIMITS:
        return WRONG, f"no such limit is known; known are {', '.join(_LIMITS)}"
    limit, exact, tabor_numbers = _LIMITS[name]
    parts = []
    for n, k in _LIMIT_CASES:
        force = exact.evaluate(Problem.dimensionless(n, k, 1.0), _FORCE).value
        keys = [(mu, _key(n, k, mu)) for mu in tabor_numbers]
        errors = [(mu, results[key].value / force - 1.0) for mu, key in keys if key in results]
        if not errors:
            continue
        (farthest_mu, farthest), (nearest_mu, nearest) = errors[0], errors[-1]
        if abs(nearest) > _LIMIT_TOLERANCE or abs(nearest) > abs(farthest) + _STANDSTILL:
            return WRONG, (
                f"the pull-off force at n = {n:g}, k = {k:g} is {100.0 * farthest:.3g} % off {limit} at "
                f"mu = {farthest_mu:g} and {100.0 * nearest:.3g} % at mu = {nearest_mu:g}: it must come nearer, to "
                f"{100.0 * _LIMIT_TOLERANCE:g} % at least"
            )
        parts.append(f"{100.0 * nearest:.3g} % at n = {n:g}, k = {k:g}, mu = {nearest_mu:g}")
    return (OK, f"off {limit} by {'; '.join(parts)}") if parts else (SKIPPED, f"it has no value towards {limit}")


def _size(results: dict[_Key, Result]) -> tuple[str, str]:
    """Compare the pull-off force with three accurate values, to a factor of 1.4."""
    forces = {_key(*case): force for case, force in _CALIBRATION.items()}
    ratios = [(results[key].value / force, key) for key, force in forces.items() if key in results]
    if not ratios:
        return SKIPPED, "it has none of the three calibration values"
    worst, key = max(ratios, key=lambda pair: max(pair[0], 1.0 / pair[0]) if pair[0] > 0.0 else math.inf)
    text = f"{_label(key)} is {worst:.3g} times the accurate one"
    if 1.0 / _CALIBRATION_FACTOR <= worst <= _CALIBRATION_FACTOR:
        return OK, f"the model has {len(ratios)} of 3 calibration values; at worst {text}"
    return WRONG, f"{text}; it is the positive number -min P, in the unit {QUANTITIES[_FORCE].unit}"
