"""Record of a run: written and read only if it fits its schema."""

import json

import pytest

from comparisons.runs.record import read_record, write_record
from tests.comparisons.records import record_of_run


def test_what_is_written_is_read(tmp_path):
    write_record(record_of_run(), tmp_path / "run.json")
    assert read_record(tmp_path / "run.json") == json.loads(json.dumps(record_of_run())) | {"files": {}}


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"format": 1}, "format"),
        ({"parts": [{"started": "2026-01-01T00:00:00+00:00"}]}, "parts"),
        ({"surprise": 1}, "surprise"),
        ({"cases_sha256": "short"}, "cases_sha256"),
        ({"started": "yesterday"}, "started"),
        ({"rows": {"all": -1, "resumed": 0}}, "rows.all"),
        ({"arguments": {"tier": "quick"}}, "arguments"),
        ({"gates_sha256": None}, "gates_sha256"),
    ],
)
def test_what_does_not_fit_is_neither_written_nor_read(tmp_path, change, named):
    path = tmp_path / "run.json"
    content = {name: value for name, value in (record_of_run() | change).items() if value is not None}
    with pytest.raises(RuntimeError, match=named):
        write_record(content, path)
    assert not path.exists()
    path.write_text(json.dumps({"files": {}, "sha256": "0" * 64} | content))
    with pytest.raises(ValueError, match=named):
        read_record(path)


@pytest.mark.parametrize("text", [None, "{", "[" * 200_000 + "]" * 200_000])
def test_a_folder_that_is_no_run(tmp_path, text):
    if text:
        (tmp_path / "run.json").write_text(text)
    with pytest.raises(ValueError, match=r"run.json (cannot be read|is not the record of a run)"):
        read_record(tmp_path / "run.json")
