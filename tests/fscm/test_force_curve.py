"""Force curves from series: bounds at problems that no series was fitted to, derivatives, limits, range."""

import math

import numpy as np
import pytest

import fscm
from fscm import NoSuchEvent, OutsideAtlas, atlas, force_curve
from fscm.interpolation.builder.curve_nodes import curve_nodes, traced, values_at_positions
from fscm.interpolation.curve import series
from fscm.interpolation.curve.pieces import CONTACT_GAP, PIECES, gap_at, rigid_load
from tests.marks import heavy
from tests.refusals import refused

#: Size of the data that was agreed on, in bytes.
LARGEST_FILE = 2e6
#: Points of a curve that is compared, and how far a chord between two of them may be from it, relative to 1 + |value|.
MANY, CHORD = 6000, 1e-7
#: Seed of the random problems of the verification, none of which is a node.
SEED = 4711
#: Largest share of the unit of loads by which the curve of a homogeneous sphere may be wrong on its stable branches.
STABLE = 5e-4


def outside(problem, curve, accuracy="default"):
    """Number of states of the model of which no point of the polygon of a curve is within both bounds."""
    path = fscm.trace(problem, accuracy, largest_turn=180.0)
    ends = np.full((len(path.load), 2, MANY - 1), np.nan)
    ends[:, 0], ends[:, 1] = 0.0, 1.0
    for name in ("displacement", "load"):
        points, bounds = getattr(curve, name), getattr(curve, f"u_{name}")
        apart, step = getattr(path, name)[:, None] - points[None, :-1], np.diff(points)
        room = np.maximum(bounds[1:], bounds[:-1]) + getattr(path, f"u_{name}") + CHORD * (1.0 + np.abs(points[1:]))
        shares = np.sort([(apart - room) / step, (apart + room) / step], axis=0)
        ends[:, 0], ends[:, 1] = np.maximum(ends[:, 0], shares[0]), np.minimum(ends[:, 1], shares[1])
    return int((ends[:, 0] > ends[:, 1]).all(axis=1).sum())


def random_problems(count):
    """Spheres and other punches, one after the other, uniform in 1/n, k and ln mu."""
    u = np.random.default_rng(SEED).uniform(size=(count, 3))
    n = np.where(np.arange(count) % 2 == 0, 2.0, 1.0 / (1.0 / 6.0 + 5.0 / 6.0 * u[:, 0]))
    return list(zip(n.tolist(), (0.8 * u[:, 1]).tolist(), (0.01 * 1000.0 ** u[:, 2]).tolist(), strict=True))


@pytest.mark.parametrize(
    ("n", "k", "mu"), [(2.0, 0.0, 0.37), (2.0, 0.23, 2.9), (3.1, 0.1, 0.8), *heavy(*random_problems(40))]
)
def test_states_of_the_model_are_within_the_bounds(n, k, mu):
    assert outside(fscm.Problem(n=n, k=k, mu=mu), force_curve(n, k, mu, points=MANY)) == 0


@pytest.mark.parametrize("mu", [14.0, 0.004, *heavy(30.0, 0.0015)])
def test_beyond_its_range_the_bounds_of_a_curve_cover_the_limit(mu):
    problem, curve = fscm.Problem(n=2, k=0.0, mu=mu), force_curve(2, 0.0, mu, points=MANY)
    assert outside(problem, curve, "quick") == 0
    # They are not infinite: at pull-off the limit is near.
    assert curve.u_load[curve.load.argmin()] < 0.1


def test_pull_off_and_jumps_are_those_of_the_atlas():
    """The atlas has bounds of its own, from other nodes."""
    rng = np.random.default_rng(SEED)
    errors = []
    for k, mu in zip(
        np.append(np.zeros(15), rng.uniform(0.0, 0.8, 15)), 0.01 * 1000.0 ** rng.uniform(size=30), strict=True
    ):
        curve = force_curve(2, k, mu, points=MANY)
        lowest = int(curve.load.argmin())
        force, u_force = atlas(2, k, mu, "pull_off_force")
        assert abs(force + curve.load[lowest]) <= u_force + curve.u_load[lowest]
        errors.append(abs(force + curve.load[lowest]) if k == 0.0 else 0.0)
        for jump, name in ((curve.jump_in, "in"), (curve.jump_out, "out")):
            try:
                value, u_value = atlas(2, k, mu, f"jump_{name}_displacement")
            except NoSuchEvent:
                value = None
            # Next to the critical Tabor number a series may have no fold.
            assert (jump is None) == (value is None) or abs(
                mu / atlas(2, k, 1.0, "critical_tabor_number").value - 1.0
            ) < 0.1
            if jump is not None and value is not None:
                unstable = np.flatnonzero(curve.branch == "unstable")
                at = unstable[0] if name == "in" else unstable[-1]
                assert abs(jump - value) <= u_value + curve.u_displacement[at]
    assert max(errors) < STABLE


def test_the_loads_of_both_branches_are_those_of_the_model():
    curve = force_curve(2, 0.0, 2.0)
    cycle = {"approach": [-6.0, -3.0, -2.4], "retreat": [1.0, -1.0, -3.2, -3.5]}
    for branch, displacements in cycle.items():
        values, bounds = curve.load_at(displacements, branch)
        for displacement, value, bound in zip(displacements, values, bounds, strict=True):
            states = fscm.equilibria(fscm.Problem(n=2, k=0.0, mu=2.0), "displacement", displacement, "quick")
            in_contact = displacement > (curve.jump_in if branch == "approach" else curve.jump_out)
            state = states[-1] if in_contact else states[0]
            assert abs(state.load - value) <= bound + state.u_num
            assert bound < 0.05


def test_beyond_the_far_end_bodies_attract_each_other_as_rigid_ones():
    value, bound = force_curve(2, 0.0, 1.0).load_at(-100.0, "approach")
    assert value == pytest.approx(float(rigid_load(np.array(2.0), np.array(100.0))), rel=1e-2)
    assert bound < 1e-3


@pytest.mark.parametrize(("parameter", "step"), [("n", 1e-4), ("k", 1e-4), ("mu", 1e-4)])
def test_derivatives_are_those_of_the_curve(parameter, step):
    at = {"n": 2.5, "k": 0.3, "mu": 1.5}
    curve = force_curve(**at)
    sides = [force_curve(**(at | {parameter: at[parameter] + side * step})) for side in (1.0, -1.0)]
    for derivative, above, below in zip(
        curve.derivative(parameter),
        *((side.displacement, side.load, side.contact_radius) for side in sides),
        strict=True,
    ):
        difference = (above - below) / (2.0 * step)
        # Where contact begins the radius is a square root.
        assert derivative[90:] == pytest.approx(difference[90:], rel=1e-5, abs=1e-5 * np.abs(difference).max())
    loads = [side.load_at([-1.0, 0.5], "retreat").value for side in sides]
    of_load = curve.load_at([-1.0, 0.5], "retreat", by=parameter).value
    assert of_load == pytest.approx((loads[0] - loads[1]) / (2.0 * step), rel=1e-3)


def test_the_derivative_by_the_tabor_number_is_that_of_jkr_beyond_the_range():
    """P = -3/2 for all mu; delta is proportional to mu at a place of the curve."""
    curve = force_curve(2, 0.0, 25.0)
    moved = curve.derivative("mu")
    contact = curve.contact_radius > 0.0
    assert moved.load[contact] == pytest.approx(0.0, abs=1e-9 * np.abs(curve.load).max())
    assert moved.displacement[contact] == pytest.approx(curve.displacement[contact] / 25.0, rel=1e-9, abs=1e-9)


def test_arrays_are_their_numbers_one_by_one():
    mu = np.array([0.005, 0.1, 3.0, 20.0])
    curves = force_curve(2, [[0.0], [0.5]], mu)
    assert curves.load.shape == (2, 4, 240)
    for i, k in enumerate((0.0, 0.5)):
        for j, number in enumerate(mu):
            one = force_curve(2, k, number)
            for name in ("displacement", "load", "contact_radius", "u_displacement", "u_load"):
                assert getattr(curves, name)[i, j] == pytest.approx(getattr(one, name), rel=1e-9, abs=1e-12)
            assert (curves.branch[i, j] == one.branch).all()
    with pytest.raises(ValueError, match="one curve"):
        curves.load_at(0.0, "approach")


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.5, 2.0), (3.0, 0.2, 0.4)])
def test_pieces_meet(n, k, mu):
    """Where two series meet, the step of a dense curve is no longer than those beside it."""
    curve = force_curve(n, k, mu, points=MANY)
    for values in (curve.displacement, curve.load):
        steps = np.abs(np.diff(values))
        for meeting in (MANY // 3 - 1, MANY - 1 - MANY // 6):
            beside = np.append(steps[meeting - 5 : meeting], steps[meeting + 1 : meeting + 6])
            assert steps[meeting] < 2.0 * beside.max()


def test_branches_are_stable_but_for_the_one_between():
    curve = force_curve(2, 0.0, 5.0)
    rises = np.diff(curve.displacement) > 0.0
    for branch in ("approach", "contact"):
        inside = curve.branch == branch
        assert rises[inside[:-1] & inside[1:]].all()
    assert not rises[(curve.branch == "unstable")[:-1]].all()
    assert curve.jump_out < curve.jump_in < 0.0
    stiff = force_curve(2, 0.0, 0.3)
    assert set(stiff.branch) == {"approach", "contact"}
    assert (stiff.jump_in, stiff.jump_out) == (None, None)


def test_the_units_of_a_problem():
    solid, punch = fscm.PowerLaw(E0=3e6, c0=1.0, k=0.0, nu=0.5), fscm.PowerPunch(n=2, Q=1e-6)
    bead = fscm.Problem(solid, punch, fscm.LennardJones(work_of_adhesion=0.05, z0=4e-10))
    plain = force_curve(bead.n, bead.k, bead.mu)
    curve = plain.in_units(bead.units)
    force = fscm.solve(bead, "pull_off_force", "quick").value
    assert -curve.load.min() == pytest.approx(force, rel=5e-3)
    x = 0.3 * plain.displacement.min()
    units = bead.units
    for by in (None, "mu"):
        dimensional = curve.load_at(x * units["displacement"], "approach", by=by).value
        assert dimensional == pytest.approx(plain.load_at(x, "approach", by=by).value * units["load"], rel=1e-9)
    assert curve.contact_radius[-1] == pytest.approx(plain.contact_radius[-1] * units["radius"])


@pytest.mark.parametrize(
    ("arguments", "words", "error"),
    [
        ((0.9, 0.0, 1.0), "n = 0.9", OutsideAtlas),
        ((2.0, 0.9, 1.0), "k = 0.9", OutsideAtlas),
        ((2.0, 0.0, -1.0), "mu = -1", ValueError),
        ((2.0, 0.0, math.nan), "mu = nan", ValueError),
        ((2.0, 0.0, math.inf), "mu = inf", ValueError),
        ((2.0, "soft", 1.0), "k = 'soft'", ValueError),
        ((2.0, [0.0, 0.1], [1.0, 2.0, 3.0]), "shapes", ValueError),
    ],
)
def test_other_parameters_are_refused(arguments, words, error):
    refused(words, force_curve, *arguments, error=error)


@pytest.mark.parametrize(
    ("displacement", "branch", "words"),
    [(1e9, "approach", "displacement = 1e"), (math.nan, "approach", "nan"), (0.0, "sideways", "sideways")],
)
def test_other_displacements_are_refused(displacement, branch, words):
    refused(words, force_curve(2, 0, 1.0).load_at, displacement, branch)


def test_the_data_are_those_of_the_nodes():
    """The series of a sphere passes its nodes; the nodes follow from their seed."""
    node = next(node for node in curve_nodes(0) if 0.2 < node[1] < 0.5 and 0.5 < node[2] < 2.0)
    values = values_at_positions(node[0], node[2], traced(*node))
    components = series.stored_curve().components(*(np.array([x]) for x in node))
    for piece in PIECES:
        count = values[piece].shape[-1]
        position = -np.cos((np.arange(count) + 0.5) * np.pi / count)
        of_series = [np.polynomial.chebyshev.chebval(position, row[0]) for row in components[piece]]
        assert np.array(of_series) == pytest.approx(values[piece], abs=2e-3)
    assert series.DATA.stat().st_size < LARGEST_FILE


def test_the_gap_of_an_approach_ends_at_the_largest_tension():
    ends = gap_at(np.array(3.0), np.array([-1.0, 1.0]))
    assert ends.tolist() == pytest.approx([25.0, CONTACT_GAP])
    law = fscm.LennardJones()
    assert law.traction(np.array([CONTACT_GAP - 1e-3, CONTACT_GAP, CONTACT_GAP + 1e-3])).argmin() == 1
