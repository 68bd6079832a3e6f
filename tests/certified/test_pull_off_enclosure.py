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

# A small case: proved to 9 digits in a few seconds.
FORM, COUNT, ETA = SphereForm(fmpq(1, 10), 5, 120), 60, 1e-3
TUBE = arb(1e-8)


@pytest.fixture(scope="module")
def states() -> ApproximateStates:
    return approximate_states(FORM)


@pytest.fixture(scope="module")
def bounds(states: ApproximateStates) -> list[PanelBounds]:
    return panel_bounds(states, COUNT)


def changed(series: list[arb], index: int, by: float) -> list[arb]:
    return [x + arb(by) if order == index else x for order, x in enumerate(series)]


@pytest.mark.parametrize("name", CERTIFIED)
def test_the_solver_is_inside_its_bound_of_the_certified_value(name):
    certified = CERTIFIED[name]
    for quantity, text in (("pull_off_force", certified.force), ("pull_off_displacement", certified.displacement)):
        enclosure = arb(text)
        solution = solve(Problem(2, 0, float(certified.form.mu)), quantity)
        assert enclosure.overlaps(arb(solution.value, solution.u_num))
    assert arb(certified.force).rad() < 1e-10


@pytest.mark.parametrize(
    "name", [n if c.quick else pytest.param(n, marks=pytest.mark.heavy) for n, c in CERTIFIED.items()]
)
def test_a_certified_value_is_proved_again(name):
    certified = CERTIFIED[name]
    enclosure = pull_off_enclosure(certified.form, certified.panel_count, certified.eta)
    with ctx.workprec(200):
        assert arb(certified.force).contains(enclosure.force)
        assert arb(certified.displacement).contains(enclosure.displacement)
    assert enclosure.curvature > 0


def test_a_smaller_degree_proves_fewer_digits_of_the_same_value(states, bounds):
    lowest = minimum(states, bounds, ETA)
    assert lowest.force.overlaps(arb(CERTIFIED["mu = 1/10"].force))
    assert 1e-11 < lowest.force.rad() < 1e-9


@pytest.mark.heavy
def test_the_interval_contains_the_states_inside_it(states, bounds):
    whole = enclose(states, bounds, arb(ETA), arb(1e-5))
    for share in (-0.9, 0.5):
        inside = approximate_states(FORM, states.delta + share * ETA)
        point = enclose(inside, panel_bounds(inside, COUNT), arb(0), TUBE)
        assert whole.load.contains(point.load)
        assert whole.first.contains(point.first)
        assert whole.second.contains(point.second)


def test_the_distance_covers_the_states_of_the_interval_and_is_not_loose(states, bounds):
    """W at the end of the interval against the quadratic polynomial in delta, at a few points."""
    distance = enclose(states, bounds, arb(ETA), arb(1e-5)).distance
    inside = approximate_states(FORM, states.delta + ETA)
    with ctx.workprec(200):
        t = arb(inside.delta) - arb(states.delta)
        series = zip(inside.traction, states.traction, states.first, states.second, strict=True)
        difference = FORM.deformed([new - a - t * b - t * t * c / 2 for new, a, b, c in series])
        points = [arb(j) / 20 for j in range(-20, 21)]
        largest = max(
            abs(sum((a * s.legendre_p(order) for order, a in enumerate(difference)), arb(0))).upper() for s in points
        )
    # Measured: 0.04 of the bound.
    assert distance / 50 < largest < distance


def test_a_bad_approximation_widens_the_ball_but_does_not_move_it_off_the_value(states, bounds):
    good = enclose(states, bounds, arb(0), TUBE)
    rough = replace(
        states,
        traction=changed(states.traction, 3, 1e-9),
        first=changed(states.first, 7, 1e-6),
        second=changed(states.second, 5, 1e-6),
    )
    wide = enclose(rough, panel_bounds(rough, COUNT), arb(0), TUBE)
    for name in ("load", "first", "second"):
        assert getattr(wide, name).contains(getattr(good, name))
        assert getattr(wide, name).rad() > 3 * getattr(good, name).rad()


#: One of the state, one of the problem, one of the proof of the minimum; the others take as long and are heavy tests.
LIGHT_WRONG = {"one coefficient of the traction", "compliance", "a comparison function of the wrong sign"}
WRONG = {
    "one coefficient of the traction": lambda s: replace(s, traction=changed(s.traction, 3, 1e-6)),
    "far traction": lambda s: replace(s, far=s.far * 1.01),
    "first derivative": lambda s: replace(s, first=changed(s.first, 3, 1e-2)),
    "second derivative": lambda s: replace(s, second=changed(s.second, 3, 10.0)),
    "displacement": lambda s: replace(s, delta=s.delta + 1e-6),
    "compliance": lambda s: replace(s, form=replace(FORM, mu=fmpq(10001, 100000))),
    "length of the projection": lambda s: replace(s, form=replace(FORM, length=6)),
    "a comparison function of the wrong sign": lambda s: replace(
        s, comparison=(s.comparison[0], [-x for x in s.comparison[1]])
    ),
    "a comparison function that is too small near the centre": lambda s: replace(
        s, comparison=(s.comparison[0], s.traction)
    ),
}


@pytest.mark.parametrize("name", [n if n in LIGHT_WRONG else pytest.param(n, marks=pytest.mark.heavy) for n in WRONG])
def test_a_wrong_number_is_not_proved(states, name):
    wrong = WRONG[name](states)
    with pytest.raises(NotProved):
        minimum(wrong, panel_bounds(wrong, COUNT), ETA)


def test_a_state_beside_the_pull_off_proves_no_minimum():
    beside = approximate_states(FORM, -0.1)
    with pytest.raises(NotProved, match="no change of the sign"):
        minimum(beside, panel_bounds(beside, COUNT), ETA)


@pytest.mark.parametrize(("tube", "reason"), [(1e-16, "leave the tube"), (0.2, "not positive in the whole tube")])
def test_the_tube_must_fit(states, bounds, tube, reason):
    with pytest.raises(NotProved, match=reason):
        enclose(states, bounds, arb(0), arb(tube))
