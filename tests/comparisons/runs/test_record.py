"""Record of a run: written and read only if it fits its schema."""

import json

import pytest

from comparisons.runs.environment import computing_environment, environment
from comparisons.runs.record import read_record, write_record

GOOD = {
    "format": 5,
    "command_name": "run",
    "arguments": {
        "tier": "quick",
        "grid": None,
        "model": None,
        "external": {},
        "gates": None,
        "jobs": 2,
        "out": "x",
    },
    "command": ["fscm-bench", "run"],
    "started": "2026-01-01T00:00:00+00:00",
    "finished": "2026-01-01T00:00:09+00:00",
    "seconds": {"run": 9.0, "by_model": {"fscm": 8.5}},
    "rows": {"all": 2, "resumed": 0, "ok": 2},
    "cases_sha256": "0" * 64,
    "gates_sha256": "f" * 64,
    "models": {"fscm": {"version": "1", "citation": "none", "domain": "all"}},
    "verdicts": {"all": "PASS", "PASS": 2},
    "parts": [{"started": "2026-01-01T00:00:00+00:00", "seconds": 9.0, "computations": 2, **computing_environment()}],
}


@pytest.fixture(scope="module")
def good():
    return GOOD | environment()


def test_one_nested_without_end_is_refused(tmp_path):
    (tmp_path / "run.json").write_text("[" * 200_000 + "]" * 200_000)
    with pytest.raises(ValueError, match=r"run.json is not the record of a run"):
        read_record(tmp_path / "run.json")


def test_what_is_written_is_read(good, tmp_path):
    write_record(good, tmp_path / "run.json")
    assert read_record(tmp_path / "run.json") == json.loads(json.dumps(good)) | {"files": {}}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"format": 1}, "format"),
        ({"parts": [{"started": "2026-01-01T00:00:00+00:00"}]}, "parts"),
        ({"surprise": 1}, "surprise"),
        ({"cases_sha256": "short"}, "cases_sha256"),
        ({"started": "yesterday"}, "started"),
        ({"rows": {"all": -1, "resumed": 0}}, "rows.all"),
        ({"arguments": {"tier": "quick"}}, "arguments"),
    ],
)
def test_what_does_not_fit_is_neither_written_nor_read(good, tmp_path, change, sentence):
    path = tmp_path / "run.json"
    with pytest.raises(RuntimeError, match=sentence):
        write_record(good | change, path)
    assert not path.exists()
    path.write_text(json.dumps({"files": {}, "sha256": "0" * 64} | good | change))
    with pytest.raises(ValueError, match=sentence):
        read_record(path)


def test_what_is_missing_is_named(good, tmp_path):
    with pytest.raises(RuntimeError, match="gates_sha256"):
        write_record({key: value for key, value in good.items() if key != "gates_sha256"}, tmp_path / "run.json")


def test_a_folder_that_is_no_run(tmp_path):
    with pytest.raises(ValueError, match="not the folder of a finished run"):
        read_record(tmp_path / "run.json")
    (tmp_path / "run.json").write_text("{")
    with pytest.raises(ValueError, match="not JSON"):
        read_record(tmp_path / "run.json")
