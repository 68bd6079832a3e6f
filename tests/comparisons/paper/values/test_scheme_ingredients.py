"""The ingredients of the Stieltjes scheme: neglected traction against closed forms and against the scheme itself."""

import pytest

from comparisons.paper.values.scheme_ingredients import HEIGHTS, exact_force, sampled_force, scheme_force
from comparisons.registry import create
from comparisons.runs.cases import Case


def test_what_a_stiff_cone_loses_beyond_the_domain():
    # p = -(8/3) (H0 + 1 + r)^-3 beyond r = 50, the repulsion being 1e-10 of it.
    found = exact_force(1.0, 0.4, 1e-4)
    H = found["central_gap"] + 1.0
    for height, lost in zip(HEIGHTS, found["beyond"], strict=True):
        u = height + H
        assert lost == pytest.approx(16 / 3 * (1 / u - 0.5 * H / u**2), rel=2e-4)


def test_what_a_stiff_sphere_loses_beyond_the_domain():
    found = exact_force(2.0, 0.2, 1e-4)
    for height, lost in zip(HEIGHTS, found["beyond"], strict=True):
        assert lost == pytest.approx(8 / 3 / (height + 1.0 + found["central_gap"]) ** 2, rel=2e-4)


@pytest.mark.parametrize(("n", "mu"), [(1.0, 0.236), (2.0, 0.668)])
def test_the_scheme_tends_to_the_converged_force_without_what_is_beyond(n, mu):
    """Two routes to the truncated force: the exact one without a part, and the sums of the scheme."""
    found = exact_force(n, 0.4, mu)
    truncated = found["force"] - found["beyond"][0]
    errors = []
    for segments in (300, 600):
        errors.append(scheme_force(n, 0.4, mu, segments)["force"] - truncated)
    # Second order: what is left after extrapolation is a small part of the error of the finer mesh.
    assert abs(errors[1] + (errors[1] - errors[0]) / 3) < 0.15 * abs(errors[1]) + 1e-5
    assert 3.0 < errors[0] / errors[1] < 5.0
    assert abs(errors[1]) < 0.1 * found["beyond"][0] + 1e-3


@pytest.mark.heavy
def test_the_scheme_is_its_own_model():
    """The stationary load found from the accurate surface is that of the path followed from afar."""
    followed = create("fscm-stieltjes-400").evaluate(Case(2.0, 0.4, 0.5).problem(), "pull_off_force").value
    direct = scheme_force(2.0, 0.4, 0.5, segments=400)
    assert direct["force"] == pytest.approx(followed, abs=direct["u_num"] + 1e-7)


@pytest.mark.heavy
def test_samples_of_the_central_gap_miss_the_largest_force():
    force = exact_force(5.0, 0.4, 0.836)["force"]
    found = sampled_force(5.0, 0.4, 0.836)
    lost = [force - sample for sample in found["sampled"]]
    assert min(lost) > 0.0
    # Gaps 0.1 apart lose a tenth; those 0.001 apart almost nothing.
    assert lost[0] > 0.1 * force
    assert lost[-1] < 3e-5 * force
    # The pull-off is before the last gap here, and beyond it for a cone on a stiff solid.
    assert found["at_last_gap"] == force
    assert sampled_force(1.0, 0.4, 0.1)["at_last_gap"] < exact_force(1.0, 0.4, 0.1)["force"] - 0.05
