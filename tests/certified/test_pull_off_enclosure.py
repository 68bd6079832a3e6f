"""Certified pull-off forces: the proof, its failures on purpose, and the value of the solver."""

from dataclasses import replace

import pytest
from flint import arb, ctx, fmpq

from fscm import Problem, solve
from tests.certified.approximate_states import ApproximateStates, approximate_states
from tests.certified.panel_bounds import NotProved, PanelBounds, panel_bounds
from tests.certified.pull_off_enclosure import CERTIFIED, minimum, pull_off_enclosure
from tests.certified.sphere_form import SphereForm
from tests.certified.state_bounds import enclose
from tests.marks import heavy

# A small case: proved to 9 digits in a second.
FORM, COUNT, ETA = SphereForm(fmpq(1, 10), 5, 120), 60, 1e-3
PULL_OFF = -0.058632631557597
TUBE = arb(1e-8)


@pytest.fixture(scope="module")
def states() -> ApproximateStates:
    return approximate_states(FORM, PULL_OFF)


@pytest.fixture(scope="module")
def bounds(states: ApproximateStates) -> list[PanelBounds]:
    return panel_bounds(states, COUNT)


def changed(series: list[arb], index: int, by: float) -> list[arb]:
    return [x + arb(by) if order == index else x for order, x in enumerate(series)]


@pytest.mark.parametrize("certified", CERTIFIED.values(), ids=CERTIFIED)
def test_the_solver_is_inside_its_bound_of_the_certified_value(certified):
    for quantity, text in (("pull_off_force", certified.force), ("pull_off_displacement", certified.displacement)):
        solution = solve(Problem(2, 0, float(certified.form.mu)), quantity)
        assert arb(text).overlaps(arb(solution.value, solution.u_num))
    assert arb(certified.force).rad() < 1e-10


@pytest.mark.heavy
@pytest.mark.parametrize("name", CERTIFIED)
def test_a_certified_value_is_proved_again(name):
    enclosure = pull_off_enclosure(CERTIFIED[name])
    with ctx.workprec(200):
        assert arb(CERTIFIED[name].force).contains(enclosure.force)
        assert arb(CERTIFIED[name].displacement).contains(enclosure.displacement)
    assert enclosure.curvature > 0


def test_the_interval_contains_the_states_inside_it_and_is_not_loose(states, bounds):
    """Load and derivatives of a state near the end of the interval; W against the polynomial in delta at points."""
    interval = enclose(states, bounds, arb(ETA), arb(1e-5))
    inside = approximate_states(FORM, states.delta + 0.9 * ETA)
    point = enclose(inside, panel_bounds(inside, COUNT), arb(0), TUBE)
    for name in ("load", "first", "second"):
        assert getattr(interval, name).contains(getattr(point, name))
    with ctx.workprec(200):
        t = arb(inside.delta) - arb(states.delta)
        series = zip(inside.traction, states.traction, states.first, states.second, strict=True)
        difference = FORM.deformed([new - a - t * b - t * t * c / 2 for new, a, b, c in series])
        values = [
            abs(sum((a * (arb(j) / 5).legendre_p(order) for order, a in enumerate(difference)), arb(0))).upper()
            for j in range(-5, 6)
        ]
    # Measured: 0.03 of the bound.
    assert interval.distance / 70 < max(values) < interval.distance


def test_a_bad_approximation_widens_the_ball_but_does_not_move_it_off_the_value(states, bounds):
    # A smaller degree proves fewer digits of the same value.
    lowest = minimum(states, bounds, ETA)
    assert lowest.force.overlaps(arb(CERTIFIED["mu = 1/10"].force))
    assert 1e-11 < lowest.force.rad() < 1e-9
    good = enclose(states, bounds, arb(0), TUBE)
    first, second = changed(states.first, 7, 1e-6), changed(states.second, 5, 1e-6)
    rough = replace(states, traction=changed(states.traction, 3, 1e-9), first=first, second=second)
    wide = enclose(rough, panel_bounds(rough, COUNT), arb(0), TUBE)
    for name in ("load", "first", "second"):
        assert getattr(wide, name).contains(getattr(good, name))
        assert getattr(wide, name).rad() > 3 * getattr(good, name).rad()


WRONG = {
    "far traction": lambda s: {"far": s.far * 1.01},
    "first derivative": lambda s: {"first": changed(s.first, 3, 1e-2)},
    "second derivative": lambda s: {"second": changed(s.second, 3, 10.0)},
    "compliance": lambda s: {"form": replace(FORM, mu=fmpq(10001, 100000))},
    "a state beside the pull-off": lambda s: vars(approximate_states(FORM, -0.1)),
    "length of the projection": lambda s: {"form": replace(FORM, length=6)},
    "a negative comparison function": lambda s: {"comparison": (s.comparison[0], [-x for x in s.comparison[1]])},
    "a comparison function that is too small near the centre": lambda s: {"comparison": (s.comparison[0], s.traction)},
}


# The defect that shows a wrong traction shows these as well.
ALIKE = ("compliance", "length of the projection")


@pytest.mark.parametrize("name", [*(name for name in WRONG if name not in ALIKE), *heavy(*ALIKE)])
def test_a_wrong_number_is_not_proved(states, name):
    wrong = replace(states, **WRONG[name](states))
    with pytest.raises(NotProved):
        minimum(wrong, panel_bounds(wrong, COUNT), ETA)


@pytest.mark.parametrize(("tube", "reason"), [(1e-16, "leave the tube"), (0.2, "not positive in the whole tube")])
def test_the_tube_must_fit(states, bounds, tube, reason):
    with pytest.raises(NotProved, match=reason):
        enclose(states, bounds, arb(0), arb(tube))
