"""Surface tension at finite strain: areas, derivatives, energy, limits of small strain and of a liquid, both forms."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import Ball, Homogeneous, LennardJones, NeoHookean, Problem, solve, solve_large_strain
from fem_reference._elastic.mesh import edge_grid
from fem_reference._elastic.trace import trace_of
from fem_reference._large_strain.discretisation import linear_event
from fem_reference._large_strain.equilibrium import solve_state
from fem_reference._large_strain.events import Family
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.surface import local_slopes
from fem_reference._large_strain.surface_area import excess, excess_residual, excess_tangent
from fem_reference.large_strain import _discretisation
from tests.marks import heavy

FORCE = "pull_off_force"

#: Of derivatives by central differences.
DIFFERENCE_TOLERANCE = 1e-7


def ball(number, mu, nu, tension, modulus=1.0):
    """Ball of the radius 1 with w/(E* R), a Tabor number and 2 Y/(E* R)."""
    E = modulus * (1.0 - nu**2)
    law = LennardJones(modulus * number, number ** (2 / 3) / mu)
    return Problem(NeoHookean(E, nu, surface_tension=0.5 * tension * modulus), Ball(1.0), law)


@pytest.fixture(scope="module")
def trace():
    return trace_of(edge_grid(1.0, 0.25, 0.25, 4.0, 0.4), 4)


def faces_of(trace, u, finiteness=1.0):
    """Faces of coefficients of both components."""
    surface = SimpleNamespace(slopes=trace.slopes(trace.s), phi=trace.phi)
    radial, axial = (finiteness * component for component in u)
    rho = trace.s + surface.phi @ radial
    return Faces(rho, 1.0 + surface.slopes @ radial, surface.slopes @ axial, np.zeros_like(rho))


@pytest.mark.parametrize("finiteness", [1.0, 0.3])
def test_the_forces_of_the_tension_are_derivatives_of_the_area_of_an_overturned_surface(trace, finiteness):
    random, s = np.random.default_rng(3), trace.nodes
    size = trace.phi.shape[1]
    u, direction = np.zeros((2, size)), random.normal(size=(2, size))
    # Where the surface turns back, and is stretched and steep.
    u[:, : s.size] = np.array([-4.0 * s * np.exp(-4.0 * (s - 1.0) ** 2), 2.0 * np.exp(-3.0 * (s - 1.0) ** 2)])
    assert faces_of(trace, u).stretch.min() < -1.0
    slopes, step = local_slopes(trace), 1e-6

    def at(sign):
        faces = faces_of(trace, u + sign * step * direction, finiteness)
        pair = excess_residual(faces, trace.weight, trace.local, slopes, finiteness)
        return excess(faces, trace.weight, finiteness), np.stack(pair, axis=2)

    along = np.stack([component[trace.functions] for component in direction], axis=2)
    (higher, above), (lower, below) = at(1), at(-1)
    rate = float((at(0)[1] * along).sum())
    assert (higher - lower) / (2 * step) == pytest.approx(rate, rel=DIFFERENCE_TOLERANCE)
    tangent = excess_tangent(faces_of(trace, u, finiteness), trace.weight, trace.local, slopes)
    change = (tangent @ along.reshape(along.shape[0], -1, 1)).reshape(along.shape)
    assert np.abs((above - below) / (2 * step) - change).max() < DIFFERENCE_TOLERANCE * np.abs(change).max()


def test_the_excess_is_that_of_a_cone_and_of_a_hemisphere(trace):
    s, weight = trace.s, trace.weight
    inside = s < 1.0
    cone = Faces(s, np.ones_like(s), np.where(inside, 0.75, 0.0), np.zeros_like(s))
    assert excess(cone, weight, 1.0) == pytest.approx(0.5 * (1.25 - 1.0), rel=1e-12)
    # More than a hemisphere: the arc to 120 degrees, whose edge is below its widest circle.
    angle = 2.0 / 3.0 * math.pi
    arc = Faces(np.sin(angle * s), angle * np.cos(angle * s), angle * np.sin(angle * s), np.zeros_like(s))
    exact = (1.0 - math.cos(angle)) - 0.5 * math.sin(angle) ** 2
    assert excess(arc, weight * inside, 1.0) == pytest.approx(exact, rel=1e-6)
    # Of small slopes it is r u_z'^2/2, which is what remains as the strains vanish.
    bent = Faces(s, np.ones_like(s), 1e-6 * s, np.zeros_like(s))
    assert excess(bent, weight, 1e-6) == pytest.approx(0.5 * float(weight @ s**3), rel=1e-9)


def states_of(problem, order=4, form="auto"):
    linear = linear_event(problem, "pull_off")
    elements = _discretisation(problem, linear, "none", form, "auto")
    return Family(replace(elements, spec=replace(elements.spec, order=order)), linear)


@pytest.mark.parametrize(("nu", "form"), [(0.5, "mixed"), *heavy((0.3, "displacement"), (0.3, "mixed"))])
def test_the_load_is_the_derivative_of_the_energy_with_tension(nu, form):
    """On one mesh: where the mesh ends, the area beyond it is left out."""
    state = states_of(ball(5e-3, 1.0, nu, 0.3), form=form).state(0.0)
    shares = np.linspace(-0.1, 0.1, 5)
    gap = state.control.gap
    path = [solve_state(state, replace(state.control, gap=gap * (1.0 + share))) for share in shares]
    delta, load, energy = (
        np.polynomial.Polynomial.fit(shares, [getattr(state, name) for state in path], 4)
        for name in ("displacement", "load", "energy")
    )
    for share in shares[1:-1]:
        assert energy.deriv()(share) / delta.deriv()(share) == pytest.approx(load(share), rel=2e-6)
    # The area under the curve.
    work = (load * delta.deriv()).integ()
    assert work(shares[-1]) - work(shares[0]) == pytest.approx(path[-1].energy - path[0].energy, rel=2e-6)


@pytest.mark.heavy
def test_both_forms_have_one_state_under_tension():
    problem = ball(5e-3, 1.0, 0.3, 0.3)
    loads = [states_of(problem, form=form).state(0.0).load for form in ("displacement", "mixed")]
    assert loads[0] == pytest.approx(loads[1], rel=1e-5)
    # Without tension it is another one.
    assert abs(states_of(ball(5e-3, 1.0, 0.3, 0.0)).state(0.0).load / loads[0] - 1.0) > 0.01


@pytest.mark.heavy
def test_bounds_with_tension_contain_a_finer_solution_and_those_of_the_other_form():
    problem = ball(5e-3, 1.0, 0.3, 0.3)
    solution, finer = (solve_large_strain(problem, FORCE, accuracy=accuracy) for accuracy in ("quick", "default"))
    assert abs(solution.value - finer.value) <= solution.u_num + finer.u_num
    assert solution.u_num < 1e-4 * solution.value
    mixed = solve_large_strain(problem, FORCE, form="mixed")
    assert abs(solution.value - mixed.value) <= solution.u_num + mixed.u_num


@pytest.mark.heavy
def test_small_strains_have_the_force_of_small_slopes_with_the_order_of_the_strains():
    """2 Y/E* over the contact radius is the same for all."""
    changes, numbers = [], (1e-7, 1e-6, 1e-5)
    for number in numbers:
        tension = 0.5 * number ** (1 / 3)
        large = solve_large_strain(ball(number, 2.0, 0.3, tension), FORCE, interaction="derjaguin")
        small = replace(ball(number, 2.0, 0.3, tension), solid=Homogeneous(0.91, 0.3, surface_tension=0.5 * tension))
        linear = solve(small, FORCE)
        changes.append(abs(large.value / linear.value - 1.0))
    orders = np.diff(np.log10(changes))
    assert np.all(np.abs(orders - 1.0 / 3.0) < 0.05), (changes, orders)
    assert changes[0] < 3e-3


@pytest.mark.heavy
def test_a_liquid_has_the_force_of_small_slopes():
    """The length 2 Y/E* is a hundred contact radii, and Y ten times the work of adhesion.

    That of a short range is pi R w; here z0 is R/20 (measured: 1.3220, and 1.3208 at small slopes).
    """
    liquid = ball(1.0, 20.0, 0.5, 20.0)
    solution = solve_large_strain(liquid, FORCE)
    assert solution.u_num < 1e-6 * solution.value
    slopes = replace(liquid, solid=Homogeneous(0.91, 0.3, surface_tension=10.0))
    assert solution.value == pytest.approx(solve(slopes, FORCE).value, rel=2e-3)
    assert 1.0 < solution.value / math.pi < 4.0 / 3.0


def test_the_energy_lost_under_tension_is_refused():
    with pytest.raises(ValueError, match="hysteresis_energy"):
        solve_large_strain(ball(1e-2, 2.0, 0.5, 0.1), "hysteresis_energy")
