"""Random problems of every kind of solid, punch and law of a problem file, by both references.

Each value at the default accuracy is compared with that at 1e-10 on a mesh that ends farther out, because the same end
would be the same tail, and with that of the finite elements.  A problem is drawn from its number, which is its seed and
which every failure names; the kinds take turns, so that all occur with all in a run of numbers.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.problem.kinds import KINDS
from fscm.accuracy import Meshes
from tests.random_kinds import LAWS, PUNCHES, between
from tests.random_solids import SOLIDS

SEED, COUNT = 20261128, 1000
#: Numbers of a test, and the share of their computations that may be refused or not converge: both references state
#: the problems that they do not take, and a refusal is no wrong value.
CHUNK, REFUSED = 20, 0.25
#: The Tabor number of a sphere as blunt as the punch on the softest part of the solid.
TABOR = 0.05, 10.0
#: A kind of law whose attraction is so slow that radii far beyond the contact move it, and one that `fscm` alone has.
SLOW, OF_FSCM = "slow mie", "smoothed table"
#: How much farther out, as a ratio of the radii, the accurate mesh ends; largest height there.
FARTHER, HIGHEST = 30.0, 1e30
#: The load integral converges for m g > 2; closer to it than this the load beyond any mesh is the load.
CONVERGENT = 2.05
#: Rounding of the accurate values, relative: the scatter between orders 16 to 24.
ROUNDING = 1e-14
QUANTITIES = tuple(name for name in fscm.QUANTITIES if name != "critical_tabor_number")
#: Numbers of the light tests, and what they are compared with.
LIGHT = ((6, "1e-10"), (21, "fem"), (2, "fem"))


class Kinds(NamedTuple):
    """Kinds of the three parts of a problem."""

    solid: str
    punch: str
    law: str


def kinds(number: int) -> Kinds:
    """The kinds of a number: each takes its turn, and every combination has its own among the first numbers."""
    names = [*SOLIDS], [*PUNCHES], [*LAWS, SLOW]
    order = np.random.default_rng(SEED).permutation(math.prod(map(len, names)))
    indices = np.unravel_index(order[number % len(order)], [len(of_part) for of_part in names])
    return Kinds(*(of_part[int(index)] for of_part, index in zip(names, indices, strict=True)))


def slow_mie(package: ModuleType, rng: np.random.Generator) -> Any:
    """A law with an attraction exponent near 1, where the work of adhesion would be infinite."""
    n = 1.0 + between(rng, 0.02, 0.5)
    return package.Mie(1.0, 1.0, n + between(rng, 0.5, 9.0), n)


def random_problem(package: ModuleType, number: int, drawn: Kinds | None = None) -> Any:
    """The problem of a number, by the classes of a package; of other kinds if they are stated."""
    drawn = drawn or kinds(number)
    rng = np.random.default_rng([SEED, number])
    mu = between(rng, *TABOR)
    punch, size = PUNCHES[drawn.punch](package, rng)
    make_law = slow_mie if drawn.law == SLOW else LAWS[drawn.law]
    law = make_law(package, rng)
    growth = _growth(number, drawn)
    while law.decay[1] * growth < CONVERGENT:
        law = package.Mie(1.0, 1.0, law.m + 1.0, law.n + 0.5) if drawn.law in (SLOW, "mie") else make_law(package, rng)
    modulus = math.sqrt(size * law.work_of_adhesion**2 / mu**3)
    # Of the contact at zero load of a sphere on a homogeneous solid.
    length = max(1.0, (size * size * law.work_of_adhesion / modulus) ** (1.0 / 3.0), math.sqrt(size))
    return package.Problem(SOLIDS[drawn.solid](package, rng, modulus, length), punch, law)


def _growth(number: int, drawn: Kinds) -> float:
    """Growth of the punch of a number, which the finite elements do not ask for."""
    rng = np.random.default_rng([SEED, number])
    between(rng, *TABOR)
    return float(PUNCHES[drawn.punch](fscm, rng)[0].growth)


class Comparison(NamedTuple):
    """A value, its bound, and its distance to another one in units of the sum of both bounds."""

    number: int
    quantity: str
    other: str
    value: float
    u_num: float
    ratio: float


def accurate(problem: fscm.Problem) -> Meshes:
    """Meshes of the accuracy 1e-10 that end farther out."""
    height = min(Meshes.end_height * FARTHER**problem.punch.growth, HIGHEST)
    return replace(Meshes.of(1e-10), end_height=height)


def compared(
    number: int, others: Sequence[str] = ("1e-10", "fem"), quantities: Sequence[str] = QUANTITIES
) -> Iterator[Comparison | str]:
    """Comparisons of the quantities of a number with other values of them, and what either reference refuses.

    A value of one where the other has no such event is infinitely far from it.
    """
    problem = random_problem(fscm, number)
    values = _solved(fscm, problem, quantities, "default")
    if isinstance(values, str):
        yield values
        return
    for other in others:
        if other == "fem" and kinds(number).law == OF_FSCM:
            continue
        if other == "fem":
            solutions = _solved(fem_reference, random_problem(fem_reference, number), quantities, "quick")
        else:
            solutions = _solved(fscm, problem, quantities, accurate(problem))
        if isinstance(solutions, str):
            yield solutions
        else:
            yield from (_compared(number, name, other, values[name], solutions[name]) for name in quantities)


def _compared(number: int, name: str, other: str, value: Any, reference: Any) -> Comparison:
    missing = [isinstance(solution, Exception) for solution in (value, reference)]
    if any(missing):
        return Comparison(number, name, other, math.nan, math.nan, 0.0 if all(missing) else math.inf)
    bounds = value.u_num + reference.u_num + ROUNDING * abs(reference.value)
    return Comparison(number, name, other, value.value, value.u_num, abs(value.value - reference.value) / bounds)


def _solved(package: ModuleType, problem: Any, quantities: Sequence[str], accuracy: Any) -> dict[str, Any] | str:
    """Solutions, or why there are none; one that misses its accuracy has a bound all the same."""
    try:
        with warnings.catch_warnings(action="ignore", category=fscm.AccuracyWarning):
            return dict(package.solve_together(problem, quantities, accuracy))
    except (package.NotConverged, ValueError) as error:
        return f"{package.__name__}: {error}"


def test_every_kind_of_a_problem_file_is_drawn() -> None:
    """A new kind needs a generator in `tests/random_kinds.py` or `tests/random_solids.py`."""
    drawn = [kinds(number) for number in range(COUNT)]
    for section in Kinds._fields:
        assert set(KINDS[section]) <= {getattr(of_number, section) for of_number in drawn}


def test_both_packages_draw_the_same_problem() -> None:
    radii = np.array([0.5, 3.0])
    for number in (number for number in range(12) if kinds(number).law != OF_FSCM):
        integral, elements = (random_problem(package, number) for package in (fscm, fem_reference))
        assert integral.punch.height(radii) == pytest.approx(elements.punch.height(radii), rel=1e-12)
        assert integral.law.traction(radii) == pytest.approx(elements.law.traction(radii), rel=1e-6)
        assert integral.solid.modulus(radii) == pytest.approx(elements.solid.modulus(radii), rel=1e-12)


@pytest.mark.parametrize(("number", "other"), LIGHT)
def test_forces_and_displacements_at_pull_off(number: int, other: str) -> None:
    comparisons = list(compared(number, (other,), ("pull_off_force", "pull_off_displacement")))
    assert [row for row in comparisons if isinstance(row, str) or row.ratio > 1.0] == []


@pytest.mark.heavy
@pytest.mark.parametrize("start", range(0, COUNT, CHUNK))
def test_no_value_is_outside_its_bound(start: int) -> None:
    """All quantities against the accurate mesh and against the finite elements; few are refused."""
    comparisons, refused = [], []
    for number in range(start, start + CHUNK):
        for row in compared(number):
            (refused if isinstance(row, str) else comparisons).append(row)
    assert [row for row in comparisons if row.ratio > 1.0] == []
    assert len(refused) <= REFUSED * 2 * CHUNK, refused
