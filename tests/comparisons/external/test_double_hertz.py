"""The example model against its authors' equations, two limits and a direct integration."""

import math
from importlib.util import module_from_spec, spec_from_file_location

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import beta

from comparisons.model import NotApplicable
from comparisons.models.jkr import JKR
from comparisons.models.maugis_dugdale import MaugisDugdaleOriginal
from fscm.problem import Problem

from .conftest import EXAMPLE

_spec = spec_from_file_location("double_hertz", EXAMPLE / "double_hertz.py")
double_hertz = module_from_spec(_spec)
_spec.loader.exec_module(double_hertz)
MODEL = double_hertz.DoubleHertz()

QUANTITIES = ("pull_off_force", "pull_off_displacement", "jump_out_displacement", "zero_load_displacement")


def test_homogeneous_states_satisfy_greenwood_and_johnson():
    """Their equations for P, delta, the work of adhesion and the largest tension, in tilde variables."""
    mu = 1.3
    states = double_hertz.States(Problem(2, 0, mu))
    for t in (0.0, 0.2, 1.0, 3.0):
        displacement, load = states.at(t)
        ratio = -math.expm1(-t)

        # c and K from w = 2 K (K+1) (c-a)^2 (c+2a) / (3 pi) and sigma = (2/pi) K sqrt(c^2-a^2).
        def work(c, ratio=ratio):
            a = ratio * c
            K = double_hertz.STRENGTH * mu * math.pi / (2 * math.sqrt(c**2 - a**2))
            return 2 * K * (K + 1) * (c - a) ** 2 * (c + 2 * a) / (3 * math.pi), a, K

        low, high = 1e-6, 1e6
        for _ in range(200):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if work(middle)[0] < 1 else (low, middle)
        _, a, K = work(low)
        assert displacement == pytest.approx(mu * (a**2 - K * (low**2 - a**2)), rel=1e-10)
        assert load == pytest.approx(4 / (3 * math.pi) * (a**3 - K * (low**3 - a**3)), rel=1e-10)


@pytest.mark.parametrize("k", [0.0, 0.4, 0.8])
@pytest.mark.parametrize("t", [0.1, 1.0])
def test_the_traction_does_the_work_of_adhesion_on_the_gap(k, t):
    """By quadrature of the traction over the gap, without the inversion that gave the closed form."""
    mu, s = 0.8, (1 - k) / 2
    S = math.sin(math.pi * s) / (math.pi * s)
    a, c, K = state_of(k, mu, t)

    def gap_slope(r):
        # H_a = (2/pi) cos(k pi/2) int_a^r x^k (r^2-x^2)^(s-1) (D(x)-D(a)) dx with
        # x^2 = a^2 + (r^2-a^2) y, y = 1 - v^(1/s), which takes the singularity away.
        def integrand(v):
            y = 1 - v ** (1 / s)
            x2 = a**2 + (r**2 - a**2) * y
            # H_a ~ integral of (r^2-a^2)^(1+s) x^(k-1) y dv, and its derivative with respect to r^2.
            x_k = x2 ** ((k - 1) / 2)
            return (k - 1) / 2 * x_k / x2 * y * y * (r**2 - a**2) + (1 + s) * x_k * y

        value = quad(integrand, 0, 1, epsabs=1e-13, epsrel=1e-12)[0]
        front = (2 / math.pi) * math.cos(k * math.pi / 2) / (2 * s) / (1 + k)
        return front * 2 * r * (r**2 - a**2) ** s * value

    def traction(r):
        return K * S * (c**2 - r**2) ** ((1 + k) / 2) / (1 + k) ** 2

    work = quad(lambda r: traction(r) * (1 + K) * gap_slope(r), a, c, epsrel=1e-10)[0]
    assert work == pytest.approx(1.0, rel=1e-8)
    assert traction(a) == pytest.approx(double_hertz.STRENGTH * mu, rel=1e-12)


def state_of(k, mu, t):
    """a, c and K from the displacement and load of a state: two equations for c and K at known a / c."""
    displacement, load = double_hertz.States(Problem(2, k, mu)).at(t)
    ratio, s = -math.expm1(-t), (1 - k) / 2
    S = math.sin(math.pi * s) / (math.pi * s)
    h = 2 * S / ((1 + k) ** 2 * (3 + k))
    delta = displacement / mu * (1 + k)
    assert beta(1, (1 + k) / 2) / 2 == pytest.approx(1 / (1 + k))

    def mismatch(c):
        K = (ratio**2 - delta / c**2) / (1 - ratio**2)
        return h * c ** (3 + k) * (ratio ** (3 + k) - K * (1 - ratio ** (3 + k))) - load, K

    candidates = np.geomspace(1e-3, 1e3, 4000)
    values = np.array([mismatch(c)[0] for c in candidates])
    for i in np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1])):
        low, high = candidates[i], candidates[i + 1]
        for _ in range(100):
            middle = 0.5 * (low + high)
            same = np.sign(mismatch(middle)[0]) == np.sign(mismatch(low)[0])
            low, high = (middle, high) if same else (low, middle)
        K = mismatch(low)[1]
        strength = K * S * (low**2 * (1 - ratio**2)) ** ((1 + k) / 2) / (1 + k) ** 2
        if K > 0 and strength == pytest.approx(double_hertz.STRENGTH * mu, rel=1e-6):
            return ratio * low, low, K
    raise AssertionError("no state has this displacement and load")


@pytest.mark.parametrize("k", [0.0, 0.2, 0.4, 0.8])
def test_limits(k):
    assert MODEL.evaluate(Problem(2, k, 1e-4), "pull_off_force").value == pytest.approx(2.0, rel=1e-5)
    soft = Problem(2, k, 100.0)
    for quantity in QUANTITIES:
        # The cohesive zone narrows as mu^(-2/(1-k)): at k = 0 its share at mu = 100 is 2e-5.
        ours, jkr = (model.evaluate(soft, quantity).value for model in (MODEL, JKR()))
        assert ours == pytest.approx(jkr, rel=3e-5)


@pytest.mark.parametrize("mu", [0.1, 0.5, 1.0, 2.0, 5.0])
@pytest.mark.parametrize("k", [0.0, 0.4])
def test_it_is_near_maugis_dugdale_of_the_same_strength(k, mu):
    """Two laws of one strength and one work of adhesion: at most 2 % apart."""
    ours, of_maugis_dugdale = (
        model.evaluate(Problem(2, k, mu), "pull_off_force").value for model in (MODEL, MaugisDugdaleOriginal())
    )
    assert of_maugis_dugdale < ours < 1.02 * of_maugis_dugdale


@pytest.mark.parametrize(("n", "k", "mu"), [(1, 0, 1), (2, 0.95, 1), (2, 0, 101)])
def test_beyond_its_domain_it_is_not_applicable(n, k, mu):
    with pytest.raises(NotApplicable, match="n = 2"):
        MODEL.evaluate(Problem(n, k, mu), "pull_off_force")


def test_a_rigid_contact_has_no_fold():
    with pytest.raises(NotApplicable, match="fold"):
        MODEL.evaluate(Problem(2, 0, 0.1), "jump_out_displacement")
