"""A run of the benchmark: files, record, resumption, failures, refusals."""

import json

import pytest

from comparisons.bench.part import Item
from comparisons.bench.run import _TimeLeft, run_bench
from comparisons.cli.main import main
from comparisons.runs import store


def measured_sizes(calls):
    def measure(settings):
        calls.append(settings["size"])
        return {"cpu_seconds": 0.5}

    return measure


def test_a_run_writes_table_figure_and_record(tiny, tmp_path):
    finished = run_bench(tmp_path)
    assert (tmp_path / "tiny.csv").read_text() == "size,cpu_seconds,status,reason,ratio\n1,0.5,ok,,0.5\n2,1,ok,,1\n"
    assert (tmp_path / "tiny.png").read_bytes().startswith(b"\x89PNG")
    record = json.loads((tmp_path / "bench.json").read_text())
    assert record["machine"].keys() == {"system", "cpu", "cores"}
    assert [part["computations"] for part in record["parts"]] == [2]
    assert {"host", "cpu", "numpy", "started"} <= record["parts"][0].keys()
    assert record["dependencies"]["numpy"] == record["parts"][0]["numpy"]
    assert finished.summary[1:] == ["2 sizes"]
    assert (tmp_path / "bench.txt").read_text().splitlines() == finished.summary
    assert finished.failures == []
    (resource,) = json.loads((tmp_path / "datapackage.json").read_text())["resources"]
    assert resource["path"] == "tiny.csv"


def test_a_resumed_run_measures_what_is_missing_and_keeps_the_record_of_the_machine(tiny, tmp_path, monkeypatch):
    calls = []

    def interrupted(settings):
        if settings["size"] == 2:
            raise KeyboardInterrupt
        return measured_sizes(calls)(settings)

    tiny(measure=interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_bench(tmp_path)
    assert calls == [1]
    assert not (tmp_path / "tiny.csv").exists()

    other = {"host": "another machine", "cpu": "another CPU", "python": "3", "numpy": "2", "scipy": "1", "system": "x"}
    monkeypatch.setattr("comparisons.runs.store.computing_environment", lambda: other)
    tiny(measure=measured_sizes(calls))
    finished = run_bench(tmp_path)
    assert calls == [1, 2]
    assert finished.tables["tiny"]["size"].tolist() == [1, 2]
    parts = json.loads((tmp_path / "bench.json").read_text())["parts"]
    assert [part["computations"] for part in parts] == [1, 1]
    assert sorted(part["host"] == "another machine" for part in parts) == [False, True]


def test_full_adds_sizes_to_the_same_folder(tiny, tmp_path):
    run_bench(tmp_path, full=True)
    assert run_bench(tmp_path).tables["tiny"]["size"].tolist() == [1, 2, 8]


def test_again_drops_what_is_stored_also_by_another_version(tiny, tmp_path, monkeypatch):
    calls = []
    tiny(measure=measured_sizes(calls))
    run_bench(tmp_path)
    monkeypatch.setattr("comparisons.bench.run.fingerprint", lambda: "code 1, NumPy 2, SciPy 3")
    with pytest.raises(ValueError, match=r"another version of the code.*choose another --out"):
        run_bench(tmp_path)
    run_bench(tmp_path, again=True)
    assert calls == [1, 2, 1, 2]


def test_a_failure_costs_one_measurement_and_is_retried_on_request(tiny, tmp_path):
    tiny(items=lambda full: [Item({"size": -1}), Item({"size": 1})])
    finished = run_bench(tmp_path)
    assert [one.reason for one in finished.failures] == ["ArithmeticError: a negative size"]
    assert finished.tables["tiny"]["status"].tolist() == ["failed", "ok"]
    calls = []
    tiny(items=lambda full: [Item({"size": -1}), Item({"size": 1})], measure=measured_sizes(calls))
    run_bench(tmp_path)
    assert calls == []
    assert run_bench(tmp_path, retry_failed=True).failures == []
    assert calls == [-1]


def test_a_part_without_a_value_has_a_table_and_no_figure(tiny, tmp_path):
    tiny(items=lambda full: [Item({"size": -1})])
    run_bench(tmp_path)
    assert "a negative size" in (tmp_path / "tiny.csv").read_text()
    assert not (tmp_path / "tiny.png").exists()


@pytest.mark.parametrize("damage", [lambda text: text[:-9], lambda text: text.replace('"size": 2', '"size": 3')])
def test_a_damaged_measurement_is_made_again(tiny, tmp_path, damage):
    calls = []
    tiny(measure=measured_sizes(calls))
    run_bench(tmp_path)
    path = tmp_path / "bench.jsonl"
    path.write_text(damage(path.read_text()))
    run_bench(tmp_path)
    assert calls == [1, 2, 2]


def test_two_commands_cannot_use_one_folder(tiny, tmp_path):
    with (
        store.alone_in(tmp_path),
        pytest.raises(ValueError, match="another process is computing into"),
    ):
        run_bench(tmp_path)


def test_the_command_prints_ratios_and_ends_with_the_status(tiny, tmp_path, capsys):
    assert main(["bench", "--out", str(tmp_path / "a")]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines()[1:] == ["2 sizes"]
    assert "tables, figures and record are in" in err
    assert main(["bench", "--out", str(tmp_path / "b"), "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
    tiny(items=lambda full: [Item({"size": -1})])
    assert main(["bench", "--out", str(tmp_path / "c"), "--quiet"]) == 4
    assert capsys.readouterr().err == "tiny (size = -1): failed: ArithmeticError: a negative size\n"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--only", "speed"], "there is no part speed; the parts are growth, cold-starts, workers, elements"),
        (["--out", "/dev/null/x"], "the output folder /dev/null/x cannot be written"),
    ],
)
def test_wrong_input_is_one_sentence(arguments, sentence, capsys):
    assert main(["bench", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"fscm-bench: {sentence}")
    assert err.count("\n") == 1


def test_the_time_left_only_falls():
    items = [Item({}, 1.0), Item({}, 10.0), Item({}, 1.0)]
    times = iter([0.0, 5.0, 10.0, 60.0])
    left = _TimeLeft(items, clock=lambda: next(times))
    estimates = [left.after(item) for item in items]
    # After one of twelve seconds of work took five, 55 are left; then the ten were faster than they state.
    assert estimates == [55.0, pytest.approx(10.0 / 11.0), 0.0]
