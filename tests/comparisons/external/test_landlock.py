"""Where the kernel has Landlock, a model writes in its scratch folder and nowhere else."""

import subprocess
import sys

import pytest

PROGRAM = """
import os, sys
from pathlib import Path
from comparisons.external.landlock import write_only_in

inside, outside = map(Path, sys.argv[1:])
if not write_only_in(inside):
    print("not here")
    sys.exit()

def tried(action):
    try:
        action()
    except OSError as error:
        return type(error).__name__
    return "done"

print(
    tried(lambda: (inside / "new").write_text("x")),
    tried(lambda: Path(os.devnull).write_text("x")),
    tried(lambda: (outside / "old").read_text()),
    tried(lambda: (outside / "old").write_text("x")),
    tried(lambda: os.truncate(outside / "old", 0)),
    tried(lambda: (outside / "old").unlink()),
    tried(lambda: (outside / "new").touch()),
    tried(lambda: (outside / "folder").mkdir()),
    tried(lambda: os.rename(inside / "new", outside / "new")),
)
"""


def test_only_the_scratch_folder_is_writable(tmp_path):
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    inside.mkdir()
    outside.mkdir()
    (outside / "old").write_text("kept")
    command = [sys.executable, "-c", PROGRAM, str(inside), str(outside)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    if said == ["not", "here"]:
        pytest.skip("this kernel has no Landlock")
    assert said[:3] == ["done"] * 3
    assert {said[3], *said[5:8]} == {"PermissionError"}
    # Truncation is refused from Linux 6.2 on, and a move across the border as such or as crossing devices.
    assert said[4] in {"PermissionError", "done"}
    assert said[8] in {"PermissionError", "OSError"}
    assert [path.name for path in outside.iterdir()] == ["old"]
    assert (outside / "old").read_text() in {"kept", ""}
