"""Each way in which a command can end early: one sentence on stderr, its exit status, and no traceback."""

import errno
import os
import shlex
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from comparisons.cli.main import main
from comparisons.console.exit_status import FAILED, TRACEBACK, WRONG_INPUT, Terminated, guarded
from comparisons.data.file_names import STORE
from comparisons.output.markdown import to_step_summary
from comparisons.output.style import FORMATS, save
from comparisons.runs.atomic_files import write_json
from comparisons.runs.frames import write_table

SOLVE = '["solve", "--model", "jkr", "--quantity", "pull_off_force", "--n", "2", "--k", "0.4", "--mu", "1"]'
ROOT = Path(__file__).resolve().parents[3]

needs_full_device = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="the system has no /dev/full")


def raising(error):
    def command():
        raise error

    return command


@pytest.mark.parametrize(
    ("error", "status", "sentence"),
    [
        (ValueError("n = 0 is outside (0, 300]"), WRONG_INPUT, "n = 0 is outside (0, 300]"),
        (KeyError("x"), FAILED, "internal error: KeyError: 'x'; please report it"),
        (RuntimeError("two\nlines"), FAILED, "internal error: RuntimeError: two lines; please report it"),
        (OSError(errno.ENOSPC, "No space left on device", "/a/b"), FAILED, "/a/b cannot be read or written (No space"),
        (OSError(errno.ENOSPC, "No space left on device"), FAILED, "the standard output or a file cannot be written"),
        (OSError("the file a cannot be written (why)"), FAILED, "the file a cannot be written (why)"),
        (ValueError("a gate \x1b[31mred"), WRONG_INPUT, "a gate \\x1b[31mred"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (Terminated(), 143, "terminated"),
    ],
)
def test_an_exception_is_a_sentence_and_a_status(capsys, monkeypatch, error, status, sentence):
    monkeypatch.delenv(TRACEBACK, raising=False)
    assert guarded(raising(error)) == status
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith(f"fscm-bench: {sentence}")
    assert shown.err.count("\n") == 1
    assert "Traceback" not in shown.err


def test_the_traceback_is_shown_on_request(capsys, monkeypatch):
    monkeypatch.setenv(TRACEBACK, "1")
    assert guarded(raising(KeyError("x"))) == FAILED
    shown = capsys.readouterr().err
    assert shown.startswith("fscm-bench: internal error: KeyError")
    assert "in command" in shown


@pytest.mark.parametrize(("code", "status"), [(None, 0), (0, 0), (2, 2), ("text", FAILED)])
def test_an_exit_of_argparse_keeps_its_status(code, status):
    assert guarded(raising(SystemExit(code))) == status


def test_a_defect_of_a_command_is_not_taken_for_a_gate_that_fails(capsys, monkeypatch):
    monkeypatch.setattr("comparisons.cli.commands.listing.records", raising(None))
    assert main(["list", "models"]) == FAILED
    assert "internal error: TypeError" in capsys.readouterr().err


def program(*, redirected, command='["list", "quantities"]', environment=None):
    """Run a command in a shell, its streams redirected; return status, stdout and stderr."""
    code = f"import sys; from comparisons.__main__ import main; sys.argv[1:] = {command}; sys.exit(main())"
    line = f"{shlex.quote(sys.executable)} -c {shlex.quote(code)} {redirected}"
    done = subprocess.run(
        ["sh", "-c", line], capture_output=True, text=True, cwd=ROOT, env=os.environ | (environment or {})
    )
    return done.returncode, done.stdout, done.stderr


@needs_full_device
@pytest.mark.parametrize(
    ("command", "unbuffered"),
    [
        ('["list", "quantities"]', ""),
        ('["--help"]', "1"),
        (SOLVE, ""),
    ],
)
def test_a_full_standard_output(command, unbuffered):
    status, _, shown = program(redirected="> /dev/full", command=command, environment={"PYTHONUNBUFFERED": unbuffered})
    assert status == FAILED
    assert shown.startswith("fscm-bench: the standard output ")
    assert shown.endswith(f" cannot be written ({os.strerror(errno.ENOSPC)})\n")
    assert shown.count("\n") == 1


def test_a_closed_standard_output():
    status, _, shown = program(redirected=">&-")
    assert status == FAILED
    assert shown.startswith("fscm-bench: the standard output is closed")
    assert shown.count("\n") == 1


@pytest.mark.parametrize(
    ("redirected", "command", "status"),
    [
        ("2>&-", '["list", "quantities"]', 0),
        pytest.param("2> /dev/full", '["list", "colours"]', WRONG_INPUT, marks=needs_full_device),
    ],
)
def test_messages_that_cannot_be_written_change_no_status(redirected, command, status):
    gave, shown, _ = program(redirected=redirected, command=command)
    assert gave == status
    assert ("pull_off_force" in shown) == (status == 0)


SLOW = """
import os, sys, time
from pathlib import Path

def wait(folder):
    Path(folder, str(os.getpid())).touch()
    time.sleep(600)
"""
PARENT = """
import sys
from comparisons.console.exit_status import guarded
from comparisons.runs.workers import each
from slow import wait

if __name__ == "__main__":
    sys.exit(guarded(lambda: len(list(each(wait, [sys.argv[1]] * 2, 2, lost=str)))))
"""


def test_sigterm_ends_the_command_and_its_worker_processes(tmp_path):
    started = tmp_path / "started"
    started.mkdir()
    (tmp_path / "slow.py").write_text(SLOW)
    (tmp_path / "parent.py").write_text(PARENT)
    path = os.pathsep.join([str(ROOT), str(tmp_path)])
    with subprocess.Popen(
        [sys.executable, tmp_path / "parent.py", started],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": path},
    ) as process:
        while len(list(started.iterdir())) < 2 and process.poll() is None:
            threading.Event().wait(0.05)
        process.send_signal(signal.SIGTERM)
        shown = process.stderr.read()
    assert (process.returncode, shown) == (143, "fscm-bench: terminated\n")
    for file in started.iterdir():
        with pytest.raises(ProcessLookupError):
            os.kill(int(file.name), 0)


@pytest.fixture
def full_disk(monkeypatch):
    """Let every file that is written be a device without room."""

    def fdopen(handle, mode):
        os.close(handle)
        return open("/dev/full", mode)

    monkeypatch.setattr("comparisons.runs.atomic_files.os.fdopen", fdopen)


def figure():
    drawn = Figure()
    drawn.add_subplot().plot([0, 1])
    return drawn


@needs_full_device
@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("run.json", lambda path: write_json({"a": 1}, path)),
        ("kappa.csv", lambda path: write_table(pd.DataFrame({"a": [1.0]}), path.with_suffix(""))),
        *[(f"figure{suffix}", lambda path: save(figure(), path)) for suffix in FORMATS],
    ],
)
def test_a_full_disk_ends_in_a_sentence_that_names_the_file(full_disk, tmp_path, name, write):
    with pytest.raises(OSError, match=rf"{name} cannot be written \(.*{os.strerror(errno.ENOSPC)}\)$") as caught:
        write(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


@needs_full_device
def test_a_full_disk_while_results_are_written_has_status_4(toys, full_disk, tmp_path, capsys):
    csv = tmp_path / "curve.csv"
    case = ["--n", "2", "--k", "0.4", "--mu", "1"]
    assert main(["curve", "--model", "exact", *case, "--csv", str(csv)]) == FAILED
    assert capsys.readouterr().err == f"fscm-bench: the file {csv} cannot be written ({os.strerror(errno.ENOSPC)})\n"


@pytest.mark.parametrize("arguments", [["run", "--jobs", "1"], ["judge"]])
def test_a_summary_page_that_cannot_be_written_is_found_before_computing(
    small_grid, tmp_path, monkeypatch, capsys, arguments
):
    computed = []
    monkeypatch.setattr("comparisons.pipeline.run.complete", computed.append)
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path))
    folder = ["--out", str(tmp_path / "out")] if arguments[0] == "run" else [str(tmp_path / "out")]
    assert main([*arguments, *folder]) == FAILED
    shown = capsys.readouterr().err
    assert shown.count("\n") == 1
    assert f"the file {tmp_path}, which the environment variable GITHUB_STEP_SUMMARY names, cannot be written" in shown
    assert computed == []


@needs_full_device
def test_a_summary_page_without_room(monkeypatch):
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "/dev/full")
    with pytest.raises(OSError, match=rf"GITHUB_STEP_SUMMARY .*\({os.strerror(errno.ENOSPC)}\)"):
        to_step_summary("text")


@needs_full_device
def test_a_summary_page_without_room_loses_no_result_and_no_verdict(small_grid, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", "/dev/full")
    folder = tmp_path / "out"
    for arguments in (["run", "--jobs", "1", "--out", str(folder)], ["judge", str(folder)]):
        assert main(arguments) == FAILED
        shown = capsys.readouterr()
        assert "1 of 1 gate passes" in shown.out
        (sentence,) = (line for line in shown.err.splitlines() if "GITHUB_STEP_SUMMARY" in line)
        assert f"cannot be written ({os.strerror(errno.ENOSPC)})" in sentence
        assert (folder / "run.json").is_file()
        assert (folder / "junit.xml").is_file()


def test_a_store_that_cannot_be_opened_has_status_4(small_grid, tmp_path, capsys):
    (tmp_path / STORE).mkdir()
    assert main(["run", "--jobs", "1", "--out", str(tmp_path)]) == FAILED
    shown = capsys.readouterr().err
    assert shown.count("\n") == 1
    assert STORE in shown


def loop(path):
    path.parent.mkdir(exist_ok=True)
    path.symlink_to(path.name)
    return path


@pytest.mark.parametrize("spec", ["folder", "folder/model.toml", "{loop}", "file.py:Model", "~no-such-user/model"])
def test_a_model_in_a_loop_of_symbolic_links_is_wrong_input(tmp_path, capsys, spec):
    loop(tmp_path / "folder" / "model.toml")
    loop(tmp_path / "file.py")
    spec = str(loop(tmp_path / "loop")) if spec == "{loop}" else spec if spec[0] == "~" else str(tmp_path / spec)
    case = ["--n", "2", "--k", "0", "--mu", "1"]
    assert main(["solve", "--model", spec, "--quantity", "pull_off_force", *case]) == WRONG_INPUT
    assert capsys.readouterr().err.count("\n") == 1
