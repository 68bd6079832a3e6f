"""Random punches with asperities, waves, flats and measured profiles, and the outcome of their paths.

`python -m tests.fscm.random_punches` adds the punches that `random_punches.csv` lacks.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fscm import CustomPunch, MeasuredPunch, Problem, solve
from fscm.punch import PunchShape
from tests.fscm.brute_force import stable_states
from tests.random_tables import complete

TABLE = Path(__file__).with_suffix(".csv")
SEED = 20261122
COUNT = 100


class RandomPunch(NamedTuple):
    """A problem, and the height of the roughness of its punch."""

    problem: Problem
    height: float


def random_punch(number: int) -> RandomPunch:
    """Problem of a number: every fifth is of one kind; heights of 0.5 to 15 z0, mu from 0.05 to 2, k from 0 to 0.6."""
    rng = np.random.default_rng([SEED, number])
    mu = float(math.exp(rng.uniform(math.log(0.05), math.log(2.0))))
    k = float(rng.choice([0.0, rng.uniform(0.0, 0.6)]))
    shape, height = _SHAPES[number % len(_SHAPES)](rng)
    return RandomPunch(Problem(2.0, k, mu, punch=shape), height)


def _height(rng: np.random.Generator) -> float:
    return float(math.exp(rng.uniform(math.log(0.5), math.log(15.0))))


def _asperity(rng: np.random.Generator) -> tuple[PunchShape, float]:
    """A bump at the center of a paraboloid."""
    h, w, R = _height(rng), rng.uniform(0.5, 3.0), math.exp(rng.uniform(0.0, math.log(20.0)))
    shape = CustomPunch(
        lambda r: -h * np.expm1(-((r / w) ** 2)) + r**2 / (2 * R),
        2.0,
        lambda r: 2 * h * r / w**2 * np.exp(-((r / w) ** 2)) + r / R,
    )
    return shape, h


def _ring(rng: np.random.Generator) -> tuple[PunchShape, float]:
    """An annular bump on a paraboloid; contact begins on it when it is higher than the paraboloid."""
    h, w, R = _height(rng), rng.uniform(0.5, 1.5), math.exp(rng.uniform(0.0, math.log(10.0)))
    c = rng.uniform(1.5, 4.0)

    def bump(r):
        x = (r**2 - c**2) / (2 * c * w)
        return h * np.exp(-(x**2)), x / (c * w)

    foot = bump(np.zeros(1))[0][0]
    shape = CustomPunch(
        lambda r: r**2 / (2 * R) - bump(r)[0] + foot,
        2.0,
        lambda r: r / R + 2 * r * bump(r)[1] * bump(r)[0],
    )
    return shape, h


def _waves(rng: np.random.Generator) -> tuple[PunchShape, float]:
    """A paraboloid with waves that fade out."""
    a, q, R = 0.5 * _height(rng), rng.uniform(0.8, 4.0), math.exp(rng.uniform(0.0, math.log(10.0)))
    a, L = min(a, 4.0), rng.uniform(4.0, 12.0)

    def fading(r):
        return np.exp(-((r / L) ** 2))

    shape = CustomPunch(
        lambda r: r**2 / (2 * R) + a * (1 - np.cos(q * r) * fading(r)),
        2.0,
        lambda r: r / R + a * fading(r) * (q * np.sin(q * r) + 2 * r / L**2 * np.cos(q * r)),
    )
    return shape, 2 * a


def _flat(rng: np.random.Generator) -> tuple[PunchShape, float]:
    """A flat of radius b that turns into a paraboloid within a width w."""
    b, w, R = rng.uniform(1.0, 5.0), rng.uniform(0.2, 1.0), math.exp(rng.uniform(0.0, math.log(10.0)))

    def bend(r):
        """s, ds/d(r^2): a smooth maximum of 0 and r^2 - b^2, less its value at the center."""
        x, width = r**2 - b**2, 2 * b * w
        root = np.hypot(x, width)
        foot = 0.5 * width**2 / (math.hypot(b**2, width) + b**2)
        return np.where(x > 0, 0.5 * (x + root), 0.5 * width**2 / (root - np.minimum(x, 0))) - foot, 0.5 * (
            1 + x / root
        )

    return CustomPunch(lambda r: bend(r)[0] / (2 * R), 2.0, lambda r: r / R * bend(r)[1]), 0.0


def _measured(rng: np.random.Generator) -> tuple[PunchShape, float]:
    """Straight segments between points of a rough paraboloid."""
    h, R, end = min(_height(rng), 5.0), math.exp(rng.uniform(0.0, math.log(10.0))), rng.uniform(4.0, 8.0)
    radii = np.linspace(0.0, end, int(rng.integers(5, 12)))
    heights = radii**2 / (2 * R) + np.append(0.0, 0.5 * h * rng.uniform(-1.0, 1.0, len(radii) - 1))
    heights[-1] = max(heights[-1], 0.5 * end**2 / (2 * R))
    return MeasuredPunch(radii, heights), h


_SHAPES = (_asperity, _ring, _waves, _flat, _measured)


def rows(number: int) -> list[dict[str, object]]:
    """Row of a punch: the force of its path, and the stable states on a fixed mesh."""
    problem, height = random_punch(number)
    states = stable_states(problem, height)
    row = {
        "number": number,
        "pull_off_force": f"{solve(problem, 'pull_off_force').value:.12g}",
        "brute_force": f"{states.pull_off_force:.6g}",
        "retreat": " ".join(f"{jump:.4f}" for jump in states.retreat),
        "approach": " ".join(f"{jump:.4f}" for jump in states.approach),
    }
    return [row]


if __name__ == "__main__":
    complete(TABLE, range(COUNT), rows)
