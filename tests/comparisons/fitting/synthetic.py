"""Records that a machine would make of known contacts: noise, unknown zeros, drift; equilibria by a solver."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

import fscm
from comparisons.fitting.record import Record
from comparisons.models.jkr import JKR
from comparisons.problem import Problem, Section


def contact(E, work, R=200e-9, k=0.0, nu=0.3, z0=0.4e-9):
    """A sphere on a solid whose modulus is E at the depth of 1 nm."""
    solid = Section("power-law", {"E0": E, "c0": 1e-9, "k": k, "nu": nu})
    law = Section("lennard-jones-9-3", {"work_of_adhesion": work, "z0": z0})
    return Problem(solid, Section("sphere", {"R": R}), law)


def of_tabor_number(mu, k=0.0, work=0.05, R=200e-9, z0=0.4e-9):
    """A contact of a Tabor number: it is a power of the modulus."""
    logs = [np.log(contact(E, work, R, k, z0=z0).posed.mu) for E in (1e8, 1e9)]
    E = 1e8 * 10.0 ** ((np.log(mu) - logs[0]) / (logs[1] - logs[0]))
    return contact(float(E), work, R, k, z0=z0)


@dataclass(frozen=True)
class Instrument:
    """Noise as a share of the pull-off force, points of each branch, and the drift as a share of the range."""

    noise: float = 0.02
    points: int = 300
    drift: float = 0.0
    largest: float = 1.5

    def record(self, problem, rng, name="synthetic", cycle=None):
        """A cycle of approach and retreat at a prescribed displacement."""
        loading, unloading, force, begin = cycle or self.cycle(problem)
        end = min(loading[0].max(), unloading[0].max())
        x = np.linspace(begin, end, self.points)
        load = np.concatenate([_at(x, loading), _at(x, unloading)[::-1]])
        displacement = np.concatenate([x, x[::-1]])
        time = np.linspace(-0.5, 0.5, 2 * self.points)
        span = np.ptp(x)
        displacement += span * (self.drift * time + rng.uniform(-1.0, 1.0))
        load += force * (self.noise * rng.normal(size=load.size) + rng.uniform(-0.5, 0.5))
        return Record(name, displacement, load, np.arange(2 * self.points) < self.points)

    def cycle(self, problem):
        """Loading and unloading, the pull-off force, and where the approach begins.

        By the FSCM; beyond a Tabor number of 300 by JKR, whose force is within 2e-5, and which snaps in at zero.
        """
        if problem.posed.mu > 300.0:
            model = JKR()
            curve = model.curve_to(problem, self.largest * model.pull_off_force(problem).value)
            (x, load), lowest = (curve.displacement, curve.load), int(np.argmin(curve.displacement))
            scale, force, begin = -x[lowest], -load.min(), 3.0 * x[lowest]
            touching = np.interp(0.0, x[lowest:], load[lowest:])
            later = x > 0.0
            loading = np.array([[begin, 0.0, 0.0, *x[later]], [0.0, 0.0, touching, *load[later]]])
            unloading = np.array([[begin, -scale, *x[lowest:]], [0.0, 0.0, *load[lowest:]]])
            units = np.array([[problem.units["displacement"]], [problem.units["load"]]])
            return loading * units, unloading * units, force * units[1, 0], begin * units[0, 0]
        posed = problem.build(fscm)
        force = fscm.solve(posed, "pull_off_force", "quick").value
        path = smooth(fscm.trace(posed, "quick", max_load=self.largest * force, longest_step=0.1))
        cycle = fscm.displacement_cycle(path)
        loading, unloading = cycle.loading, cycle.unloading[:, ::-1]
        left = unloading[0, np.argmin(unloading[1])] if cycle.jump_out is None else cycle.jump_out[0, 0]
        reach = 10.0 * problem.law["z0"] + 0.3 * (loading[0].max() - left)
        return loading, unloading, force, max(left - reach, path.displacement.min())


def smooth(path):
    """The path with points between its states by a spline: a polygon is a thousandth of the force inside the curve."""
    curve = np.array([path.displacement, path.load])
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*(np.diff(curve) / np.ptp(curve, axis=1)[:, None])))])
    kept = np.concatenate([[True], np.diff(length) > 1e-9])
    between = np.interp(np.arange(0.0, kept.sum() - 0.95, 0.1), np.arange(kept.sum()), length[kept])
    displacement, load = CubicSpline(length[kept], curve[:, kept].T)(between).T
    return replace(path, displacement=displacement, load=load, stable_under_displacement=np.ones(load.size, bool))


def _at(x, curve):
    """Loads at displacements of a curve that rises, with two columns of one displacement at a jump."""
    rising = curve[0] + np.arange(curve.shape[1]) * 1e-9 * np.ptp(curve[0]) / curve.shape[1]
    return np.interp(x, rising, curve[1])


def wrong(problem, factor):
    """The file of a user who does not know the values: work of adhesion and modulus are wrong by a factor."""
    solid = replace(problem.solid, values={**problem.solid.values, "E0": factor * problem.solid["E0"]})
    law = replace(
        problem.law, values={**problem.law.values, "work_of_adhesion": problem.law["work_of_adhesion"] / factor}
    )
    return Problem(solid, problem.punch, law)
