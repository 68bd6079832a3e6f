"""Surface compliance of graded solids against layers, an exact power law and 40-digit values."""

import numpy as np
import pytest
import scipy

from fscm import Coating, CustomSolid, Exponential, OffsetPowerLaw, TabulatedModulus
from fscm._response_factor import response_factor
from fscm.errors import NotConverged
from fscm.graded.compliance import compliance
from tests.fscm import graded_digits

XI = np.geomspace(1e-4, 1e4, 25)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_a_homogeneous_solid_has_its_compliance_at_every_wave_number(nu):
    for solid in (
        Exponential(3.0, 3.0, 1.0, nu),
        Coating(3.0, 3.0, 1.0, 0.0, nu),
        OffsetPowerLaw(3.0, 1.0, 0.0, 1.0, nu),
    ):
        # 1e-12: rounding of some hundred steps
        assert np.allclose(compliance(solid, XI), 2.0 * (1.0 - nu**2) / 3.0, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("k", [0.2, 0.4, 0.8])
def test_the_offset_power_law_tends_to_the_exact_power_law(k):
    nu, z_s = 0.3, 1e-10
    b = response_factor(k, nu)
    front = (
        2.0 * b * (1.0 - nu**2) * 2.0**-k * scipy.special.gamma((1.0 - k) / 2.0) / scipy.special.gamma((1.0 + k) / 2.0)
    )
    xi = np.array([0.1, 1.0, 10.0])
    # What the offset changes is of the order (xi z_s)^(1-k).
    limit = 10.0 * (xi * z_s) ** (1.0 - k) + 1e-11
    assert np.all(np.abs(compliance(OffsetPowerLaw(1.0, 1.0, k, z_s, nu), xi) / (front * xi**k) - 1.0) < limit)


def transfer(xi, ends, moduli, nu):
    """xi C of homogeneous layers, from matrix exponentials."""

    def system(E):
        G, lam = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
        L = lam + 2 * G
        return np.array(
            [[0, 1, 1 / G, 0], [-lam / L, 0, 0, 1 / L], [L - lam**2 / L, 0, 0, lam / L], [0, 0, -1, 0]], float
        )

    # The decaying solutions of the last layer: an ordered Schur form, as the eigenvalues are double.
    _, vectors, _ = scipy.linalg.schur(system(moduli[-1]), sort="lhp")
    basis = vectors[:, :2]
    for E, top, bottom in zip(moduli[-2::-1], ends[-2::-1], ends[:0:-1], strict=True):
        basis = scipy.linalg.expm(-system(E) * xi * (bottom - top)) @ basis
        basis = np.linalg.qr(basis)[0]
    return -(basis[:2] @ np.linalg.inv(basis[2:]))[1, 1]


def test_sharp_layers_agree_with_matrix_exponentials():
    rng = np.random.default_rng(4)
    ends = np.append(0.0, np.sort(rng.uniform(0.0, 3.0, 6)))
    moduli = rng.uniform(0.2, 5.0, 7)
    solid = CustomSolid(lambda z: moduli[np.searchsorted(ends[1:], z, side="right")], 0.3, 1.0, ends[1:])
    for xi in (0.05, 0.5, 2.0, 8.0):
        assert compliance(solid, np.array([xi]))[0] == pytest.approx(transfer(xi, ends, moduli, 0.3), rel=1e-11)


@pytest.mark.parametrize(
    "solid",
    [OffsetPowerLaw(1.0, 1.0, 0.4, 1.0, 0.3), Exponential(4.0, 1.0, 1.0, 0.3), Coating(5.0, 1.0, 1.0, 0.2, 0.3)],
)
def test_a_stack_of_200_layers_converges_to_the_graded_solid(solid):
    for xi in (0.3, 1.0, 3.0):
        errors = []
        for count in (100, 200):
            ends = np.append(0.0, np.geomspace(0.02, 60.0, count))
            moduli = solid.modulus(np.append(0.5 * (ends[1:] + ends[:-1]), ends[-1]))
            errors.append(transfer(xi, ends, moduli, 0.3))
        exact = compliance(solid, np.array([xi]))[0]
        # The error of midpoint layers falls with the square of their number; the grid is the coarse one of 100.
        assert abs(errors[1] / exact - 1.0) < 3e-4
        assert abs((4.0 * errors[1] - errors[0]) / 3.0 / exact - 1.0) < 0.2 * abs(errors[1] / exact - 1.0)


#: Digits of a Taylor series of the equations in z with 40 digits, which those of `graded_digits` have to give as well.
EXPONENTIAL_DIGITS = "0.385506390419146"


def test_one_exponential_agrees_with_40_digits():
    solid = Exponential(1.0, 9.0, 1.0, 0.3)
    assert compliance(solid, np.array([1.0]))[0] == pytest.approx(float(EXPONENTIAL_DIGITS), rel=1e-13)
    # Of the double nearest to 0.3.
    exact = 2.0 * (1.0 - 0.3**2) * graded_digits.relative_compliance(solid, 1.0)
    assert float(exact) == pytest.approx(float(EXPONENTIAL_DIGITS), rel=1e-14)


def test_tabulated_modulus_is_its_interpolant():
    solid = TabulatedModulus([0.0, 1.0, 2.0, 5.0], [1.0, 3.0, 4.0, 10.0], 0.3)
    same = CustomSolid(solid.modulus, 0.3, 1.0, [1.0, 2.0, 5.0])
    assert np.array_equal(compliance(solid, XI), compliance(same, XI))


def test_half_the_steps_change_nothing():
    for solid in (Coating(10.0, 1.0, 1.0, 0.05, 0.3, 0.5), OffsetPowerLaw(1.0, 1.0, 0.8, 1.0, 0.3)):
        assert np.allclose(compliance(solid, XI), compliance(solid, XI, 2), rtol=1e-12, atol=0.0)


def test_a_jump_that_is_no_interface_is_refused():
    solid = CustomSolid(lambda z: np.where(z < 1.0, 1.0, 2.0), 0.3, 1.0)
    with pytest.raises(NotConverged, match="jumps near the depth 1"):
        compliance(solid, np.array([1.0]))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: OffsetPowerLaw(1.0, 1.0, 1.0, 1.0, 0.3), r"k = 1.0 is outside \[0, 1\)"),
        (lambda: OffsetPowerLaw(1.0, 1.0, 0.4, 0.0, 0.3), r"z_s = 0.0 is outside \(0, inf\)"),
        (lambda: Exponential(-1.0, 1.0, 1.0, 0.3), r"E_surface = -1.0 is outside \(0, inf\)"),
        (lambda: Coating(1.0, 1.0, 1.0, -1.0, 0.3), r"transition = -1.0 is outside \[0, inf\)"),
        (lambda: Coating(1.0, 1.0, 1.0, 0.0, 0.6), r"nu_coating = 0.6 is outside \[0, 0.5\]"),
        (lambda: TabulatedModulus([0.0], [1.0], 0.3), "no table"),
        (lambda: TabulatedModulus([0.0, 2.0, 1.0], [1.0, 1.0, 1.0], 0.3), r"depths\[2\] = 1 is not above"),
        (lambda: TabulatedModulus([0.0, 1.0], [1.0, float("nan")], 0.3), r"moduli\[1\] = nan is outside"),
        (lambda: CustomSolid(lambda z: z, 0.3, 1.0), "modulus = 0 at the depth 0 is outside"),
        (lambda: CustomSolid(lambda z: 1.0, 0.3, 1.0), "function of an array"),
    ],
)
def test_bad_input_is_one_sentence(make, message):
    with pytest.raises(ValueError, match=message):
        make()
