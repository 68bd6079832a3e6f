"""Defects of a model: each costs the rows of this model, with a reason, and nothing else."""

import json
import os
import signal
import subprocess
import sys
from contextlib import closing

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external import child, process_model
from comparisons.external.child import Child
from comparisons.external.inherited import at_most
from comparisons.external.model_source import close_models, load_again, source_of
from comparisons.external.replies import Malformed, curve_of, described
from comparisons.model import ComputationFailed
from comparisons.registry import create
from comparisons.runs.computation import complete

from .conftest import FORCE, GOOD, comes_true, has_ended, row_of

#: Replies of its own on every descriptor.
WRITES = "for fd in range(3, 200):\n    with suppress(OSError):\n        os.write(fd, b'{}\\n')"

#: What `evaluate` does, and words of the reason that its row gives.
NONSENSE = [
    ("return 1 / 0", "ZeroDivisionError in evaluate, line "),
    ("sys.exit(3)", "SystemExit in evaluate, line "),
    ("return self.evaluate(problem, quantity)", "RecursionError"),
    ("return Result(float('nan'), 0.0)", "not a finite number"),
    ("return Result(1.0, -1.0)", "u_num = -1"),
    ("return Result('1.5', 0.0)", "must be real number, not str"),
    ("return Result(np.array(1.5), 0.0)", "a ndarray"),
    ("return Result(True, 0.0)", "value = true"),
    ("return Result(1.5, 0.0, size=10**30)", "size = "),
    ("return Result(1.5, 0.0, residual=float('inf'))", "not finite"),
    ("return '<b>1.5</b>'", "a str, not a Result"),
    ("raise ComputationFailed('no\\x1b[31m root\\nfound')", "no[31m root found"),
    ("raise type('Odd', (Exception,), {'__str__': lambda self: 1 / 0})", "__str__ raises ZeroDivisionError"),
    ("sys.exit(type('Odd', (), {'__repr__': lambda self: 1 / 0})())", "__str__ raises ZeroDivisionError"),
    ("raise ComputationFailed", "no reason"),
    ("raise ValueError('k is large')", "k is large (a case outside the domain is NotApplicable)"),
    ("ctypes.string_at(0)", "was killed by signal 11"),
    (WRITES, "status = None|more than one"),
    ("os.closerange(0, 100)\nreturn Result(1.0, 0.0)", "ended with exit status"),
    ("[os.fork() for _ in range(3)]\nos._exit(7)", "ended with exit status 7"),
    ("open('flood', 'wb').truncate(300_000_000)", "OSError"),
]


def by_tabor_number(bodies):
    """A body of `evaluate` that does the first of some things at mu = 1, the second at mu = 2, and is right at 0.5."""
    cases = [
        f"if problem.mu == {number}:\n" + "".join(f"    {line}\n" for line in body.splitlines())
        for number, body in enumerate(bodies, 1)
    ]
    return "".join(cases) + "print('{}' * 9999)\nos.write(1, b'x')\n" + GOOD


def test_a_defect_is_a_failed_row_with_a_reason_and_the_next_one_is_right(write_model):
    model = create(write_model(by_tabor_number(body for body, _ in NONSENSE)))
    for number, (body, sentence) in enumerate(NONSENSE, 1):
        row = row_of(model, number)
        assert (row.status, row.value, row.model) == ("failed", None, "stranger"), body
        assert any(words in row.reason for words in sentence.split("|")), (body, row.reason)
        assert row.reason.isprintable()
        if row_of(model, 0.5).status != "ok":
            # What it had written too much is noticed by the next request.
            assert "more than one line" in sentence
        assert row_of(model, 0.5).value == 1.5, body


def test_one_that_loops_for_ever_is_ended_and_evaluated_no_more(write_model, monkeypatch):
    monkeypatch.setattr(process_model, "PATIENCE", 2)
    monkeypatch.setenv("FSCM_BENCH_TIME_LIMIT", "0.3")
    model = create(write_model(f"while problem.mu == 1:\n    time.sleep(0.01)\n{GOOD}"))
    # A result in time ends a row of overdue ones.
    assert [row_of(model, mu).status for mu in (1, 2)] == ["failed", "ok"]
    reasons = [row_of(model).reason for _ in range(3)]
    assert all("within 0.3 s and was ended (FSCM_BENCH_TIME_LIMIT)" in reason for reason in reasons[:2])
    assert reasons[-1].startswith("not evaluated: it ran out of time")


def test_one_that_allocates_without_bound_runs_into_its_limit(write_model, monkeypatch):
    monkeypatch.setenv("FSCM_BENCH_MEMORY_LIMIT", "700")
    row = row_of(create(write_model("kept = []\nwhile True:\n    kept.append(bytearray(50_000_000))")))
    assert row.status == "failed"
    assert "700 MB" in row.reason


@pytest.mark.parametrize("limit", ["0", "inf", "much", "4_0_0", "\u0664\u0660"])
@pytest.mark.parametrize("name", ["FSCM_BENCH_TIME_LIMIT", "FSCM_BENCH_MEMORY_LIMIT"])
def test_a_limit_that_is_none_is_wrong_input(write_model, monkeypatch, refused, name, limit):
    monkeypatch.setenv(name, limit)
    refused(["solve", "--model", write_model(), *FORCE], name)


def test_what_it_starts_ends_with_it(write_model):
    model = create(write_model("child = os.fork()\nif child == 0:\n    time.sleep(1000)\nreturn Result(child, 0.0)"))
    grandchild = int(row_of(model).value)
    assert not has_ended(grandchild)
    model.close()
    assert comes_true(lambda: has_ended(grandchild))


CURVES = [
    ("Curve(np.arange(3.0), np.arange(4.0))", "displacement 3, load 4"),
    ("Curve(np.arange(3.0), np.array([0, 1j, 2]))", "a complex"),
    ("Curve(np.arange(3.0), np.array([0, np.nan, 2]))", "not finite"),
    ("'curve'", "a str, not a Curve"),
]


def test_a_nonsense_curve_is_refused(write_model):
    curves = ", ".join(f"lambda: {curve}" for curve, _ in CURVES)
    model = create(write_model(more=f"def curve(self, problem):\n    return [{curves}][int(problem.mu) - 1]()"))
    for number, (_, sentence) in enumerate(CURVES, 1):
        assert sentence in row_of(model, number, quantity="force_curve").reason


LOADED = "class Model: name = version = citation = domain = 'x'; evaluate = max; "


NOT_LOADED = [
    ("import no_such_module_at_all", "no_such_module_at_all"),
    ("x = 1\ndef f(:", "stranger.py, line 2"),
    ("x = 1", "does not define Model"),
    ("class Model: name = 'x'", "no version, citation, domain"),
    (LOADED.replace("evaluate = max;", ""), "evaluate"),
    (LOADED + "limits = max", "a builtin"),
    (LOADED + "applies_to = 1", "applies_to"),
    ("class Model:\n    def __init__(self):\n        raise ValueError('no such table')", "no such table"),
    ("import os; os._exit(5)", "exit status 5"),
]


def test_one_that_cannot_be_loaded_is_wrong_input(tmp_path, refused):
    file, spec = tmp_path / "stranger.py", f"{tmp_path / 'stranger.py'}:Model"
    file.write_text(NOT_LOADED[0][0])
    refused(["solve", "--model", spec, *FORCE], NOT_LOADED[0][1])
    source = source_of(spec)
    with closing(Child(source)) as process:
        for text, sentence in NOT_LOADED:
            file.write_text(text)
            with pytest.raises(ComputationFailed, match=sentence):
                described(process.exchange({"request": "describe"}), source)


NAMES = ("<b>bold</b>", "", "../up", "line\nbreak", "x" * 65, "given", "NaN")
FILES = ("a.csv", [1], ["/etc/passwd"], ["\0"], ["nothing"])


WRONG = [{"version": 1}, {"citation": None}, {"applies_to": {"n": [2, 2]}}]
#: Lists that would take a judge seconds and hundreds of megabytes, and numbers that no double holds.
LONG = [{"limits": ["x"] * 60_000}, {"limits": [1] * 100_000}, {"files": ["x"] * 60_000}, {"domain": "x" * 20_000}]
LONG += [{"applies_to": {"quantities": ["pull_off_force"], "mu": [0, 10**400]}}, {"x" * 10**6: 1}]
#: What a model says of its files in place of the worker.
ROOTS = ({"/no/such": "/no/such/x"}, {"/": 1}, {"/": "/dev/zero"}, {"/etc": "/etc/../x"}, {"x" * 999: "x" * 999}, [1])
ROOTS += ({"/etc": sys.executable},)
FORGED = [
    *({"roots": roots, "loaded": []} for roots in ROOTS),
    *({"roots": {}, "loaded": loaded} for loaded in (["x" * 5000], 1, [[]] * 9)),
    {"loaded": []},
]
HARMLESS = [
    {},
    {"roots": {}, "loaded": ["\0", "x" * 4000, "/dev/zero"]},
    {"roots": {"/etc": "/etc/passwd"}, "loaded": []},
]


@pytest.mark.parametrize(
    "stated", [*({"name": name} for name in NAMES), *({"files": files} for files in FILES), *WRONG, *LONG]
)
def test_a_description_that_could_do_harm_is_refused(tmp_path, stated):
    texts = dict.fromkeys(("name", "version", "citation", "domain"), "x")
    line = json.dumps({"status": "ok"} | texts | stated).encode()
    with pytest.raises(ComputationFailed, match=next(iter(stated))[:60]):
        described(line, {"kind": "file", "file": str(tmp_path / "model.py")})


@pytest.mark.parametrize("python", [*FORGED, *HARMLESS])
def test_forged_files_are_refused_or_change_nothing(tmp_path, python):
    """The folder of the file counts whatever a process states."""
    texts = dict.fromkeys(("name", "version", "citation", "domain"), "x")
    source = {"kind": "file", "file": str(tmp_path / "model.py")}
    (tmp_path / "model.py").touch()
    honest = described(json.dumps(texts).encode(), source)["version"]
    (tmp_path / "model.py").write_text("changed")
    reply = json.dumps(texts | {"python": python}).encode()
    if python in HARMLESS:
        assert described(reply, source)["version"] != honest
    else:
        with pytest.raises(ComputationFailed, match=r"process states|reply of the model: python"):
            described(reply, source)


def test_a_line_of_brackets_is_no_reply():
    for line in (b"[" * 10**6, b'{"status": "ok", "displacement": [' + b"[]," * 10**5 + b"[]]}", b'{"a":' * 10**5):
        with pytest.raises(Malformed, match="brackets"):
            curve_of(line)


#: One folder more, whose path is longer than the system takes, so that nothing in it would be counted.
LONG = "for _ in range(3):\n    os.mkdir('b' * 250)\n    os.chdir('b' * 250)\nreturn Result(1.5, 0.0)"

TOO_MUCH = [
    ("Path('flood').write_bytes(bytes(3_000_000))\nreturn Result(1.5, 0.0)", "bytes, more than 1000000"),
    ("[Path(f'{i}').touch() for i in range(30)]\nreturn Result(1.5, 0.0)", "more than 20 files"),
    ("while True:\n    Path(f'{time.time_ns()}').touch()", "more than 20 files"),
    (f"for _ in range(15):\n    os.mkdir('a' * 250)\n    os.chdir('a' * 250)\n{LONG}", "that cannot be read"),
    (WRITES.replace("b'{}\\n'", "b'1' * 200_000"), "bytes without the end of a line"),
]


def test_what_fills_the_disk_or_the_pipe_is_ended_and_the_next_one_is_right(write_model, monkeypatch):
    for name, limit in (("_LARGEST_SCRATCH", 1_000_000), ("_MOST_SCRATCH", 20), ("_COUNTED_AGAIN", 0.05)):
        monkeypatch.setattr(child, name, limit)
    model = create(write_model(by_tabor_number(body for body, _ in TOO_MUCH)))
    for number, (body, sentence) in enumerate(TOO_MUCH, 1):
        row = row_of(model, number)
        assert (row.status, row.value) == ("failed", None), body
        assert sentence in row.reason, (body, row.reason)
        assert row_of(model, 0.5).value == 1.5


def test_one_that_fills_the_disk_each_time_is_evaluated_no_more(write_model, monkeypatch):
    monkeypatch.setattr(process_model, "PATIENCE", 2)
    monkeypatch.setattr(child, "_LARGEST_SCRATCH", 1_000_000)
    model = create(write_model(TOO_MUCH[0][0]))
    reasons = [row_of(model).reason for _ in range(3)]
    assert [reason.startswith("not evaluated") for reason in reasons] == [False, False, True]


def test_all_evaluations_together_have_an_end(write_model):
    """One that stops itself, too, which ends no wait; afterwards nothing is sent to the model."""
    model = create(write_model(f"if problem.mu == 1:\n    os.kill(os.getpid(), signal.SIGSTOP)\n{GOOD}"))
    with at_most(1000.0):
        assert row_of(model, 0.5).status == "ok"
        with at_most(0.1):
            reasons = [row_of(model, mu).reason for mu in (1, 0.5)]
    assert all("time that a submission has" in reason for reason in reasons)
    assert reasons[1].startswith("not evaluated")
    with at_most(0.0), pytest.raises(ValueError, match="time that a submission has"):
        load_again(write_model(name="next"))


def test_a_run_completes_the_others_and_its_files_are_its_own(write_model, few_cases, tmp_path, monkeypatch):
    # As with two processes of a run, each of which opens the models again.
    monkeypatch.setattr("comparisons.pipeline.run.complete", lambda *given: close_models() or complete(*given))
    out = tmp_path / "out"
    specs = [
        write_model(name="good"),
        write_model(f"for file in Path({str(out)!r}).iterdir():\n    file.write_text('mine')\n{GOOD}", "vandal"),
        write_model(f"if problem.k and problem.mu == 1:\n    os._exit(0)\n{GOOD}", "leaver"),
        write_model(more="name = f'stranger-{os.getpid()}'"),
    ]
    assert main(["run", "--jobs", "1", "--out", str(out), "--model", *specs]) == 4
    table = pd.read_csv(out / "results.csv")
    strange = table[table["model"].str.startswith("stranger")]
    assert strange["model"].nunique() == strange["model_version"].nunique() == 1
    assert strange["reason"].str.contains("name, version or files changed").tolist() == [True] * 4
    statuses = table.drop(strange.index).groupby("model")["status"].agg(set).to_dict()
    assert statuses.pop("vandal") in ({"failed"}, {"ok"})
    assert statuses == {"bradley": {"ok"}, "good": {"ok"}, "leaver": {"failed", "ok"}}
    assert table.loc[table["model"] == "good", "value"].tolist() == [1.5] * 4


#: Loads a model, prints the ids of its processes, and is then busy with a case of it.
PARENT = """
import sys
from comparisons.registry import create
from comparisons.problem import Problem
model = create(sys.argv[1])
print(model.citation, flush=True)
model.evaluate(Problem.dimensionless(2, 0, 1), "pull_off_force")
"""


@pytest.mark.parametrize(
    ("number", "start"),
    [
        (signal.SIGINT, "os.mkdir('a', 0o700)\n    os.chmod('a', 0)\n    os.chdir({own!r})"),
        # Deeper than Python may call itself, with a link and without the right to read.
        (
            signal.SIGINT,
            "for _ in range(1200):\n        os.mkdir('a')\n        os.chdir('a')\n        os.chmod('.', 0o300)\n"
            "    os.symlink({own!r}, 'b')",
        ),
        (
            signal.SIGKILL,
            "os.symlink({own!r}, 'b')\n    os.mkdir('a')\n    os.chdir('a')\n    os.rmdir('../a')\n"
            "    os._exit = os.kill = shutil.rmtree = lambda *_, **__: None",
        ),
    ],
)
def test_process_and_scratch_folder_end_with_the_parent_and_other_files_stay(write_model, tmp_path, number, start):
    files = tmp_path / "own"
    files.mkdir()
    (files / "thesis.tex").write_text("1")
    more = (
        "citation = property(lambda self: f'{os.getpid()} {self.child}')\ndef __init__(self):\n"
        "    self.child = os.fork()\n    if self.child == 0:\n        signal.alarm(300)\n        signal.pause()\n"
        f"    {start.format(own=str(files))}"
    )
    spec = write_model("while True:\n    pass", more=more)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    command = [sys.executable, "-c", PARENT, spec]
    environment = os.environ | {"TMPDIR": str(temporary)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment) as parent:
        processes = [int(text) for text in parent.stdout.readline().split()]
        assert len(processes) == 2
        assert list(temporary.iterdir())
        parent.send_signal(number)
    assert comes_true(lambda: all(map(has_ended, processes)))
    assert comes_true(lambda: not list(temporary.iterdir()))
    assert (files / "thesis.tex").read_text() == "1"
