"""Ratios, summaries and figures of the parts, from the committed measurements; what is planned."""

from pathlib import Path

import pandas as pd
import pytest

from comparisons.bench import adhesion_package, work_precision
from comparisons.bench.baseline import BENCH_BASELINE
from comparisons.bench.part import table_of
from comparisons.bench.run import PARTS
from comparisons.bench.work_precision import CERTIFIED

COMMITTED = Path(__file__).parents[3] / BENCH_BASELINE


def stored(name):
    """The committed table of a part, and its columns that are measured."""
    table = pd.read_csv(PARTS[name].files(COMMITTED)[0])
    if name == "work-precision":
        # Numbers of fscm, names of the finite elements.
        numbers = pd.to_numeric(table["accuracy"], errors="coerce")
        table["accuracy"] = numbers.astype(object).where(numbers.notna(), table["accuracy"])
    return table, table.loc[:, :"reason"]


@pytest.mark.parametrize("name", list(PARTS))
def test_the_ratios_of_every_planned_measurement_are_those_committed(name):
    table, measured = stored(name)
    pd.testing.assert_frame_equal(PARTS[name].ratios(measured), table, rtol=1e-12)
    assert len(table) >= len(PARTS[name].plan(False))


def test_the_fits_and_the_speed_of_two_workers_are_those_committed():
    growth, workers = (PARTS[name].summary(stored(name)[0]) for name in ("growth", "workers"))
    text = (COMMITTED / "bench.txt").read_text()
    assert [line for line in (*growth[-2:], *workers) if line not in text] == []


@pytest.mark.parametrize("name", list(PARTS))
def test_a_part_is_drawn_and_summed_up_also_with_one_value_and_one_failure(name, tmp_path):
    part, (table, measured) = PARTS[name], stored(name)
    good, bad = part.plan(True)[:2]
    numbers = measured.iloc[0].drop([*good, "status", "reason"]).to_dict()
    made = {"part": name, "settings": good, "numbers": numbers, "status": "ok", "reason": ""}
    failed = {"part": name, "settings": bad, "numbers": {}, "status": "failed", "reason": "lost"}
    few = table_of(part, [failed, made])
    assert few["status"].tolist() == ["ok", "failed"]
    for rows in (table, few[few["status"] == "ok"]):
        figure = part.draw(rows)
        assert all(axes.get_xlabel() for axes in figure.axes)
        figure.savefig(tmp_path / "figure.png")
        lines = part.summary(rows)
        # All parts together fit a screen.
        assert len(lines) <= 15
        assert max(map(len, lines), default=0) <= 80
    assert table_of(part, [failed])["reason"].tolist() == ["lost"]


def test_errors_that_are_not_known_well_enough_have_no_ratio_and_the_reference_must_be_certified():
    pair = {"mu": [1.0, 1.0], "model": ["fscm", "fem"], "error": [1e-9, 1.5e-9], "cpu_seconds": [1.0, 9.0]}
    assert pd.isna(work_precision.time_ratios(pd.DataFrame({**pair, "u_reference": [1e-9, 1e-9]}))).all()
    _, measured = stored("work-precision")
    assert not PARTS["work-precision"].ratios(measured.assign(value=1.7))["reference_is_certified"].any()


def test_the_certified_values_are_those_that_the_tests_prove():
    flint = pytest.importorskip("flint")
    from tests.certified.pull_off_enclosure import CERTIFIED as PROVED

    proved = {float(case.form.mu): flint.arb(case.force) for case in PROVED.values()}
    assert proved.keys() == CERTIFIED.keys()
    for mu, interval in CERTIFIED.items():
        assert flint.arb(*interval).contains(proved[mu].mid())


def test_long_settings_are_measured_at_one_tabor_number_unless_all_are_wanted():
    few, full = ([row["mu"] for row in work_precision.plan(is_full) if 2500 in row.values()] for is_full in (0, 1))
    assert (few, full) == ([1.0], [0.1, 0.5, 1.0])


def test_without_the_package_adhesion_nothing_of_it_is_measured_and_that_is_said(monkeypatch):
    monkeypatch.setattr(adhesion_package, "_MODULES", ("json", "no_such_module_of_adhesion"))
    assert not any(row["model"] == "adhesion" for row in work_precision.plan(True))
    rows, _ = stored("work-precision")
    assert any(adhesion_package.INSTALL in line for line in work_precision.summary(rows[rows["model"] != "adhesion"]))


def test_a_busy_machine_is_named():
    table, _ = stored("workers")
    # Of 200 seconds on two cores the workers had 37.
    busy = table.assign(seconds_of_tasks=100.0, cpu_seconds=37.0)
    assert "0.18 of a core" in PARTS["workers"].summary(busy)[-1]
