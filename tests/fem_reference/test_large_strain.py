"""Contact of finite strain: derivatives, manufactured solutions, limits, energy, two forms, honest bounds."""

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from skfem import Basis, ElementQuadP, Functional, LinearForm

import fscm
from fem_reference import (
    Ball,
    LennardJones,
    NeoHookean,
    NotConverged,
    OffsetPowerLaw,
    PowerLaw,
    PowerPunch,
    Problem,
    profile_large_strain,
    solve,
    solve_large_strain,
    trace_large_strain,
)
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec, edge_grid, uniform_grid
from fem_reference._elastic.trace import trace_of
from fem_reference._large_strain import whole_path
from fem_reference._large_strain.block import block_of, linear_response
from fem_reference._large_strain.core import core_of
from fem_reference._large_strain.discretisation import _reason, linear_event
from fem_reference._large_strain.equilibrium import Control, solve_state
from fem_reference._large_strain.error_parts import state_bounds, variants_of
from fem_reference._large_strain.events import Family, found_event
from fem_reference._large_strain.material import energy, kinematics
from fem_reference._large_strain.surface import Surface, local_slopes
from fem_reference._large_strain.whole_path import PathState, path_states
from fem_reference.interaction import interaction_of
from fem_reference.large_strain import _discretisation
from fem_reference.solid import ScaledSolid
from tests.fem_reference.triangles_of_finite_strain import Square
from tests.marks import heavy
from tests.refusals import refused

#: Of derivatives by central differences.
DIFFERENCE_TOLERANCE = 1e-7

#: Displacement of the linear response of a block, relative to that in the middle: the elements are the same.
RESPONSE = 1e-11

#: Share of a sphere's small-strain pull-off force that bounds have by default (measured: up to 3e-6).
BOUND = 1e-5


def sphere(elasto_adhesion, mu, nu, punch=None, unit=1.0, pressure=1.0):
    """Sphere of the radius `unit` with w/(E* R) and a Tabor number, stresses in units of `pressure`."""
    E = pressure * (1.0 - nu**2) / elasto_adhesion
    law = LennardJones(pressure * unit, unit * elasto_adhesion ** (2 / 3) / mu)
    return Problem(NeoHookean(E, nu), Ball(unit) if punch is None else punch, law)


small_strain = cache(linear_event)


@cache
def family(problem, event="pull_off", friction="none", form="auto", order=4, interaction="auto"):
    """States on coarse meshes."""
    linear = small_strain(problem, event, "quick", friction)
    discretisation = _discretisation(problem, linear, friction, form, interaction)
    return Family(replace(discretisation, spec=replace(discretisation.spec, order=order)), linear)


def constants(nu, E=2.0):
    def of_depth(z):
        modulus = E * (1.0 + 0.5 * z)
        return modulus / (2 * (1 + nu)), (1 + nu) * (1 - 2 * nu) / (nu * modulus)

    return of_depth


def smooth_displacement(r, z, size=0.2):
    """A displacement that is zero on the axis in r, and its gradient."""
    u = size * np.array([r * np.cos(z) * (1 - 0.3 * r**2), np.sin(1.3 * r**2) + z * r**2 - 0.4 * z])
    gradient = size * np.array(
        [
            [np.cos(z) * (1 - 0.9 * r**2), -r * np.sin(z) * (1 - 0.3 * r**2)],
            [2.6 * r * np.cos(1.3 * r**2) + 2 * z * r, r**2 - 0.4 + 0 * z],
        ]
    )
    return u, gradient


def stresses(u, gradient, r, shear, lame):
    """First Piola-Kirchhoff stress and hoop stress, by matrix inversion."""
    F = np.moveaxis(gradient, (0, 1), (-2, -1)) + np.eye(2)
    hoop = 1.0 + u[0] / r
    J = np.linalg.det(F) * hoop
    inverse = np.swapaxes(np.linalg.inv(F), -1, -2)
    P = shear[..., None, None] * (F - inverse) + (lame * np.log(J))[..., None, None] * inverse
    return np.moveaxis(P, (-2, -1), (0, 1)), shear * (hoop - 1 / hoop) + lame * np.log(J) / hoop


def interpolated(core, function):
    """Coefficients of both components, by projection."""
    basis = Basis(core.dofs.topo, ElementQuadP(core.dofs.element.p), intorder=22)
    u = np.zeros(core.size)
    u[0::2] = basis.project(lambda x: function(*x)[0][0])
    u[1::2] = basis.project(lambda x: function(*x)[0][1])
    return u, basis


def test_the_residual_of_elements_is_the_weak_form_of_scikit_fem():
    core = core_of(uniform_grid(1.0, 2), constants(0.3), 5, mixed=False, extra=6)
    u, basis = interpolated(core, smooth_displacement)
    fields = [basis.interpolate(u[component::2]) for component in (0, 1)]

    def form(component):
        @LinearForm
        def virtual_work(v, w):
            r, z = w.x
            shear, softness = constants(0.3)(z)
            values = np.array([np.asarray(field) for field in fields])
            P, hoop = stresses(values, np.array([field.grad for field in fields]), r, shear, 1 / softness)
            work = P[component, 0] * v.grad[0] + P[component, 1] * v.grad[1]
            return r * (work + (hoop * v / r if component == 0 else 0.0))

        return virtual_work.assemble(basis)

    K, _ = core._linearised(slice(None), u, core.no_pressure(), 1.0)
    r = core.forces(u, core.no_pressure(), 1.0).residual
    assembled = np.bincount(core.rows.ravel(), r.ravel(), core.size)
    assert np.abs(assembled[0::2] - form(0)).max() < 1e-12
    assert np.abs(assembled[1::2] - form(1)).max() < 1e-12
    direction = np.random.default_rng(1).normal(size=core.size)
    step = 1e-6
    ends = [core.forces(u + sign * step * direction, core.no_pressure(), 1.0).residual for sign in (1, -1)]
    change = np.einsum("eij,ej->ei", K, direction[core.rows])
    assert np.abs((ends[0] - ends[1]) / (2 * step) - change).max() < DIFFERENCE_TOLERANCE * np.abs(change).max()
    # Virtual work: the residual is the derivative of the energy.
    energies = [core.energy(u + sign * step * direction) for sign in (1, -1)]
    assert (energies[0] - energies[1]) / (2 * step) == pytest.approx(float(assembled @ direction), rel=1e-7)


def _solved_with_body_force(count, order, nu, mixed):
    """Newton's method for the displacement whose boundary values and body force are manufactured; its error."""
    core = core_of(uniform_grid(1.0, count), constants(nu), order, mixed)
    exact, basis = interpolated(core, smooth_displacement)
    step = 1e-4

    def stress_at(r, z):
        u, gradient = smooth_displacement(r, z)
        shear, softness = constants(nu)(z)
        return stresses(u, gradient, r, shear, 1 / softness)

    def force(component):
        @LinearForm
        def work(v, w):
            r, z = w.x
            points = [stress_at(r + a * step, z + b * step)[0] for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1))]
            divergence = (points[0] - points[1])[component, 0] + (points[2] - points[3])[component, 1]
            P, hoop = stress_at(r, z)
            rest = P[component, 0] - (hoop if component == 0 else 0.0)
            return -(r * divergence / (2 * step) + rest) * v

        return work.assemble(basis)

    load = np.zeros(core.size)
    load[0::2], load[1::2] = force(0), force(1)
    fixed = 2 * np.unique(core.dofs.get_facet_dofs(core.dofs.topo.boundary_facets()).flatten())
    fixed = np.union1d(fixed, fixed + 1)
    free = np.setdiff1d(np.arange(core.size), fixed)
    u, pressures = exact.copy(), core.no_pressure()
    for _ in range(12):
        K, response = core._linearised(slice(None), u, pressures, 1.0)
        forces = core.forces(u, pressures, 1.0)
        r, defect = forces.residual, 0.0
        if mixed:
            r = r + np.einsum("em,emi->ei", forces.lack, response)
            defect = np.einsum("emk,ek->em", core.rise, forces.lack)
        whole = np.zeros((core.size, core.size))
        rows = core.rows
        np.add.at(whole, (rows[:, :, None], rows[:, None, :]), K)
        residual = np.bincount(rows.ravel(), r.ravel(), core.size) - load
        change = np.zeros(core.size)
        change[free] = -np.linalg.solve(whole[np.ix_(free, free)], residual[free])
        u += change
        if mixed:
            pressures = pressures + defect + np.einsum("emi,ei->em", response, change[rows])
        if np.abs(change).max() < 1e-12:
            break
    fields = [basis.interpolate(u[component::2]) for component in (0, 1)]

    @Functional
    def square(w):
        values, _ = smooth_displacement(*w.x)
        return sum((np.asarray(field) - value) ** 2 for field, value in zip(fields, values, strict=True))

    return math.sqrt(square.assemble(basis))


@pytest.mark.parametrize(("nu", "mixed"), [(0.3, False), (0.3, True), (0.45, True)])
def test_a_manufactured_solution_converges_with_the_order_of_the_elements(nu, mixed):
    coarse, fine = (_solved_with_body_force(count, 3, nu, mixed) for count in (2, 4))
    assert fine < 3e-5
    assert math.log2(coarse / fine) > 3.5  # 4 for the degree 3


@pytest.mark.parametrize(
    ("punch", "interaction"), [(PowerPunch(2.0, 1.0), "derjaguin"), (Ball(1.0), "derjaguin"), (Ball(1.0), "body")]
)
def test_the_surface_force_is_the_derivative_of_its_energy(punch, interaction):
    grid = edge_grid(1.0, 0.25, 0.25, 4.0, 0.4)
    trace = trace_of(grid, 4)
    problem = sphere(0.01, 1.0, 0.3, punch=punch)
    force = interaction_of(punch, problem.law, interaction)
    surface = Surface(trace, local_slopes(trace), punch, problem.law, force, 0.2, 70.0)
    size, s = trace.phi.shape[1], trace.nodes
    u, direction = np.zeros((2, size)), np.zeros((2, size))
    # They vanish at the end of the mesh, which takes part in the energy beyond it.
    u[:, : s.size] = 0.1 * np.array([s * (1 - s / 4) ** 2, np.cos(s) * (1 - s / 4)])
    direction[:, : s.size] = np.array([np.sin(2 * s), np.exp(-s)]) * (1 - s / 4)
    direction[:, s.size : -3] = 0.1 * np.random.default_rng(2).normal(size=(2, size - s.size - 3))
    delta, step = -0.2, 1e-6
    end = float(trace.nodes[-1])

    def at(sign, both):
        faces = surface.faces(u[0] + sign * step * direction[0], u[1] + sign * step * direction[1], delta)
        return surface.energy(faces, end, delta) if both else surface.residual(faces)

    rows = np.stack([trace.functions, trace.functions + size], axis=2).reshape(trace.functions.shape[0], -1)
    faces = surface.faces(u[0], u[1], delta)
    residual = np.stack(surface.residual(faces), axis=2).reshape(rows.shape)
    rate = 2 * math.pi * surface.size**3 * surface.modulus * float((residual * direction.ravel()[rows]).sum())
    assert (at(1, True) - at(-1, True)) / (2 * step) == pytest.approx(rate, rel=1e-7)
    tangent, by_delta = surface.tangent(faces)
    change = np.einsum("eij,ej->ei", tangent, direction.ravel()[rows])
    ends = [np.stack(at(sign, False), axis=2).reshape(rows.shape) for sign in (1, -1)]
    assert np.abs((ends[0] - ends[1]) / (2 * step) - change).max() < 1e-6 * np.abs(change).max()
    # Virtual work of the punch, with what lies beyond the mesh.
    energies = [surface.energy(surface.faces(*u, delta + x), end, delta + x) for x in (step, -step)]
    load = surface.load(faces, end, delta)
    assert (energies[0] - energies[1]) / (2 * step * surface.size) == pytest.approx(load, rel=1e-8)
    shifted = [surface.residual(surface.faces(*u, delta + sign * step)) for sign in (1, -1)]
    difference = np.stack([(a - b) / (2 * step) for a, b in zip(*shifted, strict=True)], axis=2).reshape(rows.shape)
    assert np.abs(difference - by_delta).max() < 1e-6 * np.abs(by_delta).max()


@pytest.mark.heavy
@pytest.mark.parametrize(("nu", "friction"), [(0.3, "none"), (0.5, "none"), (0.5, "bonded")])
def test_the_work_of_the_load_is_the_energy(nu, friction):
    states = family(sphere(5e-3, 2.0, nu), friction=friction, order=6)
    states.state(0.0)
    parameters = np.linspace(-0.15, 0.15, 9)
    path = [states.state(x) for x in parameters]
    delta, load, energy = (
        np.polynomial.Polynomial.fit(parameters, [getattr(state, name) for state in path], 8)
        for name in ("displacement", "load", "energy")
    )
    # The area under the whole curve, and dU/d(delta) at each place.
    area = (load * delta.deriv()).integ()
    change = path[-1].energy - path[0].energy
    assert area(parameters[-1]) - area(parameters[0]) == pytest.approx(change, rel=3e-6)
    inside = parameters[2:-2]
    assert np.abs(energy.deriv()(inside) / delta.deriv()(inside) / load(inside) - 1.0).max() < 1e-5
    slopes = load.deriv()(inside) / delta.deriv()(inside)
    scale = np.abs(slopes).max()
    assert np.abs([state.load_slope for state in path[2:-2]] - slopes).max() < 2e-4 * scale


@pytest.mark.parametrize("degrees", [80.0, 100.0, 170.0])
def test_a_turned_element_has_no_energy(degrees):
    """At a large Tabor number the surface beside the contact edge is steeper than vertical."""
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    state = kinematics(np.array([cosine - 1.0, -sine, 0.0, sine, cosine - 1.0]).reshape(5, 1, 1))
    assert state is not None
    assert energy(state, np.array(1.0), np.array(2.0)) == pytest.approx(np.zeros((1, 1)), abs=1e-14)


@pytest.mark.heavy
def test_the_surface_overturns_at_the_edge_of_a_soft_contact():
    """The largest tension is 1.74 E*: the surface beside the edge is no function of the radius."""
    overturned = family(sphere(5e-3, 10.0, 0.5)).state(0.0)
    assert -0.5 < overturned.faces.stretch.min() < -0.1
    assert overturned.block.core.energy(overturned.u, 1.0) < math.inf


def test_a_sphere_pulls_off_as_the_first_trial_did():
    states = family(sphere(5e-3, 2.0, 0.3), interaction="derjaguin")
    assert -found_event("pull_off", states).state.load / math.pi == pytest.approx(1.525, abs=1e-3)
    assert 2.0 * variants_of(states.discretisation)["core"].extent == states.discretisation.extent


def test_the_bound_of_a_force_is_small_and_has_its_parts():
    solution = solve_large_strain(sphere(5e-3, 0.5, 0.3), "pull_off_force")
    assert solution.u_num == pytest.approx(sum(solution.parts.values()))
    # One degree less is a part of the first one, which has another.
    assert solution.parts["mesh"] > 1.000001 * abs(solution.values[2] - solution.values[1])
    assert solution.u_num < BOUND * solution.value


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_triangles_and_an_energy_without_integration_by_parts_give_the_same_force(nu):
    """Measured: 4e-5 for nu = 0.3 and 2e-5 for nu = 0.5; the triangles are not finer than that."""
    number, mu = 5e-3, 2.0
    problem = sphere(number, mu, nu)
    modulus, z0 = problem.solid.E0, problem.law.z0
    # Stresses of an incompressible solid on its surface are those of this one, to begin with.
    law = fscm.LennardJones(1.0, z0)
    guess = fscm.profile(fscm.Problem(fscm.PowerLaw(0.91 / number, 1.0, 0.0, 0.3), fscm.Ball(1.0), law))
    square = Square(z0, modulus, nu, 0.25, float(guess.radius[np.argmin(guess.pressure)]))
    start = square.linear(lambda r: np.interp(r, guess.radius, guess.pressure))
    force = square.pull_off(start, z0 + float(guess.gap[0]), 3e-4 * z0)
    solution = solve_large_strain(problem, "pull_off_force", interaction="derjaguin")
    assert force == pytest.approx(solution.value / math.pi, rel=1e-4)


@pytest.mark.heavy
def test_forces_have_the_units_of_the_input():
    solution = solve_large_strain(sphere(5e-3, 2.0, 0.3), "pull_off_force")
    scaled = solve_large_strain(sphere(5e-3, 2.0, 0.3, unit=5e-6, pressure=1e4), "pull_off_force")
    assert scaled.value / (1e4 * 5e-6**2) == pytest.approx(solution.value, rel=1e-6)


#: Difference of the two branches where they meet (measured: 2e-8 and 3e-8 of the load, 1e-8 and 3e-8 z0).
BRANCHES = 1e-6

#: Change of jumps and hysteresis by strains of a hundredth.
LIMIT = 5e-3

#: Elasto-adhesion numbers at which the small-strain limit is measured, and the order of what finite strain changes.
NUMBERS, ORDER = (1e-7, 1e-6, 1e-5, 1e-4), 1.0 / 3.0


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_the_limit_of_small_strain_is_reached_with_the_order_of_the_strains(nu):
    """Strains are about a/R ~ (w/(E* R))^(1/3)."""
    changes = []
    for number in NUMBERS[:: 1 if nu == 0.3 else 3]:
        linear = solve(
            replace(sphere(number, 2.0, 0.3), solid=PowerLaw(0.91 / number, 1.0, 0.0, 0.3)), "pull_off_force"
        )
        solution = solve_large_strain(sphere(number, 2.0, nu), "pull_off_force", interaction="derjaguin")
        changes.append(abs(solution.value / linear.value - 1.0))
    decades = np.log10(NUMBERS[-1] / NUMBERS[0]) / (len(changes) - 1)
    orders = np.diff(np.log10(changes)) / decades
    assert np.all(np.abs(orders - ORDER) < 0.03), orders
    assert changes[0] < 6e-4


@pytest.mark.parametrize("bonded", [False, True])
def test_the_linear_response_of_a_block_is_that_of_small_strain(bonded):
    """Also where the surface beyond the mesh is bonded: with a free one there it is wrong by 1.2 % of the middle."""
    solid, spec = ScaledSolid(NeoHookean(1.0, 0.3), bonded=bonded), MeshSpec(0.25, 0.1, 4.0, 0.8, 5)
    block = block_of(spec.grid(), solid, spec.order, mixed=False)
    trace, pressure = block.trace, np.exp(-(block.trace.s**2))
    sides = 2 * (spec.order + 1)
    u, _ = linear_response(block, pressure, np.zeros((trace.functions.shape[0], sides, sides)))
    exact = compliance_for(solid, spec, 1.0).matrix @ (trace.phi.T @ (trace.weight * trace.s * pressure))
    assert u[block.radial + 1] == pytest.approx(exact, rel=0.0, abs=RESPONSE * exact[0])


@pytest.mark.heavy
def test_a_bonded_surface_of_small_strain_is_that_of_the_infinite_solid():
    """Where no point slides, a force displaces the surface as twice of it does in the infinite solid (Kelvin)."""
    number, nu = 1e-8, 0.3
    stiffer = 4 * (1 - nu) ** 2 / (3 - 4 * nu)
    bonded = solve_large_strain(sphere(number, 2.0, nu), "pull_off_force", friction="bonded")
    E = stiffer * 0.91 / number
    equivalent = Problem(PowerLaw(E, 1.0, 0.0, nu), Ball(1.0), sphere(number, 2.0, nu).law)
    free = solve(equivalent, "pull_off_force").value
    assert bonded.value == pytest.approx(free, rel=1e-3)
    # Where they slide the force is another one.
    sliding = replace(equivalent, solid=PowerLaw(0.91 / number, 1.0, 0.0, nu))
    assert abs(solve(sliding, "pull_off_force").value / free - 1.0) > 3e-3


@pytest.mark.heavy
def test_other_punches_and_graded_solids_are_solved():
    cone = sphere(2e-3, 1.0, 0.5, punch=PowerPunch(n=1.0, Q=8.0))
    assert solve_large_strain(cone, "pull_off_force").u_num < 1e-3
    law = LennardJones(1.0, 0.0146)
    stiffer_below = Problem(NeoHookean(E0=150.0, nu=0.5, k=0.5, z_s=1.0), Ball(1.0), law)
    graded = solve_large_strain(stiffer_below, "pull_off_force")
    assert graded.u_num < BOUND * graded.value
    table = Problem(OffsetPowerLaw(E0=200.0, c0=1.0, k=0.5, z_s=1.0, nu=0.3), Ball(1.0), law)
    assert solve_large_strain(table, "pull_off_force").value == pytest.approx(graded.value, rel=0.03)


def test_what_has_no_answer_is_refused():
    problem = sphere(5e-3, 2.0, 0.3)
    refused("unknown", solve_large_strain, problem, "critical_modulus")
    refused("rough", solve_large_strain, problem, "pull_off_force", friction="rough")
    refused("frictionless", solve_large_strain, problem, "pull_off_force", friction="frictionless")
    refused("hybrid", solve_large_strain, problem, "pull_off_force", form="hybrid")
    event = SimpleNamespace(radius=0.1)
    refused("incompressible", _discretisation, sphere(5e-3, 2.0, 0.5), event, "none", "displacement")
    refused("sideways", solve_large_strain, problem, "pull_off_force", interaction="sideways")
    refused("nowhere", profile_large_strain, problem, "nowhere")
    refused("z_s = -1", NeoHookean, 1.0, 0.5, 0.5, 1.0, -1.0)
    soft_surface = replace(problem, solid=PowerLaw(200.0, 1.0, 0.4, 0.3))
    refused("vanishes at the surface", solve_large_strain, soft_surface, "pull_off_force")


def test_the_reason_why_no_state_is_found_is_the_tension_at_which_a_flat_surface_is_unstable():
    """Where the law has it; a solid whose modulus changes at the surface has no such limit."""
    remedy = "take a stiffer solid or less adhesion"
    assert _reason(sphere(5e-3, 0.5, 0.3)) == remedy
    assert _reason(replace(sphere(0.02, 3.0, 0.3), solid=NeoHookean(45.5, 0.3, 0.5, 1.0, 1.0))) == remedy
    of_flat = _reason(sphere(0.02, 3.0, 0.3))
    assert "unstable from 0.548" in of_flat
    assert of_flat.endswith(remedy)


@pytest.mark.heavy
def test_a_surface_that_is_unstable_is_refused_with_this_reason():
    refused(r"unstable from 0\.548", family(sphere(0.02, 3.0, 0.3)).state, 0.0, error=NotConverged)


@pytest.mark.heavy
@pytest.mark.parametrize("quantity", ["jump_in_displacement", "jump_out_displacement", "hysteresis_energy"])
def test_jumps_of_a_hard_solid_are_those_of_small_strain(quantity):
    problem = sphere(1e-6, 2.0, 0.3)
    linear = solve(replace(problem, solid=PowerLaw(problem.solid.E0, 1.0, 0.0, 0.3)), quantity)
    assert solve_large_strain(problem, quantity).value == pytest.approx(linear.value, rel=LIMIT)


@pytest.mark.heavy
@pytest.mark.parametrize(
    ("quantity", "bound"),
    [("pull_off_displacement", 1e-4), ("jump_out_displacement", 1e-4), ("hysteresis_energy", 3e-4)],
)
def test_other_quantities_are_bounded(quantity, bound):
    problem = sphere(5e-3, 2.0, 0.5)
    solution = solve_large_strain(problem, quantity)
    finer = solve_large_strain(problem, quantity, accuracy="default")
    assert abs(solution.value - finer.value) <= solution.u_num + finer.u_num
    assert solution.u_num < bound * abs(solution.value)


@pytest.mark.heavy
@pytest.mark.parametrize(("number", "mu", "nu"), [(5e-3, 2.0, 0.5), (1e-3, 0.5, 0.3), (5e-3, 0.5, 0.5)])
def test_the_path_has_one_minimum_of_the_load(number, mu, nu):
    path = trace_large_strain(sphere(number, mu, nu))
    assert path.load[-1] > 0.0
    assert np.all(np.diff(path.central_gap) < 0.0)
    turns = np.sign(np.diff(path.load))
    assert np.count_nonzero(np.diff(turns)) == 1
    deepest = solve_large_strain(sphere(number, mu, nu), "pull_off_force")
    assert 0.0 <= deepest.value + path.load.min() < 5e-3 * deepest.value


def test_the_mesh_before_contact_is_that_of_the_spot_on_which_it_begins():
    """A rigid sphere is 0.05 z0 high at 0.038 R; what attracts extends to 0.3 R."""
    assert 0.02 < family(sphere(5e-3, 2.0, 0.3), "jump_in").event.radius < 0.038


@pytest.mark.parametrize("form", [*heavy("displacement"), "mixed"])
def test_the_bounds_of_a_state_contain_that_of_a_higher_degree(form):
    """Of the displacements alone, to which the other form is as near, and from wherever the iteration began."""
    problem = sphere(5e-3, 0.5, 0.3)
    coarse, fine = family(problem, form=form), family(problem, order=6)
    for x in (0.05, 0.03):
        fine.state(x)
    state, exact = coarse.state(0.0), fine.state(0.0)
    bounds = state_bounds(state, coarse.discretisation, coarse.event)
    for bound, name in zip(bounds, ("displacement", "load"), strict=True):
        error = abs(getattr(state, name) - getattr(exact, name))
        assert error < bound < 1e-3 * abs(getattr(state, name)), name


@pytest.mark.parametrize(("last_load", "ends"), [(1.0, True), (-1.0, False)])
def test_a_path_ends_where_no_state_is_found_under_compression_only(monkeypatch, last_load, ends):
    """The first state in contact is found, with a load of this sign, and no other."""
    problem, states = sphere(1e-3, 1.0, 0.5), []

    def state_at(linear, discretisation):
        if states and states[-1].linear.point.branch.touching:
            raise NotConverged("too large")
        gap = -float(len(states))
        state = SimpleNamespace(load=last_load, displacement=0.0, gap_at=lambda vertex: gap)
        states.append(PathState(state, linear, 0.0, 0.0))
        return states[-1]

    monkeypatch.setattr(whole_path, "_state_at", state_at)
    if ends:
        path = trace_large_strain(problem)
        assert len(path.load) == len(states)
        assert "too large" in path.end
    else:
        with pytest.raises(NotConverged, match="too large"):
            trace_large_strain(problem)


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_the_branches_of_the_path_meet(nu):
    """The first state whose mesh follows the contact edge is one of the branch that the central gap picks."""
    problem = sphere(5e-3, 2.0, nu)
    path, _ = path_states(problem, "quick", "none", lambda event: _discretisation(problem, event, "none", "auto"))
    last = max(i for i, point in enumerate(path) if math.isnan(point.edge_radius))
    after = path[last + 1].state
    same = solve_state(path[last].state, Control(0, after.gap_at(0)))
    assert same.load == pytest.approx(after.load, rel=BRANCHES)
    assert same.displacement == pytest.approx(after.displacement, abs=BRANCHES * problem.law.z0)


@pytest.mark.heavy
def test_random_bounds_contain_a_finer_solution():
    random = np.random.default_rng(7)
    for _ in range(8):
        number, nu = 10 ** random.uniform(-4, -2.3), random.choice([0.0, 0.2, 0.3, 0.4, 0.5])
        # Below the tension at which a compressible surface is unstable.
        mu = random.uniform(0.3, min(3.0, 0.33 / number ** (1 / 3)))
        problem = sphere(number, mu, nu)
        solution = solve_large_strain(problem, "pull_off_force")
        finer = solve_large_strain(problem, "pull_off_force", accuracy="default")
        case = (number, mu, nu)
        assert abs(solution.value - finer.value) <= solution.u_num + finer.u_num, case
        assert solution.u_num < BOUND * solution.value, case


@pytest.mark.heavy
@pytest.mark.parametrize(("number", "mu"), [(5e-3, 2.0), (1e-3, 3.0), (0.02, 0.5)])
def test_both_forms_agree_within_their_bounds(number, mu):
    forms = ("displacement", "mixed")
    first, second = (solve_large_strain(sphere(number, mu, 0.3), "pull_off_force", form=form) for form in forms)
    assert abs(first.value - second.value) <= first.u_num + second.u_num
