"""Table of reference values: numbers that were not computed by the code under test."""

from typing import NamedTuple


class ReferenceValue(NamedTuple):
    """One number: dimensionless, with so many digits after the point, and where it comes from."""

    quantity: str
    n: float
    k: float
    mu: float
    value: float
    digits: int
    origin: str

    @property
    def last_digit(self) -> float:
        """Unit of the last digit."""
        return 10.0**-self.digits

    def __str__(self) -> str:
        return f"{self.quantity} n={self.n:g} k={self.k:g} mu={self.mu:g}"


RING_CODE = "tests/fscm/ring_code.py, reproduced by tests/fscm/test_ring_code.py"
_ELEMENTS = "the finite elements of fem_reference"

REFERENCE_VALUES = (
    ReferenceValue("pull_off_force", 2.0, 0.0, 0.1, 1.96895638, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.0, 0.5, 1.78748293, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.0, 1.0, 1.67066478, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.0, 2.0, 1.58359530, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.4, 0.5, 1.86628026, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.4, 1.0, 1.78848171, 8, RING_CODE),
    ReferenceValue("pull_off_force", 2.0, 0.4, 1.4, 1.75861391, 8, RING_CODE),
    # Behind the jump-in the path runs flat through more folds.
    ReferenceValue("jump_in_displacement", 2.0, 0.6, 3.0, -3.32872, 5, _ELEMENTS),
    ReferenceValue("jump_in_gap", 2.0, 0.6, 3.0, 1.83784, 5, _ELEMENTS),
    ReferenceValue("jump_in_displacement", 5.0, 0.4, 3.0, -3.51597, 5, _ELEMENTS),
    ReferenceValue("jump_in_gap", 5.0, 0.4, 3.0, 2.07692, 5, _ELEMENTS),
    # The committed values of results/baseline/quick.csv, whose bounds are below 1e-7.
    ReferenceValue("pull_off_displacement", 2.0, 0.4, 0.5, -0.207304, 6, _ELEMENTS),
    ReferenceValue("zero_load_displacement", 2.0, 0.4, 0.5, 1.094981, 6, _ELEMENTS),
    ReferenceValue("jump_out_displacement", 2.0, 0.4, 1.0, -1.61734, 5, _ELEMENTS),
    ReferenceValue("jump_out_gap", 2.0, 0.4, 1.0, 0.103078, 6, _ELEMENTS),
    ReferenceValue("hysteresis_energy", 2.0, 0.4, 1.0, 0.023488, 6, _ELEMENTS),
    ReferenceValue("critical_tabor_number", 2.0, 0.4, 1.0, 0.782473, 6, _ELEMENTS),
)
