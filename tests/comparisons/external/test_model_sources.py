"""One model from four sources (package, file, program, data), with the same results; and what names no model."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest

from comparisons.cli.main import main
from comparisons.external import child
from comparisons.external.model_source import close_models, source_of
from comparisons.external.replies import curve_of, result_of
from comparisons.model import ComputationFailed, HasCurve, Model, NotApplicable
from comparisons.problem import Problem
from comparisons.registry import create
from tests.paths import ROOT

from .conftest import EXAMPLE, ROWS, comes_true, has_ended, row_of

FILE_SOURCE = f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz"
QUANTITY = "pull_off_force"
CASE = Problem.dimensionless(2, 0.4, 1)


def rows_of(spec):
    """Four rows of a model, without what differs by its nature."""
    rows = [row_of(create(str(spec)), mu, k) for k in (0, 0.4) for mu in (0.1, 1)]
    return [replace(row, model_version="", seconds=0.0) for row in rows]


def test_all_sources_give_the_same_rows_and_the_installed_one_has_a_curve(installed_example, write_data, capsys):
    """Those of data were written as by an author who cannot give the code away."""
    rows = rows_of(FILE_SOURCE)
    assert {row.status for row in rows} == {"ok"}
    assert rows_of(installed_example) == rows
    cells = [f"{line.rpartition(',1.')[0]},{row.value!r},{row.u_num!r}" for line, row in zip(ROWS, rows, strict=True)]
    assert rows_of(write_data(cells, change={'"measured"': '"double-hertz"'})) == rows
    model = create(installed_example)
    assert isinstance(model, Model)
    assert isinstance(model, HasCurve)
    assert row_of(model, n=1, k=0).status == "not-applicable"
    assert row_of(model, 0.1, k=0, quantity="jump_out_displacement").status == "not-applicable"
    assert main(["list", "models"]) == 0
    assert "installed by double-hertz" in capsys.readouterr().out
    assert main(["curve", "--model", installed_example, "jkr", "--n", "2", "--k", "0.4", "--mu", "1"]) == 0
    rows = [row for row in csv.DictReader(capsys.readouterr().out.splitlines()) if row["model"] == "double-hertz"]
    # The curve's own minimum, on 201 points, against the pull-off force of the same model.
    load, displacement = (np.array([float(row[name]) for row in rows]) for name in ("load", "displacement"))
    least = load.argmin()
    assert -load[least] == pytest.approx(row_of(model).value, rel=1e-3)
    zero_load = row_of(create("double-hertz-n-k"), quantity="zero_load_displacement").value
    assert np.interp(0.0, load[least:], displacement[least:]) == pytest.approx(zero_load, rel=1e-3)


def test_two_models_of_one_name_and_one_with_a_name_of_ours_are_refused(write_data, write_model, refused):
    refused(["run", "--model", write_model(name="measured"), write_data()], "two models have the name measured")
    refused(["check-model", write_model(name="jkr")], "the name jkr of the external model")


def test_a_folder_and_an_installed_model_of_its_name_are_told_apart(install, write_data, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    install("mine", "mine:Model", {})
    (tmp_path / "mine").mkdir()
    assert source_of("mine")["kind"] == "package"
    with pytest.raises(ValueError, match=r"'\./mine'"):
        create("./mine")
    (tmp_path / "mine").rmdir()
    write_data().rename(tmp_path / "mine")
    with pytest.raises(ValueError, match=r"name the folder \./mine"):
        create("mine")
    assert create("./mine/model.toml").name == "measured"


NO_MODELS = {"": "is empty", " \t": "is empty", "./nothing": "./nothing", "nothing.py:Model": "there is no file"}
NO_MODELS |= {"model.py:2": "name of a class", "./model.py": "chmod", "mine.csv": "a folder with a model.toml"}


@pytest.mark.parametrize("spec", NO_MODELS)
def test_what_names_no_model_is_refused_in_one_sentence(tmp_path, monkeypatch, refused, spec):
    """An empty path would name predictions in the working folder."""
    for name in ("model.toml", "model.py", "mine.csv"):
        (tmp_path / name).touch(0o644)
    monkeypatch.chdir(tmp_path)
    refused(["check-model", spec], NO_MODELS[spec])


PROGRAM = ROOT / "tests" / "examples" / "program" / "jkr.sh"
DESCRIBE = '{"name": "mine", "version": "1", "citation": "A. Author", "domain": "n = 2"}'
#: Replies to the first request, and then does with every other one what the test states.
SCRIPT = """#!/bin/sh
read -r request
echo '{describe}'
while read -r request; do
{body}
done
"""


@pytest.fixture
def write_program(tmp_path):
    """Return a function that writes a shell script and returns its SPEC."""

    def write(body, describe=DESCRIBE, script=SCRIPT):
        file = tmp_path / "program"
        file.write_text(script.format(describe=describe, body=body), encoding="utf-8")
        file.chmod(0o755)
        return str(file)

    return write


def ok(value="1.7", more=""):
    return f"""echo '{{"status": "ok", "value": {value}, "u_num": 1e-15{more}}}'"""


def test_the_program_of_the_document_has_the_values_of_jkr_and_keeps_the_contract(capsys):
    document = (ROOT / "docs" / "judge_your_model.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```sh\n(#!/bin/sh\n.*?)^```", document, flags=re.MULTILINE | re.DOTALL)
    assert blocks == [PROGRAM.read_text(encoding="utf-8")]
    model = create(str(PROGRAM))
    assert abs(row_of(model).value - row_of(create("jkr")).value) <= 1e-15
    assert str(model.applies_to) == "pull_off_force for n = 2, 0 <= k <= 0.9, mu >= 0.01"
    assert row_of(model, n=1, k=0).status == "not-applicable"
    assert not isinstance(model, HasCurve)
    assert main(["check-model", str(PROGRAM)]) == 0
    assert "hashed: all files in program" in " ".join(capsys.readouterr().out.split())


def test_counts_and_a_curve_of_a_program(write_program):
    body = f"""case $request in
*evaluate*) {ok(more=', "size": 12.0, "iterations": 3, "residual": 1e-12')} ;;
*) echo '{{"status": "ok", "displacement": [-1, 0], "load": [-0.5, 0.2], "columns": {{"contact_radius": [0.1, 1]}}}}' ;;
esac"""
    model = create(write_program(body, DESCRIBE[:-1] + ', "curve": true, "limits": ["jkr"]}'))
    result = model.evaluate(CASE, QUANTITY)
    assert (result.size, result.iterations, result.residual) == (12, 3, 1e-12)
    curve = model.curve(CASE)
    assert curve.load.tolist() == [-0.5, 0.2]
    assert curve.columns["contact_radius"].tolist() == [0.1, 1.0]
    assert model.limits == ("jkr",)


#: What a program does instead of a reply, and the sentence about it.
DEFECTS = (
    ("echo 'cannot open table' >&2; exit 3", "exit status 3 instead of a reply; .*: cannot open table"),
    ("kill -9 $$", "was killed by signal 9"),
    ("echo 1.7", "wrote '1.7', which is not one JSON object"),
    (f"{ok()}; {ok()}", "more than one line for"),
    ("yes | tr -d '\\n'", "wrote 3000000 bytes without the end of a line"),
    ("exec 1>&-; sleep 60", "closed its standard output"),
)


def test_a_defect_of_a_program_is_one_sentence_and_costs_one_result(write_program, monkeypatch):
    """The defect depends on the Tabor number; after it the program is started again."""
    monkeypatch.setattr(child, "_LONGEST_REPLY", dict.fromkeys(child._LONGEST_REPLY, 3_000_000))
    cases = [f"*'\"mu\": {number}.0'*)\n{body}\n;;" for number, (body, _) in enumerate(DEFECTS, 1)]
    model = create(write_program("\n".join(["case $request in", *cases, f"*)\n{ok()}\n;; esac"])))
    for number, (body, sentence) in enumerate(DEFECTS, 1):
        if "sleep" in body:
            monkeypatch.setattr(child, "_END_SECONDS", 0.1)
        # What is too much after a reply is seen at the next request.
        with pytest.raises(ComputationFailed, match=sentence):
            [model.evaluate(Problem.dimensionless(2, 0, mu), QUANTITY) for mu in (number, 0.5)]
        assert model.evaluate(Problem.dimensionless(2, 0, 0.5), QUANTITY).value == 1.7


ARRAYS = '{"status": "ok", "displacement": %s, "load": %s}'


@pytest.mark.parametrize(
    ("reply", "sentence"),
    [
        (ARRAYS % ("[]", "[]"), r"displacement = \[\] must be"),
        (ARRAYS % ("[[1, 1], [1, 1]]", "[[1, 1], [1, 1]]"), "column displacement"),
        (ARRAYS % ("[1, 2]", '[1, "b"]'), "column load"),
        ('{"status": "ok", "value": NaN, "u_num": 0}', "wrote NaN, which is not a finite number"),
        ('{"status": "ok", "value": 1e999, "u_num": 0}', "value = inf must be a finite"),
        ('{"status": "ok", "value": 1.7, "u_num": 0, "unum": 1}', "unknown key 'unum'"),
        ('{"status": "ok", "value": 1.7}', "u_num missing"),
        ('{"value": 1.7, "u_num": 0}', "status = None"),
        ('{"status": "failed", "reason": "no root"}', "^no root$"),
        (2_000_000 * "[", "more than 2500 brackets"),
    ],
)
def test_a_reply_that_is_no_result_is_one_sentence(reply, sentence):
    read = curve_of if "load" in reply else result_of
    with pytest.raises(ComputationFailed, match=sentence):
        read(reply.encode())


def test_a_program_that_keeps_its_line_or_does_not_start_is_ended(write_program, monkeypatch):
    with pytest.raises(ValueError, match=r"cannot be started .*whose first line"):
        create(write_program("", script="no program\n"))
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.5")
    with pytest.raises(ComputationFailed, match=r"within 0.5 s .*FSCM_BENCH_TIME_LIMIT.* must flush"):
        create(write_program("printf '{}'; sleep 60")).evaluate(CASE, QUANTITY)


@pytest.mark.parametrize(
    ("option", "name", "meant"), [("--model", "dtm", "dmt"), ("--quantity", "pulloff", "pull_off_force")]
)
def test_a_name_nearly_like_one_of_ours_gets_that(refused, option, name, meant):
    named = {"--model": "jkr", "--quantity": "pull_off_force"} | {option: name}
    words = [word for pair in named.items() for word in pair]
    refused(["solve", *words, "--n", "2", "--k", "0", "--mu", "1"], f"did you mean {meant}?")


def test_a_program_that_describes_no_model_cannot_be_loaded(write_program):
    with pytest.raises(ValueError, match="unknown key 'python'"):
        create(write_program(ok(), DESCRIBE[:-1] + ', "python": {}}'))


def test_a_program_has_the_limits_of_other_models_and_ends_with_it(write_program, tmp_path, monkeypatch):
    """It writes in the scratch folder, and not beside itself; its memory is limited; it sees no token of ours."""
    target = tmp_path / "written"
    body = f"""
free=yes; (echo x > {target}) 2>/dev/null || free=no
scratch=no; (echo x > here) && scratch=yes
printf '{{"status": "not-applicable", "reason": "%s %s %s %s %s"}}\\n' $$ $free $scratch $(ulimit -v) "$SECRET_TOKEN"
"""
    monkeypatch.setenv("SECRET_TOKEN", "secret")
    with pytest.raises(NotApplicable) as refusal:
        create(write_program(body)).evaluate(CASE, QUANTITY)
    process, free, scratch, kilobytes, *token = str(refusal.value).split()
    assert (scratch, int(kilobytes), token) == ("yes", 4_096_000_000 // 1024, [])
    assert (free == "no") == (not target.exists())
    assert not has_ended(process)
    version = create(str(tmp_path / "program")).version
    close_models()
    assert comes_true(lambda: has_ended(process))
    # A changed program has another version.
    assert create(write_program(ok())).version != version
