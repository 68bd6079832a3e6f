"""Records of other physics than that of the model: what is fitted all the same, and what is said about it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

import fscm
from comparisons.fitting.baseline import Baseline
from comparisons.fitting.equilibria import by_jkr, distance_of_hertz, is_without_adhesion
from comparisons.fitting.evidence import jump_in_remark, runs
from comparisons.fitting.least_squares import Minimum
from comparisons.fitting.machine import Observations
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.reading import read_records
from comparisons.fitting.search import Search
from comparisons.model import ComputationFailed
from comparisons.problem import Problem
from comparisons.problem.uncertain import Uncertainty
from tests.paths import PROBLEMS

from .synthetic import Instrument, contact, of_tabor_number, wrong
from .test_fit import FREE, deviations, fitted, recorded

SOFT = 3e3


def _says(result, *words):
    return any(all(word in remark for word in words) for remark in result.remarks)


@pytest.mark.parametrize("tilt", [-0.3, 0.5])
def test_a_tilted_baseline_is_seen_and_fitted(tilt):
    """The load without contact changes by a share of the pull-off force over the travel."""
    problem, record = recorded(SOFT, points=100)
    x = record.displacement
    force = -(record.load.min() - np.median(record.load))
    tilted = replace(record, load=record.load + tilt * force * (x - x.min()) / np.ptp(x))
    result = fitted(problem, tilted)
    assert max(map(abs, deviations(problem, result))) < 4.0
    assert result.zeros["tilt"][0] * np.ptp(x) == pytest.approx(tilt * force, rel=0.1)
    assert _says(result, "linear")
    constant = fitted(problem, tilted, baseline="constant")
    assert _says(constant, "--baseline linear")
    assert "tilt" not in constant.zeros


def test_a_level_baseline_has_no_slope():
    for seed in range(20):
        _, record = recorded(SOFT, seed=seed)
        assert Baseline.of(Observations.of(record), None).names == ("load",)


def test_attraction_far_away_is_no_tilt():
    """The loads of the record of the documentation fall towards the solid; the model has that, and leaves no slope."""
    problem = Problem.load(PROBLEMS / "probe.toml")
    (record,) = read_records(PROBLEMS.parent / "measured_curve.csv")
    assert "tilt" in Baseline.of(Observations.of(record), None).names
    result = fitted(problem, record, start=problem, free=["solid.E", "law.work_of_adhesion"])
    assert "tilt" not in result.zeros
    # Computed with 500 MPa and 40 mJ/m^2.
    for key, true in (("solid.E", 5e8), ("law.work_of_adhesion", 0.04)):
        row = result.parameters[key]
        assert abs(row.value - true) < 2.0 * row.u < 0.005 * true


@pytest.mark.parametrize("approach", [True, False])
def test_a_jump_elsewhere_is_said_and_not_used(approach):
    """Loads far away in place of some of the contact: the approach snaps in late, the retreat lets go early."""
    problem, record = recorded(SOFT, points=200, noise=0.01)
    observed = Observations.of(record)
    before, after = observed.jumps[approach]
    late = slice(after, after + 15) if approach else slice(before - 15, before + 1)
    load = record.load.copy()
    load[late] = load[before if approach else after] + 0.3 * record.noise * np.cos(9.0 * np.arange(load[late].size))
    moved = replace(record, load=load)
    result = fitted(problem, moved)
    if approach:
        # The limit of large Tabor numbers has no place for the snap before contact.
        assert max(map(abs, deviations(problem, result))) < 4.0
    else:
        assert _says(result, "parted", "nearer to")
        assert max(map(abs, deviations(problem, result))) < 4.0


def test_what_rests_on_a_jump_is_among_the_remarks(monkeypatch):
    """The fit hands over how to fit without the jump-in: the values of a good record stay where they are."""
    problem, record = recorded(SOFT, points=100)
    minima = []

    def remark(search, result, without):
        minima.append((result, without()))
        return "rests on the jump"

    monkeypatch.setattr("comparisons.fitting.fit.jump_in_remark", remark)
    result = fitted(problem, record, branch="approach")
    assert "rests on the jump" in result.remarks
    ((minimum, alone),) = minima
    assert all(abs(alone.numbers[name] - minimum.numbers[name]) < 3.0 * alone.deviations[name] for name in FREE)


@pytest.mark.parametrize(("larger", "said"), [(2.9, False), (3.1, True), (None, True)])
def test_a_value_rests_on_a_jump_without_which_it_is_not_known(larger, said):
    def minimum(deviation):
        numbers = dict.fromkeys(FREE, 0.0)
        return Minimum(numbers, 1.0, 1.0, np.diag([deviation**2, 1e-6]))

    def without():
        if larger is None:
            raise ComputationFailed("no values describe the curve")
        return minimum(1e-2 * larger)

    problem, record = recorded(SOFT)
    search = Search(Observations.of(record.only("approach")), problem, free_keys(problem, FREE))
    remark = jump_in_remark(search, minimum(1e-2), without)
    assert (remark is not None and FREE[0] in remark) == said
    # Nothing rests on a jump that does not count.
    search.jumps = (False,)
    assert jump_in_remark(search, minimum(1e-2), without) is None


def test_a_value_that_is_held_and_wrong_is_the_first_cause():
    problem, record = recorded(SOFT, points=100)
    result = fitted(problem, record, start=wrong(problem, 3.0), free=["solid.E0"])
    assert _says(result, "does not describe", "law.work_of_adhesion is held")
    assert not _says(fitted(problem, record), "is held")


def test_branches_that_differ_are_said():
    problem, record = recorded(SOFT, noise=0.005, points=100)
    load = record.load.copy()
    zero = np.median(load[:20])
    retreat = ~record.approach
    load[retreat] = zero + 1.3 * (load[retreat] - zero)
    result = fitted(problem, replace(record, load=load))
    assert _says(result, "alone", "creeps")
    assert {*result.by_branch} == {"approach", "retreat"}
    same = fitted(problem, record)
    assert not _says(same, "alone")
    assert same.as_json()["by_branch"]["retreat"][FREE[0]]["value"] == pytest.approx(problem[FREE[0]], rel=0.05)


def test_noise_with_memory_is_said():
    problem, record = recorded(SOFT, noise=1e-4, points=200)
    rng = np.random.default_rng(4)
    slow = np.convolve(rng.normal(size=record.load.size + 40), np.ones(41) / 41**0.5, "valid")
    white = rng.normal(size=record.load.size)
    depth = 0.02 * np.ptp(record.load)
    assert _says(fitted(problem, replace(record, load=record.load + depth * slow)), "keep their sign")
    assert not _says(fitted(problem, replace(record, load=record.load + depth * white)), "keep their sign")


def test_runs_of_a_coin_are_even():
    values = [runs(np.random.default_rng(seed).normal(size=200)) for seed in range(200)]
    assert abs(np.mean(values)) < 0.3
    assert np.std(values) == pytest.approx(1.0, abs=0.2)
    assert runs(np.ones(30)) == 0.0


@pytest.mark.parametrize(("mu", "k"), [(0.01, 0.0), (0.1, 0.0), (1.0, 0.4)])
def test_the_equilibria_without_adhesion_are_as_near_as_they_are_said(mu, k):
    """A factor on all loads, which a modulus is, with a free zero of the displacement."""
    problem = of_tabor_number(mu, k)
    unit, length = problem.units["load"], problem.units["displacement"]
    path = fscm.trace(problem.posed, "quick", max_load=2e4, longest_step=0.5, with_bounds=False)
    seen = path.load > 0.02 * path.load.max()
    largest = float(path.load.max()) * unit
    assert is_without_adhesion(problem, largest)
    displacement, load = by_jkr(problem, 1.5 * largest)
    rising = int(np.argmax(load > 10.0 * unit))

    def errors(numbers):
        x = path.displacement[seen] * length + numbers[1] * length
        return numbers[0] * np.interp(x, displacement[rising:], load[rising:]) / unit - path.load[seen]

    factor, _ = least_squares(errors, [1.0, 0.0], xtol=1e-12, ftol=1e-12).x
    assert 0.2 < abs(factor - 1.0) / distance_of_hertz(problem, largest) < 1.0


def test_a_contact_without_adhesion_gives_its_modulus():
    problem = contact(1e6, 1e-9, R=5e-6)
    record = Instrument(noise=0.0, points=200).record(problem, np.random.default_rng(2), cycle=_hertz(problem))
    rng = np.random.default_rng(3)
    record = replace(record, load=record.load + 0.002 * np.ptp(record.load) * rng.normal(size=record.load.size))
    result = fitted(problem, record, free=["solid.E0"])
    assert max(map(abs, deviations(problem, result))) < 4.0
    assert result.parameters["solid.E0"].u < 0.05 * problem["solid.E0"]


def _hertz(problem):
    """Loading and unloading to a tenth of the radius, pull-off force, begin."""
    x, load = by_jkr(problem, 1e5 * problem.units["load"])
    rising = int(np.argmax(load > 0.0))
    curve = np.column_stack([[[-x[-1]], [0.0]], [x[rising:], load[rising:]]])
    return curve, curve, 0.0, -x[-1]


def test_a_prior_is_in_the_answer():
    problem, record = recorded(3.0)
    law = replace(problem.law, uncertain={"z0": Uncertainty(0.1e-9, False, "0.1 nm")})
    stated = replace(problem, law=law)
    result = fitted(problem, record, stated)
    row = result.as_json()["parameters"]["law.z0"]
    assert row["prior"] == pytest.approx(0.1e-9)
    assert row["start"] == problem["law.z0"]
    assert row["u"] < row["prior"]
