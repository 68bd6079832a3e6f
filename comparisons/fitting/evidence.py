"""What speaks against the model of a fit: jumps elsewhere, residuals that follow each other, branches that differ.

Each finding is a sentence with the most likely cause and what to do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comparisons.fitting.curves import Curves
from comparisons.fitting.least_squares import Minimum
from comparisons.fitting.search import DESCRIBED, Search
from comparisons.model import Array, ComputationFailed
from comparisons.problem.units import si_text

__all__ = [
    "DISAGREES",
    "Jump",
    "branches_remark",
    "cause",
    "jump_in_remark",
    "jumps_apart",
    "of_branches",
    "runs",
    "runs_remark",
]

#: Standard deviations from which on a jump is elsewhere, or two branches differ.  The position of a jump is even over
#: the step of the record, 1.7 standard deviations to each side at most; the rest is for the error of the computed one.
DISAGREES = 5.0
#: Standard deviations by which residuals change their sign too seldom.
_SELDOM = 6.0
#: Ratio of the uncertainties without and with the jump-in from which on a value rests on it.
_RESTS = 3.0
#: Residuals over noise above which no cause in the model is likely.
_FAR_OFF = 30.0


@dataclass(frozen=True, slots=True)
class Jump:
    """A measured jump that is not where the model has it.

    Attributes
    ----------
    approach : bool
    deviations : float
        Distance from where the rest of the record puts it, in standard deviations.
    distance : float
        In m, positive nearer to the solid.
    """

    approach: bool
    deviations: float
    distance: float

    def remark(self) -> str:
        """Return what it says."""
        nearer = self.distance > 0.0
        if self.approach:
            event = "snapped together"
            why = (
                "roughness, a soft layer or a charge that repels"
                if nearer
                else "forces of longer range, as of charges, capillaries or other parts of the probe"
            )
        else:
            event = "parted"
            why = "a wrong stiffness, or a rate" if nearer else "an adhesion that grows with time or a capillary"
        side = "nearer to" if nearer else "farther from"
        far = si_text(float(f"{abs(self.distance):.2g}"), 0.0, "m")
        return (
            f"the surfaces {event} {far} {side} the solid than the rest of the record says "
            f"({self.deviations:.2g} standard deviations): the fit is without this jump; see whether there was {why}"
        )


def jumps_apart(search: Search, result: Minimum, curves: Curves) -> list[Jump]:
    """Return the jumps that disagree with the rest of a record.

    The distance of a jump from the fit becomes that from the fit without it by 1/(1 - h), its standard deviation by
    1/sqrt(1 - h), where h is its leverage.
    """
    present = _jump_residuals(search, result.numbers, curves)
    if not present or result.covariance is None:
        return []
    covariance = result.covariance / max(result.reduced, 1.0)

    def residuals(values: Mapping[str, float], curves: Curves) -> Array:
        changed = _jump_residuals(search, values, curves)
        return np.array([changed.get(approach, math.nan) for approach in present])

    rows = search.derivatives(residuals, result.numbers, curves, 1e-3)
    jumps = []
    for row, (approach, distance) in zip(rows, present.items(), strict=True):
        leverage = float(row @ covariance @ row)
        remaining = max(1.0 - leverage, 1e-6)
        deviations = abs(distance) / math.sqrt(remaining) if math.isfinite(leverage) else 0.0
        if deviations > DISAGREES:
            jumps.append(Jump(approach, deviations, distance / remaining * _step(search, approach)))
    return jumps


def jump_in_remark(search: Search, result: Minimum, without: Callable[[], Minimum]) -> str | None:
    """Say which value of an approach rests on where the surfaces snapped together: nothing else can contradict that.

    Parameters
    ----------
    search : Search
    result : Minimum
    without : callable
        Returns the minimum without that jump.
    """
    if search.baseline.has_both or True not in search.observed.jumps or True not in search.jumps:
        return None
    try:
        alone = without()
    except ComputationFailed:
        alone = None
    free = [key.name for key in search.keys if key.prior is None]
    ratios = {
        name: alone.deviations[name] / result.deviations[name] if alone and result.deviations[name] > 0.0 else math.inf
        for name in free
    }
    name = max(free, key=ratios.__getitem__)
    if ratios[name] < _RESTS:
        return None
    larger = f"{ratios[name]:.2g} times as large" if math.isfinite(ratios[name]) else "unknown"
    return (
        f"{name} rests on where the surfaces snapped together (without it u is {larger}): roughness, charges and "
        "capillaries move that place, and only a retreat can show it"
    )


def _jump_residuals(search: Search, values: Mapping[str, float], curves: Curves) -> dict[bool, float]:
    position, _ = search.zeros(values)
    return search.jump_residuals(search.machine(values, curves), position, curves.model)


def _step(search: Search, approach: bool) -> float:
    """Standard deviation of the position of a jump in m."""
    before, after = search.observed.jumps[approach]
    return abs(float(np.diff(search.observed.record.position[[before, after]])[0])) / math.sqrt(12.0)


def runs(errors: Array) -> float:
    """Return by how many standard deviations the signs of residuals change more often than by chance.

    Examples
    --------
    >>> round(runs(np.array([1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0])), 2)
    -2.29
    """
    signs = errors[errors != 0.0] > 0.0
    count, positive = len(signs), int(signs.sum())
    negative = count - positive
    if min(positive, negative) < 2:
        return 0.0
    expected = 1.0 + 2.0 * positive * negative / count
    variance = (expected - 1.0) * (expected - 2.0) / (count - 1.0)
    return float((1 + np.count_nonzero(np.diff(signs.astype(int))) - expected) / math.sqrt(variance))


def runs_remark(errors: Array, approach: NDArray[np.bool_], least: float) -> str | None:
    """Say where residuals of a branch follow each other; None where they do not, or are below a least size."""
    for name, branch in (("approach", approach), ("retreat", ~approach)):
        of_branch = errors[branch]
        if len(of_branch) < 2 or float(np.sqrt(np.mean(of_branch**2))) < least:
            continue
        if runs(of_branch) < -_SELDOM:
            return (
                f"the residuals of the {name} keep their sign over many points ({-runs(of_branch):.2g} standard "
                "deviations): u holds for independent noise; fit every tenth point, and see whether the model misses "
                "something"
            )
    return None


def of_branches(
    fits: Mapping[str, Callable[[], tuple[Minimum, Search]]],
) -> dict[str, dict[str, tuple[float, float]]]:
    """Return values and standard deviations of the free keys by each branch alone, where it determines them."""
    values: dict[str, dict[str, tuple[float, float]]] = {}
    for branch, fitted in fits.items():
        try:
            result, search = fitted()
        except (ComputationFailed, ValueError):
            continue
        of_branch = {}
        for key in search.keys:
            value, deviation = key.value(result.numbers[key.name]), result.deviations[key.name]
            if math.isfinite(deviation) and key.prior is None:
                of_branch[key.name] = value, key.uncertainty(value, deviation)
        values[branch] = of_branch
    return values


def branches_remark(values: Mapping[str, Mapping[str, tuple[float, float]]], units: Mapping[str, str]) -> str | None:
    """Say where both branches give values that differ."""
    if len(values) < 2:
        return None
    approach, retreat = values["approach"], values["retreat"]
    for name in approach.keys() & retreat.keys():
        (a, u), (b, v) = approach[name], retreat[name]
        if abs(a - b) > DISAGREES * math.hypot(u, v):
            texts = [si_text(*pair, units[name]) for pair in (approach[name], retreat[name])]
            return (
                f"the approach alone gives {name} = {texts[0]}, the retreat alone {texts[1]}: see whether the solid "
                "creeps or flows, or the machine drifts"
            )
    return None


def cause(result: Minimum, ratio: float, wide: bool, remarks: Sequence[str], held: Sequence[str] = ()) -> str | None:
    """Return the most likely cause where the model does not describe a record, and what to do.

    Parameters
    ----------
    result : Minimum
    ratio : float
        Of residuals and noise.
    wide : bool
        Whether the contact is.
    remarks : sequence of str
        On the record and its branches.
    held : sequence of str
        Keys of a usual fit that are not free.
    """
    if result.reduced < DESCRIBED:
        return None
    return "the model does not describe the curve with these values: " + _likely(ratio, wide, remarks, held)


def _likely(ratio: float, wide: bool, remarks: Sequence[str], held: Sequence[str]) -> str:
    if held:
        return f"{held[0]} is held at the value of the file, and may be another: put it behind --free, too"
    if ratio > _FAR_OFF:
        return (
            "no values near those of the file describe the curve: check radius, stiffness and units, and begin nearer "
            "to the true values"
        )
    if any("alone" in remark for remark in remarks):
        return "the two branches differ more than a state of equilibrium allows: fit one of them with --branch"
    if wide:
        return "the contact is wide: fit loads of less than a third of the radius, or take punch.kind = 'ball'"
    return "another shape, a gradient of the solid or another law may describe the curve"
