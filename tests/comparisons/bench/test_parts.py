"""Parts of the benchmark: ratios, summaries and figures of those committed; measurements of tiny sizes."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import fscm
from comparisons.bench import cold_starts, greenwood, kinds, work_precision
from comparisons.bench.kinds import cost_of_kind
from comparisons.bench.run import BENCH_BASELINE, PARTS
from comparisons.bench.work_precision import CERTIFIED, cost_of_pull_off, peak_memory
from comparisons.paper.cache import Outcome
from comparisons.registry import create

COMMITTED = Path(__file__).parents[3] / BENCH_BASELINE


def stored(name):
    """The committed table of a part, and its columns that are measured."""
    table = pd.read_csv(PARTS[name].files(COMMITTED)[0])
    return table, table.loc[:, :"reason"]


@pytest.mark.parametrize("name", list(PARTS))
def test_the_ratios_of_every_planned_measurement_are_those_committed(name):
    table, measured = stored(name)
    pd.testing.assert_frame_equal(PARTS[name].ratios(measured), table, rtol=1e-12)
    assert len(table) >= len(PARTS[name].plan(False))


@pytest.mark.parametrize("name", list(PARTS))
def test_a_part_is_drawn_and_summed_up_also_with_one_value_and_one_failure(name, tmp_path):
    part, (table, measured) = PARTS[name], stored(name)
    calls, settings = part.calls(False), part.plan(False)
    numbers = measured.iloc[0].drop([*settings[0], "status", "reason"]).to_dict()
    failed = {call: Outcome(call, failure="lost") for call in calls}
    few = part.table(False, failed | {calls[0]: Outcome(calls[0], numbers)})
    assert few["status"].tolist() == ["ok"] + ["failed"] * (len(calls) - 1)
    assert few[list(settings[0])].to_dict("records") == settings
    assert set(part.table(False, failed)["reason"]) == {"lost"}
    for rows in (table, few[few["status"] == "ok"]):
        assert max(map(len, part.summary(rows).to_string(index=False, float_format="%.3g").splitlines())) <= 80
        if part.draw:
            figure = part.draw(rows)
            assert all(axes.get_xlabel() for axes in figure.axes)
            figure.savefig(tmp_path / "figure.png")


def test_errors_that_are_not_known_well_enough_have_no_ratio():
    pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1.5e-9], "cpu_seconds": [1.0, 9.0]}
    assert pd.isna(work_precision.time_ratios(pd.DataFrame({**pair, "u_error": [1e-9, 1e-9]}))).all()


def test_the_certified_values_are_those_that_the_tests_prove():
    flint = pytest.importorskip("flint")
    from tests.certified.pull_off_enclosure import CERTIFIED as PROVED

    proved = {float(case.form.mu): flint.arb(case.force) for case in PROVED.values()}
    assert proved.keys() == CERTIFIED.keys()
    for mu, interval in CERTIFIED.items():
        assert flint.arb(*interval).contains(proved[mu].mid())


#: The pull-off force for n = 2, k = 0, mu = 1.
FORCE = 1.67066478


@pytest.mark.parametrize(
    ("model", "setting", "error"),
    [
        ("fscm", "1e-04", 1e-7),  # measured 1.3e-8
        pytest.param("fem", "quick", 1e-6, marks=pytest.mark.heavy),
        # What it leaves out behind f = 50 is 5e-4 of the force.
        ("fscm-stieltjes", "120", 2e-3),
    ],
)
def test_a_solver_computes_the_pull_off_force(model, setting, error):
    assert abs(cost_of_pull_off(2.0, 0.0, 1.0, model, setting)["value"] - FORCE) < error * FORCE


def test_no_problem_comes_twice_the_first_output_counts_and_a_long_one_is_not_repeated(monkeypatch):
    """The first problem is a neighbour, the second that of the measurement; the clock ticks before and after each."""
    solved = []
    solver = lambda problem, setting: solved.append(problem.mu) or {"value": problem.mu, "unknowns": 7}  # noqa: E731  # one line
    monkeypatch.setitem(work_precision._SOLVERS, "fscm", solver)
    for ticks, count, seconds in (([0, 0.125, 10, 10.5, 20, 20.25, 30, 31], 4, 0.25), ([0, 0.125, 10, 15], 2, 5)):
        solved.clear()
        clock = iter(ticks)
        monkeypatch.setattr("comparisons.bench.work_precision.time.process_time", lambda clock=clock: next(clock))
        numbers = cost_of_pull_off(2.0, 0.0, 3.0, "fscm", "1e-04")
        assert solved[:2] == pytest.approx([3.3, 3.0], rel=1e-12)
        assert len(set(solved)) == len(solved) == count
        assert (numbers["value"], numbers["unknowns"]) == (3.0, 7)
        assert (numbers["cold_seconds"], numbers["cpu_seconds"]) == (0.125, seconds)


def test_commands_are_called_from_a_cold_start():
    bare, numbers = map(cold_starts.cold_start, (cold_starts.BARE, "--help"))
    assert (bare["exit_status"], numbers["exit_status"]) == (0, 0)
    assert 0.0 < bare["cpu_seconds"] < numbers["cpu_seconds"]
    with pytest.raises(RuntimeError, match="exit status 2: "):
        cold_starts.cold_start("solve --model nothing --n 2 --k 0 --mu 1 --quantity pull_off_force")


@pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="the system has no /proc")
def test_the_peak_of_the_memory_includes_what_is_free_again():
    before = peak_memory()
    large = np.ones(30_000_000)
    del large
    assert peak_memory() >= max(before, 240.0)


def test_a_kind_of_problem_has_value_bound_and_times():
    """A cone by the FSCM; without a value there is no time."""
    numbers = cost_of_kind("n = 1, k = 0", 0.3, "fscm")
    assert numbers["value"] == pytest.approx(fscm.solve(fscm.Problem(1, 0, 0.3), "pull_off_force").value, rel=1e-12)
    assert 0.0 <= numbers["u_num"] < 1e-9
    assert numbers["cpu_seconds"] > 0.0
    with pytest.raises(RuntimeError, match="punch"):
        cost_of_kind("measured punch", 20.0, "jkr")


def test_every_planned_problem_is_admissible_and_a_factor_changes_it():
    for settings in kinds.plan(full=True):
        problem, softer = (kinds.KINDS[settings["problem"]].problem(settings["size"], factor) for factor in (1.0, 1.1))
        assert create(settings["model"], problem.nu).skip(problem, "pull_off_force") is None
        if problem.is_dimensionless:
            assert softer.posed.mu == pytest.approx(1.1 * problem.posed.mu)
        else:
            assert softer.law["work_of_adhesion"] == pytest.approx(1.1 * problem.law["work_of_adhesion"])
            assert math.isfinite(softer.posed.mu)


def test_the_scheme_of_greenwood_is_within_a_thousandth():
    """It leaves out what attracts behind f = 50: 6e-4 of the force."""
    for mu, (force, _) in CERTIFIED.items():
        assert greenwood.pull_off_force(mu, 100) == pytest.approx(force, rel=1e-3)
