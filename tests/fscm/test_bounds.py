"""Bounds of what two meshes share: the closed tail and the tip; and refusals that name their cause."""

import pytest

from fscm import Analysis, NotConverged, Problem, solve
from fscm._meshes import Mesh, Meshes
from fscm._tail import tail_of
from fscm.laws import Mie
from fscm.punch import PowerSum


def _finer(problem: Problem, end_height: float = 1e7) -> Analysis:
    meshes = Meshes(path=Mesh(10, 2e-5), check=Mesh(8, 1e-3), value=Mesh(18, 1e-9), end_height=end_height)
    return Analysis(problem, meshes)


@pytest.mark.parametrize(
    "problem", [Problem(0.75, 0, 0.3), Problem(2, 0, 1.0, law=Mie(3, 1.5)), Problem(2, 0.5, 1.0, law=Mie(3, 1.5))]
)
def test_the_displacement_at_pull_off_does_not_depend_on_the_end_of_the_mesh(problem: Problem) -> None:
    """A tangent without the slope of the tail by delta was off by up to 40 times the bound."""
    solution = Analysis(problem).solution("pull_off_displacement")
    exact = _finer(problem).solution("pull_off_displacement").value
    assert abs(solution.value - exact) <= solution.u_num
    assert solution.u_num < 1e-10


def test_the_derivatives_of_the_tail() -> None:
    """Against central differences in the radius and in the displacement."""
    problem = Problem(1.1, 0.3, 0.8, law=Mie(3, 2))
    T, d, h = 40.0, -1.5, 1e-5
    tail = tail_of(problem, T, d)
    right, left = (tail_of(problem, T * (1 + x), d) for x in (h, -h))
    up, down = (tail_of(problem, T, d + x) for x in (h, -h))
    for name in ("load", "displacement"):
        assert getattr(tail, f"{name}_rate") == pytest.approx(
            (getattr(right, name) - getattr(left, name)) / (2 * h), rel=1e-7
        )
        assert getattr(tail, f"{name}_slope") == pytest.approx(
            (getattr(up, name) - getattr(down, name)) / (2 * h), rel=1e-7
        )


def test_a_shape_that_is_not_yet_a_power_at_the_end_of_the_mesh_is_in_the_bound() -> None:
    """r^2 - r at f = 1e6 is off its power by 1e-3; the force moved by 2e-7 with the end, u_num was 1e-12."""
    problem = Problem(2, 0.3, 0.3, punch=PowerSum([-1, 1], [1, 2]), law=Mie(3, 1.5))
    solution = Analysis(problem).solution("pull_off_force")
    error = abs(solution.value - _finer(problem, 1e10).solution("pull_off_force").value)
    assert 1e-8 < error <= solution.u_num < 1e-5


@pytest.mark.parametrize(("n", "k", "mu"), [(1.5, 0.6, 3.0), (1.25, 0.52, 1.6), (1.0, 0.5, 3.0), (2.0, 0.4, 1.0)])
def test_the_bound_of_the_gap_at_jump_in_has_a_margin(n: float, k: float, mu: float) -> None:
    """Both meshes may share the innermost panel: their difference alone had margins down to 1.09."""
    problem = Problem(n, k, mu)
    solution = Analysis(problem).solution("jump_in_gap")
    error = abs(solution.value - _finer(problem).solution("jump_in_gap").value)
    assert error < solution.u_num / 4
    assert solution.u_num < 1e-7


def test_an_edge_below_rounding_is_refused_at_once_with_the_cause() -> None:
    with pytest.raises(NotConverged, match=r"edge of .* is about 10\^-314 wide, below the rounding"):
        solve(Problem(2, 0.999, 1.0), "pull_off_force")


@pytest.mark.parametrize(("n", "k", "mu"), [(30.0, 0.0, 1.0), (30.0, 0.4, 1.0), (30.0, 0.0, 0.05), (50.0, 0.0, 1.0)])
def test_a_flat_punch_is_solved(n: float, k: float, mu: float) -> None:
    """The first mesh sees how steeply the punch rises, and each step moves its shape exactly."""
    problem = Problem(n, k, mu)
    solution = solve(problem, "pull_off_force")
    assert abs(solution.value - _finer(problem).solution("pull_off_force").value) <= solution.u_num < 1e-9
