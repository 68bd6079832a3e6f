"""Records that violate the model on purpose: how often the stated intervals hold, and how often something is said.

``python -m tests.comparisons.fitting.other_physics 25`` fits that many records of each kind and prints the shares.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from comparisons.fitting.equilibria import Equilibria
from comparisons.fitting.fit import Fit
from comparisons.fitting.machine import Machine
from comparisons.fitting.record import Record
from comparisons.models.cohesive_models import MaugisDugdaleImproved
from comparisons.problem import Problem, Section

from .synthetic import Instrument, of_tabor_number, wrong

Made = tuple[Problem, Record]

#: Words of the remarks on evidence against the model, or on what was added to it.
FLAGS = ("snapped together", "parted", "alone gives", "keep their sign", "does not describe", "linear")

#: Standard uncertainties from which on a value is called wrong.
_WRONG = 3.0


def _instrument(rng: np.random.Generator) -> Instrument:
    return Instrument(10.0 ** rng.uniform(-2.3, -1.5), int(rng.integers(150, 400)), 0.0, 10.0 ** rng.uniform(0.0, 0.7))


def _ordinary(rng: np.random.Generator, low: float = 0.0, high: float = 4.0) -> Made:
    problem = of_tabor_number(10.0 ** rng.uniform(low, high))
    return problem, _instrument(rng).record(problem, rng)


def _cycle(displacement: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Loading and unloading of a path under a prescribed displacement, its pull-off force, and where it begins."""
    machine = Machine.of(Equilibria(displacement, load), np.inf)
    far, touching = machine.far, machine.contact
    loading = np.column_stack([far, touching[:, touching[0] > far[0, -1]]])
    unloading = np.column_stack([far[:, far[0] < touching[0, 0]], touching])
    reach = 0.3 * (loading[0].max() - unloading[0, np.argmin(unloading[1])])
    return loading, unloading, -float(load.min()), max(float(touching[0, 0]) - reach, float(displacement.min()))


def jkr_with_a_snap_of_its_own(rng: np.random.Generator) -> Made:
    """A soft solid whose approach snaps in anywhere between contact and twice the length of its neck."""
    problem = of_tabor_number(10.0 ** rng.uniform(2.6, 4.0))
    instrument = _instrument(rng)
    _, unloading, force, begin = instrument.cycle(problem)
    snap = rng.uniform(0.0, 2.0) * unloading[0, 1]
    touching = unloading[:, unloading[0] > max(snap, unloading[0, 2])]
    before = np.array([[begin, snap], [0.0, 0.0]])
    return problem, instrument.record(problem, rng, cycle=(np.hstack([before, touching]), unloading, force, begin))


def another_law(rng: np.random.Generator) -> Made:
    """Atoms with a 12-6 or a 6-2 law, fitted with 9-3."""
    problem = of_tabor_number(10.0 ** rng.uniform(-0.5, 1.5))
    m, n = [(12.0, 6.0), (6.0, 2.0)][int(rng.integers(2))]
    true = replace(problem, law=Section("mie", {**problem.law.values, "m": m, "n": n}))
    instrument = _instrument(rng)
    return problem, instrument.record(problem, rng, cycle=instrument.cycle(true))


def maugis_dugdale(rng: np.random.Generator) -> Made:
    """A constant cohesive stress."""
    problem = of_tabor_number(10.0 ** rng.uniform(0.0, 1.3))
    curve = MaugisDugdaleImproved().force_curve(problem)
    # Before the contact has a radius the tension grows with the approach over the range of the stress, about z0.
    begin = float(curve.displacement[0])
    displacement = np.concatenate([[3.0 * begin, begin - 1.0], curve.displacement]) * problem.units["displacement"]
    load = np.concatenate([[0.0, 0.0], curve.load]) * problem.units["load"]
    return problem, _instrument(rng).record(problem, rng, cycle=_cycle(displacement, load))


def tilt(rng: np.random.Generator) -> Made:
    """A baseline that rises or falls by a tenth to the whole of the pull-off force."""
    problem, record = _ordinary(rng)
    x, force = record.displacement, float(np.median(record.load) - record.load.min())
    slope = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-1.0, 0.0)
    return problem, replace(record, load=record.load + slope * force * (x - x.min()) / np.ptp(x))


def creeping_drift(rng: np.random.Generator) -> Made:
    """A drift that slows down: most of it in the first quarter of the record."""
    problem, record = _ordinary(rng)
    time = np.linspace(0.0, 1.0, record.load.size)
    drift = rng.uniform(-0.05, 0.05) * np.ptp(record.displacement) * (1.0 - np.exp(-4.0 * time))
    return problem, replace(record, displacement=record.displacement + drift)


def capillary(rng: np.random.Generator) -> Made:
    """A meniscus: the approach snaps in early, the retreat holds on at a third of its force until it breaks."""
    problem = of_tabor_number(10.0 ** rng.uniform(2.6, 4.0))
    instrument = _instrument(rng)
    _, unloading, force, begin = instrument.cycle(problem)
    length = rng.uniform(0.5, 2.0) * -unloading[0, 1]
    touching = unloading[:, 2:]
    snap, breaks = touching[0, 0] - length, touching[0, 0] - rng.uniform(0.3, 1.0) * length
    begin = min(begin, 2.0 * snap)
    pulled = np.array([[snap, touching[0, 0]], [-0.3 * force] * 2])
    held = np.array([[breaks, touching[0, 0]], [-0.3 * force] * 2])
    zero = np.zeros(2)
    early = np.hstack([np.array([[begin, snap], zero]), pulled, touching])
    late = np.hstack([np.array([[begin, breaks], zero]), held, touching])
    return problem, instrument.record(problem, rng, cycle=(early, late, force, begin))


def rough(rng: np.random.Generator) -> Made:
    """Asperities: no adhesion on approach, and half of it on retreat."""
    problem = of_tabor_number(10.0 ** rng.uniform(0.0, 2.4))
    instrument = _instrument(rng)
    loading, unloading, force, begin = instrument.cycle(problem)
    loading = np.array([loading[0], np.maximum(loading[1], 0.0)])
    return problem, instrument.record(problem, rng, cycle=(loading, unloading, force, begin))


def viscous(rng: np.random.Generator) -> Made:
    """An approach that is stiffer and a retreat that adheres more, by 5 to 50 %."""
    problem, record = _ordinary(rng)
    factor, zero = 1.0 + 10.0 ** rng.uniform(-1.3, -0.3), float(np.median(record.load[:20]))
    load = np.where(record.approach, zero + factor * (record.load - zero), record.load)
    return problem, replace(record, load=load)


def noise_with_memory(rng: np.random.Generator) -> Made:
    """Noise whose correlation lasts ten to fifty points."""
    problem = of_tabor_number(10.0 ** rng.uniform(0.0, 4.0))
    record = replace(_instrument(rng), noise=1e-4).record(problem, rng)
    length = int(rng.integers(10, 50))
    slow = np.convolve(rng.normal(size=record.load.size + length - 1), np.ones(length) / length**0.5, "valid")
    force = float(np.median(record.load) - record.load.min())
    return problem, replace(record, load=record.load + 10.0 ** rng.uniform(-2.3, -1.5) * force * slow)


#: Records of the model, and those of other physics.
KINDS: dict[str, Callable[[np.random.Generator], Made]] = {
    "the model itself": _ordinary,
    "JKR with a snap of its own": jkr_with_a_snap_of_its_own,
    "another law": another_law,
    "Maugis-Dugdale": maugis_dugdale,
    "tilted baseline": tilt,
    "drift that slows down": creeping_drift,
    "capillary": capillary,
    "roughness": rough,
    "viscosity": viscous,
    "noise with memory": noise_with_memory,
}


@dataclass(frozen=True)
class Share:
    """Shares of intervals of two u that hold, of records with a flag, and of wrong ones (three u) without."""

    holds: float
    flagged: float
    silent: float
    worst: float


def share(kind: str, count: int, fitted: Callable[[Problem, Record, Problem], Fit], seed: int = 5) -> Share:
    """Fit some records of a kind from wrong starts."""
    rng = np.random.default_rng([seed, *map(ord, kind)])
    scores, flags, wrong_ones = [], [], []
    for _ in range(count):
        problem, record = KINDS[kind](rng)
        result = fitted(problem, record, wrong(problem, float(np.exp(rng.uniform(-1.0, 1.0)))))
        of_record = [abs(row.value - problem[key]) / row.u for key, row in result.parameters.items() if row.determined]
        scores += of_record
        flags.append(any(flag in remark for remark in result.remarks for flag in FLAGS))
        wrong_ones.append(max(of_record, default=0.0) > _WRONG)
    said = np.array(flags)
    silent = np.mean(np.array(wrong_ones) & ~said)
    return Share(float(np.mean(np.array(scores) < 2.0)), float(said.mean()), float(silent), float(max(scores)))


if __name__ == "__main__":
    from .test_fit import fitted

    for kind in KINDS if len(sys.argv) < 3 else sys.argv[2:]:
        print(f"{kind:28}", share(kind, int(sys.argv[1]), fitted), flush=True)
