"""Fits of records whose values are known: made by both solvers, with noise, unknown zeros and drift."""

import json
import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from scipy.stats import binom

import fem_reference
import fscm
from comparisons import fit
from comparisons.cli.main import main
from comparisons.fitting import search
from comparisons.fitting.curves import Curves
from comparisons.fitting.equilibria import Equilibria, _with_points_between, by_fscm
from comparisons.fitting.fit import Fit, FittedValue, fit_record
from comparisons.fitting.folder import _pictures
from comparisons.fitting.machine import Machine, Observations
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.search import differences
from comparisons.model import ComputationFailed
from comparisons.problem import Problem, Section
from comparisons.problem.uncertain import Uncertainty
from tests.comparisons.conftest import is_locked
from tests.marks import heavy

from .synthetic import Instrument, contact, of_tabor_number, wrong

FREE = ["law.work_of_adhesion", "solid.E0"]

PROBE = """
solid = {kind = "power-law", E0 = "3 GPa", c0 = "1 nm", k = 0, nu = 0.3}
punch = {kind = "sphere", R = "200 nm"}
law = {kind = "lennard-jones-9-3", work_of_adhesion = "20 mJ/m^2", z0 = "0.4 nm"}
"""


def deviations(problem, fitted):
    """Distance from the true values in standard uncertainties."""
    return [(row.value - problem[key]) / row.u for key, row in fitted.parameters.items()]


def fitted(problem, record, start=None, free=FREE, **options):
    """The fit without the error of the assumptions, which takes longer than the rest."""
    start = start or wrong(problem, 3.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("comparisons.fitting.fit.budget", lambda *_: None)
        return fit_record(record, start, free_keys(start, free), **options)


@cache
def cycle(mu, k):
    return Instrument().cycle(of_tabor_number(mu, k))


def recorded(mu, k=0.0, seed=1, **instrument):
    """A contact of a Tabor number and a record of it."""
    problem = of_tabor_number(mu, k)
    return problem, Instrument(**instrument).record(problem, np.random.default_rng(seed), cycle=cycle(mu, k))


@pytest.mark.parametrize(("mu", "k"), [(3.0, 0.0), (3e3, 0.4), *heavy((0.1, 0.0), (0.6, 0.4), (20.0, 0.0))])
def test_known_values_are_found_from_a_wrong_start(mu, k):
    problem, record = recorded(mu, k, drift=0.01)
    result = fitted(problem, record)
    assert result.model == ("jkr" if mu > 100.0 else "fscm")
    assert max(map(abs, deviations(problem, result))) < 3.5
    assert all(row.determined and row.u < 0.1 * row.value for row in result.parameters.values())
    assert result.residual == pytest.approx(result.noise, rel=0.2)
    assert not any("Tabor number" in remark or "describe" in remark for remark in result.remarks)


def test_a_search_may_begin_at_the_force_of_the_record_and_any_tabor_number():
    problem, record = recorded(3.0)
    start = wrong(problem, 3.0)
    searched = search.Search(Observations.of(record), start, free_keys(start, FREE))
    begun = searched._problem_of(searched._of_pull_off(0.5))
    assert begun.posed.mu == pytest.approx(0.5, rel=1e-9)
    force = fscm.solve(begun.build(fscm), "pull_off_force", "quick").value
    assert force == pytest.approx(cycle(3.0, 0.0)[2], rel=0.05)


@pytest.mark.heavy
@pytest.mark.parametrize("E", [1e8, 2e9])
def test_a_cone_whose_force_by_jkr_depends_on_its_modulus_is_fitted(E):
    """Tabor numbers of 3 and 0.15: far from the second one JKR has no force near that of the record."""
    problem = contact(E, 0.05)
    cone = replace(problem, punch=Section("cone", {"half_angle": 1.2}))
    record = Instrument(noise=0.01, points=100).record(cone, np.random.default_rng(3))
    result = fitted(cone, record, wrong(cone, 1.6))
    assert max(map(abs, deviations(cone, result))) < 3.5
    assert all(row.u < 0.01 * row.value for row in result.parameters.values())


@pytest.mark.parametrize(("factor", "paths"), [(1.2, 10), *heavy((3.0, 24))])
def test_a_ball_is_fitted_with_few_paths_of_its_own(factor, paths, monkeypatch):
    """The noise is a thousandth of the pull-off force."""
    problem = contact(5e8, 0.05)
    ball = replace(problem, punch=Section("ball", {"R": 200e-9}))
    record = Instrument(noise=1e-3).record(ball, np.random.default_rng(9))
    traced, trace = [], fscm.trace
    monkeypatch.setattr(fscm, "trace", lambda *args, **options: traced.append(1) or trace(*args, **options))
    result = fitted(ball, record, wrong(ball, factor))
    assert max(map(abs, deviations(ball, result))) < 3.5
    assert all(row.u < 5e-4 * row.value for row in result.parameters.values())
    assert result.residual < 1.1 * result.noise
    assert len(traced) <= paths
    monkeypatch.setattr(search, "_EXPANSIONS", 1)
    with pytest.raises(ComputationFailed, match="begin nearer"):
        fitted(ball, record, wrong(ball, 3.0))


def test_a_cantilever_jumps_where_its_stiffness_says():
    """The tension ends at a higher load than of a held displacement: the softer, the nearer to pull-off."""
    problem = of_tabor_number(3.0)
    equilibria = by_fscm(problem, 1e-8, False)
    held, soft = (Machine.of(equilibria, stiffness).contact[1, 0] for stiffness in (math.inf, 0.5))
    assert equilibria.load.min() <= soft < held < 0.0
    assert soft == pytest.approx(equilibria.load.min(), rel=0.02)


def test_a_machine_stops_at_each_stable_section_on_its_way():
    """A stiff film lets go in two steps: the retreat lands on a section between contact and separation."""
    positions = np.array([-9.0, -5.0, -1.0, -2.0, -6.0, -5.0, -3.0, -4.0, -4.5, -4.0, 0.0, 5.0])
    machine = Machine.of(Equilibria(positions, np.arange(12.0) - 11.0), math.inf)
    assert machine.jumps
    assert machine.far.tolist() == [[-9.0, -5.0, -1.0], [-11.0, -10.0, -9.0]]
    assert machine.contact[:, 0].tolist() == [-6.0, -7.0]
    assert np.interp([-5.0, -4.51, -4.49, 0.0], *machine.contact) == pytest.approx([-6.0, -5.755, -2.98, -1.0])
    with pytest.raises(ComputationFailed):
        Machine.of(Equilibria(positions[:-3], np.arange(9.0)), math.inf)


@pytest.mark.heavy
def test_a_thin_stiff_film_on_a_soft_solid_is_fitted():
    film = {"E_coating": 1e9, "E_substrate": 1.5e6, "thickness": 1e-7, "nu": 0.4}
    law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    problem = Problem(Section("coating", film), Section("sphere", {"R": 5e-6}), law)
    free = ("law.work_of_adhesion", "solid.E_substrate")
    start = problem.with_value("law.work_of_adhesion", 0.04).with_value("solid.E_substrate", 2e6)
    record = Instrument(noise=0.01).record(problem, np.random.default_rng(1))
    result = fit_record(record, start, free_keys(start, free))
    values = result.parameters
    assert max(abs(values[key].value / problem[key] - 1.0) / (values[key].u / values[key].value) for key in free) < 3.5
    assert result.residual < 1.1 * result.noise


@pytest.mark.parametrize(("mu", "share"), [(2.7, 3e-4), (12.0, 1e-3), *heavy((0.3, 3e-4), (7.0, 3e-4))])
def test_series_and_grid_of_tabor_numbers_are_as_good_as_a_path(mu, share):
    """Loads differ from those of the path of the problem itself by less than a share of the larger of force and load.

    Series end at a Tabor number of 10.
    """
    problem = of_tabor_number(mu)
    own, between = (Machine.of(by_fscm(problem, 1e-9, exact), math.inf) for exact in (True, False))
    x = np.linspace(max(own.contact[0, 0], between.contact[0, 0]), own.contact[0, -1], 400)[4:-1]
    loads = [np.interp(x, *machine.contact) for machine in (own, between)]
    scale = np.maximum(np.abs(loads[0]), -own.contact[1].min())
    assert np.abs((loads[0] - loads[1]) / scale).max() < share


def test_curves_of_a_map_share_the_paths_between_tabor_numbers(monkeypatch):
    """Loads of other size, and Tabor numbers between the same ones of the grid, need no path of their own."""
    traced, trace = [], fscm.trace
    monkeypatch.setattr(
        fscm, "trace", lambda posed, *args, **keys: traced.append(posed.mu) or trace(posed, *args, **keys)
    )
    blunt = replace(of_tabor_number(1.0), punch=Section("power-law", {"n": 3.0, "Q": 1e-14}))
    low, high = (blunt.with_value("solid.E0", E).posed.mu for E in (1e8, 1e9))
    for number, largest in ((0.051, 3.0), (0.051, 60.0), (0.054, 15.0)):
        problem = blunt.with_value("solid.E0", 1e8 * (number / low) ** (1.0 / math.log10(high / low)))
        assert problem.posed.mu == pytest.approx(number)
        by_fscm(problem, largest * problem.units["load"])
    assert len(traced) == len(set(traced)) == 4


def test_points_between_states_have_the_folds_of_the_states_alone():
    """A spline swings beside a bend: between states where the displacement rises, it falls."""
    states = np.array([[0.0, 1.0, 2.0, 2.01, 2.02, 2.03, 1.0, 0.0, 3.0], np.arange(9.0)])
    length = np.arange(9.0)
    assert (np.diff(CubicSpline(length, states.T)(np.linspace(0.0, 8.0, 81))[:, 0]) < 0.0).sum() > 20
    points = _with_points_between(length, states)
    assert points.shape == (2, 65)
    assert np.array_equal(points[:, ::8], states)
    rises = np.diff(points[0]) > 0.0
    assert rises[:40].all()
    assert not rises[40:56].any()
    assert rises[56:].all()
    # A straight line stays one.
    assert points[1] == pytest.approx(np.arange(65.0) / 8.0)


def test_numbers_that_move_the_record_alone_need_no_new_equilibria(monkeypatch):
    """Three of five numbers are zeros and a drift."""
    computed, compared = [], []
    equilibria, residuals = Curves.equilibria, search.Search._residuals
    monkeypatch.setattr(Curves, "equilibria", lambda *given: computed.append(1) or equilibria(*given))
    monkeypatch.setattr(search.Search, "_residuals", lambda *given: compared.append(1) or residuals(*given))
    problem, record = recorded(2e3, seed=3)
    fitted(problem, record)
    assert len(compared) > 100
    assert len(computed) < 0.6 * len(compared)


def test_curves_near_a_series_are_those_of_their_own_series_to_first_order():
    problem = of_tabor_number(2.0, 0.4)
    key = free_keys(problem, ["solid.E0"])[0]
    near = Curves("fscm", 1.1).expanded(problem, 1e-8)
    errors = []
    for number in (0.02, 0.01):
        beside = problem.with_value("solid.E0", key.value(number))
        linear, own = (curves.equilibria(beside, {}, 1e-8) for curves in (near, Curves("fscm", 1.1)))
        errors.append(max(float(np.abs(a - b).max() / np.ptp(b)) for a, b in zip(linear, own, strict=True)))
    assert errors[1] < 0.3 * errors[0] < 1e-3


def test_a_sphere_on_a_power_law_is_fitted_without_a_path_of_the_fscm(monkeypatch):
    problem, record = recorded(6.0, drift=0.02)
    for name in ("trace", "solve"):
        monkeypatch.setattr(fscm, name, None)
    result = fitted(problem, record)
    assert max(map(abs, deviations(problem, result))) < 3.5
    assert set(result.by_branch) == {"approach", "retreat"}


@pytest.mark.parametrize("kind", ["constant", "linear"])
def test_each_branch_begins_where_both_together_end(kind):
    """The ranges of a branch, in which its zeros count, are others than those of the record; drift is a shift of it."""
    problem, whole = recorded(3.0, drift=0.02)
    shorter = np.flatnonzero(~whole.approach)[:200]
    kept = np.concatenate([np.flatnonzero(whole.approach), shorter])
    cut = replace(whole, **{name: getattr(whole, name)[kept] for name in ("displacement", "load", "approach")})
    both = search.Search(Observations.of(cut), problem, free_keys(problem, FREE), kind)
    result, _ = both.best(Curves("fscm"), [{}], False)
    for branch in ("approach", "retreat"):
        alone, start = both.of_branch(branch, result)
        points = cut.approach == (branch == "approach")
        zeros = zip(both.zeros(result.numbers), alone.zeros(start), (both.range, both.load_range), strict=True)
        for of_both, of_branch, size in zeros:
            assert of_branch.mean() == pytest.approx(of_both[points].mean(), abs=1e-3 * size)


def test_a_fit_expands_a_few_series(monkeypatch):
    """The derivatives of a series serve all numbers, and no expansion is made twice at one point."""
    expanded, made = [], Curves.expanded
    monkeypatch.setattr(
        Curves, "expanded", lambda self, problem, *given: expanded.append(problem) or made(self, problem, *given)
    )
    problem, record = recorded(3.0, seed=3)
    fitted(problem, record)
    assert 3 < len(expanded) < 60


def test_what_the_file_knows_counts_like_a_measurement():
    """An uncertain radius widens the work of adhesion by as much, and a prior that is tight holds its key."""
    problem, record = recorded(3.0, seed=2)
    plain = fitted(problem, record).parameters["law.work_of_adhesion"]
    start = wrong(problem, 2.0)
    uncertain = replace(start, punch=replace(start.punch, uncertain={"R": Uncertainty(0.05 * 200e-9, False, "5 %")}))
    wide = fitted(problem, record, uncertain).parameters["law.work_of_adhesion"]
    assert plain.u < 0.02 * plain.value
    assert 0.02 * wide.value < wide.u < 0.08 * wide.value


def test_what_a_curve_cannot_tell_is_said():
    """The range of the forces has no part in the limit of large Tabor numbers."""
    problem, record = recorded(2e3, seed=4)
    result = fitted(problem, record, free=[*FREE, "law.z0"])
    assert not result.parameters["law.z0"].determined
    assert any("law.z0" in remark for remark in result.remarks)


def test_a_jump_of_a_residual_on_one_side_is_no_derivative():
    def residuals(values):
        a = values["a"]
        return np.array([2.0 * a + (a > 1.0), 3.0 * a - (a < 1.0)])

    assert differences(residuals, {"a": 1.0}, 1e-3)[:, 0] == pytest.approx([2.0, 3.0])


def test_the_error_of_jkr_is_in_its_uncertainty():
    """Its force at a Tabor number of 3 is 3.6 % off, which the noise of a twentieth of that does not show."""
    problem, record = recorded(3.0, seed=7, noise=0.002)
    row = fitted(problem, record, problem, model="jkr").parameters["law.work_of_adhesion"]
    assert row.u >= abs(row.shifts["model"]) > 0.02 * row.value
    assert abs(row.value - problem["law.work_of_adhesion"]) < 2.0 * row.u


def test_jkr_for_a_stiff_contact_is_refused_trust():
    problem, record = recorded(0.2, seed=6, noise=0.005, points=100)
    stiff = fitted(problem, record, problem, FREE[:1], model="jkr")
    assert stiff.residual > 2.0 * stiff.noise
    assert any("Tabor number" in remark for remark in stiff.remarks)
    assert any("does not describe" in remark for remark in stiff.remarks)


def test_the_example_of_the_documentation_has_the_values_it_was_made_with():
    examples = Path(__file__).parents[3] / "docs" / "examples"
    problem = Problem.load(examples / "problems" / "probe.toml")
    (result,) = fit(examples / "measured_curve.csv", problem, ["solid.E", "law.work_of_adhesion"])
    for key, value in (("solid.E", 500e6), ("law.work_of_adhesion", 0.04)):
        assert result.parameters[key].value == pytest.approx(value, abs=3.0 * result.parameters[key].u)
    assert result.residual == pytest.approx(0.2e-9, rel=0.1)


def test_curves_share_a_folder_that_is_resumed(tmp_path, capsys):
    (tmp_path / "probe.toml").write_text(PROBE)
    curves = [str(tmp_path / f"curve{number}.csv") for number in (1, 2)]
    for seed, path in enumerate(curves):
        problem, record = recorded(3.0, seed=seed)
        branch = np.where(record.approach, "approach", "retreat")
        table = {"displacement [nm]": record.displacement * 1e9, "load [uN]": record.load * 1e6, "branch": branch}
        pd.DataFrame(table).to_csv(path, index=False)
    folder = tmp_path / "fits"
    arguments = ["--problem", str(tmp_path / "probe.toml"), "--free", *FREE, "--out", str(folder), "--jobs", "1"]
    assert main(["fit", curves[0], *arguments, "--format", "json"]) == 0
    content = json.loads(capsys.readouterr().out)
    parameters, total = content["parameters"], content["assumptions"]["total"]
    assert set(parameters) == set(FREE)
    # A model whose force is too large finds too small a work of adhesion; the two are nearly proportional.
    shift = parameters["law.work_of_adhesion"]["shift_by_assumptions"] / parameters["law.work_of_adhesion"]["value"]
    assert shift == pytest.approx(total["error"], rel=0.2)
    assert parameters["solid.E0"]["unit"] == "Pa"
    for key, row in parameters.items():
        assert abs(row["value"] - problem[key]) < 4.0 * row["u"] < 0.2 * row["value"]
        assert 0.0 < abs(row["shift_by_assumptions"]) < 0.1 * row["value"]
    assert main(["fit", *curves, *arguments]) == 0
    streams = capsys.readouterr()
    assert "1 finished" not in streams.err
    # It is smaller than the uncertainty of the fit.
    assert "assumptions of all models" not in streams.out
    table = pd.read_csv(folder / "fits.csv")
    assert sorted(set(table["curve"])) == ["curve1.csv", "curve2.csv"]
    assert {path.name for path in folder.glob("*.png")} == {"curve1.png", "curve2.png"}
    assert "\\toprule" in (folder / "fits.tex").read_text()
    assert main(["report", str(folder)]) == 2
    assert "fits.csv" in capsys.readouterr().err


def depth(record, problem, *_):
    """In place of a fit, which takes seconds: the value is the depth of the record."""
    value = FittedValue(-float(record.load.min()), 0.0, "J/m^2", True, dict.fromkeys(("model", "assumptions"), 0.0))
    zeros = dict.fromkeys(("displacement", "load"), (0.0, 0.0))
    parameters = {"law.work_of_adhesion": value}
    return Fit(record, "jkr", problem, parameters, zeros, 1.0, 1.0, [], record.position, record.load)


@pytest.fixture
def batch(tmp_path, monkeypatch):
    """A function that fits curves of some names by `depth`; returns exit status, table and names of the pictures.

    A curve is a text, or the load of its lowest point in nN.
    """
    monkeypatch.setattr("comparisons.fitting.folder.fit_record", lambda *given, **options: depth(*given))
    monkeypatch.setattr("comparisons.fitting.folder.save", lambda picture, path: path.touch())
    (tmp_path / "probe.toml").write_text(PROBE)

    def run(curves, *options):
        paths = []
        for name, curve in curves.items():
            paths.append(tmp_path / name)
            paths[-1].parent.mkdir(parents=True, exist_ok=True)
            rows = "".join(f"{i},{-curve * (i == 7)}\n" for i in range(20)) if isinstance(curve, float) else ""
            paths[-1].write_text(f"displacement [nm],load [nN]\n{rows}" if rows else curve)
        arguments = ["--problem", str(tmp_path / "probe.toml"), "--free", "law.work_of_adhesion"]
        folder = tmp_path / "fits"
        status = main(["fit", *map(str, paths), *arguments, "--out", str(folder), "--jobs", "1", *options])
        table = (
            pd.read_csv(folder / "fits.csv", keep_default_na=False, na_values={"value": [""]})
            if (folder / "fits.csv").exists()
            else None
        )
        pictures = {path.relative_to(folder).as_posix() for path in folder.rglob("*.png")}
        return status, table, pictures

    return run


def test_curves_of_one_name_have_their_own_rows_and_pictures(batch, capsys):
    status, table, pictures = batch({"a/c.csv": 1.0, "b/c.csv": 2.0, "b/d.csv": 1.0})
    assert status == 0
    assert table["curve"].tolist() == ["a/c.csv", "b/c.csv", "d.csv"]
    assert table["value"].tolist() == pytest.approx([1e-9, 2e-9, 1e-9])
    assert pictures == {"a/c.png", "b/c.png", "d.png"}
    assert "a/c.csv: " in capsys.readouterr().out


def test_one_unusable_curve_is_a_row_with_its_reason(batch, capsys):
    short, wrong_column = "displacement [nm],load [nN]\n1,2\n", "displacement [nm],weight [g]\n1,2\n"
    status, table, pictures = batch({"good.csv": 1.0, "short.csv": short, "wrong.csv": wrong_column})
    assert status == 4
    assert table["curve"].tolist() == ["good.csv", "short.csv", "wrong.csv"]
    assert [bool(reason) for reason in table["reason"]] == [False, True, True]
    assert "fewer than 20" in table["reason"][1]
    assert "column load is missing" in table["reason"][2]
    assert table["value"].isna().tolist() == [False, True, True]
    assert pictures == {"good.png"}
    printed = capsys.readouterr()
    assert "short.csv: 1 points" in printed.err
    assert "no fit" in printed.out
    status, table, _ = batch({"good.csv": 1.0, "short.csv": short}, "--format", "json")
    answer = json.loads(capsys.readouterr().out)
    assert status == 4
    assert [fitted["curve"] for fitted in answer["fits"]] == ["good.csv"]
    assert [failure["curve"] for failure in answer["failures"]] == ["short.csv"]
    # A curve that was mended, and one that fits no more.
    assert batch({"good.csv": 1.0, "short.csv": 1.0})[0] == 0


def test_curves_that_are_all_unusable_are_wrong_input(batch, capsys):
    status, table, _ = batch({"a.csv": "displacement [nm]\n", "b.csv": ""})
    assert (status, table) == (2, None)
    assert "a.csv" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("names", "pictures"),
    [
        (["c.csv", "c.txt"], ["c.csv", "c.txt"]),
        (["c.csv", "C.txt"], ["c.csv", "C.txt"]),
        (["c.h5", "c-1.csv", "d.csv"], ["c.h5", "c-1.csv", "d"]),
        (["c.h5", "c-map.csv"], ["c.h5", "c-map.csv"]),
        (["c-1.csv", "c-2.csv", "a/c.csv"], ["c-1", "c-2", "a/c"]),
    ],
)
def test_no_two_files_share_a_picture(tmp_path, names, pictures):
    assert list(_pictures(names, tmp_path).values()) == [tmp_path / name for name in pictures]


def test_the_table_of_fits_is_written_under_the_lock(batch, tmp_path, monkeypatch):
    written = []
    monkeypatch.setattr("comparisons.fitting.folder._write", lambda folder, *_: written.append(is_locked(folder)))
    batch({"c.csv": 1.0})
    assert written == [True]


def test_a_branch_without_points_is_wrong_input():
    _, record = recorded(2e3)
    approach = record.only("approach")
    with pytest.raises(ValueError, match="retreat"):
        fitted(contact(1e9, 0.05), approach, branch="retreat")


def test_a_number_too_large_for_a_step_has_no_derivative():
    with pytest.raises(ComputationFailed):
        differences(lambda values: np.ones(3), {"a": 1e30}, 1e-3)


#: Cells that are no number of a curve.
UNREADABLE = ("x", "nan", "inf", "1e999", "1e40", "4_0_0", "1.0D0", "")

#: Twenty points, whose range in the first column is 1e-307 m, and 20 nN or nm in the other.
ROWS = "".join(f"{i}e-300,{i}\n" for i in range(1, 21))


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        (None, [], "no file"),
        ("displacement [nm],load [nN]\n1,2\n", [], "fewer than 20"),
        ("displacement,load [nN]\n1,2\n", [], "has no unit"),
        ("displacement [nm],load [nm]\n1,2\n", [], "load has the unit nm"),
        *((f"displacement [nm],load [nN]\n0,1\n1,{cell}\n", [], f"line 3: load = '{cell}'") for cell in UNREADABLE),
        ("displacement [nm],load [nN]\n-11,90,1,09\n", [], "line 2: 4 values for 2 columns"),
        ("displacement [nm],load [nN]\n1,2\n1,2,0\n", [], "line 3: 3 values for 2 columns"),
        ("displacement [nm],load [nN]\n1\n", [], "line 2: 1 values for 2 columns"),
        ("displacement [nm],load [nN],load [uN]\n1,2,3\n", [], "column load stands twice"),
        ('displacement [nm],load [nN]\n1,"2\n', [], "line 2"),
        ("", [], "empty"),
        (f"displacement [nm],load [nN]\n{ROWS}", [], "displacements"),
        (f"load [nN],displacement [nm]\n{ROWS}", [], "loads"),
        ("displacement [nm],load [nN]\n" + "1,2\n" * 20, [], "all loads are equal"),
        ("height [nm],deflection [nm]\n1,2\n", [], "--stiffness"),
        ("height [nm],deflection [V]\n1,2\n", ["--stiffness", "1 N/m"], "--sensitivity"),
        ("displacement [nm],load [nN]\n1,2\n", ["--stiffness", "1 m"], "--stiffness 1 m"),
        ("displacement [nm],load [nN]\n1,2\n", ["--free", "solid.G"], "'G'"),
        ("displacement [nm],load [nN]\n1,2\n", ["--free", "solid"], "solid"),
        ("displacement [nm],load [nN]\n1,2\n", ["--free", "E0"], "did you mean solid.E0?"),
        ("displacement [nm],load [nN]\n1,2\n", ["--free", "w"], "did you mean law.work_of_adhesion?"),
        ("displacement [nm],load [nN],branch\n1,2,up\n", [], "'up'"),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, capsys, text, options, sentence):
    (tmp_path / "probe.toml").write_text(PROBE)
    if text is not None:
        (tmp_path / "curve.csv").write_text(text)
    arguments = ["--problem", str(tmp_path / "probe.toml"), "--free", "solid.E0"]
    assert main(["fit", str(tmp_path / "curve.csv"), *arguments, *options]) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert "Traceback" not in error


def test_curves_behind_the_keys_are_curves(tmp_path, refused, monkeypatch):
    (tmp_path / "probe.toml").write_text(PROBE)
    files = [tmp_path / f"{name}.csv" for name in "abc"]
    for path in files:
        path.touch()
    given = []
    monkeypatch.setattr("comparisons.cli.commands.fit.fit_files", lambda *arguments, **_: given.append(arguments) or [])
    words = [*map(str, files)]
    problem = ["--problem", str(tmp_path / "probe.toml")]
    for command in (
        [*problem, "--free", *FREE, *words],
        [words[0], "--free", *FREE, words[1], *problem, "--free", words[2]],
        [*words, *problem, "--free", *FREE],
    ):
        assert main(["fit", *command]) == 0
    assert [(curves, keys) for curves, _, keys, *_ in given] == [(files, FREE)] * 3
    refused(
        ["fit", *problem, "--free", "solid.E0", str(tmp_path / "d.csv")], "lacks a measured curve", "fit CURVE ... "
    )
    refused(["fit", *problem, "--free", words[0]], "lacks keys to fit")


def test_a_file_of_no_known_format_is_wrong_input(tmp_path, refused):
    """What afmformats raises for it is no `Exception`."""
    pytest.importorskip("afmformats")
    (tmp_path / "probe.toml").write_text(PROBE)
    (tmp_path / "curve.txt").write_text("# no format\n1 2\n")
    refused(
        ["fit", str(tmp_path / "curve.txt"), "--problem", str(tmp_path / "probe.toml"), "--free", "solid.E0"],
        "curve.txt",
    )


def test_a_file_of_an_instrument_is_read(tmp_path):
    """In the simplest text format that afmformats knows: height of the base in nm, deflection in V."""
    pytest.importorskip("afmformats")
    problem, record = recorded(2e3, seed=5, noise=0.005)
    stiffness, gain = 2.0, 1e-7
    height, volts = -record.displacement - record.load / stiffness, record.load / stiffness / gain
    half = record.approach.sum()
    rows = zip(-height[:half] * 1e9, volts[:half], -height[half:] * 1e9, volts[half:], strict=True)
    head = ["Force-Distance Curve", "File Format:\t3", "Date:\tWednesday, August 1, 2018", "Time:\t1:07:47 PM"]
    head += ["Mode:\tSingle", "Point:\t1", "X, um:\t27.25", "Y, um:\t27.25", ""]
    head += ["Extend Z-Sense(nm),Extend T-B(V),Retract Z-Sense(nm),Retract T-B(V)"]
    lines = [",".join(f"{number:.9g}" for number in row) for row in rows]
    path = tmp_path / "curve.csv"
    path.write_text("\n".join([*head, *lines]) + "\n")
    start = wrong(problem, 1.5)
    (result,) = fit(path, start, FREE, branch="retreat", stiffness=stiffness, sensitivity=gain)
    for key, row in result.parameters.items():
        assert row.value == pytest.approx(problem[key], rel=0.05)


def test_a_fold_near_a_point_of_the_record_does_not_narrow_the_uncertainty():
    """The uncertainty changes with the seed of the noise by tenths of itself, not by powers of ten."""
    shares = []
    for seed in range(3):
        problem, record = recorded(3.0, seed=seed, noise=0.04)
        shares.append([row.u / row.value for row in fitted(problem, record, problem).parameters.values()])
    assert (np.max(shares, axis=0) < 3.0 * np.min(shares, axis=0)).all()


@pytest.mark.heavy
def test_stated_intervals_hold_as_often_as_they_say():
    """500 curves, Tabor numbers 0.05 to 1e4: 68 and 95 % within four standard deviations of sampling."""
    rng = np.random.default_rng(31)
    scores = []
    for _ in range(500):
        problem = of_tabor_number(10.0 ** rng.uniform(-1.3, 4.0), float(rng.choice([0.0, 0.2, 0.4, 0.6])))
        noise, largest = 10.0 ** rng.uniform(-2.5, -1.3), 10.0 ** rng.uniform(0.0, 1.0)
        instrument = Instrument(noise, int(rng.integers(100, 500)), rng.uniform(-0.02, 0.02), largest)
        record = instrument.record(problem, rng)
        scores += map(
            abs, deviations(problem, fitted(problem, record, wrong(problem, float(np.exp(rng.uniform(-1, 1))))))
        )
    for level, limit in ((0.6827, 1.0), (0.9545, 2.0)):
        share = np.mean(np.array(scores) < limit)
        assert abs(share - level) < 4.0 * binom.std(500, level) / 500


@pytest.mark.heavy
def test_a_record_of_the_finite_elements_gives_its_values():
    problem = contact(5e8, 0.05)
    path = fem_reference.trace(problem.build(fem_reference), largest_turn=1.0)
    machine = Machine.of(Equilibria(path.displacement, path.load), math.inf)
    far, touching = machine.far, machine.contact
    loading = np.column_stack([far, touching[:, touching[0] > far[0, -1]]])
    unloading = np.column_stack([far[:, far[0] < touching[0, 0]], touching])
    cycle = loading, unloading, -path.load.min(), touching[0, 0] - 4e-9
    result = fitted(problem, Instrument(noise=0.005).record(problem, np.random.default_rng(8), cycle=cycle))
    assert max(map(abs, deviations(problem, result))) < 3.0
    assert all(row.u < 2e-3 * row.value for row in result.parameters.values())
