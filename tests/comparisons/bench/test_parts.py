"""Ratios, fits, summaries and figures of the parts, from numbers that are made up."""

import pandas as pd
import pytest

from comparisons.bench import adhesion_package, cold_starts, work_precision
from comparisons.bench.part import table_of
from comparisons.bench.run import PARTS
from comparisons.bench.work_precision import CERTIFIED


def measurement(part, settings, numbers, reason=""):
    status = "failed" if reason else "ok"
    return {"part": part, "settings": settings, "numbers": numbers, "status": status, "reason": reason}


def made_up(name, number):
    """The table of a part with the numbers that `number` returns for the settings of each measurement."""
    part = PARTS[name]
    return table_of(part, [measurement(name, settings, number(settings)) for settings in part.plan(True)])


def pull_off(settings):
    error = {"fscm": 1e-12, "fem": 1e-8, "fscm-stieltjes": 5e-4, "adhesion": 1e-3}[settings["model"]]
    seconds = {"fscm": 0.1, "fem": 4.0, "fscm-stieltjes": 200.0, "adhesion": 60.0}[settings["model"]]
    exact, _ = CERTIFIED[settings["mu"]]
    if settings.get("accuracy") == 1e-10:
        error = 0.0
    return {"value": exact * (1.0 + error), "u_num": 1e-13 * exact, "unknowns": 100, "cpu_seconds": seconds}


def system(settings):
    method, unknowns = settings["method"], round(1e4 / settings["density"] ** 2)
    return {
        "unknowns": unknowns,
        "iterations": 8 if method == "pyamg" else 0,
        "residual": 1e-12,
        "setup_seconds": 1e-5 * unknowns,
        "solve_seconds": {"pyamg": 1e-5, "direct": 5e-6, "condensed": 0.0}[method] * unknowns,
        "assembly_seconds": 1.0,
        "megabytes": {"pyamg": 6.0, "direct": 3.0, "condensed": 4.0}[method] * unknowns / 1e3,
        "displacement": 1.0 + (1e-9 if method == "pyamg" else 0.0),
    }


def grown(settings):
    decades = settings["mu"] / 10.0 + 2.0 * settings["k"]
    numbers = {"value": 2.0, "u_num": 1e-12, "unknowns": 200 + 50 * decades, "cpu_seconds": 0.1 + settings["mu"]}
    return numbers | {"edge_width": 10.0**-decades}


def started(settings):
    return {"cpu_seconds": 0.02 * len(settings["command"]), "seconds": 1.0, "exit_status": 0}


def swept(settings):
    return {"seconds": 41.0 / settings["workers"], "seconds_of_tasks": 38.0 / settings["workers"], "cpu_seconds": 37.0}


MADE_UP = {
    "growth": grown,
    "cold-starts": started,
    "workers": swept,
    "elements": system,
    "work-precision": pull_off,
}


@pytest.fixture
def tables(monkeypatch):
    monkeypatch.setattr(adhesion_package, "installed", lambda: True)
    return {name: made_up(name, MADE_UP[name]) for name in PARTS}


@pytest.mark.parametrize("name", list(PARTS))
def test_every_part_is_drawn_and_summed_up_also_with_one_value_and_one_failure(name, tables, tmp_path):
    part = PARTS[name]
    good, bad = part.plan(False)[:2]
    few = [measurement(name, good, MADE_UP[name](good)), measurement(name, bad, {}, "lost")]
    table = table_of(part, few)
    assert table["status"].tolist() == ["ok", "failed"]
    for rows in (tables[name], table[table["status"] == "ok"]):
        lines = part.summary(rows)
        # All parts together fit a screen.
        assert len(lines) <= 15
        assert max(map(len, lines), default=0) <= 80
        figure = part.draw(rows)
        assert all(axes.get_xlabel() for axes in figure.axes)
        figure.savefig(tmp_path / "figure.png")
    assert table_of(part, few[1:])["reason"].tolist() == ["lost"]


def test_a_ratio_is_to_the_fastest_fscm_with_a_certainly_smaller_error(tables):
    table = tables["work-precision"].set_index(["model", "mu", "setting"])
    assert table.loc[("fscm-stieltjes", 1.0, "N = 2500"), "ratio"] == pytest.approx(2000.0)
    assert table.loc[("adhesion", 0.5, "64 x 64"), "ratio"] == pytest.approx(600.0)
    assert table.loc["fscm"]["ratio"].isna().all()
    assert table["reference_is_certified"].all()
    pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1.5e-9], "cpu_seconds": [1.0, 9.0]}
    # The two errors are known to within 1e-9: which is smaller is open.
    assert pd.isna(work_precision.time_ratios(pd.DataFrame({**pair, "u_reference": [1e-9, 1e-9]}))).all()


def test_the_reference_must_be_in_the_certified_interval():
    table = made_up("work-precision", lambda settings: {**pull_off(settings), "value": 1.7})
    assert (table["error"] == 0.0).all()
    assert not table["reference_is_certified"].any()


def test_the_certified_values_are_those_that_the_tests_prove():
    flint = pytest.importorskip("flint")
    from tests.certified.pull_off_enclosure import CERTIFIED as PROVED

    proved = {float(case.form.mu): flint.arb(case.force) for case in PROVED.values()}
    assert proved.keys() == CERTIFIED.keys()
    for mu, interval in CERTIFIED.items():
        assert flint.arb(*interval).contains(proved[mu].mid())


@pytest.mark.parametrize(
    ("wanted", "few", "full"), [({"segments": 2500}, [1.0], [0.1, 0.5, 1.0]), ({"points": 512}, [], [0.1, 0.5, 1.0])]
)
def test_long_settings_are_measured_at_one_tabor_number_unless_all_are_wanted(wanted, few, full, tables):
    plans = [work_precision.plan(False), work_precision.plan(True)]
    assert [[row["mu"] for row in plan if wanted.items() <= row.items()] for plan in plans] == [few, full]


def test_without_the_package_adhesion_nothing_of_it_is_measured_and_that_is_said(monkeypatch):
    monkeypatch.setattr(adhesion_package, "_MODULES", ("json", "no_such_module_of_adhesion"))
    assert not any(row["model"] == "adhesion" for row in work_precision.plan(True))
    assert any(adhesion_package.INSTALL in line for line in work_precision.summary(made_up("work-precision", pull_off)))


def test_methods_are_compared_with_pyamg_on_the_same_system(tables):
    table = tables["elements"].set_index(["density", "k", "nu", "method"])
    assert table.loc[(0.3, 0.4, 0.25, "direct"), "ratio"] == pytest.approx(0.75)
    assert table.loc[(0.3, 0.4, 0.25, "condensed"), "memory_ratio"] == pytest.approx(4.0 / 6.0)
    assert table.loc[(0.3, 0.4, 0.25, "pyamg"), "disagreement"] == pytest.approx(1e-9)
    assert (len(PARTS["elements"].plan(False)), len(table)) == (12, 45)


def test_unknowns_are_fitted_against_the_width_of_the_edge(tables):
    for line in PARTS["growth"].summary(tables["growth"])[-2:]:
        assert "unknowns = 200 + 50 log10(1 / edge width) within 0 %" in line


def test_time_of_one_worker_over_time_of_two(tables):
    table = tables["workers"].set_index("workers")
    assert table["ratio"].tolist() == [1.0, 2.0]
    assert len(PARTS["workers"].summary(tables["workers"])) == 1
    # Of 200 seconds on two cores the workers had 37.
    busy = PARTS["workers"].summary(tables["workers"].assign(seconds_of_tasks=100.0, workers=[1, 2]))[-1]
    assert "0.18 of a core" in busy


def test_commands_are_compared_with_an_interpreter_that_does_nothing(tables):
    table = tables["cold-starts"].set_index("command")
    assert table.loc[cold_starts.BARE, "ratio"] == 1.0
    assert table.loc["--help", "ratio"] == pytest.approx(6.0 / 14.0)
