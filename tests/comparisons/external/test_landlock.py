"""Landlock: writing in the scratch folder of a model, and nowhere else."""

import subprocess
import sys

import pytest

from comparisons.registry import create
from comparisons.runs.tasks import evaluate

from .conftest import CASE

WORKS = "import sys; from comparisons.external.landlock import write_only_in; sys.exit(write_only_in(sys.argv[1]))"

#: The value is the number of actions that are possible elsewhere, and that of a file there which is read.
BODY = """
old, new = Path({folder!r}, "old"), Path({folder!r}, "new")
Path("here").write_text("x")
Path(os.devnull).write_text("x")
done = []
def tried(action):
    with suppress(OSError):
        action()
        done.append(action)
tried(lambda: old.open("a").write("1"))
tried(old.unlink)
tried(new.touch)
tried(new.mkdir)
tried(lambda: os.rename("here", new))
tried(lambda: os.symlink("here", new))
os.system(f"echo x > {{new}}")
thread = threading.Thread(target=tried, args=(new.touch,))
thread.start()
thread.join()
return Result(len(done) + float(old.read_text()), 0.0)
"""


def test_only_the_scratch_folder_is_writable(write_model, tmp_path):
    if subprocess.run([sys.executable, "-c", WORKS, str(tmp_path)], check=False).returncode != 1:
        pytest.skip("this kernel has no Landlock")
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    (folder / "old").write_text("0.5")
    row = evaluate(create(write_model(BODY.format(folder=str(folder)))), "pull_off_force", CASE)
    assert (row.reason, row.value) == ("", 0.5)
    assert [path.name for path in folder.iterdir()] == ["old"]
