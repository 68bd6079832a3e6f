"""Fits of contacts in a liquid: values of the double layer, under a law with a barrier."""

import numpy as np
import pytest

from comparisons.fitting.equilibria import by_fscm
from comparisons.fitting.fit import fit_record
from comparisons.fitting.machine import Machine
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.record import Record
from comparisons.problem import Problem, Section

#: A cantilever in N/m, and the noise of its load in N.
STIFFNESS, NOISE = 0.5, 2e-11
LAYER = {"hamaker_constant": 5e-21, "z0": 3e-10, "double_layer": 3e4, "debye_length": 1e-8}


def in_water(E, layer=LAYER["double_layer"], R=2e-6):
    solid, law = Section("homogeneous", {"E": E, "nu": 0.49}), Section("dlvo", LAYER | {"double_layer": layer})
    return Problem(solid, Section("sphere", {"R": R}), law)


def record_of(problem, largest):
    """A cycle with noise and unknown zeros."""
    rng = np.random.default_rng(20)
    machine = Machine.of(by_fscm(problem, largest, exact=True), STIFFNESS)
    position = np.linspace(machine.contact[0, 0] - 3e-8, machine.contact[0, -1], 300)
    loads = []
    for branch, (x, load) in machine.cycle().items():
        order = slice(None, None, 1 if branch == "approach" else -1)
        rising = x[order] + np.arange(x.size) * 1e-18  # a jump is two loads at one position
        loads.append(np.interp(position, rising, load[order])[order])
    load = np.concatenate(loads) + rng.normal(0.0, NOISE, 600)
    displacement = np.concatenate([position, position[::-1]]) - load / STIFFNESS
    return Record("water", displacement + 1.3e-8, load + 2e-10, np.arange(600) < 300, STIFFNESS)


@pytest.mark.parametrize(
    ("E", "R", "start", "free"),
    [
        (5e8, 2e-7, (5e8, 2e4), ["law.double_layer"]),
        pytest.param(5e6, 2e-6, (8e6, 2e4), ["solid.E", "law.double_layer"], marks=pytest.mark.heavy),
    ],
)
def test_the_double_layer_is_found(E, R, start, free):
    """A curve shows the barrier before contact, and the modulus in it."""
    true, begin = in_water(E, R=R), in_water(*start, R=R)
    fitted = fit_record(record_of(true, 1.5e-8), begin, free_keys(begin, free), baseline="constant")
    for name in free:
        value = fitted.parameters[name]
        assert value.determined
        assert abs(value.value - true[name]) < 4.0 * value.u < 0.2 * true[name]
    assert fitted.residual < 1.3 * NOISE
    # The double layer changes the load far away: that is no tilt of the instrument.
    assert not any("--baseline" in remark for remark in fitted.remarks)
