"""Comparison of the two references on one problem."""

import fem_reference
import fscm


def agreeing(posed, quantities=("pull_off_force",), accuracy="default"):
    """Solutions by both, by quantity, whose differences are checked against the sum of both bounds.

    `posed` makes the problem with the classes of a package; `accuracy` is that of the finite elements.
    """
    integral = fscm.solve_together(posed(fscm), quantities)
    elements = fem_reference.solve_together(posed(fem_reference), quantities, accuracy)
    pairs = {name: (integral[name], elements[name]) for name in quantities}
    for name, (of_integral, of_elements) in pairs.items():
        exists = isinstance(of_integral, fscm.Solution)
        assert isinstance(of_elements, fem_reference.Solution) == exists, name
        if exists:
            assert abs(of_integral.value - of_elements.value) <= of_integral.u_num + of_elements.u_num, name
    return pairs
