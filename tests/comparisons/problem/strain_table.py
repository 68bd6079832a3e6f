"""Table of `comparisons.description.strain_errors`: `python -m tests.comparisons.problem.strain_table` prints it."""

import csv
import itertools
import math
import sys

from comparisons.description.strain_errors import POISSON_RATIOS, SOFTNESS, ball_on, rigid_changes
from comparisons.models.fem_model import LargeStrain
from comparisons.problem import Problem
from comparisons.runs.tasks import evaluate

TABOR_NUMBERS = (0.1, 0.3, 1.0, 2.0, 3.0, 5.0)
#: Rows of compressible solids with the force of the body: w/(E* R) and the Tabor number.
OF_BODIES = ((1e-5, 2.0), (1e-3, 1.0), (1e-3, 2.0), (5e-3, 1.0), (2e-2, 0.3), (5e-2, 1.0))
#: Largest tension w/z0 in E* that is tried: from about 0.4 the surface of a compressible solid is unstable.
LARGEST_TENSION, OF_INCOMPRESSIBLE = 0.5, 0.8
#: Larger Tabor numbers, at which a force of finite strain takes one to two minutes of CPU: w/(E* R) -> Poisson's ratios
#: with such a force, and those of them with the force of the body.
LARGER = {
    10.0: {1e-5: (POISSON_RATIOS, ()), 1e-4: ((0.35, 0.5), (0.5,)), 1e-3: ((0.5,), (0.5,)), 5e-3: ((0.5,), (0.5,))},
    30.0: {1e-5: ((0.5,), ()), 1e-4: ((0.5,), (0.5,)), 1e-3: ((0.5,), (0.5,))},
}
COLUMNS = ("body", "vertical", "linear", "paraboloid")


def forces_of_a_ball(softness, mu, nu, with_strain=True, with_body=True):
    """Pull-off force of a ball with its potential, with finite strain and vertical gaps, and with small strain."""
    problem = ball_on(softness, mu, nu)
    body, vertical = LargeStrain("body") if with_body else None, LargeStrain("derjaguin") if with_strain else None
    return [model and evaluate(model, "pull_off_force", problem) for model in (body, vertical, "fscm")]


def cases():
    """The numbers of each row, whether it has a force of finite strain, and one with the potential of the ball."""
    for softness, mu, nu in itertools.product(SOFTNESS, TABOR_NUMBERS, POISSON_RATIOS):
        if math.sqrt(mu**3 * softness) <= (OF_INCOMPRESSIBLE if nu == POISSON_RATIOS[-1] else LARGEST_TENSION):
            yield softness, mu, nu, True, nu == POISSON_RATIOS[-1] or (softness, mu) in OF_BODIES
    for mu, softness in itertools.product(LARGER, SOFTNESS):
        ratios, of_bodies = LARGER[mu].get(softness, ((), ()))
        for nu in ratios or POISSON_RATIOS[-1:]:
            yield softness, mu, nu, nu in ratios, nu in of_bodies


def main():
    writer = csv.writer(sys.stdout, lineterminator="\n")
    columns = [f"{name}_{value}" for name in COLUMNS for value in ("force", "u_num")]
    writer.writerow(("elasto_adhesion_number", "mu", "nu", *columns, "rigid_shape", "rigid_body"))
    for softness, mu, nu, with_strain, with_body in cases():
        numbers = [f"{softness:g}", f"{mu:g}", f"{nu:g}"]
        for force in forces_of_a_ball(softness, mu, nu, with_strain, with_body):
            missing = force is None or force.value is None
            numbers += ["", ""] if missing else [repr(force.value / math.pi), f"{force.u_num / math.pi:.2g}"]
        paraboloid = evaluate("fscm", "pull_off_force", Problem.dimensionless(2.0, 0.0, mu))
        numbers += [repr(paraboloid.value), f"{paraboloid.u_num:.2g}"]
        rigid = rigid_changes(math.cbrt(softness) ** 2 / mu)
        writer.writerow([*numbers, *(f"{change:.10g}" for change in rigid)])
        sys.stdout.flush()


if __name__ == "__main__":
    main()
