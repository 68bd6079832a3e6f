"""Values of both references with the rounding parts of their bounds, computed in a process of its own.

``python -m tests.solvers.under_kernel NAME...`` prints those of some problems as JSON.
"""

import json
import subprocess
import sys
from functools import cache

import fem_reference
import fscm
from tests.blas.kernels import ROOT, environment


def _power_law(n: float, k: float, mu: float):
    """The problem of a Tabor number, near enough: E* is that of Eq. 29 but for a constant of k."""

    def posed(package):
        solid = package.PowerLaw(0.91 * mu ** (-(2 * n + k - 1) / n), 1.0, k, 0.3)
        return package.Problem(solid, package.PowerPunch(n, 1.0), package.LennardJones(1.0, 1.0))

    return posed


def _coated(package):
    solid = package.Coating(10.0, 1.0, 1.0, 0.0, 0.3)
    return package.Problem(solid, package.PowerPunch(2.0, 1.0), package.LennardJones(1.0, 1.0))


PROBLEMS = {
    "graded": _power_law(2.0, 0.4, 1.0),
    "cone": _power_law(1.0, 0.2, 1.5),
    "steep": _power_law(5.0, 0.6, 2.0),
    "nearly homogeneous": _power_law(3.0, 0.02, 1.2),
    "soft": _power_law(2.0, 0.0, 300.0),
    "coated": _coated,
}

QUANTITIES = ("pull_off_force", "pull_off_displacement", "zero_load_displacement", "jump_out_displacement")


def values(names):
    """Value and rounding part by package, problem and quantity, as lists."""
    table = []
    for package in (fscm, fem_reference):
        accuracy = {"accuracy": "quick"} if package is fem_reference else {}
        for name in names:
            solutions = package.solve_together(PROBLEMS[name](package), QUANTITIES, **accuracy)
            for quantity, solution in solutions.items():
                if isinstance(solution, package.Solution):
                    table.append([[package.__name__, name, quantity], [solution.value, solution.parts["rounding"]]])
    return table


@cache
def values_under(kernel, names):
    """The same from a process with a kernel of the BLAS, as a dictionary."""
    command = [sys.executable, "-m", "tests.solvers.under_kernel", *names]
    run = subprocess.run(command, cwd=ROOT, env=environment(kernel), capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return {tuple(key): tuple(pair) for key, pair in json.loads(run.stdout)}


if __name__ == "__main__":
    print(json.dumps(values(sys.argv[1:])))
