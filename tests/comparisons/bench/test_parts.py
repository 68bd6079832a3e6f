"""Parts of the benchmark: ratios, summaries and figures of those committed; measurements of tiny sizes."""

import math
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy.sparse.linalg

import fscm
from comparisons.bench import adhesion_fft, bead, cold_starts, floor, greenwood, kinds, work_precision
from comparisons.bench.kinds import cost_of_kind
from comparisons.bench.run import BENCH_BASELINE, PARTS
from comparisons.bench.work_precision import CERTIFIED, cost_of_pull_off, peak_memory
from comparisons.fitting.fit import fit_record
from comparisons.paper.cache import Outcome
from comparisons.problem import Problem
from comparisons.registry import create

COMMITTED = Path(__file__).parents[3] / BENCH_BASELINE


def stored(name):
    """The committed table of a part, and its columns that are measured."""
    table = pd.read_csv(PARTS[name].files(COMMITTED)[0])
    return table, table.loc[:, :"reason"]


@pytest.mark.parametrize("name", list(PARTS))
def test_the_ratios_of_the_committed_measurements_are_those_committed(name):
    table, measured = stored(name)
    pd.testing.assert_frame_equal(PARTS[name].ratios(measured), table, rtol=1e-12)
    # A row that a later version adds to the plan is committed with the next whole run.
    assert not table.duplicated(list(PARTS[name].plan(False)[0])).any()
    assert (table["status"] == "ok").all()


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

    def solver(problem, setting):
        solved.append(problem.mu)
        return {"value": problem.mu, "unknowns": 7, "iterations": 2}

    monkeypatch.setitem(work_precision._SOLVERS, "fscm", solver)
    monkeypatch.setattr(work_precision, "floor_seconds", lambda *effort: effort)
    for ticks, count, seconds in (([0, 0.125, 10, 10.5, 20, 20.25, 30, 31], 4, 0.25), ([0, 0.125, 10, 15], 2, 5)):
        solved.clear()
        clock = iter(ticks)
        monkeypatch.setattr("comparisons.bench.work_precision.time.process_time", lambda clock=clock: next(clock))
        numbers = cost_of_pull_off(2.0, 0.0, 3.0, "fscm", "1e-04")
        assert solved[:2] == pytest.approx([3.3, 3.0], rel=1e-12)
        assert len(set(solved)) == len(solved) == count
        assert (numbers["value"], numbers["unknowns"], numbers["floor_seconds"]) == (3.0, 7, ("fscm", 7, 2))
        assert (numbers["cold_seconds"], numbers["cpu_seconds"]) == (0.125, seconds)


def test_commands_are_called_from_a_cold_start():
    bare, numbers = map(cold_starts.cold_start, (cold_starts.BARE, "--help"))
    assert (bare["exit_status"], numbers["exit_status"]) == (0, 0)
    assert 0.0 < bare["cpu_seconds"] < numbers["cpu_seconds"]
    assert bare["floor_seconds"] is None
    assert numbers["floor_seconds"] > 0.0
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
    assert min(numbers["cpu_seconds"], numbers["floor_seconds"]) > 0.0
    with pytest.raises(RuntimeError, match="punch"):
        cost_of_kind("measured punch", 20.0, "jkr")


def test_every_planned_problem_is_admissible_and_a_factor_changes_it():
    for settings in kinds.plan(full=True):
        kind = kinds.KINDS[settings["problem"]]
        problem, softer = (kind.problem(settings["size"], factor) for factor in (1.0, 1.1))
        quantity = "pull_off_force" if kind.quantity == kinds.FIT else kind.quantity
        assert create(settings["model"], problem.nu).skip(problem, quantity) is None
        if problem.is_dimensionless:
            assert softer.posed.mu == pytest.approx(1.1 * problem.posed.mu)
        else:
            assert softer.law["work_of_adhesion"] == pytest.approx(1.1 * problem.law["work_of_adhesion"])
            assert math.isfinite(softer.posed.mu)


def test_a_fit_returns_the_mean_modulus_of_as_many_records_as_its_size(monkeypatch):
    """The start is wrong by 30 %; the noise of a record is 1 % of the pull-off force."""
    fitted = []
    monkeypatch.setattr(
        kinds, "fit_record", lambda *args, **named: fitted.append(fit_record(*args, **named)) or fitted[-1]
    )
    numbers = kinds.KINDS["fit of curves"].computation("fscm", 2.0, 1.0)()
    values = [fit.parameters["solid.E"].value for fit in fitted]
    assert len(values) == 2
    assert values[0] != values[1]
    assert numbers["value"] == pytest.approx(sum(values) / 2, rel=1e-14) == pytest.approx(1.5e6, rel=0.01)


def test_the_bead_is_that_of_its_file(tmp_path):
    path = tmp_path / "bead.toml"
    path.write_text(bead.BEAD.lstrip())
    assert Problem.load(path).posed.mu == pytest.approx(bead.bead().posed.mu, rel=1e-12)


@pytest.mark.parametrize(
    ("model", "systems", "factors"), [("fscm", 7, 0), ("fem", 0, 1), ("fem-large-strain", 0, 7), ("greenwood", 0, 0)]
)
def test_the_floor_has_the_linear_systems_of_the_newton_steps(model, systems, factors, monkeypatch):
    """A few unknowns each; every repetition of the measurement has the same."""
    sizes = {"solve": [], "splu": []}
    for module, name in ((np.linalg, "solve"), (scipy.sparse.linalg, "splu")):

        def counted(function, name, matrix, *args, **named):
            sizes[name].append(matrix.shape[0])
            return function(matrix, *args, **named)

        monkeypatch.setattr(module, name, partial(counted, getattr(module, name), name))
    seconds = floor.floor_seconds(model, 100, 7)
    assert (seconds is None) == (systems == factors == 0)
    assert sizes == {"solve": floor._REPEATS * systems * [100], "splu": floor._REPEATS * factors * [100]}
    assert floor.floor_seconds(model, None, None) is None


def test_the_floor_is_drawn_below_the_time_of_its_model():
    """Hollow markers on a dotted line; an earlier table has no floor."""
    rows = pd.DataFrame({"problem": "layers", "size": [1.0, 2.0], "model": "fscm", "cpu_seconds": [1.0, 4.0]})
    (axes,) = kinds.draw(rows).axes
    assert [line.get_label() for line in axes.lines] == ["fscm"]
    (axes,) = kinds.draw(rows.assign(floor_seconds=[0.25, 0.5])).axes
    assert axes.lines[1].get_ydata().tolist() == [0.25, 0.5]
    assert axes.lines[1].get_label() == "fscm, floor"
    rows = pd.DataFrame({"mu": 1.0, "model": "fem", "cpu_seconds": [1.0, 4.0], "error": [1e-6, 1e-8], "u_error": 1e-12})
    (axes,) = work_precision.draw(rows.assign(floor_seconds=[0.25, 0.5])).axes
    assert axes.lines[1].get_xdata().tolist() == [0.25, 0.5]


def test_the_scheme_of_greenwood_is_within_a_thousandth():
    """It leaves out what attracts behind f = 50: 6e-4 of the force."""
    for mu, (force, _) in CERTIFIED.items():
        assert greenwood.pull_off_force(mu, 100) == pytest.approx(force, rel=1e-3)


def test_adhesion_is_measured_only_where_it_is_installed(monkeypatch):
    for installed in (False, True):
        monkeypatch.setattr(adhesion_fft, "is_installed", lambda installed=installed: installed)
        assert any(row["model"] == "adhesion" for row in work_precision.plan(False)) == installed


def test_the_scheme_of_adhesion_is_within_two_thousandths():
    """A grid of 64 points a side: measured 1.0e-3 and 4.9e-4."""
    pytest.importorskip("Adhesion")
    for mu in (0.1, 0.5):
        assert adhesion_fft.pull_off_force(mu, 64) == pytest.approx(CERTIFIED[mu][0], rel=2e-3)
