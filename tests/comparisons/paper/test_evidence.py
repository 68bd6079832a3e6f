"""Outcomes of comparisons, the kinds of tests, and the measures on made-up results."""

import math

import numpy as np
import pytest

from comparisons import create
from comparisons.data.paper_statements import paper_statements
from comparisons.paper.statements import equilibria, formulas, kinds, measures
from comparisons.paper.statements.equilibria import count_jumps, turning_points
from comparisons.paper.statements.judgement import decisive
from comparisons.paper.statements.kinds import FAILS, HOLDS, READING, UNDECIDED, Evidence, Family, extrapolated
from comparisons.paper.statements.measures import Number
from comparisons.problem import Problem


def comparison(value, limit=0.0, u=0.0, u_limit=0.0, relation="<", model="fscm", clause="n = 2", title="other"):
    return Evidence.of(Family(model, clause), Number(value, u, "value"), relation, Number(limit, u_limit, title))


@pytest.mark.parametrize(
    ("value", "u", "u_limit", "outcome"),
    [
        (-1.0, 0.7, 0.25, HOLDS),
        (1.0, 0.7, 0.25, FAILS),
        # Both bounds are added, and a difference equal to their sum decides nothing.
        (-1.0, 0.75, 0.25, UNDECIDED),
        (math.nan, 0.0, 0.0, UNDECIDED),
        (-1.0, math.nan, 0.0, UNDECIDED),
    ],
)
def test_a_comparison_is_decided_beyond_the_sum_of_the_bounds(value, u, u_limit, outcome):
    assert comparison(value, 0.0, u, u_limit, "<").outcome == outcome
    assert comparison(-value, 0.0, u, u_limit, ">").outcome == outcome


def test_each_clause_model_and_kind_of_limit_keeps_the_largest_failure_before_what_is_not_decided():
    statement = next(statement for statement in paper_statements() if statement.own == {"n": [1, 1.5], "k": [0.4]})
    rows = [comparison(value, u=u) for value, u in ((-1.0, 0.0), (1e-9, 1.0), (0.5, 0.0), (2.0, 0.0))]
    (row,) = decisive(statement, rows)
    assert (row.value, row.outcome, row.comparisons, row.own_case, row.beyond_paper) == (2.0, FAILS, 4, False, True)
    assert [row.outcome for row in decisive(statement, rows[:2])] == [UNDECIDED]
    more = [comparison(-2.0, clause="n = 1"), comparison(-3.0, model="fem"), comparison(-4.0, title=READING)]
    evidence = decisive(statement, [*rows, *more])
    assert [(row.value, row.own_case) for row in evidence] == [(2.0, False), (-2.0, True), (-3.0, False), (-4.0, False)]


def sequence(function, u=0.0):
    return [Number(function(mu), u, f"mu = {mu}") for mu in (10.0, 20.0, 40.0)]


def test_a_power_has_its_limit_whose_bound_is_that_of_the_members():
    for end, power in ((-0.2, 0.5), (0.0, 2.0)):
        limit = extrapolated(*sequence(lambda mu, end=end, power=power: end + 0.7 * mu**-power))
        assert limit.value == pytest.approx(end, abs=1e-14)
    assert extrapolated(*sequence(lambda mu: 0.25)).value == 0.25
    members = sequence(lambda mu: 0.3 + 1.0 / mu, u=1e-9)
    limit, expected = extrapolated(*members), 0.0
    for i, member in enumerate(members):
        moved = [*members[:i], Number(member.value + 1e-7, 0.0, ""), *members[i + 1 :]]
        expected += abs(extrapolated(*moved).value - limit.value) / 1e-7 * 1e-9
    assert limit.u == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("end", "u", "outcomes"),
    # The last passes through zero and grows again.
    [(0.0, 0.0, {HOLDS}), (0.0, 1.0, {UNDECIDED}), (-0.05, 0.0, {HOLDS, FAILS}), (0.1, 0.0, {HOLDS, FAILS})],
)
def test_only_what_falls_to_zero_vanishes(end, u, outcomes):
    values = sequence(lambda mu: end - 3.0 / mu, u)
    rows = kinds.vanishing({"within": 1e-3}, Family("fscm", "n = 2"), values, [])
    assert {row.outcome for row in rows} == outcomes


@pytest.mark.parametrize(
    ("corners", "turns", "jumps"),
    [
        # An inner pair within the outer one is passed over both ways.
        ([0, 4, 2, 3, 1, 5], 4, 2),
        # A second maximum above the first stops the machine before it, on the way there or on the way back.
        ([0, 3, 2, 4, 1, 5], 4, 3),
        ([0, 2, 1, 4, 3, 5], 4, 4),
    ],
)
def test_turns_and_jumps_are_those_that_a_machine_sees(corners, turns, jumps):
    path = np.interp(np.linspace(0, len(corners) - 1, 20 * len(corners)), range(len(corners)), corners)
    assert (len(turning_points(path, 2e-3)), count_jumps(path, 2e-3)) == (turns, jumps)
    # A fall within twice the bound is no turn.
    assert [len(turning_points(np.array([0.0, 1.0, 1.0 - fall, 2.0]), 0.1)) for fall in (0.15, 0.25)] == [0, 2]


def at(*arguments, n=2.0, k=0.0, mu=100.0):
    return measures.Place("fscm", (("n", n), ("k", k), ("mu", mu)), arguments)


def number(value):
    return Number(value, 1e-3, "")


def arrays(**columns):
    return {name: np.array(values, float) for name, values in columns.items()}


PATH = arrays(central_gap=[20, 10, 0], displacement=[-19.9, -9.8, 0], load=[-0.1, -0.2, -2])
PATH |= {"u_displacement": 1e-3, "u_load": 1e-3}
#: The edge is at r = 2, the pile-up at r = 2, and the gap is linear inside.
SHAPE = arrays(radius=[0, 1, 2, 3], deformation=[0.5, 0.2, -0.3, -0.1])
SHAPE |= arrays(pressure=[1, 0, -1, -0.5], gap=[-0.2, 0, 0.2, 1])
SHAPE |= {f"u_{name}": np.full(4, 1e-3) for name in SHAPE}
RADII = np.linspace(0.0, 4.0, 401)
ZONE = {"radius": RADII, "gap": RADII / 1.5, "contact_radius": 1.2, "cohesive_radius": 1.5, "displacement": 2.0}
#: The same deformation as that of the zone, but for 0.25, with the displacement 2.75.
BESIDE = ({"md": ZONE}, {"radius": RADII, "gap": ZONE["gap"] - 1.0, "u_distance": 0.0}, number(2.75))
FORCES = [{"force": force, "beyond": beyond, "u_num": 1e-3} for force, beyond in ((1.0, 0.0), (2.0, 0.5))]
U_GAPS = dict.fromkeys(("u_jump_in_gap", "u_jump_out_gap"), 1e-6)
ONSET = [
    {"mu": 0.5 * (1.0 + excess), "jump_in_gap": 1.0 + distance, "jump_out_gap": 1.0, **U_GAPS}
    for excess, distance in ((1e-4, 0.03), (1e-2, 0.2))
]


@pytest.mark.parametrize(
    ("measure", "place", "made", "value", "u"),
    [
        (equilibria.gap_step, at(), [PATH], -10.0, 2e-3),
        (equilibria.far_deformation, at(), [PATH], 0.02, 1e-4),
        (equilibria.far_load, at(), [PATH], 0.1, 1e-3),
        (equilibria.pile_up_height, at(), [SHAPE], 0.8, 2e-3),
        (equilibria.centre_deformation, at(), [SHAPE], 0.5, 1e-3),
        (equilibria.pile_up_distance, at(), [SHAPE], 0.0, 0.5),
        (equilibria.step_outside, at(), [SHAPE], 0.2, 2e-3),
        (equilibria.distance_inside, at("md"), BESIDE, 0.25, 1e-3),
        (equilibria.distance_outside, at("md"), BESIDE, 0.25, 1e-3),
        (measures.jump_in_deformation, at(), [number(4.0), number(-3.5)], 0.125, 5.3125e-4),
        (equilibria.gap_cusp, at(), [{"mu": 0.5, "jumps": ONSET}], 0.5, 2.3e-4),
        # B(8, 1) / B(2, 1) = 1/4.
        (equilibria.repulsion, at("41", n=1.0), [number(1.0)], 1.0 / 256.0, 3e-3 / 256.0),
        (formulas.segments_change, at(), FORCES, 0.25, 1e-3),
    ],
)
def test_measures_of_made_up_results(measure, place, made, value, u):
    computed, bound = measure(place, *made)
    assert computed == pytest.approx(value, rel=1e-9, abs=1e-12)
    assert bound == pytest.approx(u, rel=1e-3)


def test_measures_within_their_bounds():
    mean, u = equilibria.gap_inside(at(), SHAPE)
    assert mean == pytest.approx(0.1, abs=u)
    assert equilibria.zone_width(at("md"), ZONE)[0] == pytest.approx(0.3)
    for name, stress in (("md-improved", 0.588), ("md", 1.0264)):
        assert equilibria.zone_area(at(name), ZONE)[0] == pytest.approx(abs(stress - 1.0), abs=1e-3)
    # The response falls away from its ring.
    assert formulas.phi_sharpness(at("1e-3", "1e-2"))[0] > 1.0


@pytest.mark.parametrize(("n", "k"), [(1.0, 0.0), (2.0, 0.4), (3.0, 0.8)])
def test_an_asymptote_has_the_power_of_the_tabor_number_that_is_expected(n, k):
    problems = (Problem.dimensionless(n, k, mu) for mu in (100.0, 200.0))
    values = [create("jump-asymptotes").evaluate(problem, "jump_in_displacement").value for problem in problems]
    place = at("jump_in_displacement", n=n, k=k)
    assert measures.power_of_mu(place, *map(number, values))[0] == pytest.approx(0.0, abs=1e-12)
