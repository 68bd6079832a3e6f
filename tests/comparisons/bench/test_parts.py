"""Ratios, summaries and figures of the parts, from the committed measurements; what is planned."""

from pathlib import Path

import pandas as pd
import pytest

from comparisons.bench import work_precision
from comparisons.bench.run import BENCH_BASELINE, PARTS
from comparisons.bench.work_precision import CERTIFIED
from comparisons.paper.cache import Outcome

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
