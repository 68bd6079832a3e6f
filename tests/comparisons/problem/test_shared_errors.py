"""Errors of the assumptions without a solution: what stands for a sphere on any solid, friction, surface tension."""

import math
from dataclasses import replace

import pytest

from comparisons.description.equivalent_ball import equivalent_ball
from comparisons.description.forces import change_of
from comparisons.description.shared_errors import TENSION, effect_of_tension, estimates
from comparisons.model import NotApplicable
from comparisons.models.fem_model import LargeStrain
from comparisons.models.fscm_model import FullSelfConsistent
from comparisons.problem import Section
from comparisons.runs.tasks import evaluate
from tests.comparisons.problems import on_solid
from tests.marks import heavy

STIFF = on_solid("homogeneous", {"E": 1e10, "nu": 0.2}, R=1e-6)
RUBBER = on_solid("homogeneous", {"E": 1.5e6, "nu": 0.3}, R=5e-6)
#: A law of so long a range that solutions take seconds: mu = 3 to 20.
LONG = Section("lennard-jones-9-3", {"work_of_adhesion": 0.02, "z0": 1e-8})


def on(kind, values, law=LONG):
    return replace(on_solid(kind, values, R=5e-6), law=law)


SOFT_FILM = on("layers", {"E": (1e6, 1e7), "nu": (0.4, 0.4), "thickness": (1e-6,)})
OFFSET = on("offset-power-law", {"E0": 2e6, "c0": 1e-6, "z_s": 1e-6, "k": 0.4, "nu": 0.4})
GRADED = on("power-law", {"E0": 2e6, "c0": 1e-6, "k": 0.4, "nu": 0.4})


def test_a_homogeneous_solid_stands_for_itself():
    ball = equivalent_ball(RUBBER)
    assert ball.softness == pytest.approx(0.05 * (1.0 - 0.3**2) / (1.5e6 * 5e-6))
    assert ball.mu == pytest.approx(ball.softness ** (2.0 / 3.0) * 5e-6 / 4e-10)
    assert equivalent_ball(RUBBER, contact_radius=1e-9) == ball


def test_layers_of_one_modulus_are_almost_a_homogeneous_solid():
    layers = on_solid("layers", {"E": (1.5e6, 1.5e6), "nu": (0.3, 0.3), "thickness": (1e-6,)}, R=5e-6)
    ball, exact = equivalent_ball(layers), equivalent_ball(RUBBER)
    assert ball.softness == pytest.approx(exact.softness, rel=1e-2)
    assert (ball.nu, ball.is_exact) == (0.3, False)
    for name in ("geometry", "derjaguin", "strain"):
        assert estimates(layers)[name]["error"] == pytest.approx(estimates(RUBBER)[name]["error"], rel=2e-2)
        assert estimates(layers)[name]["u_num"] > estimates(RUBBER)[name]["u_num"]


@pytest.mark.parametrize("problem", [GRADED, *heavy(SOFT_FILM, OFFSET)])
def test_the_paraboloid_on_a_solid_that_is_not_homogeneous_is_inside_its_uncertainty(problem):
    """Against two solutions, and the contact radius against that at pull-off."""
    exact = replace(problem, punch=Section("ball", {"R": problem.punch["R"]}))
    error, bound = change_of(*(evaluate("fscm", "pull_off_force", case) for case in (problem, exact)))
    looked_up = estimates(problem)["geometry"]
    assert looked_up["error"] == pytest.approx(error, abs=looked_up["u_num"] + bound)
    assert looked_up["u_num"] < 0.6 * error
    surface = FullSelfConsistent().pull_off_profile(problem)
    radius = float(surface.radius[int(surface.pressure.argmin())]) * problem.units["radius"]
    share = (9.0 * math.pi / 8.0 * equivalent_ball(problem).softness) ** (1.0 / 3.0)
    assert share == pytest.approx(radius / problem.punch["R"], rel=0.2)


#: Problems, contact radii in R, and relative changes of the force of the ball by its potential and by finite strain, of
#: the finite elements (bounds below 1e-5).
FILM = replace(SOFT_FILM, law=Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 8e-8}))
EXPONENTIAL = on(
    "exponential",
    {"E_surface": 1e6, "E_depth": 3e6, "length": 1e-6, "nu": 0.4},
    Section("lennard-jones-9-3", {"work_of_adhesion": 0.02, "z0": 5e-8}),
)
SOLVED = [(FILM, 0.27678, 0.022876, -0.0017365), (EXPONENTIAL, 0.18546, 0.0085060, 0.00059964)]


@pytest.mark.parametrize(("problem", "share", "area", "strain"), SOLVED)
def test_area_and_strain_on_layers_and_gradients_are_inside_their_uncertainty(problem, share, area, strain):
    errors = estimates(problem, share * problem.punch["R"])
    for name, change in (("derjaguin", area), ("strain", strain)):
        assert errors[name]["error"] == pytest.approx(-change / (1.0 + change), abs=0.5 * errors[name]["u_num"])
        assert errors[name]["u_num"] < 0.6 * area


@pytest.mark.heavy
@pytest.mark.parametrize(("problem", "share", "area", "strain"), SOLVED)
def test_the_finite_elements_have_these_changes(problem, share, area, strain):
    ball = replace(problem, punch=Section("ball", {"R": problem.punch["R"]}))
    models = ("fscm", LargeStrain("derjaguin"), LargeStrain("body"))
    small, vertical, body = (evaluate(model, "pull_off_force", ball).value for model in models)
    assert vertical / small - 1.0 == pytest.approx(strain, abs=2e-6)
    assert body / vertical - 1.0 == pytest.approx(area, abs=2e-6)
    surface = FullSelfConsistent().pull_off_profile(problem)
    radius = float(surface.radius[int(surface.pressure.argmin())]) * problem.units["radius"]
    assert radius / problem.punch["R"] == pytest.approx(share, rel=1e-2)


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"punch": Section("cone", {"half_angle": 1.2})}, "cone"),
        ({"law": Section("mie", {"work_of_adhesion": 0.02, "z0": 1e-8, "m": 8.0, "n": 4.0})}, "mie"),
        ({"solid": Section("exponential", {"E_surface": 1e2, "E_depth": 1e3, "length": 1e-6, "nu": 0.4})}, "larger"),
    ],
)
def test_no_ball_stands_for_another_punch_or_law_or_a_larger_contact(changed, reason):
    with pytest.raises(NotApplicable, match=reason):
        equivalent_ball(replace(OFFSET, **changed))


def test_without_slip_the_force_is_between_that_of_a_free_and_an_inextensible_surface():
    """The latter has (3 - 4 nu)/(4 (1 - nu)^2) of the compliance; both forces by the FSCM."""
    stiffer = replace(STIFF, solid=Section("homogeneous", {"E": 1e10 * 4.0 * 0.8**2 / 2.2, "nu": 0.2}))
    error, _ = change_of(*(evaluate("fscm", "pull_off_force", case) for case in (STIFF, stiffer)))
    friction = estimates(STIFF)["friction"]
    assert friction["error"] - friction["u_num"] == pytest.approx(error, rel=1e-4)
    assert friction["error"] + friction["u_num"] == pytest.approx(0.0, abs=1e-12)
    assert (friction["basis"], error < -1e-3) == ("estimate", True)


@pytest.mark.parametrize("mu", [3e-3, 1e3])
def test_without_slip_a_rigid_or_a_very_soft_sphere_has_the_same_force(mu):
    """Bradley's force and that of JKR do not depend on the modulus."""
    modulus = 1e9 * (on_solid("homogeneous", {"E": 1e9, "nu": 0.2}).posed.mu / mu) ** 1.5
    friction = estimates(on_solid("homogeneous", {"E": modulus, "nu": 0.2}))["friction"]
    assert friction["error"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("surface", [{}, {"surface_tension": 0.02}])
def test_an_incompressible_solid_does_not_slip(surface):
    friction = estimates(on_solid("homogeneous", {"E": 1e9, "nu": 0.5} | surface))["friction"]
    assert (friction["error"], friction["u_num"], friction["basis"]) == (0.0, 0.0, "bound")


def test_friction_of_another_solid_or_law_is_unknown():
    mie = Section("mie", {"work_of_adhesion": 0.02, "z0": 1e-8, "m": 8.0, "n": 4.0})
    for problem in (SOFT_FILM, GRADED, replace(RUBBER, law=mie)):
        assert estimates(problem)["friction"]["basis"] == "unknown"


@pytest.mark.parametrize(
    ("section", "key", "value", "name"),
    [
        ("solid", "surface_tension", 0.02, "surface_tension"),
        ("solid", "surface_tension", 0.0, "surface_tension"),
        ("solid", "friction", "bonded", "friction"),
        ("law", "interaction", "body", "derjaguin"),
    ],
)
def test_what_a_problem_states_is_no_assumption(section, key, value, name):
    ball = replace(STIFF, punch=Section("ball", STIFF.punch.values))
    part = getattr(ball, section)
    stated = replace(ball, **{section: Section(part.kind, {**part.values, key: value})})
    before, after = estimates(ball)[name], estimates(stated)[name]
    assert before["error"] != 0.0
    assert (after["error"], after["u_num"], after["basis"]) == (0.0, 0.0, "bound")


def test_the_effect_of_a_surface_tension_is_that_of_a_soft_homogeneous_solid_under_a_sphere():
    assert -0.03 < effect_of_tension(RUBBER) < -0.01
    assert "mN/m" in estimates(RUBBER)["surface_tension"]["reason"]
    for law in (RUBBER.law, replace(RUBBER.law, values={**RUBBER.law.values, "interaction": "body"})):
        ball = replace(RUBBER, punch=Section("ball", {"R": 5e-6}), law=law)
        assert effect_of_tension(ball) == effect_of_tension(RUBBER)
    for problem in (STIFF, SOFT_FILM, replace(RUBBER, punch=Section("cone", {"half_angle": 1.2}))):
        assert effect_of_tension(problem) is None
        assert estimates(problem)["surface_tension"]["error"] is None
    stated = RUBBER.with_value("solid.surface_tension", TENSION)
    assert estimates(stated)["surface_tension"]["error"] == 0.0


@pytest.mark.heavy
@pytest.mark.parametrize("kind", ["sphere", "ball"])
def test_the_effect_of_a_surface_tension_is_that_of_the_full_model(kind):
    """At a Tabor number of 18 the limit of soft solids is a fifth off; it is less for softer ones."""
    bead = on(
        "homogeneous", {"E": 1.5e6, "nu": 0.5}, Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 8e-9})
    )
    bead = replace(bead, punch=Section(kind, {"R": 5e-6}))
    forces = [
        evaluate("fscm", "pull_off_force", problem)
        for problem in (bead, bead.with_value("solid.surface_tension", TENSION))
    ]
    assert forces[1].value / forces[0].value - 1.0 == pytest.approx(effect_of_tension(bead), rel=0.25)
