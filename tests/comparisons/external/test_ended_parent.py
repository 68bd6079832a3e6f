"""End of the parent of a model's process: no process and no scratch folder is left, and every other file is."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.external import cleaner

from .test_hostile_models import comes_true, has_ended

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


@pytest.mark.parametrize(
    ("number", "start"),
    [
        (signal.SIGTERM, "os.chdir({own!r})"),
        (signal.SIGINT, "os.mkdir('a', 0o700)\n    os.chmod('a', 0)"),
        (signal.SIGKILL, "os.mkdir('a')\n    os.chdir('a')\n    os.rmdir('../a')"),
        (signal.SIGKILL, "os.symlink({own!r}, 'a')\n    os._exit = os.kill = shutil.rmtree = lambda *_, **__: None"),
    ],
)
def test_process_and_scratch_folder_end_with_the_parent_and_other_files_stay(write_model, tmp_path, number, start):
    own = tmp_path / "own"
    own.mkdir()
    (own / "thesis.tex").write_text("1")
    (own / "thesis.tex").chmod(0o640)
    more = f"def __init__(self):\n    {start.format(own=str(own))}{PROCESS_ID}"
    spec = write_model("while True:\n    pass", more=more)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    command = [sys.executable, "-c", PARENT, spec]
    environment = os.environ | {"TMPDIR": str(temporary)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment) as parent:
        child = int(parent.stdout.readline())
        assert list(temporary.iterdir())
        parent.send_signal(number)
    assert comes_true(lambda: has_ended(child))
    assert comes_true(lambda: not list(temporary.iterdir()))
    assert (own / "thesis.tex").read_text() == "1"


def test_a_link_in_place_of_the_scratch_folder_is_not_followed(tmp_path):
    kept = tmp_path / "kept"
    (kept / "closed").mkdir(parents=True, mode=0o500)
    (tmp_path / "link").symlink_to(kept)
    cleaner.remove(str(tmp_path / "link"))
    assert (kept / "closed").stat().st_mode & 0o777 == 0o500
    (tmp_path / "folder" / "closed").mkdir(parents=True, mode=0)
    (tmp_path / "folder").chmod(0)
    assert cleaner.remove(str(tmp_path / "folder"))
    assert not Path(tmp_path / "folder").exists()
