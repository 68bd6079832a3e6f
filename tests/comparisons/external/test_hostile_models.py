"""Defects of a model: each costs the rows of this model, with a reason, and nothing else."""

import os
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external.child import PATIENCE
from comparisons.external.model_source import source_of
from comparisons.external.process_model import ExternalModel, connect
from comparisons.external.text_rules import model_name
from comparisons.pipeline import inputs
from comparisons.registry import create
from comparisons.runs.cases import Case, load_grids
from comparisons.runs.tasks import evaluate

from .conftest import HEAD, light

CASE = Case(2, 0.4, 1)
GOOD = "return Result(1.5, 1e-9)"


def row_of(spec):
    return evaluate(create(spec), "pull_off_force", CASE)


#: What `evaluate` does, and words of the reason that its row gives.
NONSENSE = [
    ("return 1 / 0", "ZeroDivisionError in evaluate, line "),
    ("sys.exit(3)", "sys.exit(3)"),
    ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    ("return self.evaluate(problem, quantity)", "RecursionError"),
    ("return Result(float('nan'), 0.0)", "nan, which is not a finite number"),
    ("return Result(1.0, float('inf'))", "u_num = inf"),
    ("return Result(1.0, -1.0)", "u_num = -1"),
    ("return Result('1.5', 0.0)", "must be real number, not str"),
    ("return Result(1j, 0.0)", "must be real number, not complex"),
    ("return Result(np.array([1.0, 2.0]), 0.0)", "TypeError in evaluate"),
    ("return Result(np.array(1.5), 0.0)", "an array of shape ()"),
    ("return Result(True, 0.0)", "bool True"),
    ("return Result(1.5, 0.0, size=10**30)", f"int {10**30} as size, which is outside [0, 2^63)"),
    ("return Result(1.5, 0.0, iterations=2**63)", "as iterations, which is outside [0, 2^63)"),
    ("return Result(1.5, 0.0, iterations=-1)", "int -1 as iterations, which is outside [0, 2^63)"),
    ("return '<b>1.5</b>'", "str '<b>1.5</b>', which is not a comparisons.model.Result"),
    ("return 1.5 + 2j", "complex (1.5+2j)"),
    ("return np.ones(7)", "an array of shape (7,)"),
    ("pass", "NoneType None"),
    ("return 1.5", "float 1.5"),
    ("raise ComputationFailed('no\\x1b[31m root\\nfound')", "no[31m root found"),
    ("raise type('Odd', (Exception,), {'__str__': lambda self: 1 / 0})", "__str__ raises ZeroDivisionError"),
    ("raise type('Odd', (ComputationFailed,), {'__str__': lambda self: 1 / 0})", "__str__ raises ZeroDivisionError"),
    ("sys.exit(type('Odd', (), {'__repr__': lambda self: 1 / 0})())", "__repr__ raises ZeroDivisionError"),
    ("import mangled", "SyntaxError in line 2 of mangled.py: "),
    ("raise ComputationFailed", "without a reason"),
    ("raise ValueError('k is large')", "k is large (a case outside the domain is NotApplicable)"),
]


@pytest.fixture(scope="module")
def nonsense(tmp_path_factory):
    """One process with all defects above; the Tabor number is the number of the defect."""
    bodies = "\n".join(
        f"        if problem.mu == {number}:\n            {body}" for number, (body, _) in enumerate(NONSENSE, 1)
    )
    file = tmp_path_factory.mktemp("nonsense") / "stranger.py"
    file.with_name("mangled.py").write_text("x = 1\nx = (\n")
    file.write_text(f"{HEAD.format(name='stranger')}\n    def evaluate(self, problem, quantity):\n{bodies}\n")
    spec = f"{file}:Model"
    model = connect(source_of(spec), spec)
    yield model
    model.close()


@pytest.mark.parametrize(("number", "sentence"), list(enumerate((sentence for _, sentence in NONSENSE), 1)))
def test_nonsense_is_a_failed_row_with_a_reason(nonsense, number, sentence):
    row = evaluate(nonsense, "pull_off_force", Case(2, 0, number))
    assert (row.status, row.value, row.model) == ("failed", None, "stranger")
    assert sentence in row.reason
    assert row.reason.isprintable()


@pytest.mark.parametrize("count", [10**30, -1, 2**63])
def test_a_process_that_writes_a_count_of_its_own_is_not_believed(count):
    reply = {"status": "ok", "value": 1.5, "u_num": 0.0, "size": count, "iterations": 0, "residual": 0.0}
    texts = {"name": "stranger", "version": "1", "citation": "", "domain": "", "digest": "0" * 64, "hashed": ""}
    child = SimpleNamespace(request=lambda *_, **__: reply, is_program=False)
    model = ExternalModel(child, texts | {"limits": [], "physical": False})
    assert evaluate(model, "pull_off_force", CASE).reason == "its process wrote something that is not a result"


@pytest.mark.parametrize(
    ("body", "sentence"),
    light(
        [
            ("os._exit(0)", "ended its process with exit status 0"),
            ("ctypes.string_at(0)", "killed by SIGSEGV"),
            ("os.kill(os.getpid(), 40)", "killed by signal 40"),
            (
                "for fd in range(3, 200):\n    with suppress(OSError):\n        os.write(fd, b'{}\\n')",
                "not a result",
            ),
            ("os.closerange(0, 100)\nreturn Result(1.0, 0.0)", "exit status"),
        ],
        1,
        3,
        4,
    ),
)
def test_one_that_ends_or_corrupts_its_process_is_a_failed_row(write_model, body, sentence):
    row = row_of(write_model(body))
    assert (row.status, row.value) == ("failed", None)
    assert sentence in row.reason


def test_one_that_loops_for_ever_is_ended_and_evaluated_no_more(write_model, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.3")
    spec = write_model("while True:\n    pass")
    reasons = [row_of(spec).reason for _ in range(PATIENCE + 1)]
    assert reasons == ["it gave no result within 0.3 s (FSCM_BENCH_TIME_LIMIT) and was ended"] * PATIENCE + [
        f"not evaluated: it ran out of time {PATIENCE} times in a row"
    ]


def test_one_that_allocates_without_bound_runs_into_its_limit(write_model, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_MEMORY_LIMIT", "1500")
    spec = write_model("kept = []\nwhile True:\n    kept.append(bytearray(50_000_000))")
    row = row_of(spec)
    assert row.status == "failed"
    assert "1500 MB" in row.reason
    assert row_of(spec).status == "failed"


def test_a_refusal_whose_text_cannot_be_had_is_a_refusal(write_model):
    row = row_of(write_model("raise type('Odd', (NotApplicable,), {'__str__': lambda self: 1 / 0})"))
    assert row.status == "not-applicable"
    assert "__str__ raises ZeroDivisionError" in row.reason


def test_printing_of_a_model_is_not_shown(write_model, capfd):
    body = "print('{\"status\": \"ok\"}' * 9999)\nos.write(1, b'x')\nos.write(2, b'y')\nsys.stdout.close()\n" + GOOD
    assert row_of(write_model(body)).value == 1.5
    assert capfd.readouterr() == ("", "")


def test_it_recovers_after_a_crash(write_model):
    spec = write_model("if quantity == 'jump_in_gap':\n    os._exit(1)\n" + GOOD)
    model = create(spec)
    statuses = [evaluate(model, q, CASE).status for q in ("pull_off_force", "jump_in_gap", "pull_off_force")]
    assert statuses == ["ok", "failed", "ok"]


def test_it_cannot_signal_us_nor_see_our_environment(write_model, monkeypatch):
    monkeypatch.setenv("SOME_TOKEN", "secret")
    assert row_of(write_model("return Result(float('SOME_TOKEN' in os.environ), 0.0)")).value == 0.0
    # Signal 0 does nothing, whatever the system allows.
    row = row_of(write_model("os.kill(os.getppid(), 0)\n" + GOOD, name="killer"))
    assert row.status in {"ok", "failed"}


def test_it_leaves_no_process_behind(write_model, tmp_path):
    body = "child = os.fork()\nif child == 0:\n    time.sleep(1000)\nreturn Result(float(child), 0.0)"
    model = create(write_model(body))
    grandchild = int(evaluate(model, "pull_off_force", CASE).value)
    os.kill(grandchild, 0)
    model.close()
    assert ended(grandchild)


def test_a_child_does_not_outlive_us(write_model):
    """Also in the middle of an evaluation, when this process is killed and cannot end the child."""
    spec = write_model("while True:\n    pass", more="@property\ndef citation(self):\n    return str(os.getpid())")
    program = f"""
from comparisons.registry import create
from fscm.problem import Problem
model = create({spec!r})
print(model.citation, flush=True)
model.evaluate(Problem(2, 0, 1), "pull_off_force")
"""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as parent:
        child = int(parent.stdout.readline())
        parent.kill()
    assert ended(child)


def ended(process):
    """Whether a process that was sent a SIGKILL is gone, or a zombie that has not been reaped yet."""
    for _ in range(1000):
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.01)
    return False


CURVES = [
    ("np.arange(3.0), np.arange(4.0)", "displacement 3, load 4"),
    ("np.arange(3.0), np.array([0, 1j, 2])", "complex128"),
    ("np.arange(3.0), np.array([0, np.nan, 2])", "not finite"),
    ("[], []", "not 1 to"),
    ("np.ones((2, 2)), np.ones((2, 2))", "shape (2, 2)"),
    ("['a'], [1.0]", "real numbers"),
]


def test_a_nonsense_curve_is_refused(write_model, capsys):
    curves = "".join(
        f"    if problem.mu == {number}:\n        return Curve({curve})\n"
        for number, (curve, _) in enumerate(CURVES, 1)
    )
    spec = write_model(GOOD, more=f"def curve(self, problem):\n{curves}    return 'curve'")
    for number, (_, sentence) in enumerate([*CURVES, ("", "str 'curve'")], 1):
        assert main(["curve", "--model", spec, "jkr", "--n", "2", "--k", "0", "--mu", str(number)]) == 4
        shown = capsys.readouterr()
        assert sentence in shown.err
        assert "jkr" in shown.out
        assert "stranger" not in shown.out


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("<b>bold</b>", "letters, digits"),
        ("", "letters, digits"),
        ("../up", "letters, digits"),
        ("line\nbreak", "letters, digits"),
        ("x" * 65, "64"),
        ("given", "every model"),
        ("NaN", "missing value"),
    ],
)
def test_a_name_that_could_do_harm_is_refused(name, sentence):
    with pytest.raises(ValueError, match=sentence):
        model_name(name)


@pytest.mark.parametrize(("name", "sentence"), [("<b>bold</b>", "letters, digits"), ("jkr", "a model of fscm-bench")])
def test_a_model_with_such_a_name_is_wrong_input(write_model, capsys, name, sentence):
    spec = write_model(GOOD, more=f"name = {name!r}")
    assert main(["solve", "--model", spec, "--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"]) == 2
    message = capsys.readouterr().err
    assert sentence in message
    assert message.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    light(
        [
            ("import no_such_module_at_all", "no_such_module_at_all"),
            ("x = 1\ndef f(:", "SyntaxError in line 2 of stranger.py: invalid syntax"),
            ("exec('def f(:')", "SyntaxError in <module>, line 1 of stranger.py"),
            ("import os; os._exit(5)", "exit status 5"),
            ("import sys; sys.exit()", "sys.exit(None)"),
            ("x = 1", "does not define Model"),
            ("class Model:\n    pass", "name"),
            ("class Model:\n    name = version = citation = domain = 'x'", "evaluate"),
            ("class Model:\n    def __init__(self):\n        raise ValueError('no such table')", "no such table"),
            ("class Model:\n    def __init__(self, radius):\n        pass", "radius"),
        ],
        1,
        3,
        5,
        7,
        9,
    ),
)
def test_one_that_cannot_be_loaded_is_wrong_input(tmp_path, capsys, text, sentence):
    file = tmp_path / "stranger.py"
    file.write_text(text)
    arguments = ["--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1"]
    assert main(["solve", "--model", f"{file}:Model", *arguments]) == 2
    shown = capsys.readouterr()
    assert "cannot be loaded" in shown.err
    assert "NotApplicable" not in shown.err
    assert sentence in shown.err
    assert shown.out == ""


GRID = """
[[grid]]
id = "two"
title = "Two cases"
tier = "quick"
reference = "bradley"
models = ["dmt"]
quantities = ["pull_off_force"]
n = [2]
k = [0, 0.4]
mu = [1]
"""


def test_a_run_completes_the_others_and_its_files_are_its_own(write_model, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.5")
    out = tmp_path / "out"
    vandal = f"for file in Path({str(out)!r}).iterdir():\n    file.write_text('mine')\n    file.chmod(0o777)\n" + GOOD
    bodies = {
        "good": GOOD,
        "vandal": vandal,
        # Only where the run evaluates it: its process is started again after each end.
        "leaver": "if problem.mu == 1 and quantity == 'pull_off_force':\n    os._exit(0)\nraise NotApplicable('no')",
        "looper": "while True:\n    time.sleep(1000)",
        "nonsense": "return Result(float('nan'), 0.0)",
    }
    specs = [write_model(body, name) for name, body in bodies.items()]
    assert main(["run", "--jobs", "1", "--out", str(out), "--model", *specs, "jkr"]) == 4
    table = pd.read_csv(out / "results.csv")
    by_model = table.groupby("model")["status"].agg(list).to_dict()
    assert by_model.pop("vandal") in (["failed"] * 2, ["ok"] * 2)
    assert by_model == {
        "bradley": ["ok"] * 2,
        "good": ["ok"] * 2,
        "jkr": ["ok"] * 2,
        "leaver": ["failed"] * 2,
        "looper": ["failed"] * 2,
        "nonsense": ["failed"] * 2,
    }
    assert table.loc[table["model"] == "good", "value"].tolist() == [1.5, 1.5]
    assert "mine" not in (out / "results.csv").read_text()
