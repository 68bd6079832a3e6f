"""Tables, ratios, fits, summaries and figures of the parts, from numbers that are made up."""

import pandas as pd
import pytest

from comparisons.bench import adhesion_package, cold_starts, elements, growth, two_workers, work_precision
from comparisons.bench.fits import growth_exponent, line
from comparisons.bench.part import Measurement, table_of
from comparisons.bench.references import CERTIFIED
from comparisons.bench.registry import PARTS, chosen


def made_up(part, number):
    """A table of a part with the number that `number` returns for the settings of each measurement."""
    items = PARTS[part].items(True)
    return table_of([Measurement(part, item.settings, number(item.settings)) for item in items])


def pull_off(settings):
    error = {"fscm": 1e-12, "fem": 1e-8, "fscm-stieltjes": 5e-4, "adhesion": 1e-3}[settings["model"]]
    seconds = {"fscm": 0.1, "fem": 4.0, "fscm-stieltjes": 200.0, "adhesion": 60.0}[settings["model"]]
    exact = CERTIFIED[settings["mu"]].centre
    if settings.get("accuracy") == 1e-10:
        error = 0.0
    value = exact * (1.0 + error)
    return {"value": value, "u_num": 1e-13 * exact, "unknowns": 100, "cpu_seconds": seconds}


def system(settings):
    method, unknowns = settings["method"], round(1e4 / settings["density"] ** 2)
    return {
        "unknowns": unknowns,
        "iterations": {"pyamg": round(8 / settings["density"] ** 0.1)}.get(method, 0),
        "residual": 1e-12,
        "setup_seconds": 1e-5 * unknowns,
        "solve_seconds": {"pyamg": 1e-5, "direct": 5e-6, "condensed": 0.0}[method] * unknowns,
        "assembly_seconds": 1.0,
        "megabytes": {"pyamg": 6.0, "direct": 3.0, "condensed": 4.0}[method] * unknowns / 1e3,
        "displacement": 1.0 + (1e-9 if method == "pyamg" else 0.0),
    }


def grown(settings):
    width = 10.0 ** -(settings["mu"] / 10.0 + 2.0 * settings["k"])
    unknowns = 200 + 50 * (settings["mu"] / 10.0 + 2.0 * settings["k"])
    return {
        "value": 2.0,
        "u_num": 1e-12,
        "unknowns": unknowns,
        "cpu_seconds": 0.1 + settings["mu"],
        "edge_width": width,
    }


MADE_UP = {
    "growth": grown,
    "cold-starts": lambda settings: {
        "cpu_seconds": 0.02 * len(settings["command"]),
        "seconds": 1.0,
        "exit_status": 0,
    },
    "workers": lambda settings: {
        "seconds": 41.0 / settings["workers"],
        "seconds_of_tasks": 38.0 / settings["workers"],
        "cpu_seconds": 37.0,
    },
    "elements": system,
    "work-precision": pull_off,
}


@pytest.fixture
def tables(monkeypatch):
    monkeypatch.setattr(adhesion_package, "installed", lambda: True)
    return {name: part.table(made_up(name, MADE_UP[name])) for name, part in PARTS.items()}


def test_every_part_has_made_up_numbers():
    assert set(MADE_UP) == set(PARTS)
    assert [part.name for part in chosen(["elements", "growth"])] == ["growth", "elements"]


def test_the_whole_summary_fits_a_screen(tables):
    lines = [line for name, part in PARTS.items() for line in part.summary(tables[name])]
    assert len(lines) <= 39  # and one that names the machine
    assert [line for line in lines if len(line) > 80] == []


@pytest.mark.parametrize("name", list(PARTS))
def test_every_part_is_drawn(name, tables, tmp_path):
    figure = PARTS[name].draw(tables[name])
    assert all(axes.get_xlabel() or axes.get_ylabel() for axes in figure.axes)
    figure.savefig(tmp_path / "figure.png")


@pytest.mark.parametrize("name", list(PARTS))
def test_a_part_with_one_value_and_one_failure_is_drawn_and_summarised(name, tables):
    part = PARTS[name]
    items = part.items(False)[:2]
    good = Measurement(name, items[0].settings, MADE_UP[name](items[0].settings))
    bad = Measurement(name, items[1].settings, status="failed", reason="lost")
    table = part.table(table_of([good, bad]))
    assert table["status"].tolist() == ["ok", "failed"]
    part.draw(table)
    part.summary(table)
    assert part.table(table_of([bad]))["reason"].tolist() == ["lost"]


def test_a_ratio_is_to_the_fastest_fscm_with_a_certainly_smaller_error(tables):
    table = tables["work-precision"].set_index(["model", "mu", "setting"])
    assert table.loc[("fscm-stieltjes", 1.0, "N = 2500"), "ratio"] == pytest.approx(2000.0)
    assert table.loc[("adhesion", 0.5, "64 x 64"), "ratio"] == pytest.approx(600.0)
    assert table.loc["fscm"]["ratio"].isna().all()
    assert table["reference_is_certified"].all()
    pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1.5e-9], "cpu_seconds": [1.0, 9.0]}
    # The two errors are known to within 1e-9: which is smaller is open.
    (ours, other) = work_precision.ratios(pd.DataFrame({**pair, "u_reference": [1e-9, 1e-9]}))
    assert ours != ours
    assert other != other


def test_the_reference_is_the_tightest_accuracy_and_must_be_in_the_certified_interval():
    rows = made_up("work-precision", lambda settings: {**pull_off(settings), "value": 1.7})
    table = work_precision.table(rows)
    assert (table["error"] == 0.0).all()
    assert not table["reference_is_certified"].any()
    assert "reference in the certified interval at mu = none" in work_precision.summary(table)[-1]


def test_the_certified_values_are_those_that_the_tests_prove():
    flint = pytest.importorskip("flint")
    from tests.certified.pull_off_enclosure import CERTIFIED as PROVED

    proved = {float(one.form.mu): flint.arb(one.force) for one in PROVED.values()}
    assert proved.keys() == CERTIFIED.keys()
    for mu, enclosure in CERTIFIED.items():
        assert flint.arb(enclosure.centre, enclosure.radius).contains(proved[mu].mid())


def test_long_settings_are_measured_at_one_tabor_number_unless_all_are_wanted(monkeypatch):
    monkeypatch.setattr(adhesion_package, "installed", lambda: True)

    def tabor_numbers(full, **wanted):
        settings = [item.settings for item in work_precision.items(full)]
        return [one["mu"] for one in settings if wanted.items() <= one.items()]

    assert tabor_numbers(False, segments=2500) == [1.0]
    assert tabor_numbers(True, segments=2500) == [0.1, 0.5, 1.0]
    assert tabor_numbers(False, points=512) == []
    assert tabor_numbers(True, points=512) == [0.1, 0.5, 1.0]


def test_without_the_package_adhesion_nothing_of_it_is_measured_and_that_is_said(monkeypatch):
    monkeypatch.setattr(adhesion_package, "installed", lambda: False)
    assert not any(item.settings["model"] == "adhesion" for item in work_precision.items(True))
    table = work_precision.table(made_up("work-precision", pull_off))
    assert '  adhesion is not installed: pip install "fscm-bench[bench]"' in work_precision.summary(table)


def test_a_module_that_cannot_be_found_is_a_package_that_is_not_installed(monkeypatch):
    monkeypatch.setattr(adhesion_package, "_MODULES", ("json", "no_such_module_of_adhesion"))
    assert not adhesion_package.installed()
    monkeypatch.setattr(adhesion_package, "_DISTRIBUTIONS", ("numpy", "no-such-distribution"))
    assert adhesion_package.versions().keys() == {"numpy"}


def test_methods_are_compared_with_pyamg_on_the_same_system(tables):
    table = tables["elements"].set_index(["density", "k", "nu", "method"])
    assert table.loc[(0.3, 0.4, 0.25, "direct"), "ratio"] == pytest.approx(0.75)
    assert table.loc[(0.3, 0.4, 0.25, "condensed"), "memory_ratio"] == pytest.approx(4.0 / 6.0)
    assert table.loc[(0.3, 0.4, 0.25, "pyamg"), "disagreement"] == pytest.approx(1e-9)
    assert len(elements.items(False)) == 12
    assert len(elements.items(True)) == 45


def test_unknowns_are_fitted_against_the_width_of_the_edge(tables):
    lines = growth.summary(tables["growth"])
    assert "  with mu: unknowns = 200 + 50 log10(1 / edge width) within 0 %" in lines[-2]
    assert "  with k: unknowns = 200 + 50 log10(1 / edge width) within 0 %" in lines[-1]


def test_time_of_one_worker_over_time_of_two(tables):
    table = tables["workers"].set_index("workers")
    assert table["ratio"].tolist() == [1.0, 2.0]
    assert two_workers.summary(tables["workers"]) == [
        "2 workers / 1 on 200 cases: 2.00 times as fast (2.00 with their start)"
    ]
    # Of 200 seconds on two cores the workers had 37.
    (_, busy) = two_workers.summary(tables["workers"].assign(seconds_of_tasks=100.0, workers=[1, 2]))
    assert busy == "  (the machine was busy: a worker had 0.18 of a core; repeat on an idle machine)"
    assert len(busy) <= 80


def test_commands_are_compared_with_an_interpreter_that_does_nothing(tables):
    table = tables["cold-starts"].set_index("command")
    assert table.loc[cold_starts.BARE, "ratio"] == 1.0
    assert table.loc["--help", "ratio"] == pytest.approx(6.0 / 14.0)


def test_a_line_and_a_power():
    assert line([1.0, 2.0, 3.0], [1.0, 3.0, 5.0]) == (-1.0, 2.0, 0.0)
    assert line([0.0, 1.0, 2.0], [1.0, 2.0, 1.0]).residual == pytest.approx(2.0 / 6.0)
    assert growth_exponent([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]) == pytest.approx(2.0)
    with pytest.raises(ValueError, match="two points with different x; there are 1"):
        line([2.0, 2.0], [1.0, 3.0])
