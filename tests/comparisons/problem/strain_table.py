"""Table of `comparisons.description.strain_errors`: `python -m tests.comparisons.problem.strain_table` prints it."""

import csv
import itertools
import math
import sys

from comparisons.description.strain_errors import POISSON_RATIOS, SOFTNESS, ball_on
from comparisons.runs.tasks import evaluate

TABOR_NUMBERS = (0.1, 0.3, 1.0, 2.0, 3.0, 5.0)
#: Largest tension w/z0 in E* that is tried: from about 0.4 the surface is unstable.
LARGEST_TENSION = 0.5


def forces_of_a_ball(softness, mu, nu):
    """Pull-off force of a ball with finite strain, by `fem-large-strain`, and with small strain, by `fscm`."""
    problem = ball_on(softness, mu, nu)
    return [evaluate(model, "pull_off_force", problem) for model in ("fem-large-strain", "fscm")]


def main():
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(("elasto_adhesion_number", "mu", "nu", "pull_off_force", "u_num", "linear_force", "linear_u_num"))
    for softness, mu, nu in itertools.product(SOFTNESS, TABOR_NUMBERS, POISSON_RATIOS):
        if math.sqrt(mu**3 * softness) <= LARGEST_TENSION:
            numbers = [f"{softness:g}", f"{mu:g}", f"{nu:g}"]
            for force in forces_of_a_ball(softness, mu, nu):
                failed = force.value is None
                numbers += ["", ""] if failed else [repr(force.value / math.pi), f"{force.u_num / math.pi:.2g}"]
            writer.writerow(numbers)
            sys.stdout.flush()


if __name__ == "__main__":
    main()
