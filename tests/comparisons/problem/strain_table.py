"""Table of `comparisons.description.strain_errors`: `python -m tests.comparisons.problem.strain_table` prints it."""

import csv
import itertools
import math
import sys

from comparisons.description.strain_errors import POISSON_RATIOS, SOFTNESS, ball_on
from comparisons.models.fem_model import LargeStrain
from comparisons.runs.tasks import evaluate

TABOR_NUMBERS = (0.1, 0.3, 1.0, 2.0, 3.0, 5.0)
#: Rows of compressible solids with the force of the body: w/(E* R) and the Tabor number.
OF_BODIES = ((1e-5, 2.0), (1e-3, 1.0), (1e-3, 2.0), (5e-3, 1.0), (2e-2, 0.3), (5e-2, 1.0))
#: Largest tension w/z0 in E* that is tried where the solid is compressible: from about 0.4 the surface is unstable.
LARGEST_TENSION = 0.5
COLUMNS = ("body_force", "body_u_num", "vertical_force", "vertical_u_num", "linear_force", "linear_u_num")


def forces_of_a_ball(softness, mu, nu, with_body=True):
    """Pull-off force of a ball with its potential, with finite strain and vertical gaps, and with small strain."""
    problem = ball_on(softness, mu, nu)
    models = (LargeStrain("body") if with_body else None, LargeStrain("derjaguin"), "fscm")
    return [model and evaluate(model, "pull_off_force", problem) for model in models]


def cases():
    """The numbers of each row."""
    for softness, mu, nu in itertools.product(SOFTNESS, TABOR_NUMBERS, POISSON_RATIOS):
        if math.sqrt(mu**3 * softness) <= LARGEST_TENSION:
            yield softness, mu, nu


def main():
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(("elasto_adhesion_number", "mu", "nu", *COLUMNS))
    for softness, mu, nu in cases():
        numbers = [f"{softness:g}", f"{mu:g}", f"{nu:g}"]
        for force in forces_of_a_ball(softness, mu, nu, nu == POISSON_RATIOS[-1] or (softness, mu) in OF_BODIES):
            missing = force is None or force.value is None
            numbers += ["", ""] if missing else [repr(force.value / math.pi), f"{force.u_num / math.pi:.2g}"]
        writer.writerow(numbers)
        sys.stdout.flush()


if __name__ == "__main__":
    main()
