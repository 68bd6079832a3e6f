"""Reference values of the tests, each with its digits and its origin."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ReferenceValue:
    """One dimensionless value; `digits` decimals are believed correct."""

    quantity: str
    n: float
    k: float
    mu: float
    value: float
    digits: int
    origin: str


INTEGRAL_EQUATION = "integral equation, solved by a code that is not part of this project"

REFERENCE_VALUES = (
    ReferenceValue("pull_off_force", 2.0, 0.0, 0.1, 1.96895638, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.0, 0.5, 1.78748293, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.0, 1.0, 1.67066478, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.0, 2.0, 1.58359530, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.4, 0.5, 1.86628026, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.4, 1.0, 1.78848171, 8, INTEGRAL_EQUATION),
    ReferenceValue("pull_off_force", 2.0, 0.4, 1.4, 1.75861391, 8, INTEGRAL_EQUATION),
)
"""Of the 9-3 law; loads in pi Q^(2/n) dgamma z0^(2/n-1), lengths in z0."""

OTHER_LAWS = {
    (12.0, 4.0): ReferenceValue("pull_off_force", 2.0, 0.4, 1.0, 1.743571075, 9, "fscm with Mie(12, 4), u_num 5e-12"),
    (8.0, 2.5): ReferenceValue("pull_off_force", 2.0, 0.4, 1.0, 1.825276438, 9, "fscm with Mie(8, 2.5), u_num 4e-11"),
}
"""Of m-n laws, by their exponents."""
