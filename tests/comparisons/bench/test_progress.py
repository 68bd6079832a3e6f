"""CPU time now, then and at the floor: units, rows that one benchmark lacks, refusals."""

import json

import pandas as pd
import pytest

from comparisons.bench import progress
from comparisons.bench.cold_starts import BARE
from comparisons.bench.run import BENCH_BASELINE
from comparisons.cli.main import main
from tests.paths import ROOT


def tables(bare, cite, **sphere):
    """Times of two commands and of a problem, in seconds."""
    commands = pd.DataFrame({"command": [BARE, "cite"], "cpu_seconds": [bare, cite], "status": "ok"})
    problems = pd.DataFrame({"problem": ["sphere"], "size": 10.0, "model": "fem", **sphere, "status": "ok"})
    return {"cold-starts": commands, "kinds": problems}


def test_times_of_two_machines_are_each_in_their_own_bare_interpreter():
    now = tables(0.1, 0.3, cpu_seconds=2.0, floor_seconds=0.5)
    then = tables(0.2, 0.4, cpu_seconds=12.0)
    table = progress.progress(now, then)
    assert table.loc["sphere, 10 mu, fem"].to_dict() == pytest.approx(
        {"now": 20.0, "then": 60.0, "floor": 5.0, "then_over_now": 3.0, "now_over_floor": 4.0}
    )
    assert table.loc["cite", ["now", "then"]].tolist() == pytest.approx([3.0, 2.0])
    assert pd.isna(table.loc["cite", "floor"])
    assert progress.progress(now, None)["then"].isna().all()


def test_rows_that_failed_or_that_one_benchmark_lacks_have_no_ratio():
    now, then = tables(0.1, 0.3, cpu_seconds=2.0), tables(0.1, 0.3, cpu_seconds=2.0)
    then["kinds"] = then["kinds"].assign(problem="a kind of an earlier version")
    assert progress.progress(now, then)["then"].isna().tolist() == [False, False, True]
    now["kinds"] = now["kinds"].assign(status="failed")
    assert progress.progress(now, then).index.tolist() == [BARE, "cite"]
    now["cold-starts"] = now["cold-starts"].assign(status="failed")
    assert progress.progress(now, then).empty


def test_the_committed_benchmark_is_compared_and_drawn(tmp_path):
    stored = progress.stored_tables(ROOT / BENCH_BASELINE)
    table = progress.progress(stored, stored)
    assert (table["then_over_now"] == 1.0).all()
    assert table.loc[BARE, "now"] == 1.0
    shown = progress.summary(table).to_string(index=False, float_format="%.3g", na_rep="")
    assert max(map(len, shown.splitlines())) <= 80
    (axes,) = progress.draw(table.assign(floor=0.5 * table["now"])).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == list(table.index[::-1])
    assert {line.get_label() for line in axes.lines} == {"floor", "then", "now"}


@pytest.mark.parametrize("has_record", [False, True])
def test_a_folder_to_compare_with_must_be_a_benchmark_with_cold_starts(has_record, tmp_path, capsys):
    other = tmp_path / "other"
    other.mkdir()
    if has_record:
        (other / "bench.json").write_text(json.dumps({}))
    assert main(["bench", "--out", str(tmp_path / "out"), "--against", str(other)]) == 2
    assert str(other) in capsys.readouterr().err
    assert not (tmp_path / "out" / "bench.json").exists()
