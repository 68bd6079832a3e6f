"""A program that speaks JSON lines: the documented example, and programs with every kind of defect."""

import re
from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.model import ComputationFailed, HasCurve, NotApplicable
from comparisons.registry import create
from fscm.problem import Problem

from .test_hostile_models import comes_true, has_ended

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / "tests" / "examples" / "program" / "jkr.sh"
CASE = Problem(2, 0.4, 1)

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

    def write(body, describe=DESCRIBE, text=None):
        file = tmp_path / "program"
        file.write_text(text or SCRIPT.format(describe=describe, body=body), encoding="utf-8")
        file.chmod(0o755)
        return str(file)

    return write


def ok(value="1.7", more=""):
    return f"""echo '{{"status": "ok", "value": {value}, "u_num": 1e-15{more}}}'"""


def test_the_example_of_the_document_has_the_values_of_jkr_and_keeps_the_contract(capsys):
    document = (ROOT / "docs" / "judge_your_model.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```sh\n(#!/bin/sh\n.*?)^```", document, flags=re.MULTILINE | re.DOTALL)
    assert blocks == [EXAMPLE.read_text(encoding="utf-8")]
    model = create(str(EXAMPLE))
    result = model.evaluate(CASE, "pull_off_force")
    assert abs(result.value - create("jkr").evaluate(CASE, "pull_off_force").value) <= 1e-15
    assert str(model.applies_to) == "pull_off_force for n = 2, 0 <= k <= 0.9, mu >= 0.01"
    with pytest.raises(NotApplicable, match="the model is for n = 2"):
        model.evaluate(Problem(1, 0, 1), "pull_off_force")
    assert not isinstance(model, HasCurve)
    assert main(["check-model", str(EXAMPLE)]) == 0
    assert "hashed: all files in program" in " ".join(capsys.readouterr().out.split())


def test_counts_and_a_curve_of_a_program(write_program):
    body = f"""case $request in
*evaluate*) {ok(more=', "size": 12, "iterations": 3, "residual": 1e-12')} ;;
*) echo '{{"status": "ok", "displacement": [-1, 0], "load": [-0.5, 0.2], "columns": {{"contact_radius": [0.1, 1]}}}}' ;;
esac"""
    model = create(write_program(body, DESCRIBE[:-1] + ', "curve": true, "limits": ["jkr"]}'))
    result = model.evaluate(CASE, "pull_off_force")
    assert (result.size, result.iterations, result.residual) == (12, 3, 1e-12)
    curve = model.curve(CASE)
    assert curve.load.tolist() == [-0.5, 0.2]
    assert curve.columns["contact_radius"].tolist() == [0.1, 1.0]
    assert model.limits == ("jkr",)


#: What a program does instead of a reply, and the sentence about it.
DEFECTS = (
    ("echo 'cannot open table' >&2; exit 3", "exit status 3 instead of a reply; .*: cannot open table"),
    ("kill -9 $$", "was killed by signal 9"),
    ("exec 1>&-; sleep 60", "closed its standard output"),
    ("echo 1.7", "wrote '1.7', which is not one JSON object"),
    ("echo", "wrote '', which is not one JSON object"),
    ("printf '\\377\\n'", "which is not one JSON object"),
    (ok("NaN"), "wrote NaN, which is not a finite number"),
    (ok("1e999"), "gave inf as value, which is not a finite number"),
    (ok('"1.7"'), "gave str '1.7' as value, which is not a real number"),
    (ok(more=', "size": -1'), "size, which is outside"),
    (ok(more=', "unum": 1'), "gave the unknown key 'unum'"),
    ("""echo '{"status": "ok", "value": 1.7}'""", "has no u_num"),
    ("""echo '{"value": 1.7, "u_num": 0}'""", "gave NoneType None as status"),
    ("""echo '{"status": []}'""", "as status"),
    ("""echo '{"status": "failed", "reason": "no root"}'""", "^no root$"),
    ("""echo '{"status": "failed"}'""", "no reason"),
    (f"{ok()}; {ok()}", "more than one line for"),
    ("head -c 2000000 /dev/zero | tr '\\0' '['; echo", "which is not one JSON object"),
    ("yes | tr -d '\\n'", "wrote 200 MB without the end of a line"),
)


def both(model, number):
    """Evaluate the case of a defect and another one: what is too much after a reply is seen at the next request."""
    for mu in (number, 0.5):
        model.evaluate(Problem(2, 0, mu), "pull_off_force")


def test_a_defect_of_a_program_is_one_sentence_and_costs_one_result(write_program):
    """The defect depends on the Tabor number; after it the program is started again."""
    cases = [f"*'\"mu\": {number}.0'*)\n{body}\n;;" for number, (body, _) in enumerate(DEFECTS, 1)]
    model = create(write_program("\n".join(["case $request in", *cases, f"*)\n{ok()}\n;; esac"])))
    for number, (_, sentence) in enumerate(DEFECTS, 1):
        with pytest.raises(ComputationFailed, match=sentence):
            both(model, number)
        assert model.evaluate(Problem(2, 0, 0.5), "pull_off_force").value == 1.7


def test_a_program_that_is_too_slow_or_keeps_its_line_is_ended(write_program, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "1.5")
    with pytest.raises(ComputationFailed, match=r"within 1.5 s \(FSCM_BENCH_TIME_LIMIT\) .* must flush"):
        create(write_program("sleep 60")).evaluate(CASE, "pull_off_force")
    close_models()
    with pytest.raises(ValueError, match=r"cannot be loaded: .* must flush its standard output"):
        create(write_program("", text="#!/bin/sh\nread -r request\nprintf '{}'\nsleep 60\n"))


@pytest.mark.parametrize(
    ("describe", "sentence"),
    [
        ("{}", "has no name, version, citation, domain"),
        (DESCRIBE.replace('"1"', "1"), "gave int 1 as version, which is not a text"),
        (DESCRIBE.replace('"mine"', '"two words"'), "'two words' is not 1 to 64 letters"),
        (DESCRIBE[:-1] + ', "limits": "jkr"}', "limits = str 'jkr'"),
        (DESCRIBE[:-1] + ', "applies_to": {"n": [2, 2]}}', "applies_to: quantities = None is not a list"),
        (DESCRIBE[:-1] + ', "applies_to": {"quantities": [["a"]]}}', "cannot be loaded"),
        (DESCRIBE[:-1] + ', "digest": "0"}', "gave the unknown key 'digest'"),
        (DESCRIBE[:-1] + ', "files": ["none.csv"]}', "there is no such file or folder beside the model"),
    ],
)
def test_a_program_that_describes_no_model_cannot_be_loaded(write_program, describe, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        create(write_program(ok(), describe))


def test_what_is_no_program_is_wrong_input(write_program):
    with pytest.raises(ValueError, match=r"cannot be started .*whose first line"):
        create(write_program("", text="no program\n"))


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
        create(write_program(body)).evaluate(CASE, "pull_off_force")
    process, free, scratch, kilobytes, *token = str(refusal.value).split()
    assert (scratch, int(kilobytes), token) == ("yes", 4_096_000_000 // 1024, [])
    assert (free == "no") == (not target.exists())
    assert not has_ended(process)
    close_models()
    assert comes_true(lambda: has_ended(process))


def test_a_changed_program_has_another_version(write_program):
    version = create(write_program(ok())).version
    close_models()
    assert create(write_program(ok("1.8"))).version != version
