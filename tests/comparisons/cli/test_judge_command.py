"""Verdicts of a run and of a folder that is judged again: exit statuses and files."""

import random
import re
import shutil

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.data.file_names import VERDICT_FILES, is_of_verdicts
from comparisons.output.report.page import make_page
from comparisons.output.report.stored_run import read_folder
from comparisons.runs.environment import fingerprint
from comparisons.runs.record import read_record, write_record


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Where the run is that every test gets a copy of."""
    return tmp_path_factory.mktemp("finished") / "run"


@pytest.fixture
def folder(small_grid, finished, tmp_path, capsys):
    """A finished run."""
    if not finished.exists():
        assert main(["run", "--jobs", "1", "--out", str(finished)]) == 0
        capsys.readouterr()
    return shutil.copytree(finished, tmp_path / "run")


def verdicts_in(folder):
    """What is written when the folder is judged."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if is_of_verdicts(path.name)}


def gates(text, tmp_path, *changes):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "gates.toml").write_text(text)
    return ["--gates", str(tmp_path / "gates.toml")]


def test_judging_again_gives_the_same_and_computes_nothing(folder, monkeypatch, capsys):
    before = verdicts_in(folder)
    assert before.keys() > set(VERDICT_FILES)
    monkeypatch.setattr("comparisons.registry.create", None)
    monkeypatch.setattr("comparisons.runs.tasks.evaluate_task", None)
    captured = []
    for _ in range(2):
        assert main(["judge", str(folder), "--verbose"]) == 0
        captured.append(capsys.readouterr().out)
        assert verdicts_in(folder) == before
    assert captured[0] == captured[1]
    assert "fscm-bench solve --model ten-percent --quantity pull_off_force --n 2 --k 0" in captured[0]
    assert "1 of 1 gates pass" in captured[0]


FAILING = ("upper = 0.11", "upper = 0.095")


def declared(worst, low, high):
    """The change of a gate that declares its failure with a worst error and the range of it."""
    declaration = f'expected_failure = "known"\nworst_measured = {worst}\nmeasured_range = [{low}, {high}]\n'
    return "min_cases", f"{declaration}min_cases"


@pytest.mark.parametrize(
    ("changes", "status", "verdict"),
    [
        ([], 0, "PASS"),
        ([FAILING], 1, "FAIL"),
        ([("upper = 0.11", "upper = 0.1")], 3, "INCONCLUSIVE"),
        ([("min_cases = 4", "min_cases = 5")], 4, "ERROR"),
        ([('tier = "quick"', 'tier = "full"')], 4, "ERROR"),
        ([FAILING, declared(0.1, 0.0999, 0.1001)], 0, "XFAIL"),
        ([FAILING, declared(0.2, 0.15, 0.25)], 1, "FAIL"),
        ([declared(0.2, 0.15, 0.25)], 1, "XPASS"),
    ],
)
def test_the_exit_status_is_the_verdict(small_grid, folder, tmp_path, capsys, changes, status, verdict):
    rules = gates(small_grid, tmp_path, *changes)
    for command in (["run", "--jobs", "1", "--out", str(tmp_path / "out")], ["judge", str(folder)]):
        assert main([*command, *rules]) == status
        captured = capsys.readouterr()
        assert verdict in captured.out or "no gate was evaluated" in captured.err
        # Status 4 is explained on stderr.
        assert ("a gate is in error" in captured.err or "no gate was" in captured.err) == (verdict == "ERROR")
    assert read_record(tmp_path / "out" / "run.json")["verdicts"]["all"] == verdict


def provenance(folder):
    """What the page states of a folder."""
    return dict(make_page(read_folder(folder)).tables["provenance"].stored.to_numpy())


def test_other_gates_than_those_of_the_run_are_named_and_the_record_agrees(folder, small_grid, tmp_path, capsys):
    finished = read_record(folder / "run.json")
    assert main(["judge", str(folder), *gates(small_grid, tmp_path, FAILING)]) == 1
    assert re.search("judged by .*gates.toml, which are not the gates of the run", capsys.readouterr().err)
    record = read_record(folder / "run.json")
    assert record["verdicts"] == {"all": "FAIL", "FAIL": 4}
    assert record["judged_again"]["gates"] == str(tmp_path / "gates.toml")
    assert set(pd.read_csv(folder / "verdicts.csv")["verdict"]) == {"FAIL"}
    assert provenance(folder)["judged_again.gates"] == str(tmp_path / "gates.toml")
    # Without --gates the run's own are back, and nothing of the others is left.
    assert main(["judge", str(folder)]) == 0
    assert read_record(folder / "run.json") == finished


def test_a_run_is_judged_again_by_the_gates_it_was_made_with(small_grid, tmp_path, capsys):
    other_gate = small_grid.replace("TEN-PERCENT", "OTHER").replace('"ten-percent"', '"refuses"')
    rules = gates(small_grid + other_gate, tmp_path, FAILING)
    assert main(["run", "--jobs", "1", "--out", str(tmp_path / "run"), "--model", "ten-percent", *rules]) == 1
    kept = {name: (tmp_path / "run" / name).read_bytes() for name in ("run.json", "gates.toml")}
    before = verdicts_in(tmp_path / "run")
    (tmp_path / "gates.toml").unlink()
    assert main(["judge", str(tmp_path / "run")]) == 1
    assert "run/gates.toml, which are the gates of the run" in capsys.readouterr().err
    assert verdicts_in(tmp_path / "run") == before
    assert {name: (tmp_path / "run" / name).read_bytes() for name in kept} == kept


RIVAL = ('"rel"', '"rel"\nrival = "twelve-percent"'), ("lower = 0.09", "lower = -inf"), ("upper = 0.11", "upper = 0.0")


@pytest.mark.parametrize("candidate", ["ten-percent", "given"])
def test_a_gate_whose_rival_is_not_computed_is_refused_and_adding_it_helps(small_grid, tmp_path, capsys, candidate):
    rules = gates(small_grid, tmp_path, *RIVAL, ('candidate = "ten-percent"', f'candidate = "{candidate}"'))
    command = ["run", "--jobs", "1", *rules, "--out", str(tmp_path / "run"), "--model", "ten-percent"]
    assert main(command) == 2
    assert "add --model twelve-percent" in capsys.readouterr().err
    # The rival is not compared with itself.
    assert main([*command, "twelve-percent"]) == 0
    assert "1 of 1 gates pass" in capsys.readouterr().out


#: Bits that are flipped in each file, one at a time, chosen by this seed.  In files that neither command reads, all of
#: them have a flip at once: each time costs a whole judgement and a report.
FLIPS, SEED = 4, 20262


def flipped(content, rng):
    damaged = bytearray(content)
    damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
    return bytes(damaged)


def test_no_flipped_bit_of_any_stored_file_is_judged_in_silence(folder, refused):
    rng = random.Random(SEED)
    intact = {path.name: path.read_bytes() for path in folder.iterdir() if path.stat().st_size}
    assert intact.keys() - {"store.sqlite", "run.json"} == set(read_record(folder / "run.json")["files"])
    not_read = {name for name in intact if name == "store.sqlite" or is_of_verdicts(name)}
    for name in sorted(intact.keys() - not_read):
        for _ in range(FLIPS):
            (folder / name).write_bytes(flipped(intact[name], rng))
            refused(["judge", folder], name)
            refused(["report", folder], name)
            (folder / name).write_bytes(intact[name])
    damaged = {name: flipped(intact[name], rng) for name in sorted(not_read)}
    for name, content in damaged.items():
        (folder / name).write_bytes(content)
    assert (main(["judge", str(folder)]), main(["report", str(folder)])) == (0, 0)
    # Neither command reads the journal, and the judge writes the others again.
    for name in damaged:
        assert (folder / name).read_bytes() == (damaged if name == "store.sqlite" else intact)[name], name


def test_after_a_change_the_run_writes_its_tables_again(folder, refused):
    intact = (folder / "results.csv").read_bytes()
    (folder / "results.csv").write_bytes(intact[:-1])
    refused(["judge", folder], f"run with --out {folder}")
    assert main(["run", "--jobs", "1", "--out", str(folder)]) == 0
    assert (folder / "results.csv").read_bytes() == intact
    assert main(["judge", str(folder)]) == 0


@pytest.mark.parametrize("command", ["judge", "report"])
def test_results_of_other_code_are_named_as_such(folder, capsys, command):
    record = read_record(folder / "run.json")
    other_code = re.sub("NumPy .*?,", "NumPy 0.1,", record["package"]["fingerprint"])
    write_record(record | {"package": record["package"] | {"fingerprint": other_code}}, folder / "run.json")
    assert main([command, str(folder)]) == 0
    assert "computed by another version of the code, of NumPy or of SciPy (NumPy 0.1, now" in capsys.readouterr().err
    if command == "judge":
        assert read_record(folder / "run.json")["judged_by_other_code"] == fingerprint()
        assert provenance(folder)["judged_by_other_code"] == fingerprint()
        write_record(record, folder / "run.json")
        assert main(["judge", str(folder)]) == 0
        assert "judged_by_other_code" not in read_record(folder / "run.json")


@pytest.mark.parametrize("lost", ["run.json", "results.csv", "curves.csv"])
def test_a_folder_that_is_no_finished_run_is_wrong_input(folder, lost, refused):
    (folder / lost).unlink()
    refused(["judge", folder], "not the folder of a finished run")


def test_a_report_replaces_no_file_of_the_run(folder, refused):
    (folder / "link.html").symlink_to("run.json")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    for name in ("run.json", "store.sqlite", "results.csv", "gates.toml", "link.html"):
        refused(["report", folder, "--out", folder / name], f"--out {folder / name} is a file of the run")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
