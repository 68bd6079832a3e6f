"""Defects of a model: each costs the rows of this model, with a reason, and nothing else."""

import os
import time
from pathlib import Path

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external.child import PATIENCE
from comparisons.external.replies import result_of
from comparisons.external.text_rules import model_name
from comparisons.model import ComputationFailed
from comparisons.registry import create
from comparisons.runs.cases import Case
from comparisons.runs.tasks import evaluate

from .conftest import CASE, FORCE, GOOD

#: What `evaluate` does, and words of the reason that its row gives.
NONSENSE = [
    ("return 1 / 0", "ZeroDivisionError in evaluate, line "),
    ("sys.exit(3)", "sys.exit(3)"),
    ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    ("return self.evaluate(problem, quantity)", "RecursionError"),
    ("return Result(float('nan'), 0.0)", "not a finite number"),
    ("return Result(1.0, -1.0)", "u_num = -1"),
    ("return Result('1.5', 0.0)", "must be real number, not str"),
    ("return Result(np.array([1.0, 2.0]), 0.0)", "TypeError in evaluate"),
    ("return Result(np.array(1.5), 0.0)", "an array of shape ()"),
    ("return Result(True, 0.0)", "bool True"),
    ("return Result(1.5, 0.0, size=10**30)", "as size"),
    ("return Result(1.5, 0.0, iterations=-1)", "as iterations"),
    ("return '<b>1.5</b>'", "str '<b>1.5</b>', which is not a comparisons.model.Result"),
    ("raise ComputationFailed('no\\x1b[31m root\\nfound')", "no[31m root found"),
    ("raise type('Odd', (Exception,), {'__str__': lambda self: 1 / 0})", "__str__ raises ZeroDivisionError"),
    ("sys.exit(type('Odd', (), {'__repr__': lambda self: 1 / 0})())", "__repr__ raises ZeroDivisionError"),
    ("exec('x = (')", "SyntaxError"),
    ("raise ComputationFailed", "no reason"),
    ("raise ValueError('k is large')", "k is large (a case outside the domain is NotApplicable)"),
    ("os._exit(0)", "ended with exit status 0"),
    ("ctypes.string_at(0)", "was killed by signal 11"),
    ("os.kill(os.getpid(), 40)", "was killed by signal 40"),
    (
        "for fd in range(3, 200):\n    with suppress(OSError):\n        os.write(fd, b'{}\\n')",
        "None as status|more than one line",
    ),
    ("os.closerange(0, 100)\nreturn Result(1.0, 0.0)", "ended with exit status"),
    ("[os.fork() for _ in range(3)]\nos._exit(7)", "ended with exit status 7"),
    ("Path('flood').write_bytes(bytes(300_000_000))", "OSError"),
]


def test_a_defect_is_a_failed_row_with_a_reason_and_the_next_one_is_right(write_model):
    """The Tabor number is the number of the defect."""
    cases = [
        f"if problem.mu == {number}:\n" + "".join(f"    {line}\n" for line in body.splitlines())
        for number, (body, _) in enumerate(NONSENSE, 1)
    ]
    model = create(write_model("".join(cases) + "print('{}' * 9999)\nos.write(1, b'x')\n" + GOOD))
    for number, (body, sentence) in enumerate(NONSENSE, 1):
        row = evaluate(model, "pull_off_force", Case(2, 0, number))
        assert (row.status, row.value, row.model) == ("failed", None, "stranger"), body
        assert any(words in row.reason for words in sentence.split("|")), body
        assert row.reason.isprintable()
        row = evaluate(model, "pull_off_force", Case(2, 0, 0.5))
        if row.status != "ok":
            # What it had written too much is noticed here, and costs one result more.
            assert "more than one line" in row.reason
            row = evaluate(model, "pull_off_force", Case(2, 0, 0.5))
        assert row.value == 1.5, body


@pytest.mark.parametrize("reply", [{"size": 2**63}, {"value": None}, {"u_num": 10**400}, {"mine": 1}])
def test_a_process_that_writes_a_reply_of_its_own_is_not_believed(reply):
    with pytest.raises(ComputationFailed):
        result_of({"status": "ok", "value": 1.5, "u_num": 0.0} | reply)


def test_one_that_loops_for_ever_is_ended_and_evaluated_no_more(write_model, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.3")
    model = create(write_model("while True:\n    pass"))
    reasons = [evaluate(model, "pull_off_force", CASE).reason for _ in range(PATIENCE + 1)]
    assert all("within 0.3 s (FSCM_BENCH_TIME_LIMIT)" in reason for reason in reasons[:PATIENCE])
    assert reasons[-1].startswith("not evaluated: it ran out of time")


def test_one_that_allocates_without_bound_runs_into_its_limit(write_model, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_MEMORY_LIMIT", "1500")
    model = create(write_model("kept = []\nwhile True:\n    kept.append(bytearray(50_000_000))"))
    row = evaluate(model, "pull_off_force", CASE)
    assert row.status == "failed"
    assert "1500 MB" in row.reason


@pytest.mark.parametrize("limit", ["0", "-1", "inf", "much"])
@pytest.mark.parametrize("name", ["FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"])
def test_a_limit_that_is_none_is_wrong_input(write_model, monkeypatch, capsys, name, limit):
    monkeypatch.setenv(name, limit)
    assert main(["solve", "--model", write_model(), *FORCE]) == 2
    assert name in capsys.readouterr().err


def test_a_refusal_whose_text_cannot_be_had_is_a_refusal(write_model):
    odd = create(write_model("raise type('Odd', (NotApplicable,), {'__str__': lambda self: 1 / 0})"))
    row = evaluate(odd, "pull_off_force", CASE)
    assert row.status == "not-applicable"
    assert "__str__ raises ZeroDivisionError" in row.reason


def test_it_does_not_see_our_environment_and_its_children_end_with_it(write_model, monkeypatch):
    monkeypatch.setenv("SOME_TOKEN", "secret")
    body = "if 'SOME_TOKEN' in os.environ:\n    return None\nchild = os.fork()\nif child == 0:\n    time.sleep(1000)\n"
    model = create(write_model(f"{body}return Result(float(child), 0.0)"))
    grandchild = int(evaluate(model, "pull_off_force", CASE).value)
    assert not has_ended(grandchild)
    model.close()
    assert comes_true(lambda: has_ended(grandchild))


def has_ended(process):
    """Whether a process is gone, or a zombie that has not been reaped yet."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def comes_true(condition):
    """Whether a condition holds within a minute; a loaded machine needs a part of it."""
    for _ in range(3000):
        if condition():
            return True
        time.sleep(0.02)
    return False


CURVES = [
    ("np.arange(3.0), np.arange(4.0)", "displacement 3, load 4"),
    ("np.arange(3.0), np.array([0, 1j, 2])", "complex128"),
    ("np.arange(3.0), np.array([0, np.nan, 2])", "not finite"),
    ("[], []", "not 1 to"),
    ("np.ones((2, 2)), np.ones((2, 2))", "shape (2, 2)"),
]


def test_a_nonsense_curve_is_refused(write_model, capsys):
    curves = "".join(
        f"    if problem.mu == {number}:\n        return Curve({curve})\n"
        for number, (curve, _) in enumerate(CURVES, 1)
    )
    spec = write_model(more=f"def curve(self, problem):\n{curves}    return 'curve'")
    for number, (_, sentence) in enumerate([*CURVES, ("", "str 'curve'")], 1):
        assert main(["curve", "--model", spec, "jkr", "--n", "2", "--k", "0", "--mu", str(number)]) == 4
        shown = capsys.readouterr()
        assert sentence in shown.err
        assert "jkr" in shown.out
        assert "stranger" not in shown.out


@pytest.mark.parametrize("name", ["<b>bold</b>", "", "../up", "line\nbreak", "x" * 65, "given", "NaN"])
def test_a_name_that_could_do_harm_is_refused(name):
    with pytest.raises(ValueError, match="name"):
        model_name(name)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("import no_such_module_at_all", "no_such_module_at_all"),
        ("x = 1\ndef f(:", "SyntaxError in line 2 of stranger.py"),
        ("import os; os._exit(5)", "exit status 5"),
        ("import sys; sys.exit()", "sys.exit(None)"),
        ("x = 1", "does not define Model"),
        ("class Model: name = 'x'", "no version, citation, domain"),
        ("class Model: name = version = citation = domain = 'x'", "evaluate"),
        ("class Model: name = version = citation = domain = '<b>'; evaluate = max", "letters, digits"),
        ("class Model: name = version = citation = domain = 'jkr'; evaluate = max", "a model of fscm-bench"),
        ("class Model: name = version = citation = domain = 'x'; evaluate = max; limits = 'jkr'", "limits"),
        ("class Model: name = version = citation = domain = 'x'; evaluate = max; limits = max", "limits|JSON"),
        ("class Model: name = version = citation = domain = 'x'; evaluate = max; applies_to = 1", "applies_to"),
        ("class Model:\n    def __init__(self):\n        raise ValueError('no such table')", "no such table"),
        ("class Model:\n    def __init__(self, radius):\n        pass", "radius"),
    ],
)
def test_one_that_cannot_be_loaded_is_wrong_input(tmp_path, capsys, text, sentence):
    (tmp_path / "stranger.py").write_text(text)
    assert main(["solve", "--model", f"{tmp_path / 'stranger.py'}:Model", *FORCE]) == 2
    shown = capsys.readouterr()
    assert any(words in shown.err for words in sentence.split("|"))
    assert "NotApplicable" not in shown.err
    assert shown.err.count("\n") == 1
    assert shown.out == ""


def test_a_run_completes_the_others_and_its_files_are_its_own(write_model, few_cases, tmp_path, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.5")
    out = tmp_path / "out"
    bodies = {
        "good": GOOD,
        "vandal": f"for file in Path({str(out)!r}).iterdir():\n    file.write_text('mine')\n{GOOD}",
        "leaver": "os._exit(0)",
        "looper": "while True:\n    time.sleep(1000)",
    }
    specs = [write_model(body, name) for name, body in bodies.items()]
    assert main(["run", "--jobs", "1", "--out", str(out), "--model", *specs]) == 4
    table = pd.read_csv(out / "results.csv")
    by_model = table.groupby("model")["status"].agg(set).to_dict()
    assert by_model.pop("vandal") in ({"failed"}, {"ok"})
    assert by_model == {"bradley": {"ok"}, "good": {"ok"}, "leaver": {"failed"}, "looper": {"failed"}}
    assert table.loc[table["model"] == "good", "value"].tolist() == [1.5] * 4
    assert os.path.getsize(out / "results.csv") > 500
