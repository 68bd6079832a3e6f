"""Jumps of a cycle of prescribed displacement on paths with several stable branches."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fscm import Analysis, EquilibriumPath, displacement_cycle
from fscm._arc_length import Point
from fscm._jumps import Branch, jumps_between
from fscm.errors import NotConverged
from fscm.stability import margins
from tests.fscm.solved_once import stiff_on_soft

#: Displacements at jump-in and at both folds of the retreat of the film below, in nm; from its traced path.
FILM_JUMPS = [-9.0557, -122.2588, -135.4293]
#: Loss in the first jump of the retreat, in pi R w z0, by the finite elements (`tests/fem_reference/test_jumps.py`).
LOSS_OF_FILM = 0.46289


def _bracket(name: str) -> tuple[Point, Point]:
    """A stand-in that is only handed on."""
    return name  # type: ignore[return-value]


def _branches(*spans: tuple[float, float]) -> list[Branch]:
    branches = []
    for i, (least, largest) in enumerate(spans):
        low = None if least == -math.inf else _bracket(f"low {i}")
        high = None if largest == math.inf else _bracket(f"high {i}")
        branches.append(Branch(low, high, least, largest))
    return branches


@pytest.mark.parametrize(
    ("spans", "approach", "retreat"),
    [
        ([(-math.inf, 1.0), (0.0, math.inf)], [("high 0", 1)], [("low 1", 0)]),
        # The last minimum is not the lowest: two jumps of the retreat, one of the approach.
        ([(-math.inf, 9.0), (0.0, 3.0), (2.0, math.inf)], [("high 0", 2)], [("low 2", 1), ("low 1", 0)]),
        # The last minimum is the lowest: the branch in the middle is not met on retreat.
        ([(-math.inf, 3.0), (2.0, 9.0), (0.0, math.inf)], [("high 0", 1), ("high 1", 2)], [("low 2", 0)]),
        # Two asperities that jump one after the other both ways.
        ([(-math.inf, 1.0), (0.0, 7.0), (6.0, math.inf)], [("high 0", 1), ("high 1", 2)], [("low 2", 1), ("low 1", 0)]),
        # The branch in the middle is above the first jump and below the second: neither lands there.
        ([(-math.inf, 1.0), (2.0, 3.0), (0.0, math.inf)], [("high 0", 2)], [("low 2", 0)]),
    ],
)
def test_each_jump_lands_on_the_next_branch_with_its_displacement(
    spans: list[tuple[float, float]], approach: list[tuple[str, int]], retreat: list[tuple[str, int]]
) -> None:
    branches = _branches(*spans)
    for inward, expected in ((True, approach), (False, retreat)):
        jumps = [(fold, branches.index(branch)) for fold, branch in jumps_between(branches, inward)]
        assert jumps == expected


def test_a_jump_without_a_branch_to_land_on_is_told() -> None:
    with pytest.raises(NotConverged, match=r"displacement 9, at which a jump-in begins"):
        jumps_between(_branches((-math.inf, 9.0), (0.0, 3.0)), inward=True)


@pytest.fixture(scope="module")
def film() -> Analysis:
    """A sphere on a stiff film on a soft solid: the film alone jumps out of contact before the solid below does."""
    return stiff_on_soft()[0]


def test_a_film_jumps_twice_on_retreat(film: Analysis) -> None:
    jumps = [*film.jumps("jump_in"), *film.jumps("jump_out")]
    assert [len(film.jumps(name)) for name in ("jump_in", "jump_out")] == [1, 2]
    assert [0.4 * fold.value.displacement for fold, _ in jumps] == pytest.approx(FILM_JUMPS, abs=1e-4)
    assert film.solution("jump_out_displacement").value == jumps[-1][0].value.displacement
    for fold, landing in jumps:
        assert landing.value.displacement == pytest.approx(fold.value.displacement, abs=1e-9)
        assert margins(landing.value, 0)[0] > 0.0
        assert fold.value.energy > landing.value.energy


def test_the_hysteresis_of_a_film_is_what_its_three_jumps_lose(film: Analysis) -> None:
    jumps = [*film.jumps("jump_in"), *film.jumps("jump_out")]
    losses = [fold.value.energy - landing.value.energy for fold, landing in jumps]
    energy = film.solution("hysteresis_energy")
    assert energy.value == pytest.approx(sum(losses), rel=1e-12)
    assert losses[1] == pytest.approx(LOSS_OF_FILM, rel=1e-3)
    assert 0.0 < energy.u_num < 1e-7 * energy.value


@pytest.mark.parametrize(
    ("held", "retreat"), [([True, False, False, False, False, True], [-2.5]), ([], [-2.5, -3.0])], ids=["marks", "none"]
)
def test_a_recorded_jump_passes_over_what_cannot_be_held(held: list[bool], retreat: list[float]) -> None:
    """Of a part between two folds that is unstable twice the displacement rises, too."""
    displacement = np.array([-9.0, 0.0, -3.0, -1.0, -2.5, 1.0])
    blank, marks = np.zeros(6), np.array(held, bool)
    cycle = displacement_cycle(
        EquilibriumPath(blank, displacement, np.arange(6.0), blank, blank, 0.0, 0.0, (), marks, marks)
    )
    jumps = np.flatnonzero(np.diff(cycle.unloading[0]) == 0.0)
    assert cycle.unloading[0, jumps].tolist() == retreat
    assert cycle.jump_in is not None
    assert cycle.jump_out is not None
    assert cycle.jump_in[0].tolist() == [0.0, 0.0]
    assert cycle.jump_out[0, 0] == retreat[-1]
