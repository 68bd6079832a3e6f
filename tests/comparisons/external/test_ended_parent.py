"""End of the parent of a model's process: no process and no scratch folder is left, and every other file is."""

import json
import os
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import comparisons
from comparisons.external.launch import PROGRAM
from comparisons.external.scratch import Scratch, make_scratch, remove_scratch

from .test_hostile_models import ended

#: Loads a model, prints the id of its process, and is then busy with a case of it.
PARENT = """
import sys
from comparisons.registry import create
from fscm.problem import Problem
model = create(sys.argv[1])
print(model.citation, flush=True)
model.evaluate(Problem(2, 0, 1), "pull_off_force")
"""

PROCESS_ID = "\n@property\ndef citation(self):\n    return str(os.getpid())"


def ended_by(number, spec, temporary):
    """Start a parent that computes with the model, send it a signal, and return the id of the model's process."""
    temporary.mkdir()
    environment = os.environ | {"TMPDIR": str(temporary)}
    command = [sys.executable, "-c", PARENT, spec]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment) as parent:
        child = int(parent.stdout.readline())
        parent.send_signal(number)
    return child


def comes_true(condition):
    """Whether a condition holds within a minute; a loaded machine needs a part of it."""
    for _ in range(3000):
        if condition():
            return True
        time.sleep(0.02)
    return False


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_the_working_folder_of_a_model_is_not_removed(write_model, tmp_path, number):
    own = tmp_path / "own"
    (own / "below").mkdir(parents=True)
    (own / "table.csv").write_text("1")
    (own / "below" / "thesis.tex").write_text("2")
    more = f"def __init__(self):\n    os.chdir({str(own)!r}){PROCESS_ID}"
    child = ended_by(number, write_model("while True:\n    pass", more=more), tmp_path / "temporary")
    assert ended(child)
    assert comes_true(lambda: not list((tmp_path / "temporary").iterdir()))
    assert (own / "table.csv").read_text() == "1"
    assert (own / "below" / "thesis.tex").read_text() == "2"


def test_a_model_whose_working_folder_is_gone_ends_too(write_model, tmp_path):
    more = "def __init__(self):\n    os.mkdir('a')\n    os.chdir('a')\n    os.rmdir('../a')" + PROCESS_ID
    child = ended_by(signal.SIGKILL, write_model("while True:\n    pass", more=more), tmp_path / "temporary")
    assert ended(child)
    assert comes_true(lambda: not list((tmp_path / "temporary").iterdir()))


def test_a_model_that_changes_the_functions_of_its_process_ends_too(write_model, tmp_path):
    more = (
        "def __init__(self):\n"
        "    import select, shutil\n"
        "    os._exit = os.kill = shutil.rmtree = lambda *_, **__: time.sleep(1000)\n"
        "    select.poll = threading.Thread = None" + PROCESS_ID
    )
    child = ended_by(signal.SIGKILL, write_model("while True:\n    pass", more=more), tmp_path / "temporary")
    assert ended(child)
    assert comes_true(lambda: not list((tmp_path / "temporary").iterdir()))


#: Writes elsewhere from our own thread when the parent has ended, and leaves the outcome in its scratch folder.
TRESPASSER = """
import os, shutil, sys
from pathlib import Path

def trespass(*_, **__):
    try:
        (Path({elsewhere!r}) / "new").write_text("x")
    except OSError:
        Path({scratch!r}, "refused").touch()
    else:
        Path({scratch!r}, "written").touch()
    ended(0)

ended, os._exit, shutil.rmtree = os._exit, trespass, trespass

class Model:
    name, version, citation, domain = "trespasser", "1", "none", "tests"

    def evaluate(self, problem, quantity):
        while True:
            pass
"""


def test_landlock_holds_for_our_thread_in_the_process_of_a_model(tmp_path):
    elsewhere, scratch = tmp_path / "elsewhere", tmp_path / "scratch"
    elsewhere.mkdir()
    scratch.mkdir()
    file = tmp_path / "trespasser.py"
    file.write_text(TRESPASSER.format(elsewhere=str(elsewhere), scratch=str(scratch)))
    replies, child_end = os.pipe()
    path = [str(Path(comparisons.__file__).parent.parent), *filter(None, sys.path)]
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(child_end), str(scratch), *path],
        stdin=subprocess.PIPE,
        pass_fds=[child_end],
        cwd=scratch,
    ) as child:
        os.close(child_end)
        ready = {"request": "ready", "limits": {}, "path": path}
        loading = {"request": "load", "source": {"kind": "file", "file": str(file), "attribute": "Model"}}
        for request in (ready, loading):
            child.stdin.write(json.dumps(request).encode() + b"\n")
            child.stdin.flush()
            assert select.select([replies], [], [], 120.0)[0]
            assert json.loads(os.read(replies, 1 << 16))["status"] == "ok"
        child.stdin.write(b'{"request": "evaluate", "n": 2, "k": 0, "mu": 1, "quantity": "pull_off_force"}\n')
        child.stdin.close()
    os.close(replies)
    if (scratch / "written").exists() and not landlock_works(tmp_path):
        pytest.skip("this kernel has no Landlock")
    assert [entry.name for entry in scratch.iterdir()] == ["refused"]
    assert not list(elsewhere.iterdir())


def landlock_works(folder):
    program = (
        "import sys; from comparisons.external.landlock import write_only_in; sys.exit(write_only_in(sys.argv[1]))"
    )
    return subprocess.run([sys.executable, "-c", program, str(folder)], check=False).returncode == 1


def test_only_the_folder_that_was_made_is_removed(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    scratch = make_scratch()
    (Path(scratch.path) / "closed").mkdir(mode=0)
    kept = tmp_path / "kept"
    kept.mkdir()
    (kept / "file").touch()
    made = Path(scratch.path).rename(tmp_path / "made")
    # Another folder of the same path, a link to one, and a folder whose name is not ours.
    Path(scratch.path).mkdir()
    assert not remove_scratch(scratch)
    Path(scratch.path).rmdir()
    Path(scratch.path).symlink_to(kept)
    assert not remove_scratch(scratch)
    found = kept.stat()
    assert not remove_scratch(Scratch(scratch.path, found.st_dev, found.st_ino))
    assert not remove_scratch(Scratch(str(kept), found.st_dev, found.st_ino))
    assert (kept / "file").exists()
    Path(scratch.path).unlink()
    made.rename(scratch.path)
    assert remove_scratch(scratch)
    assert remove_scratch(scratch)
