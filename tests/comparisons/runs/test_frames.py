"""Tables of rows: one order whatever the order of the rows."""

import random

from comparisons.runs.frames import curve_frame, frame
from tests.comparisons.rows import row

NUMBERS = {"size": 7, "iterations": 3, "residual": 1e-12, "seconds": 0.1}
NOTHING = {"value": None, "u_num": None, "size": None, "iterations": None, "residual": None, "seconds": 0.25}
POISSON_RATIOS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.45)
#: A sort that does not keep the order of equal keys shows it from 17 rows on.
POINTS = 200


def _row(quantity="pull_off_force", nu=None, **more):
    return row("fem", quantity, nu=nu, **more)


def _shuffled(rows, seed):
    return random.Random(seed).sample(rows, len(rows))


def test_rows_that_differ_in_the_poisson_ratio_alone_have_one_order():
    rows = [_row(nu=nu, value=1.0 + nu, u_num=1e-9, **NUMBERS) for nu in POISSON_RATIOS]
    for seed in range(5):
        assert frame(_shuffled(rows, seed))["nu"].tolist() == list(POISSON_RATIOS)


def _curves():
    return [
        _row(
            "force_curve",
            nu,
            **NOTHING,
            points=([float(x) for x in range(POINTS)], [nu * x for x in range(POINTS)], 0.1),
        )
        for nu in POISSON_RATIOS
    ]


def test_the_points_of_a_curve_stay_in_their_order():
    for seed in range(3):
        table = curve_frame(_shuffled(_curves(), seed))
        assert table["nu"].tolist() == [nu for nu in POISSON_RATIOS for _ in range(POINTS)]
        assert table["point"].tolist() == list(range(POINTS)) * len(POISSON_RATIOS)
        assert table["x"].tolist() == table["point"].tolist()
