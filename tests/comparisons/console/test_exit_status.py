"""Each way in which a command can end early: one sentence on stderr, its exit status, and no traceback."""

import errno
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from comparisons.cli.main import main
from comparisons.console.exit_status import FAILED, TRACEBACK, WRONG_INPUT, Terminated, guarded
from comparisons.data.file_names import STORE
from comparisons.output.style import FORMATS, save
from comparisons.registry import create
from comparisons.runs.atomic_files import write_json
from comparisons.runs.csv_format import write_table
from tests.comparisons.external.conftest import comes_true, has_ended
from tests.paths import ROOT

LIST = ["list", "quantities"]
NO_ROOM = os.strerror(errno.ENOSPC)

needs_full_device = pytest.mark.skipif(not os.path.exists("/dev/full"), reason="the system has no /dev/full")


def raising(error):
    def command():
        raise error

    return command


@pytest.mark.parametrize(
    ("error", "status", "sentence"),
    [
        (ValueError("a gate \x1b[31mred"), WRONG_INPUT, "a gate \\x1b[31mred"),
        (ModuleNotFoundError("No module", name="bokeh.core"), WRONG_INPUT, "the package bokeh.core is not installed"),
        (ModuleNotFoundError("No module", name="numpy"), FAILED, "the package numpy of the installation is missing"),
        (ImportError("no name", name="comparisons.cli"), FAILED, "internal error: ImportError"),
        (RuntimeError("two\nlines"), FAILED, "internal error: RuntimeError: two lines; please report it"),
        (OSError(errno.ENOSPC, NO_ROOM, "/a/b"), FAILED, f"/a/b cannot be read or written ({NO_ROOM})"),
        (OSError(errno.ENOSPC, NO_ROOM), FAILED, "the standard output or a file cannot be written"),
        (OSError("the file a cannot be written (why)"), FAILED, "the file a cannot be written (why)"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (Terminated(), 143, "terminated"),
    ],
)
def test_an_exception_is_a_sentence_and_a_status(capsys, monkeypatch, error, status, sentence):
    monkeypatch.delenv(TRACEBACK, raising=False)
    assert guarded(raising(error)) == status
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(f"fscm-bench: {sentence}")
    assert printed.err.count("\n") == 1


def test_a_defect_has_a_traceback_on_request_and_an_exit_of_argparse_is_no_failure(capsys, monkeypatch):
    monkeypatch.setenv(TRACEBACK, "1")
    assert guarded(raising(TypeError())) == FAILED
    assert "Traceback" in capsys.readouterr().err
    assert (guarded(raising(SystemExit(0))), guarded(raising(SystemExit("text")))) == (0, FAILED)


def program(command, redirected, **environment):
    """Run a command in a shell, its streams redirected; return status, stdout and stderr."""
    code = f"import sys; from comparisons.__main__ import main; sys.argv[1:] = {command!r}; sys.exit(main())"
    line = f"{shlex.quote(sys.executable)} -c {shlex.quote(code)} {redirected}"
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, cwd=ROOT, env=os.environ | environment)
    return done.returncode, done.stdout, done.stderr


NO_OUTPUT = rf"fscm-bench: the standard output .*cannot be written \({NO_ROOM}\)\n"


@pytest.mark.parametrize(
    ("redirected", "command", "expected", "sentence"),
    [
        pytest.param("> /dev/full", LIST, FAILED, NO_OUTPUT, marks=needs_full_device),
        pytest.param("> /dev/full", ["--help"], FAILED, NO_OUTPUT, marks=needs_full_device),
        (">&-", LIST, FAILED, r"[^\n]+\n"),
        ("2>&-", LIST, 0, ""),
        pytest.param("2> /dev/full", ["list", "colours"], WRONG_INPUT, "", marks=needs_full_device),
    ],
)
def test_streams_that_are_closed_or_cannot_be_written(redirected, command, expected, sentence):
    # Without a buffer the help is not written at the end, but at once.
    status, printed, message = program(command, redirected, PYTHONUNBUFFERED="" if command == LIST else "1")
    assert status == expected
    assert ("pull_off_force" in printed) == (status == 0)
    assert re.fullmatch(sentence, message)


PARENT = """
import os, sys, time
from pathlib import Path
from comparisons.console.exit_status import guarded
from comparisons.runs.workers import each

def wait(folder):
    Path(folder, str(os.getpid())).touch()
    time.sleep(600)

if __name__ == "__main__":
    from parent import wait
    sys.exit(guarded(lambda: len(list(each(wait, [sys.argv[1]] * 2, 2, lost=str)))))
"""


@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, 143), (signal.SIGKILL, -signal.SIGKILL)])
def test_a_signal_ends_the_command_and_its_worker_processes(tmp_path, number, status):
    started = tmp_path / "started"
    started.mkdir()
    (tmp_path / "parent.py").write_text(PARENT)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(tmp_path)])}
    command = [sys.executable, tmp_path / "parent.py", started]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment) as process:
        while len(list(started.iterdir())) < 2 and process.poll() is None:
            time.sleep(0.05)
        process.send_signal(number)
        process.wait()
        assert all(comes_true(lambda file=file: has_ended(file.name)) for file in started.iterdir())
        assert process.returncode == status
        assert number == signal.SIGKILL or process.stderr.read() == "fscm-bench: terminated\n"


@pytest.fixture
def full_disk(monkeypatch):
    """Let every file that is written be a device without room."""

    def fdopen(handle, mode):
        os.close(handle)
        return open("/dev/full", mode)

    monkeypatch.setattr("comparisons.runs.atomic_files.os.fdopen", fdopen)


@needs_full_device
@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("run.json", lambda path: write_json({"a": 1}, path)),
        ("kappa.csv", lambda path: write_table(pd.DataFrame({"a": [1.0]}), path.with_suffix(""))),
        *[(f"figure{suffix}", lambda path: save(Figure(), path)) for suffix in FORMATS],
    ],
)
def test_a_full_disk_ends_in_a_sentence_that_names_the_file(full_disk, tmp_path, name, write):
    with pytest.raises(OSError, match=rf"^.*{name} cannot be written \(.*{NO_ROOM}\)$"):
        write(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_store_that_cannot_be_opened_has_status_4(small_grid, tmp_path, capsys):
    (tmp_path / STORE).mkdir()
    assert main(["run", "--jobs", "1", "--out", str(tmp_path)]) == FAILED
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert STORE in message


@pytest.mark.parametrize("spec", ["./loop", "./folder", "folder/model.toml", "file.py:Model", "~no-such-user/model"])
def test_a_model_in_a_loop_of_symbolic_links_is_wrong_input(tmp_path, monkeypatch, spec):
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    for path in (Path("loop"), Path("folder", "model.toml"), Path("file.py")):
        path.symlink_to(path.name)
    with pytest.raises(ValueError, match=r"^[^\n]*$"):
        create(spec)
